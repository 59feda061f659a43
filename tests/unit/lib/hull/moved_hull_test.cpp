// SPDX-License-Identifier: MIT
#include "hull/moved_hull.h"

#include <gtest/gtest.h>

#include <random>

#include "exact/vectors.h"
#include "support/random_pose.h"
#include "support/small_hull.h"

namespace cdprep::test {
namespace {

/// Points on a sphere whose coordinates are multiples of 2^-6: faces of several triangles, and
/// corners of about the same height along their normals.
std::vector<Double3> rough_ball(std::mt19937& random) {
    std::normal_distribution<double> normal;
    std::vector<Double3> points;
    for (int i = 0; i < 200; ++i) {
        const Double3 p = {normal(random), normal(random), normal(random)};
        const double scale = 8 / std::hypot(p.x, p.y, p.z);
        points.push_back({std::round(p.x * scale * 8) / 64, std::round(p.y * scale * 8) / 64,
                          std::round(p.z * scale * 8) / 64});
    }
    return points;
}

// By the definition: the value is that of the point returned, and none is higher. Along the normal
// of a face rounding decides which corner a search in the hull's own frame finds.
TEST(MovedHull, TheProvenPointHasTheProvenValue) {
    std::mt19937 random(20261123);
    int others = 0, asked = 0;
    for (int round = 0; round < 20; ++round) {
        const std::vector<Double3> points = rough_ball(random);
        const SmallHull hull(points);
        const ConvexPoints view = hull.view();
        const Pose pose = random_pose(random, 3);
        const MovedHull moved(view, &pose);
        const Double3 origin = moved.point(0);
        for (const auto& t : hull.triangles()) {
            const Double3 a = moved.point(t[0]);
            const Double3 direction = cdprep::cross(moved.point(t[1]) - a, moved.point(t[2]) - a);
            const std::uint32_t near = moved.farthest(direction, 0);
            const kernels::FarthestPoint found = moved.proven(direction, origin, near);
            ASSERT_EQ(found.value, cdprep::dot(moved.point(found.number) - origin, direction));
            const double along = moved.bound_along(direction, origin);
            ASSERT_LE(along, found.bound + 1e-12);
            moved.each_point([&](std::uint32_t, const Double3& p) {
                ASSERT_LE(cdprep::dot(p - origin, direction), found.bound);
                ASSERT_LE(cdprep::dot(p - origin, direction), found.value);
                ASSERT_LE(cdprep::dot(p - origin, direction), along);
            });
            others += found.number != near ? 1 : 0;
            ++asked;
        }
    }
    EXPECT_GT(others, asked / 100);
}

}  // namespace
}  // namespace cdprep::test
