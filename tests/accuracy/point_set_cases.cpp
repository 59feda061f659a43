// SPDX-License-Identifier: MIT
// C: hulls of points, judged by exact numbers: every point inside or on each facet, edges
// convex, corners real ones, and where they are known, as many as by hand.
#include <algorithm>

#include "accuracy/epeck.h"
#include "accuracy/exact_change.h"
#include "accuracy/hard_cases.h"
#include "hull/convex_hull.h"
#include "support/hard_point_sets.h"
#include "support/run_threads.h"
#include "unit/tools/hull_flaw.h"

namespace cdprep::test {
namespace {

using convex::ConvexHull;
using Points = std::vector<Double3>;

std::size_t faces_of(const ConvexHull& hull) {
    return hull.groups.size() - 1;
}

Points sorted(Points points) {
    std::sort(points.begin(), points.end(), [](const Double3& p, const Double3& q) {
        return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
    });
    return points;
}
/// What no change of the input may change.
Points corners_of(const ConvexHull& hull) {
    return sorted(hull.points);
}

class Asker {
public:
    Asker(Scoreboard& board, const HardPointSet& hard)
        : board_(board), hard_(hard), corners_(corners_of(convex::convex_hull(hard.points))) {}

    void ask(const Points& points, const std::string& name, const std::string& strategy,
             ParallelFor run) {
        const ConvexHull hull = convex::convex_hull(points, run);
        std::string flaw = hull_flaw(points, hull);
        if (hull.dimension != hard_.dimension) flaw = "dimension " + std::to_string(hull.dimension);
        if (hard_.corners && hull.points.size() != *hard_.corners) {
            flaw = std::to_string(hull.points.size()) + " corners";
        }
        if (hard_.faces && faces_of(hull) != *hard_.faces) {
            flaw = std::to_string(faces_of(hull)) + " faces";
        }
        if (hull.points.size() != corners_.size()) flaw = "other corners than before";
        board_.of(hard_.id, strategy).expect(flaw.empty(), [&] {
            return hard_.id + ": " + name + ": " + flaw;
        });
    }
    /// C01 of the catalogue has CGAL for its oracle.
    void ask_epeck(const Points& points, const std::string& name) {
        if (!hard_.id.starts_with("C01")) return;
        const ConvexHull hull = convex::convex_hull(points);
        const EpeckHull other = epeck_hull(points);
        const bool is_same =
            hull.dimension == other.dimension && corners_of(hull) == sorted(other.corners);
        board_.of(hard_.id, "EPECK").expect(is_same, [&] { return hard_.id + ": " + name; });
    }
    /// Nothing but numbers may depend on the order, on threads or on copies.
    void ask_again(const Points& points, const std::string& name, ParallelFor run) {
        const bool is_same = corners_of(convex::convex_hull(points, run)) == corners_;
        board_.of(hard_.id, "hull/again").expect(is_same, [&] { return hard_.id + ": " + name; });
    }

private:
    Scoreboard& board_;
    const HardPointSet& hard_;
    Points corners_;
};

Points twice(const Points& points) {
    Points result = points;
    result.insert(result.end(), points.rbegin(), points.rend());
    return result;
}

}  // namespace

void score_point_sets(const HardCaseOptions& options, Scoreboard& board) {
    const bool full = options.size == CaseSize::full;
    for (const HardPointSet& hard : hard_point_sets(full)) {
        if (!options.wants(hard.id)) continue;
        Asker asker(board, hard);
        asker.ask_again(shuffled(hard.points, 1), "in another order", serial_for);
        asker.ask_again(twice(hard.points), "each twice", serial_for);
        asker.ask_again(hard.points, "on threads", run_threads);
        for (const ExactChange& change : exact_changes(!full || hard.points.size() > 1500)) {
            const auto points = change(hard.points);
            if (!points) continue;
            asker.ask(*points, change.name, "hull/exact", serial_for);
            asker.ask_epeck(*points, change.name);
        }
    }
}

}  // namespace cdprep::test
