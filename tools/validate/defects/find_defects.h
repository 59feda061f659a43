// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "cdprep/format/verdict.h"
#include "validate/defects/finding.h"
#include "mesh/mesh.h"
#include "crossings/self_intersections.h"
#include "mesh/stop.h"

namespace cdprep::mesh {

struct DefectOptions {
    double weld_distance = 0;       ///< near_vertex; model units; 0 looks for none
    double seam_width = 0;          ///< near_seam; model units; 0 looks for none
    double sliver_ratio = 1e-10;    ///< sliver: area below this times the longest edge squared
    std::size_t max_places = 1000;  ///< kept of each finding
    bool crossings = true;          ///< rules 403 and 501 to 503
    /// Pairs of triangles that meet: the search for them ends soon after so many.
    std::uint64_t max_pairs = kDefaultMaxPairs;
    /// Work on that search: it ends soon after so many steps, as SearchLimits counts them.
    /// 0: as many as default_steps() says.
    std::uint64_t max_steps = 0;
    StopCheck stop = {};  ///< ends find_defects() soon; what it returns then is of no use
    ParallelFor parallel_for = serial_for;
};

/// The keys of `counts` in reports. All but the first three are of the mesh after
/// vertices with equal positions were joined.
struct DefectCounts {
    std::uint64_t non_finite_vertices = 0;
    std::uint64_t out_of_range_triangles = 0;
    std::uint64_t unreferenced_vertices = 0;
    std::uint64_t duplicate_vertices = 0;
    std::uint64_t degenerate_triangles = 0;  ///< that repeat a corner; the rest leaves them out
    std::uint64_t zero_area_triangles = 0;   ///< exactly, without the degenerate
    std::uint64_t sliver_triangles = 0;
    std::uint64_t duplicate_triangles = 0;  ///< of either winding
    std::uint64_t opposite_triangles = 0;   ///< those of opposite winding among them
    std::uint64_t boundary_edges = 0;
    std::uint64_t boundary_loops = 0;
    std::uint64_t non_manifold_edges = 0;
    std::uint64_t non_manifold_vertices = 0;
    std::uint64_t inconsistent_edges = 0;
    std::uint64_t non_orientable_components = 0;
    std::uint64_t t_junctions = 0;
    std::uint64_t near_seams = 0;
    std::uint64_t components = 0;  ///< of triangles that share a vertex
    std::uint64_t inverted_components = 0;
    std::uint64_t nested_components = 0;       ///< pairs, inner and outer
    std::uint64_t overlapping_components = 0;  ///< pairs
    std::uint64_t crossing_pairs = 0;          ///< these three as self_intersections.h says
    std::uint64_t touching_pairs = 0;
    std::uint64_t coplanar_overlap_pairs = 0;
    std::uint64_t self_intersecting_pairs = 0;  ///< as CGAL's self_intersections counts
};

struct DefectReport {
    std::vector<Finding> findings;  ///< by ascending id; none with a count of 0
    DefectCounts counts;
    std::vector<format::Verdict> verdicts;  ///< the whole mesh, then each component
    /// The search for pairs came to its end; false without DefectOptions::crossings. If a
    /// limit ended it, the counts from nested_components on are lower bounds; no component
    /// counts as nested, and no verdict calls a component free of crossings.
    bool crossings_complete = true;
    bool t_junctions_complete = true;  ///< else a limit ended the search for those
};

/// Says what is wrong with a mesh and where, and what may be promised of it.
///
/// Everything is decided exactly on the coordinates as read, or RuleText::decided says
/// how. Never fails: triangles with a corner that is out of range or not finite are
/// reported and left out of all that follows. Source numbers throughout. The same for any
/// parallel_for. O(n log n), and O(pairs) for triangles that meet, up to the limits; copies
/// of a triangle count in none of these pairs, however many there are. Memory is linear in
/// the mesh.
[[nodiscard]] DefectReport find_defects(const TriangleSoup& soup,
                                        const DefectOptions& options = {});

}  // namespace cdprep::mesh
