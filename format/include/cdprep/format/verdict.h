// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace cdprep::format {

/// Bits of Verdict::facts: facts about a mesh or one component of it. A bit that is not set means
/// that the fact is false. The exception is self_crossing: it is valid only if crossings_examined
/// is set. Before facts are decided, vertices with equal positions are merged and triangles with a
/// repeated corner are left out. If no triangle is left, no fact but crossings_examined can be set,
/// and promise_surface is the only promise.
enum VerdictFacts : std::uint32_t {
    verdict_closed = 1,               ///< every edge is used by two triangles or more
    verdict_two_manifold = 2,         ///< at most two triangles per edge, one fan per vertex
    verdict_oriented = 4,             ///< where an edge has exactly two triangles, they traverse it
                                      ///< in opposite directions
    verdict_orientable = 8,           ///< some choice of windings would make it oriented
    verdict_balanced = 16,            ///< directed uses of every edge cancel: winding numbers exist
    verdict_inverted = 32,            ///< balanced, and its signed volume is negative
    verdict_crossings_examined = 64,  ///< self_crossing was decided
    verdict_self_crossing = 128,      ///< triangles meet outside their common vertices and edges,
                                      ///< or coincide
};

/// Bits of Verdict::promises: guarantees for queries on the mesh.
enum VerdictPromises : std::uint32_t {
    /// collide, overlap, distance, within, ray and closest, as queries about the surface, are
    /// exact. This holds for any mesh that can be baked.
    promise_surface = 1,
    /// Winding numbers decide exactly whether a point is inside: the mesh is balanced.
    promise_inside_exact = 2,
    /// The winding number is 0 or 1 everywhere, and Verdict::volume is the enclosed volume. The
    /// mesh is closed, 2-manifold, oriented and not inverted. It was examined for crossings, and
    /// none was found.
    promise_simple_solid = 4,
    /// Pieces of the surface can have piece_contained (pieces.h): the mesh is closed and oriented.
    promise_contained_pieces = 8,
};

/// The facts and promises of the whole mesh or of a component. The first verdict of the section is
/// that of the mesh. Those of the components follow, in the order of `first_triangle`. Triangles
/// that repeat a corner join no components and form none.
struct Verdict {
    std::uint32_t facts;           ///< VerdictFacts
    std::uint32_t promises;        ///< VerdictPromises
    std::uint32_t triangle_count;  ///< including those that repeat a corner
    std::uint32_t first_triangle;  ///< lowest source number of a triangle that repeats no corner;
                                   ///< 0 if there is none
    std::uint32_t boundary_loops;  ///< holes, counted as loops of edges with one triangle
    std::int32_t euler;            ///< V - E + F, over the triangles that repeat no corner
    std::int32_t genus;            ///< handles of a closed orientable 2-manifold; otherwise -1
    std::uint32_t reserved;        ///< zero
    double area;                   ///< square model units
    double volume;                 ///< cubic model units, signed; 0 unless balanced
};

static_assert(sizeof(Verdict) == 48 && alignof(Verdict) == 8);
static_assert(offsetof(Verdict, euler) == 20);
static_assert(offsetof(Verdict, area) == 32);
static_assert(std::is_trivially_copyable_v<Verdict> && std::is_standard_layout_v<Verdict>);

}  // namespace cdprep::format
