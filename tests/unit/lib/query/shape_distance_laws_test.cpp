// SPDX-License-Identifier: MIT
#include "cdprep/points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "support/brute_force.h"
#include "support/exact_distance.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"
#include "support/touched.h"

namespace cdprep::test {
namespace {

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
    const auto found = shape_distance(model, shape, workspace, {.world_from_model = pose});
    ASSERT_TRUE(found);
    ASSERT_LE(exact_square(found->lower), truth);
    ASSERT_GE(exact_square(found->upper), truth);
    ASSERT_EQ(found->upper == 0, truth.sign() == 0);
    const double size = largest(mesh, pose, shape.corner);
    ASSERT_LE(found->upper - found->lower, 1e-12 * found->lower + 1e-15 * size);
    const double apart =
        std::hypot(found->on_model.x - found->on_shape.x, found->on_model.y - found->on_shape.y,
                   found->on_model.z - found->on_shape.z);
    ASSERT_NEAR(apart, found->upper, 1e-12 * size);
    const ExactRational of_triangle =
        exact_squared_distance(shape.corner, corners_of(mesh, found->triangle, &pose));
    ASSERT_LE(of_triangle, exact_square(found->upper));
    const auto found_within = [&](double limit) {
        const ShapeOptions options = {.world_from_model = pose, .max_distance = limit};
        return shape_distance(model, shape, workspace, options).has_value();
    };
    ASSERT_TRUE(found_within(found->upper));
    if (found->lower > 0) {
        ASSERT_FALSE(found_within(found->lower * (1 - 1e-6)));
    }
}

/// The same for a capsule around the first edge: less by its radius, or 0.
void expect_truth_around_edge(const TestMesh& mesh, const Model& model, const TriangleShape& shape,
                              double radius, const Pose& pose, Workspace& workspace) {
    const Corners segment = {shape.corner[0], shape.corner[1], shape.corner[1]};
    const ExactRational truth = nearest(mesh, pose, segment);
    const Capsule capsule = {segment[0], segment[1], radius};
    const auto found = shape_distance(model, capsule, workspace, {.world_from_model = pose});
    ASSERT_TRUE(found);
    ASSERT_EQ(found->upper == 0, truth <= exact_square(radius));
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
            const auto found =
                shape_distance(model.model, shape, workspace, {.world_from_model = pose});
            apart += found->lower > 0 ? 1 : 0;
            ++cases;
        }
    }
    EXPECT_GT(apart, cases * 3 / 10) << "seed 101";
    EXPECT_LT(apart, cases * 8 / 10) << "seed 101";
}

/// The square of the distance of a point and a box, in exact numbers.
ExactRational to_box(const Box& box, const Double3& p) {
    const auto beyond = [](double at, double lower, double upper) {
        if (at < lower) return ExactNumber(lower) - ExactNumber(at);
        return at > upper ? ExactNumber(at) - ExactNumber(upper) : ExactNumber(0.0);
    };
    const ExactNumber x = beyond(p.x, box.lower.x, box.upper.x);
    const ExactNumber y = beyond(p.y, box.lower.y, box.upper.y);
    const ExactNumber z = beyond(p.z, box.lower.z, box.upper.z);
    return {x * x + y * y + z * z, 1.0};
}

/// The square of the distance of a triangle and a box: 0 if they touch. Otherwise a corner of the
/// triangle or one of the box's twelve edges attains it.
ExactRational to_box(const Box& box, const Corners& t, bool touch) {
    if (touch) return {ExactNumber(0.0), 1.0};
    ExactRational best = to_box(box, t[0]);
    for (const Double3& p : t) best = std::min(best, to_box(box, p));
    const auto corner = [&](unsigned at) {
        return Double3{(at & 1U ? box.upper : box.lower).x, (at & 2U ? box.upper : box.lower).y,
                       (at & 4U ? box.upper : box.lower).z};
    };
    for (unsigned from = 0; from < 8; ++from) {
        for (const unsigned bit : {1U, 2U, 4U}) {
            if (from & bit) continue;
            const Double3 end = corner(from | bit);
            best = std::min(best, exact_squared_distance({corner(from), end, end}, t));
        }
    }
    return best;
}

