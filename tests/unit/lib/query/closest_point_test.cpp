// SPDX-License-Identifier: MIT
#include "cdprep/points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "support/open_tiny.h"

namespace cdprep::test {
namespace {

std::optional<ClosestPoint> nearest(const TestMesh& mesh, const Double3& q,
                                    double limit = std::numeric_limits<double>::infinity()) {
    const OpenModel model = open_tiny(mesh, {.double_precision = true});
    Workspace workspace;
    return closest_point(model.model, q, workspace, limit);
}

// The cube's answers are known by hand.
TEST(ClosestPoint, InsideMeasuresToTheSurfaceNotToTheSolid) {
    const auto hit = nearest(unit_cube(), {0.5, 0.5, 0.75});
    ASSERT_TRUE(hit);
    EXPECT_LE(hit->lower, 0.25);
    EXPECT_GE(hit->upper, 0.25);
    EXPECT_EQ(hit->point.z, 1.0);
}

TEST(ClosestPoint, OnTheSurfaceTheDistanceIsZero) {
    const auto hit = nearest(unit_cube(), {0.25, 0.5, 0});
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->lower, 0.0);
    EXPECT_LT(hit->upper, 256 * 0x1p-53);
}

TEST(ClosestPoint, LimitCutsOffWhatIsFarther) {
    EXPECT_TRUE(nearest(unit_cube(), {0.5, 0.5, 3}, 2.0));
    EXPECT_FALSE(nearest(unit_cube(), {0.5, 0.5, 3}, 1.999));
}

TEST(ClosestPoint, EqualDistancesGoToTheLowestTriangle) {
    const auto hit = nearest(unit_cube(), {0.5, 0.5, 0.5});  // the centre: all six faces tie
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->triangle, 0u);
}

TEST(ClosestPoint, FlatAndEmptyModelsHaveDefinedAnswers) {
    EXPECT_FALSE(nearest({}, {0, 0, 0}));
    const TestMesh point{{{1, 2, 3}}, {{{0, 0, 0}}}};
    const auto hit = nearest(point, {1, 2, 7});
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->point, (Double3{1, 2, 3}));
    EXPECT_LE(hit->lower, 4.0);
    EXPECT_GE(hit->upper, 4.0);
    const auto sheet = nearest(grid_sheet(5, 5), {2.5, 2.5, 1});
    ASSERT_TRUE(sheet);
    EXPECT_LE(sheet->lower, 1.0);
    EXPECT_GE(sheet->upper, 1.0);
}

TEST(ClosestPoint, ScaleDoesNotMatter) {
    for (const double scale : {0x1p-1000, 0x1p-100, 0x1p100, 0x1p900}) {
        const auto hit =
            nearest(moved_by(unit_cube(), scale, {0, 0, 0}), {scale / 2, scale / 2, 3 * scale});
        ASSERT_TRUE(hit) << scale;
        EXPECT_LE(hit->lower, 2 * scale);
        EXPECT_GE(hit->upper, 2 * scale);
        EXPECT_LT(hit->upper - hit->lower, scale * 1e-13);
    }
}

using Vector = std::array<long double, 3>;

