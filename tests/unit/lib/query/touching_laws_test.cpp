// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "cdprep/points.h"
#include "support/brute_force.h"
#include "support/exact_box.h"
#include "support/exact_distance.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"
#include "support/touched.h"

namespace cdprep::test {
namespace {

// The oracles: by the definition, in exact numbers.

bool truly_touches(const Box& box, const Corners& t) {
    return touches_box_by_cutting(t, {box.lower, box.upper});
}
bool truly_touches(const Sphere& sphere, const Corners& t) {
    return exact_squared_distance(sphere.centre, t) <= exact_square(sphere.radius);
}
bool truly_touches(const Capsule& capsule, const Corners& t) {
    return exact_squared_distance({capsule.from, capsule.to, capsule.to}, t) <=
           exact_square(capsule.radius);
}
bool truly_touches(const TriangleShape& triangle, const Corners& t) {
    return triangles_touch_by_segments(triangle.corner, t);
}

/// How many answers a test has seen.
struct Tally {
    int hits = 0;
    int triangles = 0;
    int models_hit = 0;
    int models = 0;

    void expect_two_sided() const {
        EXPECT_GT(hits, triangles / 50);
        EXPECT_LT(hits, triangles * 7 / 10);
        EXPECT_GT(models_hit, models * 3 / 10);
        EXPECT_LT(models_hit, models * 7 / 10) << models_hit;
    }
};

/// All three forms and the yes or no, against every triangle.
template <class Shape>
void expect_truth(const TestMesh& mesh, const Model& model, const Shape& shape,
                  const ShapeOptions& options, Workspace& workspace, Tally& tally) {
    Numbers truth;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const Corners corners = corners_of(mesh, i, &options.world_from_model);
        if (options.degenerate == Degenerate::skip && is_degenerate(corners_of(mesh, i, nullptr))) {
            continue;
        }
        if (truly_touches(shape, corners)) truth.push_back(i);
    }
    tally.hits += static_cast<int>(truth.size());
    tally.triangles += static_cast<int>(mesh.triangles.size());
    tally.models_hit += truth.empty() ? 0 : 1;
    tally.models += 1;

    ASSERT_EQ(touches(model, shape, workspace, options), !truth.empty());
    Numbers found(mesh.triangles.size());
    found.resize(touching_triangles(model, shape, workspace, found, options));
    ASSERT_EQ(found, truth);
    ASSERT_EQ(touching_triangles(model, shape, workspace, {}, options), truth.size());
    Numbers few(truth.size() / 2);
    ASSERT_EQ(touching_triangles(model, shape, workspace, few, options), truth.size());
    ASSERT_TRUE(std::equal(few.begin(), few.end(), truth.begin()));
    Numbers visited;
    const auto visit = [&](std::uint32_t i) {
        visited.push_back(i);
        return true;
    };
    ASSERT_TRUE(visit_touching_triangles(model, shape, workspace, visit, options));
    std::sort(visited.begin(), visited.end());
    ASSERT_EQ(visited, truth);
    const auto stop = [](std::uint32_t) { return false; };
    ASSERT_EQ(visit_touching_triangles(model, shape, workspace, stop, options), truth.empty());
}

Double3 whole_point(std::mt19937& random, int reach) {
    std::uniform_int_distribution<int> grid(-reach, reach);
    const double x = grid(random), y = grid(random), z = grid(random);
    return {x, y, z};
}

/// Shapes with corners by `point`; `size` of radii and edges.
struct Draw {
    std::mt19937& random;
    std::function<Double3()> point;
    std::function<double()> size;

