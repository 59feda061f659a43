// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "exact/triangle_contact.h"

namespace cdprep::test {

/// Two triangles in a difficult position, and the expected results.
struct HardPair {
    std::string id;  ///< number in the catalogue, T01 ... T23, and a description
    Corners a;
    Corners b;
    bool closed;  ///< they have a common point
    bool proper;  ///< their interiors cross, or they share area in one plane
};

/// Returns the pairs T01 to T23 of the catalogue at their own size. T15, T17 and T18 are
/// scaled() and shifted() versions of the others; T20 is relabelled(). The catalogue gives
/// some results, which are entered by hand. The others come from the definition in exact
/// numbers.
[[nodiscard]] std::vector<HardPair> hard_triangles();

/// Returns the pair with all coordinates times 2^exponent; nothing if a double cannot hold one.
[[nodiscard]] std::optional<HardPair> scaled(const HardPair& pair, int exponent);
/// Returns the pair with every point multiplied by a matrix, given row by row. The matrix must not
/// be singular; `closed` and `proper` then stay the same. Returns nothing if a double cannot hold a
/// coordinate.
[[nodiscard]] std::optional<HardPair> mapped(const HardPair& pair,
                                             const std::array<double, 9>& matrix);
/// Returns the pair with `shift` added to all coordinates; nothing if a double cannot hold one.
[[nodiscard]] std::optional<HardPair> shifted(const HardPair& pair, double shift);

inline constexpr std::size_t kRelabellings = 72;
/// Returns the pair with corners in another order, 6 x 6, and with a and b exchanged or not.
[[nodiscard]] HardPair relabelled(const HardPair& pair, std::size_t number);

inline constexpr std::size_t kAxisTurns = 48;
/// Returns the pair with axes permuted and reversed: rotations and reflections of the cube.
[[nodiscard]] HardPair turned(const HardPair& pair, std::size_t number);

}  // namespace cdprep::test
