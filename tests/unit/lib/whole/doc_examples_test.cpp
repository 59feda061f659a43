// SPDX-License-Identifier: MIT
// The examples of README.md and of the public headers, as programs that run.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <sstream>
#include <thread>
#include <vector>

#include "cdprep/advanced/refit_bvh.h"
#include "cdprep/cdprep.hpp"
#include "support/open_tiny.h"
#include "support/scratch_folder.h"

namespace cdprep::test {
namespace {

/// The working folder of the test holds the files that the examples open.
class DocExamples : public testing::Test {
protected:
    void SetUp() override {
        const TestMesh cube = unit_cube();
        const AlignedBytes bytes = bake_tiny(cube.positions, cube.triangles);
        for (const char* name : {"arm.cdp.h5", "part.cdp.h5", "bracket.cdp.h5"}) {
            scratch_.write(name, bytes.span());
        }
        std::filesystem::current_path(scratch_.path());
    }
    void TearDown() override {
        std::filesystem::current_path(before_);
    }

private:
    const ScratchFolder scratch_;
    const std::filesystem::path before_ = std::filesystem::current_path();
};

struct ReadmeAnswer {
    bool hit;
    std::vector<TrianglePair> pairs;
};

std::optional<ReadmeAnswer> readme() {
    auto asks = cdprep::Ask::collide | cdprep::Ask::overlap;
    auto arm = cdprep::Model::open("arm.cdp.h5", asks),
         part = cdprep::Model::open("part.cdp.h5", asks);
    auto arm_from_part = cdprep::Pose::from_quaternion(1, 0, 0, 0, {0.1, 0, 0});
    if (!arm || !part || !arm_from_part) return std::nullopt;

    cdprep::Workspace workspace;
    cdprep::Pair pair{*arm, *part, cdprep::Placement::b_moves(*arm_from_part)};
    bool hit = collide(pair, workspace).hit == cdprep::Answer::yes;

    cdprep::TrianglePair room[1000];
    std::size_t count = overlaps(pair, workspace, room);
    return ReadmeAnswer{hit, {room, room + count}};
}

// Two unit cubes, one shifted by 0.1 along x: their sides share area.
TEST_F(DocExamples, Readme) {
    const auto answer = readme();
    ASSERT_TRUE(answer);
    EXPECT_TRUE(answer->hit);
    EXPECT_FALSE(answer->pairs.empty());
    EXPECT_LE(answer->pairs.size(), 144U);
}

int model_example(std::ostream& out) {
    auto opened = cdprep::Model::open("bracket.cdp.h5");
    if (!opened) {
        out << opened.error().message << '\n';
        return 1;
    }
    const cdprep::Model& model = opened.value();
    out << model.triangle_count() << " triangles\n";
    return 0;
}

TEST_F(DocExamples, ModelAndResult) {
    std::ostringstream out;
    EXPECT_EQ(model_example(out), 0);
    EXPECT_EQ(out.str(), "12 triangles\n");
    std::filesystem::remove("bracket.cdp.h5");
    EXPECT_EQ(model_example(out), 1);
}

TEST_F(DocExamples, ClosestPoint) {
    const auto opened = cdprep::Model::open("bracket.cdp.h5");
    ASSERT_TRUE(opened);
    const cdprep::Model& model = opened.value();
    cdprep::Workspace workspace;
    std::ostringstream out;
    if (auto near = cdprep::closest_point(model, {0, 0, 2}, workspace)) {
        out << "triangle " << near->triangle << " at " << near->upper << '\n';
    }
    EXPECT_NE(out.str().find(" at 1\n"), std::string::npos) << out.str();
}

// Of a cube 0.25 above it, the bottom is within 0.25 of the top's two triangles and of
// those that have an edge or a corner there: all but the bottom's.
TEST_F(DocExamples, TrianglesWithin) {
    const auto opened = cdprep::Model::open("bracket.cdp.h5");
    ASSERT_TRUE(opened);
    const cdprep::Model& a = opened.value();
    const cdprep::Model& b = a;
    const auto pose = cdprep::Pose::from_quaternion(1, 0, 0, 0, {0, 0, 1.25});
    const auto placement = cdprep::Placement::b_moves(pose.value());
    cdprep::Workspace workspace;
    std::vector<bool> is_near(a.triangle_number_bound());
    const auto visit = [&](const cdprep::TrianglePair& pair) {
        is_near[pair.a] = true;
        return true;
    };
    cdprep::visit_pairs_within({a, b, placement}, 0.25, workspace, visit);
    EXPECT_EQ(std::count(is_near.begin(), is_near.end(), true), 10);
}

// The one cube and another, 0.5 and 3 away along x.
TEST_F(DocExamples, ParallelForAndBatch) {
    const auto opened = cdprep::Model::open("bracket.cdp.h5");
    ASSERT_TRUE(opened);
    std::vector<cdprep::Pair> jobs;
    for (const double x : {0.5, 3.0, 0.5, 3.0}) {
        const auto pose = cdprep::Pose::from_quaternion(1, 0, 0, 0, {x, 0, 0});
        jobs.emplace_back(*opened, *opened, cdprep::Placement::b_moves(*pose));
    }
    const auto run = [&](std::size_t count, cdprep::Task task) {
        std::vector<std::jthread> threads;
        for (std::size_t i = 0; i < count; ++i) threads.emplace_back(task, i);
    };
    std::vector<cdprep::Workspace> workspaces(4);
    std::vector<cdprep::Collision> answers(jobs.size());
    cdprep::collide_many(jobs, workspaces, run, answers);
    EXPECT_TRUE(answers[0].hit == Answer::yes && answers[2].hit == Answer::yes);
    EXPECT_TRUE(answers[1].hit == Answer::no && answers[3].hit == Answer::no);
}

/// Moves the hierarchy along; returns its cost after.
double refit_example(build::Bvh& bvh, double& cost_when_built,
                     const std::vector<Double3>& positions,
                     const std::vector<Triangle>& triangles) {
    using build::Quality;
    double cost = refit_bvh(bvh, positions, triangles);
    if (cost > 1.5 * cost_when_built) {
        rebuild_bvh(bvh, positions, triangles, {.quality = Quality::fast});
        cost_when_built = surface_cost(bvh);
    }
    return surface_cost(bvh);
}

// Turned inside out, neighbours stay neighbours; in another order, they do not.
TEST_F(DocExamples, RefitBvh) {
    const TestMesh sphere = icosphere(4);
    build::Bvh bvh = build::build_bvh(sphere.positions, sphere.triangles);
    const double built = surface_cost(bvh);
    double cost_when_built = built;
    const TestMesh inside_out = moved_by(sphere, -1, {});
    EXPECT_NEAR(refit_example(bvh, cost_when_built, inside_out.positions, sphere.triangles), built,
                0.01 * built);
    EXPECT_EQ(cost_when_built, built);
    TestMesh soup = sphere;
    std::reverse(soup.triangles.begin(), soup.triangles.end());
    EXPECT_LT(refit_example(bvh, cost_when_built, soup.positions, soup.triangles), 1.5 * built);
    EXPECT_NE(cost_when_built, built);
}

}  // namespace
}  // namespace cdprep::test
