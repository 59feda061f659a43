// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cdprep/advanced/build_bvh.h"
#include "repair/repair_step.h"
#include "crossings/self_intersections.h"

/// The steps of repair(), each a function from a mesh to a mesh and what it changed. All
/// but the first ask for finite positions, and corners that are in range.
namespace cdprep::mesh {

/// Leaves out triangles with a corner that is not finite, and those that the import found
/// out of range: `out_of_range` of them, by ascending number.
[[nodiscard]] Stepped drop_bad_numbers(RepairMesh mesh,
                                       std::span<const std::uint32_t> out_of_range);

/// weld(), with vertices that no triangle uses left out.
[[nodiscard]] Stepped weld_vertices(RepairMesh mesh, double distance);

/// Leaves out vertices that no triangle uses.
[[nodiscard]] Stepped drop_unused(RepairMesh mesh);

[[nodiscard]] Stepped drop_repeated_corners(RepairMesh mesh);

/// Of triangles with the same corners and the same winding the lowest stays. Those of
/// opposite winding are left to split_non_manifold().
[[nodiscard]] Stepped drop_duplicates(RepairMesh mesh);

/// Replaces a triangle of exactly collinear corners and its neighbour across the longest
/// edge by two triangles that cover what the neighbour covered; one whose longest edge
/// has no neighbour is left out. Nothing moves. Refuses where that edge has several
/// neighbours, or the new edge is there already.
[[nodiscard]] Stepped drop_zero_area(RepairMesh mesh);

/// Winds triangles as their neighbours across edges of two triangles, reversing the fewer
/// of each patch. Where a patch cannot be oriented, split_non_manifold() cuts it.
[[nodiscard]] Stepped orient(RepairMesh mesh);

/// Parts edges of more than two triangles into pairs and boundaries, and vertices into one
/// a fan. Pairs are what bounds the same wedge of solid, by exact angles. Two triangles
/// with the same corners that remain get a vertex in the middle of the later one; edges
/// that two pairs still share get one in the middle of one pair's. Those middles are
/// rounded: the only positions that may be off the surface, by a rounding.
[[nodiscard]] Stepped split_non_manifold(RepairMesh mesh);

/// Joins vertices of boundaries, edges of one triangle, that are at most `width` apart, to
/// the lowest of them.
[[nodiscard]] Stepped stitch_seams(RepairMesh mesh, double width);

/// Cuts triangles at vertices of boundaries that lie on their boundary edges: exactly, or
/// within `width`, which moves the edge there.
[[nodiscard]] Stepped resolve_t_junctions(RepairMesh mesh, double width);

/// What becomes of a patch that meets a triangle of a mesh where none met before.
enum class Crossing : std::uint8_t {
    refused,
    resolved_later  ///< by resolve_self_intersections(), after this step
};
struct HoleLimits {
    double diagonal;  ///< of a loop's box, at most; model units
    Crossing crossing;
};

/// Closes loops of boundary edges: with the triangles that CGAL's
/// triangulate_hole_polyline() proposes, or, where those would share an edge with others,
/// around a new vertex in the middle. The mesh must be 2-manifold and oriented.
/// `search.stop` leaves the loops that are left open, unsaid.
[[nodiscard]] Stepped fill_holes(RepairMesh mesh, const HoleLimits& limits,
                                 const SearchOptions& search);

/// Reverses closed components of negative volume, but for cavities: those whose box and
/// first vertex lie within an odd number of other closed components.
[[nodiscard]] Stepped orient_outward(RepairMesh mesh);

/// Leaves what bounds the solid: triangles are cut where they cross, touch or overlap, and
/// those kept that part a place of winding number 0 from one of another. So overlapping
/// components become their union, and what lies inside goes.
///
/// Changes nothing where no two triangles meet. Refuses, and names the pair: a mesh that is
/// not balanced; one whose cuts, rounded, go on crossing; one with sheets that bound
/// nothing, which would be lost; one with more pairs than the limits allow; and one that
/// `stop` gave up, which is not asked while pairs are searched.
[[nodiscard]] Stepped resolve_self_intersections(RepairMesh mesh, const SearchOptions& search,
                                                 const StopCheck& stop);

/// Leaves out components of fewer than `least` triangles.
[[nodiscard]] Stepped drop_components(RepairMesh mesh, std::uint64_t least);

}  // namespace cdprep::mesh
