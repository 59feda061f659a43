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

/// How two triangles of one mesh meet where they should not: by the corners they share,
/// whether they lie in one plane, and what else they have in common. All of them together
/// are what CGAL's self_intersections() lists. A meeting belongs to rule 501, 502 or 503
/// where it says so; the counts then are those of a checker that asks, edge by edge,
/// whether an edge of one triangle runs through the inside of another.
enum class Meeting : std::uint8_t {
    /// No common corner, and an edge of one runs through the inside of the other. 501
    crossing,
    /// No common corner; the insides cross, but where their common segment ends, edges or
    /// corners of both meet. 502
    edge_crossing,
    /// No common corner, not in one plane: they touch, and their insides do not cross. 502
    touching,
    /// No common corner, in one plane: they touch and share no area. A corner on an edge
    /// of a flat side, for one: see t_junction.
    flat_touching,
    /// No common corner, in one plane: they share area. 503
    coplanar_overlap,
    /// One common corner, not in one plane: they meet elsewhere too. 501
    corner_crossing,
    /// One common corner, in one plane: they share part of an edge and no area.
    edge_overlap,
    /// One or two common corners, in one plane: they share area. 503
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

/// How much a search may do at most.
struct SearchLimits {
    static constexpr std::uint64_t kNone = std::numeric_limits<std::uint64_t>::max();
    std::uint64_t pairs = kNone;  ///< meetings found
    std::uint64_t steps = kNone;  ///< pairs of triangles, of leaves or of nodes looked at
};

/// So many take some 3 s on one core, measured with overlapping triangles in one plane at
/// 0.6 us a pair.
inline constexpr std::uint64_t kDefaultMaxPairs = 5'000'000;

/// Enough for every mesh whose pairs stay below the limit as a rule, and some minutes at
/// most: a step takes 20 to 100 ns, and sound meshes need 1 to 20 a triangle.
[[nodiscard]] constexpr std::uint64_t default_steps(std::uint64_t triangles) {
    return 500'000'000 + 200 * triangles;
}

struct SearchOptions {
    SearchLimits limits = {};
    StopCheck stop = {};  ///< ends the search; what was found until then depends on the machine
    ParallelFor parallel_for = serial_for;
};

/// Takes some meetings. Called from one thread at a time.
using TakeMeetings = std::function<void(std::span<const TriangleMeeting>)>;

/// Finds every pair of triangles of a mesh that have more in common than the vertices
/// and edges they share, and hands each over once, in no order. Triangles of zero area are
/// in none, as in CGAL's self_intersections().
///
/// Returns true if the search is complete. Else the limits ended it, shortly after one of
/// them was reached: the meetings are some of all, the same for any parallel_for.
///
/// Vertices are told apart by number: no two that triangles use may be equal, as weld()
/// leaves them. Positions must be finite. CGAL's answer is defined for meshes with at most
/// two triangles at an edge; here more may meet there, and every two of them are asked.
///
/// Exact. O(n log n), and O(pairs) for those that meet and for those whose boxes overlap,
/// or around one vertex are seen over each other from it. Long triangles around one vertex
/// are no such pairs: see Hubs. k copies of one triangle are k (k - 1) / 2 pairs:
/// see Copies. Some 60 bytes of scratch a triangle, none a pair.
/// tests/bench/self_intersections_bench measures.
bool search_self_intersections(const Mesh& mesh, const SearchOptions& options,
                               const TakeMeetings& take);

/// All of them, sorted by (a, b): 12 bytes a pair.
[[nodiscard]] std::vector<TriangleMeeting> find_self_intersections(
    const Mesh& mesh, ParallelFor parallel_for = serial_for);

}  // namespace cdprep::mesh
