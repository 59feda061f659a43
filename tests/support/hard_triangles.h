// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "exact/triangle_contact.h"

namespace cdprep::test {

/// Two triangles that stand awkwardly, and what must be said of them.
struct HardPair {
    std::string id;  ///< of the catalogue: T01 ... T23, with what is special
    Corners a;
    Corners b;
    bool closed;  ///< they have a common point
    bool proper;  ///< their insides cross, or they share area in one plane
};

/// The catalogue's pairs T01 to T23 at their own size. T15, T17 and T18 are
/// scaled() and shifted() ones of the others, T20 is relabelled(). Answers are
/// written down by hand where the catalogue gives them, and otherwise found by
/// the definition in exact numbers.
[[nodiscard]] std::vector<HardPair> hard_triangles();

/// All coordinates times 2^exponent; nothing when one of them cannot be held.
[[nodiscard]] std::optional<HardPair> scaled(const HardPair& pair, int exponent);
/// Every point times a matrix, row by row, which is not singular: what touches, crosses or shares
/// area still does. Nothing when a coordinate cannot be held.
[[nodiscard]] std::optional<HardPair> mapped(const HardPair& pair,
                                             const std::array<double, 9>& matrix);
/// All coordinates plus `shift`; nothing when one of them cannot be held.
[[nodiscard]] std::optional<HardPair> shifted(const HardPair& pair, double shift);

inline constexpr std::size_t kRelabellings = 72;
/// Corners in another order, 6 x 6, and a and b exchanged.
[[nodiscard]] HardPair relabelled(const HardPair& pair, std::size_t number);

inline constexpr std::size_t kAxisTurns = 48;
/// Axes permuted and reversed: rotations and reflections of the cube.
[[nodiscard]] HardPair turned(const HardPair& pair, std::size_t number);

}  // namespace cdprep::test
