// SPDX-License-Identifier: MIT
#include "cdprep/shape_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "cdprep/touching_capsule.h"
#include "cdprep/touching_triangle.h"
#include "support/brute_force.h"
#include "support/exact_distance.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"

namespace cdprep::test {
namespace {

ExactRational square(double x) {
    return {ExactNumber(x) * ExactNumber(x), 1.0};
}

/// The square of the distance to the surface, by all triangles in exact numbers.
ExactRational nearest(const TestMesh& mesh, const Pose& pose, const Corners& shape) {
    ExactRational best = exact_squared_distance(shape, corners_of(mesh, 0, &pose));
    for (std::size_t i = 1; i < mesh.triangles.size(); ++i) {
        best = std::min(best, exact_squared_distance(shape, corners_of(mesh, i, &pose)));
    }
    return best;
}

double largest(const TestMesh& mesh, const Pose& pose, const Corners& shape) {
    double size = 0;
    const auto take = [&](const Double3& p) {
        size = std::max({size, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    };
    for (const Double3& p : shape) take(p);
    for (const Double3& p : mesh.positions) take(transform_point(pose, p));
    return size;
}

/// Interval, its width, witness, triangle and limit.
void expect_truth(const TestMesh& mesh, const Model& model, const TriangleShape& shape,
                  const Pose& pose, Workspace& workspace) {
    const ExactRational truth = nearest(mesh, pose, shape.corner);
    const auto found = distance_to(model, shape, workspace, {pose});
    ASSERT_TRUE(found);
    ASSERT_LE(square(found->lower), truth);
    ASSERT_GE(square(found->upper), truth);
    ASSERT_EQ(found->upper == 0, truth.sign() == 0);
    const double size = largest(mesh, pose, shape.corner);
    ASSERT_LE(found->upper - found->lower, 1e-12 * found->lower + 1e-15 * size);
    const double apart =
        std::hypot(found->on_model.x - found->on_shape.x, found->on_model.y - found->on_shape.y,
                   found->on_model.z - found->on_shape.z);
    ASSERT_NEAR(apart, found->upper, 1e-12 * size);
    const ExactRational of_triangle =
        exact_squared_distance(shape.corner, corners_of(mesh, found->triangle, &pose));
    ASSERT_LE(of_triangle, square(found->upper));
    ASSERT_TRUE(distance_to(model, shape, workspace, {pose, found->upper}));
    if (found->lower > 0) {
        ASSERT_FALSE(distance_to(model, shape, workspace, {pose, found->lower * (1 - 1e-6)}));
    }
}

/// The same for a capsule around the first edge: less by its radius, or 0.
void expect_truth_around_edge(const TestMesh& mesh, const Model& model, const TriangleShape& shape,
                              double radius, const Pose& pose, Workspace& workspace) {
    const Corners segment = {shape.corner[0], shape.corner[1], shape.corner[1]};
    const ExactRational truth = nearest(mesh, pose, segment);
    const Capsule capsule = {segment[0], segment[1], radius};
    const auto found = distance_to(model, capsule, workspace, {pose});
    ASSERT_TRUE(found);
    ASSERT_EQ(found->upper == 0, truth <= square(radius));
    if (found->upper == 0) return;
    const auto below = ExactRational(found->lower) + ExactRational(radius);
    const auto above = ExactRational(found->upper) + ExactRational(radius);
    ASSERT_LE(below * below, truth);
    ASSERT_GE(above * above, truth);
    const double size = std::max(radius, largest(mesh, pose, shape.corner));
    ASSERT_LE(found->upper - found->lower, 1e-12 * (found->lower + radius) + 2e-15 * size);
}

// The oracle: every triangle in rational numbers, fine and coarse, moved and not.
TEST(ShapeDistanceLaws, TheIntervalHoldsTheExactDistance) {
    std::mt19937 random(101);
    Workspace workspace;
    int apart = 0, cases = 0;
    for (int round = 0; round < 60 && !HasFatalFailure(); ++round) {
        const TestMesh mesh =
            round % 2 == 0 ? random_soup(random(), 40, 0.3) : coarse_grid_soup(random(), 25, 3);
        const OpenModel model = open_tiny(mesh, {.double_precision = true});
        std::uniform_real_distribution<double> place(-4, 4);
        for (int i = 0; i < 6 && !HasFatalFailure(); ++i) {
            TriangleShape shape{};
            for (Double3& p : shape.corner) {
                const double x = place(random), y = place(random), z = place(random);
                p = round % 2 == 0 ? Double3{x, y, z}
                                   : Double3{std::round(x), std::round(y), std::round(z)};
            }
            if (i % 3 == 0) shape.corner[2] = shape.corner[1];
            const Pose pose = i % 2 == 0 ? Pose() : random_pose(random, 2);
            expect_truth(mesh, model.model, shape, pose, workspace);
            const double radius = static_cast<double>(random() % 3);
            expect_truth_around_edge(mesh, model.model, shape, radius, pose, workspace);
            const auto found = distance_to(model.model, shape, workspace, {pose});
            apart += found->lower > 0 ? 1 : 0;
            ++cases;
        }
    }
    EXPECT_GT(apart, cases * 3 / 10) << "seed 101";
    EXPECT_LT(apart, cases * 8 / 10) << "seed 101";
}

// By hand: five apart on a 3-4-5 grid, at every size.
TEST(ShapeDistanceLaws, SizeDoesNotMatter) {
    Workspace workspace;
    for (const double scale : {0x1p-1000, 0x1p-300, 1.0, 0x1p300, 0x1p990}) {
        const TestMesh mesh =
            moved_by({{{3, 4, 0}, {9, 9, 0}, {9, 4, 0}}, {{{0, 1, 2}}}}, scale, {0, 0, 0});
        const OpenModel model = open_tiny(mesh, {.double_precision = true});
        const Capsule capsule = {{0, 0, 0}, {0, 0, 0}, 2 * scale};
        const auto found = distance_to(model.model, capsule, workspace);
        ASSERT_TRUE(found) << scale;
        EXPECT_LE(found->lower, 3 * scale);
        EXPECT_GE(found->upper, 3 * scale);
        EXPECT_EQ(found->on_model, (Double3{3 * scale, 4 * scale, 0}));
        EXPECT_LE(found->upper - found->lower, 1e-11 * scale);
    }
}

}  // namespace
}  // namespace cdprep::test
