// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace cdprep::format {

/// The limits that the runtime relies on, all inclusive. find_damage() enforces them, so queries
/// may size stacks and indices by them.

inline constexpr std::uint32_t kMaxTriangles = 0x7fffffff;  ///< triangles of one model
inline constexpr std::uint32_t kMaxVertices = 0x7fffffff;   ///< vertices of one model

/// The number of boxes in a node, and of triangles in a leaf, of the BVH.
inline constexpr std::uint32_t kBvhWidth = 8;

/// An upper bound of the number of levels of nodes above the leaves. Ten levels already suffice for
/// 8^11 triangles, more than kMaxTriangles.
inline constexpr std::uint32_t kMaxBvhLevels = 11;

inline constexpr std::uint32_t kMaxSections = 120;  ///< entries that fit in the user block

/// The limit of |x| for every coordinate x of a vertex, in model units. Sums and differences of
/// coordinates stay far below the largest double.
inline constexpr double kMaxCoordinate = 0x1p1000;

/// The limits of FileHeader::frame_exponent. Vertices that reach r from the origin of their frame
/// get the exponent -2 - floor(log2 r), and r is 2^-1074 to kMaxCoordinate. So corners of boxes are
/// at most 2^1002 from the origin in model units, far below the largest double.
inline constexpr std::int32_t kMinFrameExponent = -1002;
inline constexpr std::int32_t kMaxFrameExponent = 1072;

}  // namespace cdprep::format
