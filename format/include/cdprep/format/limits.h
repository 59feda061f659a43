// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace cdprep::format {

/// The limits that the runtime relies on. find_damage() checks every one of
/// them, so a query may size its stack and its indices by them. All inclusive.

inline constexpr std::uint32_t kMaxTriangles = 0x7fffffff;  ///< triangles of one model
inline constexpr std::uint32_t kMaxVertices = 0x7fffffff;   ///< vertices of one model

/// Boxes in a node, and triangles in a leaf, of the bounding volume hierarchy.
inline constexpr std::uint32_t kBvhWidth = 8;

/// Levels of nodes above the leaves: 8^11 triangles exceed kMaxTriangles.
inline constexpr std::uint32_t kMaxBvhLevels = 11;

inline constexpr std::uint32_t kMaxSections = 120;  ///< entries that fit the user block

/// |x| of every coordinate, and of every extent, in model units. A quarter of
/// the largest double's exponent range stays free for products of two.
inline constexpr double kMaxCoordinate = 0x1p1000;

}  // namespace cdprep::format
