// SPDX-License-Identifier: MIT
// P: which points are inside, asked of the hierarchy, of every structure and through the C
// face.
#include <cmath>
#include <utility>

#include "accuracy/asked_models.h"
#include "accuracy/exact_change.h"
#include "accuracy/hard_cases.h"
#include "accuracy/in_mode.h"
#include "accuracy/mesh_variants.h"
#include "support/hard_points.h"

#include "cdprep/cells.h"
#include "cdprep/points.h"

namespace cdprep::test {
namespace {

/// How far a sum of some ten angles may be off.
constexpr double kWindingError = 1e-12;

bool is_right(const Inclusion& found, const HardPoint& point) {
    if (found.on_surface != point.is_on_surface) return false;
    if (point.is_on_surface) return found.answer == Answer::yes;
    if (point.is_unknown) {
        return found.answer == Answer::unknown &&
               (!point.winding || std::fabs(found.winding - *point.winding) <= kWindingError);
    }
    return found.winding == *point.winding &&
           found.answer == (*point.winding != 0 ? Answer::yes : Answer::no);
}

constexpr std::array kThrough = {
    std::pair(Structure::bvh, "bvh"), std::pair(Structure::octree, "octree"),
    std::pair(Structure::adaptive_octree, "adaptive"),
    std::pair(Structure::hashed_octree, "hashed"), std::pair(Structure::tetra_tree, "tetra-tree")};

class Asker {
public:
    Asker(Scoreboard& board, const std::string& id) : board_(board), id_(id) {}

    void ask(const TestMesh& mesh, const std::vector<HardPoint>& points,
             const std::string& change) {
        const std::size_t turn = turn_++;
        const AskedModel asked(mesh, turn);
        for (const HardPoint& point : points) {
            const auto told = [&] {
                return id_ + ": " + change + ": at " + std::to_string(point.at.x) + " " +
                       std::to_string(point.at.y) + " " + std::to_string(point.at.z);
            };
            for (const auto& [structure, name] : kThrough) {
                const bool is_bvh = structure == Structure::bvh;
                const Inclusion found = is_bvh ? in_mode([&] {
                    return points_inside(asked.model(), point.at, workspace_);
                })
                                               : in_mode([&] {
                                                     return points_inside(asked.model(), point.at,
                                                                          workspace_, structure);
                                                 });
                const std::string kind = is_bvh          ? asked.bounds()
                                         : turn % 2 == 1 ? "boxes"
                                                         : "plain";
                board_.of(id_, name + ("/" + kind)).expect(is_right(found, point), told);
            }
        }
        if (turn % 3 == 0) ask_c_face(asked, points, change);
    }

private:
    void ask_c_face(const AskedModel& asked, const std::vector<HardPoint>& points,
                    const std::string& change) {
        const CModel model(asked.bytes());
        for (const HardPoint& point : points) {
            const std::array<double, 3> at = {point.at.x, point.at.y, point.at.z};
            cdprep_point_query query;
            cdprep_point_query_init(&query, sizeof query);
            query.model = model.get();
            query.points = at.data();
            cdprep_point_state found{};
            const int code = cdprep_points_inside(&query, c_workspace_.get(), &found, nullptr);
            const Inclusion answered = {static_cast<Answer>(found.inside), found.on_surface != 0,
                                        found.winding};
            board_.of(id_, "C face").expect(code == CDPREP_OK && is_right(answered, point), [&] {
                return id_ + ": " + change;
            });
        }
    }

    Scoreboard& board_;
    std::string id_;
    std::size_t turn_ = 0;
    Workspace workspace_{cells()};
    CWorkspace c_workspace_;
};

}  // namespace

void score_inclusion(const HardCaseOptions& options, Scoreboard& board) {
    for (const HardPoints& hard : hard_points()) {
        if (!options.wants(hard.id)) continue;
        Asker asker(board, hard.id);
        asker.ask(relabelled(hard.mesh, 1).mesh, hard.points, "relabelled");
        const bool few = options.size == CaseSize::small;
        for (const ExactChange& change : exact_changes(few)) {
            const auto mesh = change(hard.mesh);
            std::vector<HardPoint> points;
            for (HardPoint point : hard.points) {
                const auto at = change(point.at);
                if (!at) continue;
                point.at = *at;
                points.push_back(point);
            }
            if (mesh) asker.ask(*mesh, points, change.name);
        }
    }
}

}  // namespace cdprep::test
