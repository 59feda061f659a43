// SPDX-License-Identifier: MIT
#include "cdprep/pairs.h"

#include <gtest/gtest.h>

#include "support/brute_force.h"
#include "support/open_tiny.h"
#include "support/placements.h"

namespace cdprep::test {
namespace {

std::vector<TrianglePair> ask(const TestMesh& a, const TestMesh& b, const Placement& placement,
                              const PairOptions& options = {}) {
    const OpenModel model_a = open_tiny(a);
    const OpenModel model_b = open_tiny(b);
    Workspace workspace;
    return all_pairs(model_a.model, model_b.model, placement, workspace, options);
}

// By hand: the face x = 1 of one cube lies on the face x = 0 of the other.
TEST(OverlappingTriangles, TouchingFacesCount) {
    const auto pairs = ask(unit_cube(), unit_cube(), shifted({1, 0, 0}));
    EXPECT_FALSE(pairs.empty());
    EXPECT_TRUE(ask(unit_cube(), unit_cube(), shifted({1.0000001, 0, 0})).empty());
}

// By hand: touching cubes share area on the common face alone, and both diagonals
// run alike there, so each half face lies on one half of the other.
TEST(OverlappingTriangles, ProperLeavesOutWhatOnlyTouches) {
    const auto pairs =
        ask(unit_cube(), unit_cube(), shifted({1, 0, 0}), {.overlap = Overlap::proper});
    for (const TrianglePair& pair : pairs) {
        EXPECT_TRUE(pair.a >= 10 && (pair.b == 8 || pair.b == 9)) << pair.a << " " << pair.b;
    }
    EXPECT_EQ(pairs.size(), 2u);
    EXPECT_TRUE(
        ask(unit_cube(), unit_cube(), shifted({1, 1, 0}), {.overlap = Overlap::proper}).empty());
}

// A law: the pairs come in rising order, and a short span gets the first of them.
TEST(OverlappingTriangles, ShortSpanHoldsTheSmallestPairs) {
    const OpenModel sheet = open_tiny(grid_sheet(12, 12));
    Workspace workspace;
    const Placement same = Placement::b_moves(Pose());
    const auto all = all_pairs(sheet.model, sheet.model, same, workspace);
    EXPECT_TRUE(std::is_sorted(all.begin(), all.end()));
    std::vector<TrianglePair> some(17);
    EXPECT_EQ(overlaps({sheet.model, sheet.model, same}, workspace, some), all.size());
    EXPECT_TRUE(std::equal(some.begin(), some.end(), all.begin()));
}

// B05: by counting, n * m equal triangles, and an output that is capped.
TEST(OverlappingTriangles, EqualTrianglesAllOverlap) {
    const OpenModel copies = open_tiny(copies_of_one_triangle(1000));
    Workspace workspace;
    EXPECT_EQ(overlaps({copies.model, copies.model, Placement::b_moves(Pose())}, workspace, {}),
              1'000'000u);
}

// B02: a sphere's mesh lies between its inner and its outer radius, so a shell twice
// as thick away touches nothing, however near.
TEST(OverlappingTriangles, NestedShellsStayApart) {
    const TestMesh outer = icosphere(5);
    const OpenModel inside = open_tiny(moved_by(outer, 0.997, {}), {.double_precision = true});
    const OpenModel outside = open_tiny(outer, {.double_precision = true});
    Workspace workspace;
    EXPECT_EQ(overlaps({outside.model, inside.model, shifted({0, 0, 0})}, workspace, {}), 0u);
    const PairOptions solid = {.body = Body::solid};
    EXPECT_TRUE(collide({outside.model, inside.model, shifted({0, 0, 0}), solid}, workspace).hit ==
                Answer::yes);
}

// B03: parallel sheets one grid step apart, by construction; and none apart.
TEST(OverlappingTriangles, ParallelSheetsMeetOnlyWhenTheyCoincide) {
    const OpenModel sheet = open_tiny(grid_sheet(150, 150));
    Workspace workspace;
    const auto count = [&](double z) {
        return overlaps({sheet.model, sheet.model, shifted({0.25, 0.25, z})}, workspace, {});
    };
    EXPECT_EQ(count(0x1p-20), 0u);
    EXPECT_EQ(count(-0x1p-1000), 0u);
    EXPECT_GT(count(0), 150u * 150 * 12);
}

// B07: one triangle through a fine sphere meets what brute force finds.
TEST(OverlappingTriangles, OneTriangleMeetsMany) {
    const TestMesh sphere = icosphere(5);
    const TestMesh slice{{{-9, -9, 0.25}, {9, -9, 0.5}, {0, 9, 0.75}}, {{{0, 1, 2}}}};
    const Placement same = shifted({0, 0, 0});
    const auto pairs = ask(sphere, slice, same);
    EXPECT_EQ(pairs, brute_force_pairs(in_floats(sphere), slice, same));
    EXPECT_GT(pairs.size(), 200u);
}

// B06: by construction every triangle of the fan holds the origin.
TEST(OverlappingTriangles, ProbeAtTheHubMeetsTheWholeFan) {
    const TestMesh probe{{{0, 0, 0}, {1, 0, -1}, {0, 1, -1}}, {{{0, 1, 2}}}};
    EXPECT_EQ(ask(fan(20000), probe, shifted({0, 0, 0})).size(), 20000u);
}

// B11: an empty model overlaps nothing, a point answers as the point that it is.
TEST(OverlappingTriangles, TrivialMeshesHaveDefinedAnswers) {
    EXPECT_TRUE(ask({}, unit_cube(), shifted({0, 0, 0})).empty());
    EXPECT_TRUE(ask({}, {}, shifted({0, 0, 0})).empty());
    const TestMesh point{{{0.5, 0.5, 0}}, {{{0, 0, 0}}}};
    EXPECT_EQ(ask(unit_cube(), point, shifted({0, 0, 0})).size(), 2u);  // on a face's diagonal
    EXPECT_TRUE(ask(unit_cube(), point, shifted({0, 0, 0.5})).empty());
    EXPECT_TRUE(
        ask(unit_cube(), point, shifted({0, 0, 0}), {.degenerate = Degenerate::skip}).empty());
}

// B10, B09: boxes of extreme shapes still hold their triangles.
TEST(OverlappingTriangles, MeetsItselfAtExtremeScales) {
    for (const double scale : {0x1p-1000, 0x1p-200, 0x1p-40, 0x1p40, 0x1p200, 0x1p900}) {
        const TestMesh torus_mesh = moved_by(torus(2, 0.5, 16, 8), scale, {0, 0, 0});
        const OpenModel model = open_tiny(torus_mesh, {.double_precision = true});
        Workspace workspace;
        const Placement same = Placement::b_moves(Pose());
        EXPECT_EQ(all_pairs(model.model, model.model, same, workspace),
                  brute_force_pairs(torus_mesh, torus_mesh, same))
            << "scale " << scale;
    }
    EXPECT_EQ(
        ask(geometric_progression(100), geometric_progression(100), shifted({0, 0, 0})).size(),
        100u);
}

// A small model inside the coordinate range of one 2^300 times as large.
TEST(OverlappingTriangles, MeetsAcrossScales) {
    const TestMesh small = moved_by(icosphere(1), 0x1p-150, {0, 0, 0});
    const TestMesh large = moved_by(grid_sheet(4, 4), 0x1p150, {-0x1p151, -0x1p151, 0});
    for (const bool swapped : {false, true}) {
        const TestMesh& a = swapped ? large : small;
        const TestMesh& b = swapped ? small : large;
        const OpenModel model_a = open_tiny(a, {.double_precision = true});
        const OpenModel model_b = open_tiny(b, {.double_precision = true});
        Workspace workspace;
        const Placement same = Placement::b_moves(Pose());
        const auto pairs = all_pairs(model_a.model, model_b.model, same, workspace);
        EXPECT_EQ(pairs, brute_force_pairs(a, b, same));
        EXPECT_FALSE(pairs.empty());
    }
}

}  // namespace
}  // namespace cdprep::test
