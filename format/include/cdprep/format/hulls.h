// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "cdprep/format/geometry.h"
#include "cdprep/format/hull.h"

namespace cdprep::format {

/// What a hull is around.
enum class HullScope : std::uint32_t {
    whole = 0,      ///< the whole mesh
    component = 1,  ///< a connected component
    instance = 2,   ///< an instance of the imported file
    part = 3,       ///< some of the surface and of what it encloses; all parts hold all of it
};

/// Bits of Hull::flags.
enum HullFlags : std::uint32_t {
    hull_exact = 1,  ///< its points are vertices; else it contains the exact hull
};

/// A convex hull: of dimension 3 a closed polyhedron, 2 a polygon seen from both sides, 1 a
/// segment, 0 a point, -1 of nothing. No point of it is farther than `distance`, in model
/// units, from the exact hull; of a part, from the surface and what it encloses. What belongs to
/// hulls follows each other in their sections without gaps, in the order of the hulls; numbers in
/// them count from the hull's own first one.
struct Hull {
    HullScope scope;
    std::uint32_t number;  ///< of the component, instance or part; 0 for the whole
    std::int32_t dimension;
    std::uint32_t flags;        ///< HullFlags
    std::uint32_t first_block;  ///< HullBlock, and eight times as many hull_vertices
    std::uint32_t point_count;
    std::uint32_t first_facet;
    std::uint32_t facet_count;  ///< 2 * point_count - 4 in dimensions 2 and 3, else 0
    std::uint32_t first_group;
    std::uint32_t group_count;
    std::uint32_t first_neighbour;  ///< of point_count + 1 begins, then neighbour_count points
    std::uint32_t neighbour_count;  ///< 0: neither, as for small hulls, which are scanned
    std::uint32_t first_start;
    std::uint32_t start_count;  ///< kHullStarts where there are neighbours, else 0
    double distance;            ///< see below
    Double3 reach;              ///< at least |x|, |y|, |z| of every point
};

/// A triangle of a hull, counter-clockwise from outside.
struct HullFacet {
    std::array<std::uint32_t, 3> point;
    std::array<std::uint32_t, 3> across;  ///< facet beyond the edge from point i to the next
    std::uint32_t group;                  ///< rises with the facets' numbers
};

/// A maximal coplanar face of a hull, exactly.
struct HullGroup {
    std::uint32_t first_facet;
    std::uint32_t facet_count;
};

/// Directions for which a start is stored: 8 x 8 cells on each face of a cube.
inline constexpr std::uint32_t kHullStarts = 6 * 8 * 8;
/// In hull_vertices: a point that is none of the imported file's.
inline constexpr std::uint32_t kNoVertex = 0xffffffffU;

static_assert(sizeof(Hull) == 88 && alignof(Hull) == 8);
static_assert(offsetof(Hull, first_block) == 16 && offsetof(Hull, first_start) == 48);
static_assert(offsetof(Hull, distance) == 56 && offsetof(Hull, reach) == 64);
static_assert(sizeof(HullFacet) == 28 && alignof(HullFacet) == 4);
static_assert(offsetof(HullFacet, group) == 24);
static_assert(sizeof(HullGroup) == 8 && alignof(HullGroup) == 4);
static_assert(std::is_trivially_copyable_v<Hull> && std::is_standard_layout_v<Hull>);
static_assert(std::is_trivially_copyable_v<HullFacet> && std::is_standard_layout_v<HullFacet>);

}  // namespace cdprep::format
