// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "cdprep/format/bvh_shape.h"
#include "cdprep/format/hull.h"

namespace cdprep::format {

/// Bits of Piece::flags.
enum PieceFlags : std::uint32_t {
    /// No point of the hull is outside the solid that the piece's component bounds. Without
    /// it nothing is known of what the hull covers besides the piece.
    piece_contained = 1,
};

/// A convex piece of the surface: triangles that all lie on the boundary of the hull of
/// their corners, or at most outer_error below it. Sections 50 to 53 are all there or none.
///
/// Its triangles are piece_triangles[first_triangle] up to those of the next piece, or to
/// the end; likewise the hull's corners in piece_vertices and its facets in piece_facets.
struct Piece {
    std::uint32_t first_triangle;  ///< in piece_triangles; a piece has one at least
    std::uint32_t first_vertex;    ///< in piece_vertices; a hull has one at least
    std::uint32_t first_facet;     ///< in piece_facets
    std::uint32_t flags;           ///< PieceFlags
    double outer_error;            ///< model units, 0 or more; 0: exactly on the hull
    std::uint32_t dimension;       ///< of the hull: 3; 2: flat, seen from both sides; 1; 0
    std::uint32_t reserved;        ///< zero
};

/// Bits of PieceFacet::flags.
enum PieceFacetFlags : std::uint32_t {
    /// The triangles of the piece do not cover the face that the facet is of: who meets it
    /// has not met the surface yet.
    facet_virtual = 1,
    facet_first_of_face = 2,  ///< the first of a maximal coplanar face of the hull
};

/// A triangle of a hull's boundary, counter-clockwise seen from outside, not degenerate; those
/// of a coplanar face follow each other.
struct PieceFacet {
    std::array<std::uint32_t, 3> corner;  ///< places among the corners of its own piece
    std::uint32_t flags;                  ///< PieceFacetFlags
};

/// Triangles of one piece that a box of the lowest piece_nodes is around: one after the
/// other in piece_triangles. Sections 54 to 56 and 61 are all there or none.
struct PieceLeaf {
    std::uint32_t piece;
    std::uint32_t first_triangle;  ///< in piece_triangles
    std::uint32_t count;           ///< 1 to kBvhWidth
};

/// Most corners of the hull around a node of the hierarchy of pieces.
inline constexpr std::uint32_t kPieceHullCorners = 32;

/// A convex hull of few corners around what a node of the hierarchy of pieces holds: every
/// vertex below is in it, exactly.
struct PieceNodeHull {
    std::array<HullBlock, kPieceHullCorners / kHullLanes> block;  ///< corners
    /// No point of it is farther than this from the exact hull of what is below, model units.
    double slack;
    std::uint32_t count;         ///< corners, 1 to kPieceHullCorners; lanes beyond repeat the last
    std::uint32_t reserved[13];  ///< zero
};

/// The shape of the hierarchy: as that of a model's boxes, but what a box of level 0 is
/// around is leaf 8i + j of piece_leaves. `leaves` is at most kMaxPieceLeaves.
inline constexpr std::uint32_t kMaxPieceLeaves = kMaxTriangles / kBvhWidth;
[[nodiscard]] constexpr BvhShape piece_tree_shape(std::uint32_t leaves) noexcept {
    return bvh_shape(leaves * kBvhWidth);
}

/// How many nodes have hulls, the first ones: all above level 0, and the root.
[[nodiscard]] constexpr std::uint32_t piece_hull_count(const BvhShape& shape) noexcept {
    return shape.levels > 1 ? shape.first[0] : shape.node_count;
}

static_assert(sizeof(PieceLeaf) == 12 && alignof(PieceLeaf) == 4);
static_assert(sizeof(PieceNodeHull) == 832 && alignof(PieceNodeHull) == 64);
static_assert(offsetof(PieceNodeHull, slack) == 768 && offsetof(PieceNodeHull, count) == 776);
static_assert(std::is_trivially_copyable_v<PieceLeaf> &&
              std::is_trivially_copyable_v<PieceNodeHull>);

/// The facets beyond a facet's edges, numbered within the piece: across[i] beyond the edge
/// from corner i to the next. Every edge of a hull has two facets.
struct PieceAdjacency {
    std::array<std::uint32_t, 3> across;
};

/// How the surface bends at an edge of a triangle, by exact signs: convex and reflex seen from
/// outside, that is from where triangles turn counter-clockwise.
enum class EdgeConvexity : std::uint8_t {
    /// No two triangles meet in it that agree what outside is: a border, more than two, two
    /// wound against each other or one over the other in a plane, one without area.
    unknown = 0,
    flat = 1,
    convex = 2,
    reflex = 3,
};

/// Of a triangle's bits in edge_convexity: the edge from its corner `edge`, below 3, to the next.
[[nodiscard]] constexpr EdgeConvexity edge_convexity(std::uint8_t bits, std::size_t edge) noexcept {
    return static_cast<EdgeConvexity>((bits >> (2 * edge)) & 3);
}

/// The bits of three edges.
[[nodiscard]] constexpr std::uint8_t edge_convexity_bits(
    const std::array<EdgeConvexity, 3>& edge) noexcept {
    return static_cast<std::uint8_t>(static_cast<unsigned>(edge[0]) |
                                     static_cast<unsigned>(edge[1]) << 2 |
                                     static_cast<unsigned>(edge[2]) << 4);
}

static_assert(sizeof(PieceAdjacency) == 12 && alignof(PieceAdjacency) == 4);
static_assert(sizeof(Piece) == 32 && alignof(Piece) == 8);
static_assert(offsetof(Piece, outer_error) == 16 && offsetof(Piece, dimension) == 24);
static_assert(sizeof(PieceFacet) == 16 && alignof(PieceFacet) == 4);
static_assert(offsetof(PieceFacet, flags) == 12);
static_assert(std::is_trivially_copyable_v<Piece> && std::is_trivially_copyable_v<PieceFacet>);

}  // namespace cdprep::format
