// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace cdprep::format {

/// The limits that the runtime relies on. find_damage() checks each of them, so a query may size
/// its stack and its indices by them. All are inclusive.

inline constexpr std::uint32_t kMaxTriangles = 0x7fffffff;  ///< triangles of one model
inline constexpr std::uint32_t kMaxVertices = 0x7fffffff;   ///< vertices of one model

/// The number of boxes in a node, and of triangles in a leaf, of the BVH.
inline constexpr std::uint32_t kBvhWidth = 8;

/// The number of levels of nodes above the leaves: 8^11 triangles exceed kMaxTriangles.
inline constexpr std::uint32_t kMaxBvhLevels = 11;

inline constexpr std::uint32_t kMaxSections = 120;  ///< entries that fit the user block

/// The limit of |x| for every coordinate and every extent, in model units. Sums and differences of
/// such numbers stay far below the largest double.
inline constexpr double kMaxCoordinate = 0x1p1000;

}  // namespace cdprep::format
