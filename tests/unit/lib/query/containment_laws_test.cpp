// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "support/brute_force.h"
#include "support/exact_winding.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"

#include "cdprep/pairs.h"
#include "cdprep/points.h"

namespace cdprep::test {
namespace {

/// A tetrahedron on a grid, any way round, or flat.
TestMesh tetrahedron(std::mt19937& random, int grid) {
    std::uniform_int_distribution<int> step(-grid, grid);
    TestMesh mesh;
    for (int i = 0; i < 4; ++i) {
        const int x = step(random), y = step(random), z = step(random);
        mesh.positions.push_back(
            {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
    }
    mesh.triangles = {{{0, 1, 2}}, {{1, 0, 3}}, {{2, 1, 3}}, {{0, 2, 3}}};
    return mesh;
}

TestMesh tetrahedra(std::mt19937& random, int count, int grid) {
    TestMesh mesh = tetrahedron(random, grid);
    for (int i = 1; i < count; ++i) mesh = joined(mesh, tetrahedron(random, grid));
    return mesh;
}

// Many components, so that the tree has levels; points on a half grid, so that
// rays run through corners and along edges.
TEST(IncludesLaws, AgreesWithExactRays) {
    constexpr std::uint32_t kSeed = 71;
    std::mt19937 random(kSeed);
    std::uniform_int_distribution<int> half(-8, 8);
    Workspace workspace;
    int on_surface = 0, outside = 0, inside = 0;
    for (const int exponent : {0, -1060, -1000, -300, 40, 900}) {
        const double scale = std::ldexp(1.0, exponent);
        for (int round = 0; round < 8; ++round) {
            const TestMesh mesh = moved_by(tetrahedra(random, 5 + 5 * round, 4), scale, {0, 0, 0});
            const OpenModel model = open_tiny(mesh, {.double_precision = true});
            const std::vector<Corners> surface = surface_of(mesh);
            ASSERT_TRUE(model.model.is_balanced());
            for (int i = 0; i < 25; ++i) {
                const int x = half(random), y = half(random), z = half(random);
                const Double3 q{scale * x / 2, scale * y / 2, scale * z / 2};
                const std::optional<int> truth = exact_winding(surface, q);
                const Inclusion found = points_inside(model.model, q, workspace);
                ASSERT_EQ(found.on_surface, !truth) << kSeed << ' ' << exponent << ' ' << round;
                ASSERT_EQ(found.winding, truth.value_or(0)) << exponent << ' ' << round;
                ASSERT_EQ(found.answer, !truth || *truth != 0 ? Answer::yes : Answer::no);
                ++(!truth ? on_surface : *truth == 0 ? outside : inside);
            }
        }
    }
    EXPECT_GT(on_surface, 100);
    EXPECT_GT(outside, 200);
    EXPECT_GT(inside, 120);
}

/// The answer by definition, for surfaces that do not touch: some component's
/// vertex has a winding number other than 0 in the other model.
bool contained_by_definition(const TestMesh& inner, const Pose* pose,
                             const std::vector<Corners>& outer) {
    for (std::size_t first = 0; first < inner.positions.size(); first += 4) {
        const Double3 p = inner.positions[first];
        const auto found = exact_winding(outer, pose == nullptr ? p : transform_point(*pose, p));
        if (found && *found != 0) return true;
    }
    return false;
}

// Large and small solids anywhere, by every placement; pairs that touch are left
// out, since the question is not about them.
TEST(ContainmentLaws, AgreesWithExactRaysUnderEveryPlacement) {
    constexpr std::uint32_t kSeed = 72;
    std::mt19937 random(kSeed);
    Workspace workspace;
    int yes = 0, no = 0;
    for (int round = 0; round < 1'200; ++round) {
        const TestMesh a = tetrahedra(random, 1 + round % 3, 6);
        const TestMesh b = moved_by(tetrahedra(random, 1 + round % 2, 2), 0.25, {0, 0, 0});
        const Pose p = random_pose(random, round % 2 == 0 ? 2 : 1000);
        Pose q = p;
        if (round % 2 == 0) q = random_pose(random, 2);
        const Placement placement = round % 3 == 0   ? Placement::b_moves(random_pose(random, 2))
                                    : round % 3 == 1 ? Placement::a_moves(random_pose(random, 2))
                                                     : Placement::world(p, q);
        if (!brute_force_pairs(a, b, placement).empty()) continue;
        const OpenModel model_a = open_tiny(a, {.double_precision = true});
        const OpenModel model_b = open_tiny(b, {.double_precision = true});
        const Pose* pose_a = placement.a_is_moved() ? &placement.pose_a() : nullptr;
        const Pose* pose_b = placement.b_is_moved() ? &placement.pose_b() : nullptr;
        const bool a_inside = contained_by_definition(a, pose_a, surface_of(b, pose_b));
        const bool b_inside = contained_by_definition(b, pose_b, surface_of(a, pose_a));
        const Containment found = containment({model_a.model, model_b.model, placement}, workspace);
        ASSERT_EQ(found.answer == Answer::yes, a_inside || b_inside) << kSeed << ' ' << round;
        ASSERT_NE(found.answer, Answer::unknown) << round;
        if (found.answer == Answer::yes) {
            ASSERT_TRUE(found.a_inside_b ? a_inside : b_inside) << round;
        }
        ++(a_inside || b_inside ? yes : no);
    }
    EXPECT_GT(yes, 50);
    EXPECT_GT(no, 200);
}

// By construction: a small cube well inside a large one that lacks a triangle.
TEST(ContainmentLaws, AHoleTurnsAnswersIntoUnknown) {
    std::mt19937 random(73);
    Workspace workspace;
    TestMesh open = moved_by(unit_cube(), 4, {-2, -2, -2});
    open.triangles.pop_back();
    const OpenModel outer = open_tiny(open, {.double_precision = true});
    const OpenModel inner =
        open_tiny(moved_by(unit_cube(), 0.5, {0, 0, 0}), {.double_precision = true});
    for (int round = 0; round < 50; ++round) {
        const Pose pose = random_pose(random, 0.25);
        const Containment found =
            containment({outer.model, inner.model, Placement::b_moves(pose)}, workspace);
        ASSERT_EQ(found.answer, Answer::unknown) << round;
        ASSERT_FALSE(found.a_inside_b);
        ASSERT_GT(found.winding, 0.5);
        ASSERT_LT(found.winding, 1);
    }
}

}  // namespace
}  // namespace cdprep::test
