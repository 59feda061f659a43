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
    /// No point of the hull is outside the solid that the piece's component bounds. Without this
    /// bit, points of the hull that are not on the piece may be inside or outside.
    piece_contained = 1,
};

/// A convex piece of the surface. Its triangles all lie on the boundary of the hull of their
/// corners, or at most outer_error below that boundary. Sections pieces, piece_triangles,
/// piece_vertices and piece_facets are all present or all absent.
///
/// Its triangles begin at piece_triangles[first_triangle]. They end before those of the next piece,
/// or at the end of the section. The same holds for the hull's corners in piece_vertices and its
/// facets in piece_facets.
struct Piece {
    std::uint32_t first_triangle;  ///< in piece_triangles; a piece has at least one
    std::uint32_t first_vertex;    ///< in piece_vertices; a hull has at least one
    std::uint32_t first_facet;     ///< in piece_facets
    std::uint32_t flags;           ///< PieceFlags
    double outer_error;            ///< model units, >= 0; 0: exactly on the hull
    std::uint32_t dimension;       ///< of the hull, 0 to 3; 2: a polygon with facets on both sides
    std::uint32_t reserved;        ///< zero
};

/// Bits of PieceFacet::flags.
enum PieceFacetFlags : std::uint32_t {
    /// The piece's triangles do not fully cover the hull face that contains this facet. A contact
    /// with this facet need not be a contact with the surface.
    facet_virtual = 1,
    facet_first_of_face = 2,  ///< the first facet of a maximal coplanar face of the hull
};

/// A triangle of a hull's boundary, counter-clockwise seen from outside, not degenerate. The facets
/// of a coplanar face are consecutive.
struct PieceFacet {
    std::array<std::uint32_t, 3> corner;  ///< indices among the corners of its own piece
    std::uint32_t flags;                  ///< PieceFacetFlags
};

/// A leaf of the BVH over pieces: consecutive elements of piece_triangles, all of one piece. The
/// triangles of leaf k lie in box k % 8 of node k / 8 on the lowest level of piece_nodes. Sections
/// piece_nodes, piece_leaves, piece_node_hulls and piece_swept are all present or all absent.
struct PieceLeaf {
    std::uint32_t piece;
    std::uint32_t first_triangle;  ///< in piece_triangles
    std::uint32_t count;           ///< 1 to kBvhWidth
};

/// A hull around a node of the BVH over pieces has at most this many corners.
inline constexpr std::uint32_t kPieceHullCorners = 32;

/// A convex hull of few corners around the contents of a node of the BVH over pieces. It contains
/// every vertex below the node, exactly.
struct PieceNodeHull {
    std::array<HullBlock, kPieceHullCorners / kHullLanes> block;  ///< corners
    /// No point of the hull is farther than this from the exact hull of the vertices below; model
    /// units.
    double slack;
    std::uint32_t count;         ///< corners, 1 to kPieceHullCorners; lanes beyond repeat the last
    std::uint32_t reserved[13];  ///< zero
};

/// The largest number of leaves of the BVH over pieces.
inline constexpr std::uint32_t kMaxPieceLeaves = kMaxTriangles / kBvhWidth;

/// Returns the shape of the BVH over pieces. It is that of a model's BVH with this many leaves. On
/// level 0, box j of node i contains leaf 8i + j of piece_leaves. `leaves` is at most
/// kMaxPieceLeaves.
[[nodiscard]] constexpr BvhShape piece_tree_shape(std::uint32_t leaves) noexcept {
    return bvh_shape(leaves * kBvhWidth);
}

/// Returns the number of nodes with hulls. These are the first ones: all above level 0, and the
/// root.
[[nodiscard]] constexpr std::uint32_t piece_hull_count(const BvhShape& shape) noexcept {
    return shape.levels > 1 ? shape.first[0] : shape.node_count;
}

static_assert(sizeof(PieceLeaf) == 12 && alignof(PieceLeaf) == 4);
static_assert(sizeof(PieceNodeHull) == 832 && alignof(PieceNodeHull) == 64);
static_assert(offsetof(PieceNodeHull, slack) == 768 && offsetof(PieceNodeHull, count) == 776);
static_assert(std::is_trivially_copyable_v<PieceLeaf> &&
              std::is_trivially_copyable_v<PieceNodeHull>);

/// The facets on the other side of a facet's edges, numbered within the piece. across[i] is beyond
/// the edge from corner i to the next. Every edge of a hull has two facets.
struct PieceAdjacency {
    std::array<std::uint32_t, 3> across;
};

/// The bend of the surface at an edge of a triangle, decided by exact predicates. Convex and reflex
/// are seen from outside, where a triangle's corners are in counter-clockwise order.
enum class EdgeConvexity : std::uint8_t {
    /// The bend is not defined. The edge may be a border or have more than two triangles. Its two
    /// triangles may have opposite windings or fold onto each other in a plane. One of the
    /// triangles may have no area.
    unknown = 0,
    flat = 1,
    convex = 2,
    reflex = 3,
};

/// Returns the convexity of the edge from corner `edge` to the next. `bits` is the triangle's byte
/// in section edge_convexity, and `edge` is below 3.
[[nodiscard]] constexpr EdgeConvexity edge_convexity(std::uint8_t bits, std::size_t edge) noexcept {
    return static_cast<EdgeConvexity>((bits >> (2 * edge)) & 3);
}

/// Returns a triangle's byte in section edge_convexity for the convexity of its three edges.
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
