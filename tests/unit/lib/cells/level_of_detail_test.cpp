// SPDX-License-Identifier: MIT
#include "cdprep/cells/level_of_detail.h"
#include "cdprep/cells.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/more_sections.h"
#include "support/open_tiny.h"

#include "cdprep/pairs.h"

namespace cdprep::test {
namespace {

OpenModel with_cones(const TestMesh& mesh, std::uint32_t level) {
    // Boxes, which do not hold the inside, must not be used.
    return open_tiny(with_tetra_tree(bake_tiny(mesh.positions, mesh.triangles),
                                     {.level = level, .bounding = format::TetraBounding::boxes}));
}

Placement shifted(const Double3& by) {
    return Placement::b_moves(Pose::from_quaternion(1, 0, 0, 0, by).value());
}

/// Any rotation, the centres so far apart.
Pose turned_and_apart(std::mt19937& random, double distance) {
    std::normal_distribution<double> normal;
    const double x = normal(random), y = normal(random), z = normal(random);
    const double factor = distance / std::sqrt(x * x + y * y + z * z);
    const double w = normal(random), i = normal(random), j = normal(random), k = normal(random);
    return Pose::from_quaternion(w, i, j, k, {x * factor, y * factor, z * factor}).value();
}

/// A sphere with bumps: star-shaped about the origin, not convex.
TestMesh bumpy(std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> factor(0.6, 1.4);
    TestMesh mesh = icosphere(3);
    for (Double3& p : mesh.positions) {
        const double f = factor(random);
        p = {p.x * f, p.y * f, p.z * f};
    }
    return in_floats(mesh);
}

TEST(LevelOfDetail, ErrorFallsAsTheLevelRises) {
    const OpenModel sphere = with_cones(in_floats(icosphere(4)), 5);
    double before = level_error(sphere.model, 0);
    EXPECT_GT(before, 0.5);  // from the middle of an octant's face to its corners
    for (std::uint32_t level = 1; level <= 5; ++level) {
        const double error = level_error(sphere.model, level);
        EXPECT_LT(error, before) << level;
        before = error;
    }
    EXPECT_LT(before, 0.1);
    EXPECT_EQ(level_error(sphere.model, 14), before);
}

TEST(LevelOfDetail, NeverContradictsTheSolids) {
    const OpenModel a = with_cones(bumpy(1), 4);
    const OpenModel b = with_cones(bumpy(2), 4);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> gap(0, 3.2);
    Workspace workspace(cells());
    int known_yes = 0;
    int known_no = 0;
    int last_unknown = 0;
    constexpr int kRounds = 400;
    for (int round = 0; round < kRounds; ++round) {
        const Pose pose = turned_and_apart(random, gap(random));
        const Placement placement = Placement::b_moves(pose);
        PairOptions options;
        options.body = Body::solid;
        const bool hit =
            collide({a.model, b.model, placement, options}, workspace).hit == Answer::yes;
        Answer before = Answer::unknown;
        for (std::uint32_t level = 0; level <= 4; ++level) {
            const Answer answer =
                collide_at_level({a.model, b.model, placement}, level, workspace).answer;
            EXPECT_TRUE(answer != Answer::yes || hit) << round << ' ' << level;
            EXPECT_TRUE(answer != Answer::no || !hit) << round << ' ' << level;
            // Deeper facets lie between shallower ones: what is apart stays so.
            EXPECT_TRUE(before != Answer::no || answer == Answer::no) << round << ' ' << level;
            before = answer;
        }
        known_yes += before == Answer::yes ? 1 : 0;
        known_no += before == Answer::no ? 1 : 0;
        last_unknown += before == Answer::unknown ? 1 : 0;
    }
    EXPECT_GT(known_yes, kRounds / 4);
    EXPECT_GT(known_no, kRounds / 10);
    EXPECT_LT(last_unknown, kRounds / 2);
    EXPECT_GT(last_unknown, 0);
}

TEST(LevelOfDetail, ThreeAnswersOfTwoSpheres) {
    const OpenModel a = with_cones(in_floats(icosphere(4)), 5);
    Workspace workspace(cells());
    const auto answer = [&](double gap, std::uint32_t level) {
        return collide_at_level({a.model, a.model, shifted({gap, 0.1, 0.2})}, level, workspace)
            .answer;
    };
    EXPECT_EQ(answer(3.6, 0), Answer::no);
    EXPECT_EQ(answer(2.15, 0), Answer::unknown);
    EXPECT_EQ(answer(2.15, 5), Answer::no);
    EXPECT_EQ(answer(0.5, 0), Answer::yes);
    EXPECT_EQ(answer(1.9, 0), Answer::unknown);
    EXPECT_EQ(answer(1.7, 5), Answer::yes);
    // Beyond the deepest level, also where its first key is no 32-bit number.
    for (const std::uint32_t level : {6U, 14U, 15U, 16U, 77U, UINT32_MAX}) {
        EXPECT_EQ(answer(2.15, level), Answer::no) << level;
        EXPECT_EQ(answer(1.7, level), Answer::yes) << level;
    }
}

TEST(LevelOfDetail, OpenOrHollowModelsAreNeverCertainToCollide) {
    TestMesh open = in_floats(icosphere(2));
    open.triangles.pop_back();
    const OpenModel a = with_cones(open, 3);
    const OpenModel b = with_cones(in_floats(icosphere(2)), 3);
    Workspace workspace(cells());
    EXPECT_EQ(collide_at_level({a.model, b.model, shifted({0.1, 0, 0})}, 3, workspace).answer,
              Answer::unknown);
    EXPECT_EQ(collide_at_level({a.model, b.model, shifted({4, 0, 0})}, 3, workspace).answer,
              Answer::no);
    // A torus: its centre is outside.
    const OpenModel ring = with_cones(in_floats(torus(2, 0.5, 24, 12)), 3);
    EXPECT_EQ(collide_at_level({ring.model, ring.model, shifted({0.1, 0, 0})}, 3, workspace).answer,
              Answer::unknown);
}

// By the table of needs: a file without a tetra-tree does not serve Ask::tetra_tree.
TEST(LevelOfDetailDeathTest, StopsWhereAModelWasNotBakedForIt) {
    const OpenModel sphere = with_cones(in_floats(icosphere(2)), 3);
    const OpenModel bare = open_tiny(in_floats(icosphere(1)));
    Workspace workspace(cells());
    const Placement near = shifted({0.5, 0, 0});
    EXPECT_DEATH((void)collide_at_level({sphere.model, bare.model, near}, 2, workspace),
                 "tetra-tree needs");
    EXPECT_DEATH((void)level_error(bare.model, 2), "tetra-tree needs");
}

TEST(LevelOfDetail, OddModels) {
    const OpenModel sphere = with_cones(in_floats(icosphere(2)), 3);
    const OpenModel empty = with_cones({}, 3);
    const OpenModel flat = with_cones(fan(7), 3);  // triangles hold the centre
    Workspace workspace(cells());
    const Placement near = shifted({0.5, 0, 0});
    EXPECT_EQ(collide_at_level({sphere.model, empty.model, near}, 2, workspace).answer, Answer::no);
    EXPECT_EQ(collide_at_level({sphere.model, flat.model, near}, 2, workspace).answer,
              Answer::unknown);
    EXPECT_EQ(level_error(empty.model, 2), 0);
    // A triangle at the centre is below no facet, but still in the box around all.
    EXPECT_EQ(
        collide_at_level({sphere.model, flat.model, shifted({50, 0, 0})}, 2, workspace).answer,
        Answer::no);
}

// Scaling by a power of two changes no answer.
TEST(LevelOfDetail, AnyScale) {
    for (const int exponent : {-900, 900}) {
        const double scale = std::ldexp(1.0, exponent);
        const TestMesh mesh = moved_by(icosphere(3), scale, {0, 0, 0});
        const OpenModel a = open_tiny(with_tetra_tree(
            bake_tiny(mesh.positions, mesh.triangles, {.double_precision = true}), {.level = 4}));
        Workspace workspace(cells());
        const auto answer = [&](double gap) {
            return collide_at_level(
                       {a.model, a.model, shifted({gap * scale, 0.1 * scale, 0.2 * scale})}, 4,
                       workspace)
                .answer;
        };
        EXPECT_EQ(answer(2.3), Answer::no) << exponent;
        EXPECT_EQ(answer(1.5), Answer::yes) << exponent;
    }
}

// Facets of a curved surface never agree; the keys of the deepest level fill 32 bits. Two specks
// far apart have few cones there.
TEST(LevelOfDetail, TheDeepestLevelThatAKeyHoldsHasFacets) {
    const OpenModel specks = with_cones(
        joined(moved_by(icosphere(1), 1e-3, {3, 2, 1}), moved_by(icosphere(1), 1e-3, {-3, -2, -1})),
        format::kMaxTetraLevel);
    ASSERT_EQ(format::tetra_level(specks.model.tetra_tree().nodes.back().key),
              format::kMaxTetraLevel);
    const double error = level_error(specks.model, format::kMaxTetraLevel);
    EXPECT_GT(error, 0);
    EXPECT_LE(error, level_error(specks.model, format::kMaxTetraLevel - 1));
}

}  // namespace
}  // namespace cdprep::test
