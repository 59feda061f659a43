// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "support/meshes.h"

#include "cdprep/pose.h"

namespace cdprep::test {

/// Axes renamed and reversed, then all lengths times a power of two, then all coordinates
/// plus a number: what may change no answer, where it loses no bit.
struct ExactChange {
    std::string name;
    std::array<std::size_t, 3> axis = {0, 1, 2};
    std::array<double, 3> sign = {1, 1, 1};
    int exponent = 0;
    double shift = 0;

    /// Nothing when a coordinate cannot be held.
    [[nodiscard]] std::optional<Double3> operator()(const Double3& p) const;
    [[nodiscard]] std::optional<std::vector<Double3>> operator()(
        const std::vector<Double3>& points) const;
    [[nodiscard]] std::optional<TestMesh> operator()(const TestMesh& mesh) const;
    /// The turn and the shift as a pose, of coordinates that have been scaled.
    [[nodiscard]] Pose pose() const;
    /// Lengths, where they can be held.
    [[nodiscard]] double length(double before) const;
};

/// The 24 turns of the cube, scaling by 2^-40, 2^-20, 2^20 and 2^40, a shift by 2^20, and some
/// of all at once; with `few`, three turns of the 23. The first changes nothing.
[[nodiscard]] std::vector<ExactChange> exact_changes(bool few);

}  // namespace cdprep::test
