// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "cdprep/format/verdict.h"
#include "crossings/self_intersections.h"
#include "mesh/mesh.h"
#include "mesh/stop.h"
#include "validate/defects/finding.h"

namespace cdprep::mesh {

struct DefectOptions {
    double weld_distance = 0;       ///< near_vertex; model units; 0 disables it
    double seam_width = 0;          ///< near_seam; model units; 0 disables it
    std::size_t max_places = 1000;  ///< kept per finding
    bool crossings = true;          ///< rules 403 and 501 to 503
    /// The limit on pairs of triangles that meet; the search for them ends soon after it.
    std::uint64_t max_pairs = kDefaultMaxPairs;
    /// The limit on steps of that search, as SearchLimits counts them; it ends soon after. 0
    /// selects default_steps().
    std::uint64_t max_steps = 0;
    StopCheck stop = {};  ///< ends find_defects() soon; its result is then useless
    ParallelFor parallel_for = serial_for;
};

/// The keys of `counts` in reports. All but the first three refer to the mesh after vertices
/// with equal positions were joined.
struct DefectCounts {
    std::uint64_t non_finite_vertices = 0;
    std::uint64_t out_of_range_triangles = 0;
    std::uint64_t unreferenced_vertices = 0;
    std::uint64_t duplicate_vertices = 0;
    std::uint64_t degenerate_triangles = 0;  ///< that repeat a corner; all others leave them out
    std::uint64_t zero_area_triangles = 0;   ///< exact; without the degenerate ones
    std::uint64_t sliver_triangles = 0;
    std::uint64_t duplicate_triangles = 0;  ///< in either winding
    std::uint64_t opposite_triangles = 0;   ///< the opposite ones among them
    std::uint64_t boundary_edges = 0;
    std::uint64_t boundary_loops = 0;
    std::uint64_t non_manifold_edges = 0;
    std::uint64_t non_manifold_vertices = 0;
    std::uint64_t inconsistent_edges = 0;
    std::uint64_t non_orientable_components = 0;
    std::uint64_t t_junctions = 0;
    std::uint64_t near_seams = 0;
    std::uint64_t components = 0;  ///< sets of triangles connected by shared vertices
    std::uint64_t inverted_components = 0;
    std::uint64_t nested_components = 0;       ///< pairs, inner and outer
    std::uint64_t overlapping_components = 0;  ///< pairs
    std::uint64_t crossing_pairs = 0;          ///< these three: see self_intersections.h
    std::uint64_t touching_pairs = 0;
    std::uint64_t coplanar_overlap_pairs = 0;
    std::uint64_t self_intersecting_pairs = 0;  ///< the count of CGAL's self_intersections
};

struct DefectReport {
    std::vector<Finding> findings;  ///< by ascending id; none with count 0
    DefectCounts counts;
    std::vector<format::Verdict> verdicts;  ///< the whole mesh, then each component
    /// The search for pairs was complete; false without DefectOptions::crossings. If a limit
    /// ended it, the counts from nested_components on are lower bounds. No component then
    /// counts as nested, and no verdict calls a component free of crossings.
    bool crossings_complete = true;
    bool t_junctions_complete = true;  ///< false if a limit ended the search for them
};

/// Returns the defects of a mesh with their places, and its verdicts.
///
/// Decides exactly on the coordinates as read, unless RuleText::decided says otherwise. Never
/// fails: reports triangles with a corner that is out of range or not finite, and leaves them
/// out afterwards. All numbers are source numbers. The result is the same for any parallel_for.
///
/// O(n log n), and O(pairs) for triangles that meet, up to the limits. Copies of a triangle
/// count in none of these pairs, whatever their number. Memory is linear in the mesh.
[[nodiscard]] DefectReport find_defects(const TriangleSoup& soup,
                                        const DefectOptions& options = {});

}  // namespace cdprep::mesh
