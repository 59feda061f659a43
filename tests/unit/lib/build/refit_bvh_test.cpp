// SPDX-License-Identifier: MIT
#include "cdprep/advanced/refit_bvh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "cdprep/format/find_damage.h"
#include "cdprep/pairs.h"
#include "support/brute_force.h"
#include "support/bvh_boxes.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"

namespace cdprep::test {
namespace {

using build::build_bvh;
using build::Bvh;
using build::refit_bvh;

/// Every vertex a little elsewhere.
TestMesh shaken(TestMesh mesh, std::uint32_t seed, double reach) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> within(-reach, reach);
    for (Double3& p : mesh.positions) {
        p = {p.x + within(random), p.y + within(random), p.z + within(random)};
    }
    return mesh;
}

/// Twisted about z, by the height.
TestMesh twisted(TestMesh mesh, double radians_per_unit) {
    for (Double3& p : mesh.positions) {
        const double c = std::cos(radians_per_unit * p.z);
        const double s = std::sin(radians_per_unit * p.z);
        p = {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
    }
    return mesh;
}

/// What a mesh was when its hierarchy was built, and what became of it.
struct Deformation {
    TestMesh before;
    TestMesh after;
};

std::vector<Deformation> deformations() {
    const TestMesh sphere = icosphere(4);
    const TestMesh soup = random_soup(1, 700, 0.3);
    TestMesh collapsed = soup;
    for (Double3& p : collapsed.positions) p = {1, 2, 3};
    return {{sphere, sphere},
            {sphere, shaken(sphere, 2, 0.05)},
            {sphere, twisted(sphere, 3)},
            {sphere, moved_by(sphere, 1000, {1e6, 0, -1e6})},  // far outside the old frame
            {sphere, moved_by(sphere, 0x1p-1000, {})},
            {sphere, moved_by(sphere, 0x1p998, {})},
            {in_floats(soup), shaken(soup, 3, 1e-9)},  // exact leaves no longer
            {shaken(soup, 3, 1e-9), in_floats(soup)},
            {soup, collapsed},
            {collapsed, soup},
            {fan(1), moved_by(fan(1), 3, {1, 1, 1})},
            {fan(9), shaken(fan(9), 4, 0.3)},
            {coarse_grid_soup(2, 65, 3), coarse_grid_soup(5, 65, 3)}};
}

TEST(RefitBvh, BoxesHoldTheMovedTrianglesInExactArithmetic) {
    for (const Deformation& d : deformations()) {
        Bvh bvh = build_bvh(d.before.positions, d.before.triangles);
        const std::vector<std::uint32_t> order = bvh.order;
        refit_bvh(bvh, d.after.positions, d.after.triangles);
        EXPECT_EQ(bvh.order, order);
        EXPECT_TRUE(boxes_hold_all(d.after, bvh));
        const AlignedBytes file =
            bake_tiny(d.after.positions, d.after.triangles, bvh, {.double_precision = true});
        EXPECT_FALSE(format::find_deep_damage(file.span()));
    }
}

// Where the order is the one that a build finds, refitting must be building.
TEST(RefitBvh, MakesWhatABuildThatComesToTheSameOrderMakes) {
    for (const Deformation& d : deformations()) {
        const Bvh built = build_bvh(d.after.positions, d.after.triangles);
        Bvh refitted = build_bvh(d.before.positions, d.before.triangles);
        refitted.order = built.order;
        const double cost = refit_bvh(refitted, d.after.positions, d.after.triangles);
        EXPECT_TRUE(same_bytes(refitted, built));
        EXPECT_EQ(cost, surface_cost(built));
    }
}

TEST(RefitBvh, WhatWasBeforeDoesNotMatter) {
    for (const Deformation& d : deformations()) {
        Bvh there = build_bvh(d.before.positions, d.before.triangles);
        const Bvh begun = there;
        refit_bvh(there, d.after.positions, d.after.triangles);
        refit_bvh(there, d.before.positions, d.before.triangles);
        EXPECT_TRUE(same_bytes(there, begun));
    }
}

TEST(RefitBvh, ThreadsDoNotChangeTheResult) {
    const TestMesh sphere = icosphere(6);
    const TestMesh moved = twisted(sphere, 2);
    Bvh serial = build_bvh(sphere.positions, sphere.triangles);
    Bvh backwards = serial;
    refit_bvh(serial, moved.positions, moved.triangles);
    const auto last_first = [](std::size_t count, Task task) {
        for (std::size_t i = count; i-- > 0;) task(i);
    };
    refit_bvh(backwards, moved.positions, moved.triangles, {.parallel_for = last_first});
    EXPECT_TRUE(same_bytes(serial, backwards));
}

TEST(RefitBvh, OrientedBoxesAreDroppedWhereNotAskedFor) {
    const TestMesh sphere = icosphere(2);
    Bvh bvh = build_bvh(sphere.positions, sphere.triangles);
    const Bvh built = bvh;
    refit_bvh(bvh, sphere.positions, sphere.triangles, {.bounds = build::BvhBounds::aligned});
    EXPECT_TRUE(bvh.oriented_nodes.empty());
    refit_bvh(bvh, sphere.positions, sphere.triangles);
    EXPECT_TRUE(same_bytes(bvh, built));
}

TEST(RefitBvh, NothingIsMadeOfNothing) {
    Bvh bvh;
    EXPECT_EQ(refit_bvh(bvh, {}, {}), 0);
    EXPECT_TRUE(same_bytes(bvh, Bvh{}));
}

// A rigid motion keeps the cost about as it was; mixing neighbours up does not.
TEST(RefitBvh, TheCostTellsWhenTheOrderIsSpoilt) {
    const TestMesh sphere = icosphere(5);
    Bvh bvh = build_bvh(sphere.positions, sphere.triangles);
    const double built = surface_cost(bvh);
    const Pose turn = Pose::from_quaternion(1, 2, 3, 4, {5, 6, 7}).value();
    TestMesh turned = sphere;
    for (Double3& p : turned.positions) p = transform_point(turn, p);
    EXPECT_LT(refit_bvh(bvh, turned.positions, turned.triangles), 1.3 * built);
    TestMesh mixed = sphere;
    std::shuffle(mixed.positions.begin(), mixed.positions.end(), std::mt19937(6));
    EXPECT_GT(refit_bvh(bvh, mixed.positions, mixed.triangles), 5 * built);
}

// The oracle: questions to a hierarchy built for the moved triangles.
TEST(RefitBvh, AnswersAreThoseOfANewHierarchy) {
    const TestMesh sphere = icosphere(4);
    const TestMesh after = twisted(shaken(sphere, 9, 0.02), 2);
    Bvh bvh = build_bvh(sphere.positions, sphere.triangles);
    refit_bvh(bvh, after.positions, after.triangles);
    const TinyOptions doubles = {.double_precision = true};
    const OpenModel refitted = open_tiny(bake_tiny(after.positions, after.triangles, bvh, doubles));
    const OpenModel built = open_tiny(after, doubles);
    const OpenModel ring = open_tiny(torus(1, 0.25, 40, 20), doubles);
    std::mt19937 random(3);
    Workspace workspace;
    int hits = 0;
    constexpr int kPoses = 60;
    for (int i = 0; i < kPoses; ++i) {
        const Placement placement = Placement::b_moves(random_pose(random, 1.9));
        const auto expected = all_pairs(built.model, ring.model, placement, workspace);
        EXPECT_EQ(all_pairs(refitted.model, ring.model, placement, workspace), expected);
        EXPECT_EQ(collide({refitted.model, ring.model, placement}, workspace).hit == Answer::yes,
                  !expected.empty());
        hits += expected.empty() ? 0 : 1;
    }
    EXPECT_GE(hits, kPoses * 3 / 10);
    EXPECT_LE(hits, kPoses * 7 / 10);
}

// By the header: the triangles are those of the build, in every build of the program.
TEST(RefitBvhDeathTest, AnotherNumberOfTrianglesStopsTheProgram) {
    const TestMesh ball = icosphere(1);
    Bvh bvh = build_bvh(ball.positions, ball.triangles);
    const auto fewer = std::span(ball.triangles).first(ball.triangles.size() - 1);
    EXPECT_DEATH(refit_bvh(bvh, ball.positions, fewer), "not built over these triangles");
}

}  // namespace
}  // namespace cdprep::test
