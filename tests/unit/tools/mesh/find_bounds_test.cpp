// SPDX-License-Identifier: MIT
#include "mesh/find_bounds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "support/exact_rational.h"
#include "support/random_pose.h"
#include "unit/tools/soup_of.h"

namespace cdprep::convex {
namespace {

using format::Bounds;
using format::Double3;
using test::ExactNumber;

Bounds bounds_of(const test::TestMesh& mesh) {
    return find_bounds(test::mesh_of(mesh));
}

ExactNumber exact_dot(const Double3& axis, const Double3& p, const Double3& q) {
    return ExactNumber(axis.x) * (ExactNumber(p.x) - ExactNumber(q.x)) +
           ExactNumber(axis.y) * (ExactNumber(p.y) - ExactNumber(q.y)) +
           ExactNumber(axis.z) * (ExactNumber(p.z) - ExactNumber(q.z));
}

bool is_within(const ExactNumber& x, double half) {
    return x <= ExactNumber(half) && ExactNumber(-half) <= x;
}

/// Whether both boxes contain the point, without rounding anything.
bool contains_exactly(const Bounds& bounds, const Double3& p) {
    const bool aligned = bounds.lower.x <= p.x && p.x <= bounds.upper.x && bounds.lower.y <= p.y &&
                         p.y <= bounds.upper.y && bounds.lower.z <= p.z && p.z <= bounds.upper.z;
    return aligned &&
           is_within(exact_dot(bounds.axis[0], p, bounds.oriented_centre), bounds.half_extent.x) &&
           is_within(exact_dot(bounds.axis[1], p, bounds.oriented_centre), bounds.half_extent.y) &&
           is_within(exact_dot(bounds.axis[2], p, bounds.oriented_centre), bounds.half_extent.z);
}

void expect_contains_all(const Bounds& bounds, const test::TestMesh& mesh, const char* name) {
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        ASSERT_TRUE(contains_exactly(bounds, mesh.positions[i])) << name << ", vertex " << i;
    }
}

double oriented_volume(const Bounds& bounds) {
    return 8 * bounds.half_extent.x * bounds.half_extent.y * bounds.half_extent.z;
}

double aligned_volume(const Bounds& bounds) {
    return (bounds.upper.x - bounds.lower.x) * (bounds.upper.y - bounds.lower.y) *
           (bounds.upper.z - bounds.lower.z);
}

test::TestMesh turned(test::TestMesh mesh, const Pose& pose) {
    for (Double3& p : mesh.positions) p = transform_point(pose, p);
    return mesh;
}

TEST(FindBounds, TheAlignedBoxIsExact) {
    const test::TestMesh mesh = test::random_soup(7, 50, 0.5);
    const Bounds bounds = bounds_of(mesh);
    const auto by = [&](auto member) {
        return std::minmax_element(
            mesh.positions.begin(), mesh.positions.end(),
            [&](const Double3& a, const Double3& b) { return a.*member < b.*member; });
    };
    EXPECT_EQ(bounds.lower.x, by(&Double3::x).first->x);
    EXPECT_EQ(bounds.upper.x, by(&Double3::x).second->x);
    EXPECT_EQ(bounds.lower.y, by(&Double3::y).first->y);
    EXPECT_EQ(bounds.upper.y, by(&Double3::y).second->y);
    EXPECT_EQ(bounds.lower.z, by(&Double3::z).first->z);
    EXPECT_EQ(bounds.upper.z, by(&Double3::z).second->z);
}

// A box of 1 x 2 x 5 turned anyhow: its own edges are its principal axes.
TEST(FindBounds, ATurnedBoxIsFoundAgain) {
    std::mt19937 random(3);
    test::TestMesh box = test::unit_cube();
    for (Double3& p : box.positions) p = {p.x, 2 * p.y, 5 * p.z};
    for (int round = 0; round < 50; ++round) {
        const Bounds bounds = bounds_of(turned(box, test::random_pose(random, 10)));
        std::array<double, 3> half{bounds.half_extent.x, bounds.half_extent.y,
                                   bounds.half_extent.z};
        std::sort(half.begin(), half.end());
        EXPECT_NEAR(half[0], 0.5, 1e-11);
        EXPECT_NEAR(half[1], 1.0, 1e-11);
        EXPECT_NEAR(half[2], 2.5, 1e-11);
    }
}

TEST(FindBounds, AnEmptyMeshHasZeros) {
    const Bounds bounds = find_bounds({});
    EXPECT_EQ(bounds.lower, (Double3{0, 0, 0}));
    EXPECT_EQ(bounds.half_extent, (Double3{0, 0, 0}));
    EXPECT_EQ(bounds.axis[1], (Double3{0, 1, 0}));
}

TEST(FindBounds, FlatStraightAndPointLikeMeshesHaveBoxes) {
    const test::TestMesh point = {{{3, 4, 5}}, {{{0, 0, 0}}}};
    const test::TestMesh line = {{{0, 0, 0}, {1, 2, 3}, {2, 4, 6}}, {{{0, 1, 2}}}};
    for (const test::TestMesh& mesh : {point, line, test::grid_sheet(3, 3)}) {
        const Bounds bounds = bounds_of(mesh);
        expect_contains_all(bounds, mesh, "flat");
        EXPECT_TRUE(std::isfinite(oriented_volume(bounds)));
    }
}

// Equal triangle areas, far more vertices on one side: areas decide, not vertices.
TEST(FindBounds, AxesFollowAreasNotVertexCounts) {
    std::mt19937 random(5);
    const Pose pose = test::random_pose(random, 1);
    test::TestMesh coarse = test::grid_sheet(10, 2);
    test::TestMesh fine = coarse;
    for (int split = 0; split < 200; ++split) {  // a fan into one corner triangle
        const auto added = static_cast<std::uint32_t>(fine.positions.size());
        const format::Triangle triangle = fine.triangles[0];
        const Double3& a = fine.positions[triangle.vertex[0]];
        const Double3& b = fine.positions[triangle.vertex[1]];
        fine.positions.push_back({(a.x + b.x) / 2, (a.y + b.y) / 2, (a.z + b.z) / 2});
        fine.triangles[0].vertex[1] = added;
        fine.triangles.push_back({{added, triangle.vertex[1], triangle.vertex[2]}});
    }
    const Bounds of_coarse = bounds_of(turned(coarse, pose));
    const Bounds of_fine = bounds_of(turned(fine, pose));
    EXPECT_NEAR(of_coarse.half_extent.z, of_fine.half_extent.z, 1e-9);
    EXPECT_NEAR(of_coarse.half_extent.x, of_fine.half_extent.x, 1e-9);
}

TEST(FindBoundsLaws, BothBoxesContainEveryVertexInExactArithmetic) {
    std::mt19937 random(11);
    int oriented = 0, rounds = 0;
    for (const int exponent : {-1070, -1000, -100, 0, 100, 997}) {
        for (std::uint32_t seed = 1; seed <= 6; ++seed) {
            const test::TestMesh soup = turned(seed % 2 == 0 ? test::random_soup(seed, 20, 0.4)
                                                             : test::coarse_grid_soup(seed, 20, 3),
                                               test::random_pose(random, 1));
            const test::TestMesh mesh = test::moved_by(soup, std::ldexp(1.0, exponent), {0, 0, 0});
            const Bounds bounds = bounds_of(mesh);
            expect_contains_all(bounds, mesh, "scaled");
            ++rounds;
            oriented += bounds.axis[0] != Double3{1, 0, 0};
        }
    }
    EXPECT_GT(oriented, rounds / 5);
    EXPECT_LT(oriented, rounds);
}

// Far away, a coordinate's last bit is large compared with the mesh.
TEST(FindBoundsLaws, BothBoxesContainEveryVertexFarFromTheOrigin) {
    std::mt19937 random(13);
    for (const int exponent : {10, 30, 45, 52}) {
        const double far = std::ldexp(1.0, exponent);
        test::TestMesh box = test::unit_cube();
        for (Double3& p : box.positions) p = {p.x, 3 * p.y, 20 * p.z};
        for (int round = 0; round < 10; ++round) {
            const test::TestMesh mesh = test::moved_by(turned(box, test::random_pose(random, 5)), 1,
                                                       {far, -far, 0.5 * far});
            expect_contains_all(bounds_of(mesh), mesh, "far");
        }
    }
}

// Up to the widening that keeps every vertex inside.
TEST(FindBoundsLaws, TheOrientedBoxIsNeverLargerThanTheAlignedOne) {
    for (std::uint32_t seed = 1; seed <= 60; ++seed) {
        for (const test::TestMesh& mesh :
             {test::random_soup(seed, 15, 0.5), test::coarse_grid_soup(seed, 15, 2)}) {
            const Bounds bounds = bounds_of(mesh);
            EXPECT_LE(oriented_volume(bounds), aligned_volume(bounds) * (1 + 1e-12))
                << "seed " << seed;
        }
    }
}

TEST(FindBoundsLaws, AxesAreOrthonormalAndRightHanded) {
    for (std::uint32_t seed = 1; seed <= 60; ++seed) {
        const Bounds bounds = bounds_of(test::random_soup(seed, 15, 0.5));
        const auto& [a, b, c] = bounds.axis;
        const auto dot = [](const Double3& p, const Double3& q) {
            return p.x * q.x + p.y * q.y + p.z * q.z;
        };
        EXPECT_NEAR(dot(a, a), 1, 1e-14);
        EXPECT_NEAR(dot(b, b), 1, 1e-14);
        EXPECT_NEAR(dot(c, c), 1, 1e-14);
        EXPECT_NEAR(dot(a, b), 0, 1e-14);
        EXPECT_NEAR(dot(c, {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}),
                    1, 1e-14);
    }
}

}  // namespace
}  // namespace cdprep::convex
