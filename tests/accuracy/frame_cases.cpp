// SPDX-License-Identifier: MIT
// S12 and S13: what a simulation would ask of meshes that deform and tear, frame by frame,
// without one: the overlaps of a hierarchy that was refitted or built again in its place.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "accuracy/hard_cases.h"
#include "support/brute_force.h"
#include "support/bvh_boxes.h"
#include "support/exact_pairs.h"
#include "support/open_tiny.h"

#include "cdprep/advanced/refit_bvh.h"

namespace cdprep::test {
namespace {

using build::Bvh;

/// Asks of one mesh as it is now, and of another that stays as it is.
class Asker {
public:
    Asker(Scoreboard& board, const std::string& id, const TestMesh& still)
        : board_(board), id_(id), still_(still), other_(open_tiny(baked_whole(still))) {}

    [[nodiscard]] std::vector<TrianglePair> truth_of(const TestMesh& mesh) const {
        return exact_pairs(mesh, still_, kInPlace).closed;
    }
    /// What the hierarchy lists is what the definition does.
    void ask(const std::string& strategy, const TestMesh& mesh, const Bvh& bvh,
             const std::vector<TrianglePair>& truth) {
        const OpenModel model =
            open_tiny(bake_tiny(mesh.positions, mesh.triangles, bvh, {.double_precision = true}));
        const auto told = [&] { return id_ + " " + strategy; };
        Tally& tally = board_.of(id_, strategy);
        tally.expect(boxes_hold_all(mesh, bvh), told);
        tally.expect(all_pairs(model.model, other_.model, kInPlace, workspace_) == truth, told);
    }

private:
    static inline const Placement kInPlace = Placement::b_moves(Pose());
    static AlignedBytes baked_whole(const TestMesh& mesh) {
        return bake_tiny(mesh.positions, mesh.triangles, {.double_precision = true});
    }

    Scoreboard& board_;
    std::string id_;
    TestMesh still_;
    OpenModel other_;
    Workspace workspace_;
};

TestMesh sheared(TestMesh mesh, double phase) {
    for (Double3& p : mesh.positions) p.x += 0.5 * std::sin(phase) * p.z;
    return mesh;
}

/// A hundredth of the triangles gives way to as many elsewhere.
void tear(TestMesh& mesh, std::mt19937& random) {
    const std::size_t count = std::max<std::size_t>(mesh.triangles.size() / 100, 1);
    std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
    mesh.triangles.resize(mesh.triangles.size() - count);
    const auto vertices = static_cast<std::uint32_t>(mesh.positions.size());
    std::uniform_int_distribution<std::uint32_t> any(0, vertices - 1);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t at = any(random);
        mesh.triangles.push_back({{at, (at + 1) % vertices, (at + 5) % vertices}});
    }
}

}  // namespace

void score_frames(const HardCaseOptions& options, Scoreboard& board) {
    const bool full = options.size == CaseSize::full;
    const TestMesh ball = icosphere(full ? 4 : 2);
    const TestMesh ring = torus(1, 0.25, full ? 48 : 16, full ? 24 : 8);
    if (options.wants("S12")) {
        Asker asker(board, "S12", ring);
        Bvh refitted = build::build_bvh(ball.positions, ball.triangles);
        const int frames = full ? 60 : 8;
        for (int frame = 0; frame < frames; ++frame) {
            const TestMesh now = sheared(ball, 2 * std::numbers::pi * frame / frames);
            build::refit_bvh(refitted, now.positions, now.triangles);
            const std::vector<TrianglePair> truth = asker.truth_of(now);
            asker.ask("refitted", now, refitted, truth);
            asker.ask("rebuilt", now, build::build_bvh(now.positions, now.triangles), truth);
        }
    }
    if (options.wants("S13")) {
        Asker asker(board, "S13", ring);
        std::mt19937 random(13);
        TestMesh now = ball;
        Bvh bvh = build::build_bvh(now.positions, now.triangles);
        const int frames = full ? 1000 : 40, step = full ? 20 : 5;
        for (int frame = 1; frame <= frames; ++frame) {
            tear(now, random);
            build::rebuild_bvh(bvh, now.positions, now.triangles,
                               {.quality = build::Quality::fast});
            if (frame % step == 0) asker.ask("rebuilt", now, bvh, asker.truth_of(now));
        }
    }
}

}  // namespace cdprep::test
