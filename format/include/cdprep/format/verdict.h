// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace cdprep::format {

/// Bits of Verdict::facts: what was found true of a mesh, or of one component of it.
/// A bit that is not set is false, but for self_crossing, which says something only
/// together with crossings_examined. All are decided after vertices with equal
/// positions were joined and triangles that repeat a corner were left out. Where no triangle
/// is left all but crossings_examined are unset, and promise_surface is the only promise.
enum VerdictFacts : std::uint32_t {
    verdict_closed = 1,               ///< every edge is used by two triangles or more
    verdict_two_manifold = 2,         ///< at most two triangles an edge, one fan a vertex
    verdict_oriented = 4,             ///< edges of two triangles are run through in both directions
    verdict_orientable = 8,           ///< some choice of windings would make it oriented
    verdict_balanced = 16,            ///< oriented uses of every edge cancel: winding numbers exist
    verdict_inverted = 32,            ///< balanced, and its signed volume is negative
    verdict_crossings_examined = 64,  ///< self_crossing was decided
    verdict_self_crossing = 128,      ///< triangles cross, touch, or overlap in a plane where
                                      ///< they are not neighbours
};

/// Bits of Verdict::promises: what answers mean on it.
enum VerdictPromises : std::uint32_t {
    /// collide, overlap, distance, within, ray and closest, as questions about the
    /// surface: exact on any mesh that can be baked.
    promise_surface = 1,
    /// Inside is decided exactly by a winding number: balanced.
    promise_inside_exact = 2,
    /// That number is 0 or 1 everywhere, and the volume is what is enclosed: closed,
    /// 2-manifold, oriented, not inverted, and examined without a crossing.
    promise_simple_solid = 4,
    /// Convex pieces of its surface may lie within the solid: closed and oriented.
    promise_contained_pieces = 8,
};

/// What was found of the whole mesh (the first of the section) or of a component (the
/// others, in the order of their lowest source triangle).
struct Verdict {
    std::uint32_t facts;           ///< VerdictFacts
    std::uint32_t promises;        ///< VerdictPromises
    std::uint32_t triangle_count;  ///< those that repeat a corner among them
    std::uint32_t first_triangle;  ///< the lowest, source numbering; 0 when there is none
    std::uint32_t boundary_loops;  ///< holes, by their loops of edges with one triangle
    std::int32_t euler;            ///< vertices - edges + triangles, repeated corners left out
    std::int32_t genus;            ///< handles, of closed orientable 2-manifolds; -1 else
    std::uint32_t reserved;        ///< zero
    double area;                   ///< square model units
    double volume;                 ///< cubic model units, signed; 0 unless balanced
};

static_assert(sizeof(Verdict) == 48 && alignof(Verdict) == 8);
static_assert(offsetof(Verdict, euler) == 20);
static_assert(offsetof(Verdict, area) == 32);
static_assert(std::is_trivially_copyable_v<Verdict> && std::is_standard_layout_v<Verdict>);

}  // namespace cdprep::format