    [[nodiscard]] Box box() const {
        const Double3 m = point();
        const double x = size(), y = size(), z = size();
        return {{m.x - x, m.y - y, m.z - z}, {m.x + x, m.y + y, m.z + z}};
    }
    [[nodiscard]] Sphere sphere() const {
        const Double3 m = point();
        return {m, size()};
    }
    [[nodiscard]] Capsule capsule() const {
        const Double3 m = point(), to = point();
        return {m, random() % 6 == 0 ? m : to, size()};
    }
    [[nodiscard]] TriangleShape triangle() const {
        const Double3 a = point(), b = point(), c = point();
        return {{a, random() % 6 == 0 ? a : b, c}};
    }
};

/// Turns by a multiple of a right angle, and shifts by whole numbers: a grid stays one.
Pose grid_pose(std::mt19937& random) {
    const std::array<std::array<double, 9>, 4> turns = {{{1, 0, 0, 0, 1, 0, 0, 0, 1},
                                                         {0, -1, 0, 1, 0, 0, 0, 0, 1},
                                                         {0, 0, 1, 1, 0, 0, 0, 1, 0},
                                                         {-1, 0, 0, 0, 0, 1, 0, 1, 0}}};
    std::array<double, 12> rows{};
    std::copy_n(turns[random() % 4].begin(), 9, rows.begin());
    const Double3 t = whole_point(random, 2);
    rows[9] = t.x;
    rows[10] = t.y;
    rows[11] = t.z;
    return Pose::from_rows(rows).value();
}

template <class Ask>
void for_grid_cases(std::uint32_t seed, int rounds, int reach, Ask ask) {
    std::mt19937 random(seed);
    Workspace workspace;
    for (int round = 0; round < rounds && !testing::Test::HasFatalFailure(); ++round) {
        const int count = round % 4 == 0 ? 7 : 90;
        const TestMesh mesh = coarse_grid_soup(random(), count, 4);
        const OpenModel model = open_tiny(mesh, {.double_precision = round % 2 == 0});
        const Draw draw{random, [&] { return whole_point(random, reach); },
                        [&] { return static_cast<double>(random() % 4); }};
        for (int i = 0; i < 8 && !testing::Test::HasFatalFailure(); ++i) {
            ShapeOptions options;
            if (i % 2 == 1) options.world_from_model = grid_pose(random);
            if (i % 8 > 5) options.degenerate = Degenerate::skip;
            ask(draw, mesh, model.model, options, workspace);
        }
    }
}

template <class Ask>
void for_fine_cases(std::uint32_t seed, int rounds, double reach, Ask ask) {
    std::mt19937 random(seed);
    Workspace workspace;
    for (int round = 0; round < rounds && !testing::Test::HasFatalFailure(); ++round) {
        const double scale = std::array<double, 5>{1, 1, 1e-30, 1e30, 1e3}[round % 5];
        const TestMesh mesh =
            moved_by(in_floats(random_soup(random(), round % 2 == 0 ? 400 : 9, 0.3)), scale,
                     round % 5 == 4 ? Double3{9e5, -1e6, 1e4} : Double3{0, 0, 0});
        const OpenModel model = open_tiny(mesh, {.double_precision = round % 2 == 0 || scale != 1});
        const Double3 shift = round % 5 == 4 ? Double3{9e5, -1e6, 1e4} : Double3{0, 0, 0};
        std::uniform_real_distribution<double> size(0, 0.6);
        const Draw draw{
            random,
            [&] {
                const Double3 p = fine_point(random, reach);
                return Double3{scale * p.x + shift.x, scale * p.y + shift.y, scale * p.z + shift.z};
            },
            [&] { return scale * size(random) * (random() % 4 == 0 ? 4 : 1); }};
        for (int i = 0; i < 4 && !testing::Test::HasFatalFailure(); ++i) {
            ShapeOptions options;
            if (i % 2 == 1 && round % 5 != 4) {
                Pose turn = random_pose(random, 0.3);
                std::array<double, 12> rows{};
                std::copy_n(turn.rotation().begin(), 9, rows.begin());
                rows[9] = scale * turn.translation().x;
                rows[10] = scale * turn.translation().y;
                rows[11] = scale * turn.translation().z;
                options.world_from_model = Pose::from_rows(rows).value();
            }
            ask(draw, mesh, model.model, options, workspace);
        }
    }
}

/// Points of shapes lie within `reach` cells, of which four hold a grid's triangles.
template <class Make>
void expect_truth_everywhere(std::uint32_t seed, int grid_rounds, int fine_rounds, int reach,
                             Make make) {
    Tally grid, fine;
    for_grid_cases(seed, grid_rounds, reach, [&](const Draw& draw, auto&... rest) {
        const auto ask = [&](const TestMesh& mesh, const Model& model, const ShapeOptions& options,
                             Workspace& workspace) {
            expect_truth(mesh, model, make(draw), options, workspace, grid);
        };
        ask(rest...);
    });
    for_fine_cases(seed, fine_rounds, reach / 4.5, [&](const Draw& draw, auto&... rest) {
        const auto ask = [&](const TestMesh& mesh, const Model& model, const ShapeOptions& options,
                             Workspace& workspace) {
            expect_truth(mesh, model, make(draw), options, workspace, fine);
        };
        ask(rest...);
    });
    grid.expect_two_sided();
    fine.expect_two_sided();
}

/// Numbers of any size, up to 2^reach.
double wild_number(std::mt19937& random, int reach) {
    std::uniform_real_distribution<double> digits(-1, 1);
    std::uniform_int_distribution<int> exponent(-reach, reach);
    const double x = digits(random);
    return random() % 4 == 0 ? x : std::ldexp(x, exponent(random));
}

// Shapes far smaller, larger and farther than the model: what the walk leaves out is
// nothing that touches.
TEST(TouchingLaws, WildSizesLoseNothing) {
    std::mt19937 random(95);
    Workspace workspace;
    Tally tally;
    for (int round = 0; round < 150 && !HasFatalFailure(); ++round) {
        const TestMesh mesh = random_soup(random(), 30, 0.5);
        const OpenModel model = open_tiny(mesh, {.double_precision = true});
        const int reach = round % 2 == 0 ? 60 : 990;
        const auto number = [&] { return wild_number(random, reach); };
        const auto point = [&] {
            const double x = number(), y = number(), z = number();
            return Double3{x, y, z};
        };
        ShapeOptions options;
        if (round % 3 == 0) options.world_from_model = random_pose(random, 1);
        const Draw draw{random, point, [&] { return std::fabs(number()); }};
        const auto ask = [&](const auto& shape) {
            expect_truth(mesh, model.model, shape, options, workspace, tally);
        };
        ask(draw.box());
        ask(draw.sphere());
        ask(draw.capsule());
        ask(draw.triangle());
        // A sphere through a corner, from anywhere: as near to it as double can tell.
        Sphere through = draw.sphere();
        const Double3 corner = transform_point(options.world_from_model, mesh.positions[0]);
        through.radius = std::hypot(corner.x - through.centre.x, corner.y - through.centre.y,
                                    corner.z - through.centre.z);
        ask(through);
    }
    EXPECT_GT(tally.models_hit, tally.models * 3 / 10) << tally.models_hit;
    EXPECT_LT(tally.models_hit, tally.models * 7 / 10);
}

TEST(TouchingLaws, BoxesAgreeWithCutting) {
    expect_truth_everywhere(91, 120, 20, 6, [](const Draw& draw) { return draw.box(); });
}

TEST(TouchingLaws, SpheresAgreeWithExactDistances) {
    expect_truth_everywhere(92, 80, 20, 6, [](const Draw& draw) { return draw.sphere(); });
}

TEST(TouchingLaws, CapsulesAgreeWithExactDistances) {
    expect_truth_everywhere(93, 40, 10, 8, [](const Draw& draw) { return draw.capsule(); });
}

TEST(TouchingLaws, TrianglesAgreeWithSixSegments) {
    expect_truth_everywhere(94, 120, 40, 9, [](const Draw& draw) { return draw.triangle(); });
}

}  // namespace
}  // namespace cdprep::test