Vector at(const Double3& p) {
    return {p.x, p.y, p.z};
}
Vector minus(const Vector& a, const Vector& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
long double dot(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

long double distance_to_segment(const Vector& q, const Vector& a, const Vector& b) {
    const Vector e = minus(b, a), w = minus(q, a);
    const long double squared = dot(e, e);
    const long double t = squared > 0 ? std::clamp(dot(w, e) / squared, 0.0L, 1.0L) : 0.0L;
    const Vector d = {w[0] - t * e[0], w[1] - t * e[1], w[2] - t * e[2]};
    return std::sqrt(dot(d, d));
}

long double distance_to_triangle(const Double3& point, const TestMesh& mesh,
                                 const Triangle& triangle) {
    const Vector q = at(point), a = at(mesh.positions[triangle.vertex[0]]);
    const Vector b = at(mesh.positions[triangle.vertex[1]]);
    const Vector c = at(mesh.positions[triangle.vertex[2]]);
    long double best = std::min(
        {distance_to_segment(q, a, b), distance_to_segment(q, b, c), distance_to_segment(q, c, a)});
    const Vector n = cross(minus(b, a), minus(c, a));
    const long double squared = dot(n, n);
    if (squared > 0 && dot(n, cross(minus(b, a), minus(q, a))) >= 0 &&
        dot(n, cross(minus(c, b), minus(q, b))) >= 0 &&
        dot(n, cross(minus(a, c), minus(q, c))) >= 0) {
        best = std::min(best, std::fabs(dot(n, minus(q, a))) / std::sqrt(squared));
    }
    return best;
}

// The oracle: brute force in long double, eleven bits more.
TEST(ClosestPointLaws, IntervalHoldsTheTruth) {
    std::mt19937 random(20261121);
    std::uniform_real_distribution<double> anywhere(-2, 2);
    int within = 0, asked = 0;
    for (int round = 0; round < 40; ++round) {
        const TestMesh mesh = round % 2 == 0
                                  ? random_soup(random(), 60, round % 4 == 0 ? 0.3 : 1e-4)
                                  : coarse_grid_soup(random(), 30, 1);
        const OpenModel model = open_tiny(mesh);
        Workspace workspace;
        for (int i = 0; i < 50; ++i) {
            const double x = anywhere(random), y = anywhere(random), z = anywhere(random);
            const Double3 q = round % 3 == 0 ? Double3{std::round(x), std::round(y), std::round(z)}
                                             : Double3{x, y, z};
            long double truth = 100;
            for (const Triangle& triangle : mesh.triangles) {
                truth = std::min(truth, distance_to_triangle(q, mesh, triangle));
            }
            const auto hit = closest_point(model.model, q, workspace);
            ASSERT_TRUE(hit);
            const long double oracle_error = 1e-18L * 64;
            ASSERT_LE(hit->lower, truth + oracle_error) << "round " << round << ", point " << i;
            ASSERT_GE(hit->upper, truth - oracle_error) << "round " << round << ", point " << i;
            ASSERT_LT(hit->upper - hit->lower, 1e-9) << "round " << round << ", point " << i;
            const bool near = closest_point(model.model, q, workspace, 0.75).has_value();
            ASSERT_EQ(near, hit->lower <= 0.75);
            within += near ? 1 : 0;
            ++asked;
        }
    }
    EXPECT_GT(within, asked * 3 / 10);
    EXPECT_LT(within, asked * 9 / 10);
}

// By hand: from the least double to x = 2^980 it is farther than any double. From there to a face
// at x = -2^980 it is less.
TEST(ClosestPoint, TheIntervalHoldsDistancesBeyondDouble) {
    constexpr double kMost = std::numeric_limits<double>::max();
    const TestMesh face{{{0, 0, 0}, {0, 0x1p960, 0}, {0, 0, 0x1p960}}, {{{0, 1, 2}}}};
    Workspace workspace;
    const OpenModel beyond =
        open_tiny(moved_by(face, 1, {0x1p980, 0, 0}), {.double_precision = true});
    const auto far = closest_point(beyond.model, {-kMost, 0, 0}, workspace);
    ASSERT_TRUE(far);
    EXPECT_LE(far->lower, kMost);
    EXPECT_GE(far->lower, kMost * (1 - 1e-12));
    EXPECT_EQ(far->upper, std::numeric_limits<double>::infinity());
    EXPECT_NEAR(far->point.x, 0x1p980, 0x1p972);  // rounded relative to the query
    const OpenModel before =
        open_tiny(moved_by(face, 1, {-0x1p980, 0, 0}), {.double_precision = true});
    const auto near = closest_point(before.model, {-kMost, 0, 0}, workspace);
    ASSERT_TRUE(near);
    EXPECT_LE(near->lower, kMost - 0x1p980);
    EXPECT_GE(near->upper, kMost - 0x1p980);
    EXPECT_FALSE(closest_point(beyond.model, {-kMost, 0, 0}, workspace, 0x1p1023));
}

}  // namespace
}  // namespace cdprep::test
