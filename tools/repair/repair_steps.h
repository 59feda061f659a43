// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cdprep/advanced/build_bvh.h"
#include "crossings/self_intersections.h"
#include "repair/repair_step.h"

/// The steps of repair(). Each is a function from a mesh to a mesh and a report of its changes.
/// All but the first require finite positions, and corners that are in range.
namespace cdprep::mesh {

/// Drops triangles with a corner that is not finite, and those in `out_of_range`. These are the
/// triangles that the import found out of range, by ascending number.
[[nodiscard]] Stepped drop_bad_numbers(RepairMesh mesh, std::span<const OutOfRange> out_of_range);

/// Runs weld(), and drops vertices that no triangle uses.
[[nodiscard]] Stepped weld_vertices(RepairMesh mesh, double distance);

/// Drops vertices that no triangle uses.
[[nodiscard]] Stepped drop_unused(RepairMesh mesh);

[[nodiscard]] Stepped drop_repeated_corners(RepairMesh mesh);

/// Keeps the lowest of the triangles with the same corners and the same winding. Those of
/// opposite winding remain for split_non_manifold().
[[nodiscard]] Stepped drop_duplicates(RepairMesh mesh);

/// Replaces a triangle with exactly collinear corners and its neighbour across the longest edge
/// by two triangles. These cover the same surface as the neighbour did. If the longest edge has
/// no neighbour, the triangle is dropped. Nothing moves. Refuses if that edge has several
/// neighbours, or if the new edge exists already.
[[nodiscard]] Stepped drop_zero_area(RepairMesh mesh);

/// Gives neighbours across edges of two triangles consistent windings. Reverses the smaller
/// number of triangles in each patch. Where a patch cannot be oriented, split_non_manifold()
/// cuts it.
[[nodiscard]] Stepped orient(RepairMesh mesh);

/// Splits edges of more than two triangles into pairs and boundaries, and vertices into one per
/// fan. A pair bounds the same wedge of solid, by exact angles. If two triangles with the same
/// corners remain, the later one gets a vertex in its middle. If two pairs still share an edge,
/// one of them gets a vertex in its middle. These middles are rounded: only they may lie off the
/// surface, by the rounding.
[[nodiscard]] Stepped split_non_manifold(RepairMesh mesh);

/// Joins boundary vertices that are at most `width` apart to the lowest of them. A boundary edge
/// has one triangle.
[[nodiscard]] Stepped stitch_seams(RepairMesh mesh, double width);

/// Cuts triangles at boundary vertices that lie on their boundary edges. The test is exact, or
/// within `width`; the edge then moves to the vertex.
[[nodiscard]] Stepped resolve_t_junctions(RepairMesh mesh, double width);

/// The treatment of a patch that meets a triangle in a mesh that had no meetings.
enum class Crossing : std::uint8_t {
    refused,
    resolved_later  ///< by resolve_self_intersections(), after this step
};
struct HoleLimits {
    double diagonal;  ///< limit on the diagonal of a loop's box, in model units
    Crossing crossing;
};

/// Closes loops of boundary edges. Uses the triangles that CGAL's triangulate_hole_polyline()
/// proposes. If these would share an edge with others, it uses triangles around a new vertex in
/// the middle. The mesh must be 2-manifold and oriented. `search.stop` leaves the remaining
/// loops open, without a report.
[[nodiscard]] Stepped fill_holes(RepairMesh mesh, const HoleLimits& limits,
                                 const SearchOptions& search);

/// Reverses balanced components of negative volume, except cavities. A cavity lies within an odd
/// number of other balanced components, by its box and its first point off the other's surface.
/// Refuses to reverse a component that touches another at every point tested.
[[nodiscard]] Stepped orient_outward(RepairMesh mesh);

/// Keeps the boundary of the solid. Cuts triangles where they cross, touch or overlap. Keeps
/// those that separate winding number 0 from another one. Overlapping components become their
/// union, and inner surfaces disappear.
///
/// Changes nothing if no two triangles meet. Refuses in these cases, and names a pair if it
/// knows one:
/// - The mesh is not balanced.
/// - The cuts still cross after rounding.
/// - A part touches others at every point tested, so its winding number is unknown.
/// - The mesh has sheets that bound nothing; these would be lost.
/// - There are more pairs than the limits allow.
/// - `stop` ended the work; it is not tested during the search for pairs.
[[nodiscard]] Stepped resolve_self_intersections(RepairMesh mesh, const SearchOptions& search,
                                                 const StopCheck& stop);

/// Drops components with fewer than `least` triangles.
[[nodiscard]] Stepped drop_components(RepairMesh mesh, std::uint64_t least);

}  // namespace cdprep::mesh
