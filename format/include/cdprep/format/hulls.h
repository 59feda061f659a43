// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "cdprep/format/geometry.h"
#include "cdprep/format/hull.h"

namespace cdprep::format {

/// The set that a hull encloses.
enum class HullScope : std::uint32_t {
    whole = 0,      ///< the whole mesh
    component = 1,  ///< a connected component
    instance = 2,   ///< an instance of the imported file
    part = 3,       ///< a part; all parts together contain the surface and its interior
};

/// Bits of Hull::flags.
enum HullFlags : std::uint32_t {
    hull_exact = 1,  ///< all points are mesh vertices; otherwise the hull contains the exact hull
};

/// A convex hull. In dimension 3 it is a closed polyhedron, in 2 a two-sided polygon. In 1 it is a
/// segment, in 0 a point, and in -1 it is empty.
///
/// The exact hull is the convex hull of the enclosed vertices. No point of the stored hull is
/// farther than `distance` from the exact hull, in model units. No point of a part is farther than
/// `distance` from the surface and its interior. In each section, the elements of a hull directly
/// follow those of the previous hull. Indices in these elements count from the hull's own first
/// element, except the vertex numbers in hull_vertices.
struct Hull {
    HullScope scope;
    std::uint32_t number;  ///< of the component, instance or part; 0 for the whole
    std::int32_t dimension;
    std::uint32_t flags;        ///< HullFlags
    std::uint32_t first_block;  ///< in hull_blocks; 8 * first_block in hull_vertices
    std::uint32_t point_count;
    std::uint32_t first_facet;
    std::uint32_t facet_count;  ///< 2 * point_count - 4 in dimensions 2 and 3, else 0
    std::uint32_t first_group;
    std::uint32_t group_count;
    std::uint32_t first_neighbour;  ///< in hull_neighbours: point_count + 1 list starts, then
                                    ///< neighbour_count points
    std::uint32_t neighbour_count;  ///< 0: no lists are stored; searches scan the hull
    std::uint32_t first_start;
    std::uint32_t start_count;  ///< kHullStarts with neighbours, otherwise 0
    double distance;            ///< model units; see above
    Double3 reach;              ///< at least |x|, |y|, |z| of every point
};

/// A triangle of a hull, counter-clockwise from outside.
struct HullFacet {
    std::array<std::uint32_t, 3> point;
    std::array<std::uint32_t, 3> across;  ///< the facet beyond the edge from point i to the next
    std::uint32_t group;                  ///< index of its HullGroup; facets are sorted by it
};

/// A maximal, exactly coplanar face of a hull.
struct HullGroup {
    std::uint32_t first_facet;
    std::uint32_t facet_count;
};

/// The number of directions with a stored start point for hill climbing. These directions point to
/// the middles of 8 x 8 cells on each face of a cube.
inline constexpr std::uint32_t kHullStarts = 6 * 8 * 8;
/// The value in hull_vertices for a point that is not a vertex of the imported file, and for lanes
/// past the last point.
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
