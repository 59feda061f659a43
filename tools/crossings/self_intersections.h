// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "mesh/mesh.h"
#include "mesh/stop.h"

namespace cdprep::mesh {

/// The kinds of unwanted meetings of two triangles of one mesh. They differ by the shared
/// corners, by whether the triangles are coplanar, and by what else they share. Together they
/// are the pairs that CGAL's self_intersections() lists. A kind with a number belongs to rule
/// 501, 502 or 503. A checker that tests single edges gives the same counts: it asks whether an
/// edge of one triangle passes through the interior of another.
enum class Meeting : std::uint8_t {
    /// No common corner, and an edge of one passes through the interior of the other. 501
    crossing,
    /// No common corner; the interiors cross, but edges or corners of both meet at the ends of
    /// their common segment. 502
    edge_crossing,
    /// No common corner, not coplanar: they touch, and their interiors do not cross. 502
    touching,
    /// No common corner, coplanar: they touch but share no area. For example, a corner lies on
    /// an edge of a flat side: see t_junction.
    flat_touching,
    /// No common corner, coplanar: they share area. 503
    coplanar_overlap,
    /// One common corner, not coplanar: they also meet elsewhere. 501
    corner_crossing,
    /// One common corner, coplanar: they share part of an edge but no area.
    edge_overlap,
    /// One or two common corners, coplanar: they share area. 503
    fold,
    /// The same three corners, in either winding.
    duplicate,
};

struct TriangleMeeting {
    std::uint32_t a;  ///< triangle of the mesh; a < b
    std::uint32_t b;
    Meeting meeting;
    friend bool operator==(const TriangleMeeting&, const TriangleMeeting&) = default;
};

/// The limits on the work of a search.
struct SearchLimits {
    static constexpr std::uint64_t kNone = std::numeric_limits<std::uint64_t>::max();
    std::uint64_t pairs = kNone;  ///< meetings found
    std::uint64_t steps = kNone;  ///< tested pairs of triangles, leaves or nodes
};

/// The default limit on pairs: some 3 s on one core, measured with overlapping coplanar
/// triangles at 0.6 us per pair.
inline constexpr std::uint64_t kDefaultMaxPairs = 5'000'000;

/// Returns the default limit on steps. It usually suffices for every mesh whose pairs stay below
/// their limit, and takes some minutes at most. A step takes 20 to 100 ns, and sound meshes use
/// 1 to 20 steps per triangle.
[[nodiscard]] constexpr std::uint64_t default_steps(std::uint64_t triangles) {
    return 500'000'000 + 200 * triangles;
}

struct SearchOptions {
    SearchLimits limits = {};
    StopCheck stop = {};  ///< ends the search; the meetings found by then depend on the machine
    ParallelFor parallel_for = serial_for;
};

/// Takes some meetings. Called from one thread at a time.
using TakeMeetings = std::function<void(std::span<const TriangleMeeting>)>;

/// Finds every pair of triangles of a mesh that share more than common vertices and edges.
/// Delivers each pair once, in no order. Triangles of zero area are in no pair, as in CGAL's
/// self_intersections().
///
/// Returns true if the search is complete. Otherwise a limit ended it, shortly after it was
/// reached. The meetings are then a part of all, the same for any parallel_for.
///
/// Vertices are distinguished by number: vertices that triangles use must have distinct
/// positions, as weld() ensures. Positions must be finite. CGAL's answer is defined for meshes
/// with at most two triangles at an edge. Here an edge may have more, and every two of them are
/// tested.
///
/// Exact. O(n log n), plus O(pairs) for those that meet, whose boxes overlap, or that overlap as
/// seen from a common vertex. Long triangles around one vertex are no such pairs: see Hubs. k
/// copies of one triangle are k (k - 1) / 2 pairs: see Copies. Uses some 60 bytes of scratch
/// memory per triangle, none per pair. tests/bench/self_intersections_bench measures this.
bool search_self_intersections(const Mesh& mesh, const SearchOptions& options,
                               const TakeMeetings& take);

/// Returns all meetings, sorted by (a, b); 12 bytes per pair.
[[nodiscard]] std::vector<TriangleMeeting> find_self_intersections(
    const Mesh& mesh, ParallelFor parallel_for = serial_for);

}  // namespace cdprep::mesh