// The oracle: corners and edges of every triangle and of the box in rational numbers.
TEST(ShapeDistanceLaws, TheIntervalHoldsTheExactDistanceToABox) {
    std::mt19937 random(211);
    Workspace workspace;
    int apart = 0, cases = 0;
    for (int round = 0; round < 16 && !HasFatalFailure(); ++round) {
        const bool fine = round % 2 == 0;
        const TestMesh mesh =
            fine ? random_soup(random(), 30, 0.3) : coarse_grid_soup(random(), 20, 3);
        const OpenModel model = open_tiny(mesh, {.double_precision = true});
        std::uniform_real_distribution<double> place(-4, 4), length(0, 4);
        const auto rounded = [&](double x) { return fine ? x : std::round(x); };
        for (int i = 0; i < 6; ++i) {
            Box box{};
            for (double Double3::*axis : {&Double3::x, &Double3::y, &Double3::z}) {
                box.lower.*axis = rounded(place(random));
                box.upper.*axis = box.lower.*axis + rounded(length(random));
            }
            const Pose pose = i % 2 == 0 ? Pose() : random_pose(random, 2);
            const ShapeOptions options = {.world_from_model = pose};
            const auto found = shape_distance(model.model, box, workspace, options);
            ASSERT_TRUE(found);
            const auto truth_of = [&](std::uint32_t triangle) {
                const Corners corners = corners_of(mesh, triangle, &pose);
                const TestMesh one = {{corners.begin(), corners.end()}, {{{0, 1, 2}}}};
                const OpenModel alone = open_tiny(one, {.double_precision = true});
                return to_box(box, corners, touches(alone.model, box, workspace));
            };
            ExactRational truth = truth_of(0);
            for (std::uint32_t t = 1; t < mesh.triangles.size(); ++t) {
                truth = std::min(truth, truth_of(t));
            }
            ASSERT_LE(exact_square(found->lower), truth);
            ASSERT_GE(exact_square(found->upper), truth);
            ASSERT_EQ(found->upper == 0, truth.sign() == 0);
            ASSERT_LE(truth_of(found->triangle), exact_square(found->upper));
            const double size = std::max(8.0, largest(mesh, pose, {}));
            ASSERT_LE(found->upper - found->lower, 1e-12 * found->lower + 1e-15 * size);
            ASSERT_LE(to_box(box, found->on_shape), exact_square(1e-15 * size));
            const Double3 &p = found->on_model, &q = found->on_shape;
            ASSERT_NEAR(std::hypot(p.x - q.x, p.y - q.y, p.z - q.z), found->upper, 1e-12 * size);
            apart += found->lower > 0 ? 1 : 0;
            ++cases;
        }
    }
    EXPECT_GT(apart, cases * 3 / 10) << "seed 211";
    EXPECT_LT(apart, cases * 8 / 10) << "seed 211";
}

// By hand: infinite limits make half-spaces and wedges. An empty box has no distance.
TEST(ShapeDistanceLaws, BoxesMayBeOpen) {
    const OpenModel model =
        open_tiny({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{{0, 1, 2}}}}, {.double_precision = true});
    Workspace workspace;
    const auto to = [&](const Box& box) { return shape_distance(model.model, box, workspace); };
    const auto above = to({{-kInfinity, -kInfinity, 2}, {kInfinity, kInfinity, kInfinity}});
    ASSERT_TRUE(above);
    EXPECT_LE(above->lower, 2);
    EXPECT_GE(above->upper, 2);
    EXPECT_LE(above->upper - above->lower, 1e-13);
    const auto corner = to({{4, 4, -kInfinity}, {kInfinity, kInfinity, kInfinity}});
    ASSERT_TRUE(corner);
    EXPECT_LE(corner->lower, 3.5 * std::sqrt(2.0));
    EXPECT_NEAR(corner->upper, 3.5 * std::sqrt(2.0), 1e-13);
    const auto all = to({{-kInfinity, -kInfinity, -kInfinity}, {kInfinity, kInfinity, kInfinity}});
    ASSERT_TRUE(all);
    EXPECT_EQ(all->upper, 0);
    EXPECT_FALSE(to({{1, 0, 0}, {0, 1, 1}}));
    EXPECT_FALSE(to({{0, 0, std::nan("")}, {0, 1, 1}}));
}

// By hand: five apart on a 3-4-5 grid, at every size.
TEST(ShapeDistanceLaws, SizeDoesNotMatter) {
    Workspace workspace;
    for (const double scale : {0x1p-1000, 0x1p-300, 1.0, 0x1p300, 0x1p990}) {
        const TestMesh mesh =
            moved_by({{{3, 4, 0}, {9, 9, 0}, {9, 4, 0}}, {{{0, 1, 2}}}}, scale, {0, 0, 0});
        const OpenModel model = open_tiny(mesh, {.double_precision = true});
        const Capsule capsule = {{0, 0, 0}, {0, 0, 0}, 2 * scale};
        const auto found = shape_distance(model.model, capsule, workspace);
        ASSERT_TRUE(found) << scale;
        EXPECT_LE(found->lower, 3 * scale);
        EXPECT_GE(found->upper, 3 * scale);
        EXPECT_EQ(found->on_model, (Double3{3 * scale, 4 * scale, 0}));
        EXPECT_LE(found->upper - found->lower, 1e-11 * scale);
    }
}

}  // namespace
}  // namespace cdprep::test
