// SPDX-License-Identifier: MIT
#include "cdprep/pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "cdprep/points.h"
#include "exact/winding.h"
#include "support/hard_points.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"

namespace cdprep::test {
namespace {

Inclusion where(const TestMesh& mesh, const Double3& p) {
    const OpenModel model = open_tiny(mesh, {.double_precision = true});
    Workspace workspace;
    return points_inside(model.model, p, workspace);
}

// P02, P03: by hand, a cube's inside, with rays along its diagonals and edges.
TEST(Containment, HalfIntegerProbesOfACube) {
    const OpenModel model = open_tiny(cube_at(-2, 2));
    Workspace workspace;
    for (int i = -4; i <= 4; ++i) {
        for (int j = -4; j <= 4; ++j) {
            for (int k = -4; k <= 4; ++k) {
                const Inclusion found =
                    points_inside(model.model, {i * 0.75, j * 0.75, k * 0.75}, workspace);
                const int farthest = std::max({std::abs(i), std::abs(j), std::abs(k)});
                ASSERT_EQ(found.answer == Answer::yes, farthest * 0.75 <= 2)
                    << i << " " << j << " " << k;
            }
        }
    }
}

// P04: points in the plane of a face or on the line of an edge, but outside.
TEST(Containment, ExtensionsOfFacesAndEdgesAreOutside) {
    for (const Double3& p : {Double3{-1, 0, 0}, Double3{-1, 1, 1}, Double3{-1, 0.5, 0},
                             Double3{-1, 0.5, 1}, Double3{0.5, -1, 0}, Double3{0, 0, -3}}) {
        EXPECT_EQ(where(unit_cube(), p).answer, Answer::no);
    }
}

// P05
TEST(Containment, TheBoundaryIsOnTheSurface) {
    for (const Double3& p : {Double3{0.25, 0.5, 0}, Double3{0.5, 0, 0}, Double3{1, 1, 1}}) {
        const Inclusion found = where(unit_cube(), p);
        EXPECT_TRUE(found.on_surface);
        EXPECT_EQ(found.answer, Answer::yes);
    }
}

// P06, P09: by counting shells.
TEST(Containment, WindingNumbersAddUp) {
    const Double3 core{1.5, 1.5, 1.5};
    EXPECT_EQ(where(joined(cube_at(0, 3), cube_at(1, 2)), core).winding, 2);
    const Inclusion hollow = where(joined(cube_at(0, 3), reversed(cube_at(1, 2))), core);
    EXPECT_EQ(hollow.answer, Answer::no);
    EXPECT_EQ(hollow.winding, 0);
    const Inclusion inverted = where(reversed(cube_at(1, 2)), core);
    EXPECT_EQ(inverted.winding, -1);
    EXPECT_EQ(inverted.answer, Answer::yes);
}

// P01: the ray runs through a folded vertex, where once-per-sign rules fail.
TEST(Containment, FoldedVertexIsCountedRight) {
    const TestMesh folded = folded_corner();
    const Double3 o{0, 0, -20}, q{0, 0, -0.5};
    int winding = 0;
    for (const Triangle& t : folded.triangles) {
        winding += winding_term(o, q,
                                {folded.positions[t.vertex[0]], folded.positions[t.vertex[1]],
                                 folded.positions[t.vertex[2]]})
                       .crossings;
    }
    EXPECT_EQ(std::abs(winding), 1);
    EXPECT_EQ(where(folded, q).answer, Answer::yes);
}

// P07
TEST(Containment, SolidsThatShareAnEdgeAreNotRefused) {
    const TestMesh two = joined(cube_at(0, 1), moved_by(unit_cube(), 1, {1, 1, 0}));
    EXPECT_EQ(where(two, {0.5, 0.5, 0.5}).answer, Answer::yes);
    EXPECT_EQ(where(two, {1.5, 1.5, 0.5}).answer, Answer::yes);
    EXPECT_EQ(where(two, {1.5, 0.5, 0.5}).answer, Answer::no);
}

// P08: by symmetry, five of six equal faces make 5/6.
TEST(Containment, OpenInputIsNeverGuessed) {
    TestMesh open = unit_cube();
    open.triangles.resize(10);
    const Inclusion centre = where(open, {0.5, 0.5, 0.5});
    EXPECT_EQ(centre.answer, Answer::unknown);
    EXPECT_NEAR(centre.winding, 5.0 / 6, 1e-12);
    EXPECT_EQ(where(open, {5, 5, 5}).answer, Answer::no);  // outside the box: outside
}

TEST(WindingTerm, DoesNotDependOnTheOrigin) {
    std::mt19937 random(3);
    std::uniform_int_distribution<int> grid(-3, 3);
    const TestMesh mesh = joined(cube_at(-2, 2), cube_at(-1, 1));
    int inside = 0, asked = 0;
    for (int i = 0; i < 300; ++i) {
        const auto point = [&] {
            const double x = grid(random), y = grid(random), z = grid(random);
            return Double3{0.75 * x, 0.75 * y, 0.75 * z};
        };
        const Double3 q = point();
        std::optional<int> expected;
        for (int k = 0; k < 5; ++k) {
            const Double3 o = point();
            if (o == q) continue;
            int winding = 0;
            bool on = false;
            for (const Triangle& t : mesh.triangles) {
                const WindingTerm term =
                    winding_term(o, q,
                                 {mesh.positions[t.vertex[0]], mesh.positions[t.vertex[1]],
                                  mesh.positions[t.vertex[2]]});
                winding += term.crossings;
                on = on || term.on_surface;
            }
            if (on) break;
            ASSERT_EQ(expected.value_or(winding), winding) << "query " << i;
            expected = winding;
        }
        if (expected) inside += *expected != 0 ? 1 : 0;
        if (expected) ++asked;
    }
    EXPECT_GT(asked, 100);
    EXPECT_GT(inside, 5);
    EXPECT_LT(inside, asked);
}

Collision solid(const TestMesh& a, const TestMesh& b, const Placement& placement) {
    const OpenModel model_a = open_tiny(a, {.double_precision = true});
    const OpenModel model_b = open_tiny(b, {.double_precision = true});
    Workspace workspace;
    return collide({model_a.model, model_b.model, placement, {.body = Body::solid}}, workspace);
}

// By construction: a small cube inside a large one, under every placement.
TEST(CollideSolid, NestedSolidsCollideHoweverTheyAreMoved) {
    std::mt19937 random(9);
    for (int i = 0; i < 20; ++i) {
        const Pose p = random_pose(random, 10);
        for (const bool swapped : {false, true}) {
            const TestMesh inner = cube_at(1, 2), outer = cube_at(0, 3);
            const Collision found = swapped ? solid(outer, inner, Placement::world(p, p))
                                            : solid(inner, outer, Placement::world(p, p));
            ASSERT_EQ(found.hit, Answer::yes);
            EXPECT_EQ(found.containment.answer, Answer::yes);
            EXPECT_EQ(found.containment.a_inside_b, !swapped);
            EXPECT_EQ(found.containment.winding, 1);
        }
    }
}

TEST(CollideSolid, SurfacesAloneDoNotCollideWhenNested) {
    const OpenModel inner = open_tiny(cube_at(1, 2)), outer = open_tiny(cube_at(0, 3));
    Workspace workspace;
    EXPECT_FALSE(collide({inner.model, outer.model, Placement::b_moves(Pose())}, workspace).hit ==
                 Answer::yes);
}

TEST(CollideSolid, ACavityHoldsNothing) {
    const TestMesh hollow = joined(cube_at(0, 3), reversed(cube_at(1, 2)));
    const Collision found = solid(hollow, cube_at(1.25, 1.75), Placement::b_moves(Pose()));
    EXPECT_EQ(found.hit, Answer::no);
    EXPECT_EQ(found.containment.answer, Answer::no);
}

/// The first vertex of the first triangle of a mesh is the first corner.
TestMesh tetrahedron(const std::array<Double3, 4>& corners) {
    TestMesh mesh;
    mesh.positions.assign(corners.begin(), corners.end());
    mesh.triangles = {{{0, 2, 1}}, {{0, 1, 3}}, {{0, 3, 2}}, {{1, 2, 3}}};
    return mesh;
}

Answer solid_properly(const TestMesh& a, const TestMesh& b) {
    const OpenModel model_a = open_tiny(a, {.double_precision = true});
    const OpenModel model_b = open_tiny(b, {.double_precision = true});
    Workspace workspace;
    const PairOptions options = {.body = Body::solid, .overlap = Overlap::proper};
    const Collision found =
        collide({model_a.model, model_b.model, Placement::b_moves(Pose()), options}, workspace);
    EXPECT_EQ(
        collide({model_b.model, model_a.model, Placement::b_moves(Pose()), options}, workspace).hit,
        found.hit);
    return found.hit;
}

// By hand: where touching does not count, a vertex on the other surface does not decide. Each
// vertex may be the one that is tested.
TEST(CollideSolid, AVertexOnTheSurfaceDoesNotDecide) {
    const TestMesh cube = cube_at(0, 10);
    std::array<Double3, 4> inside = {{{5, 5, 0}, {4, 4, 3}, {6, 4, 3}, {5, 6, 3}}};
    std::array<Double3, 4> outside = {{{5, 5, 0}, {4, 6, -3}, {6, 6, -3}, {5, 4, -3}}};
    for (int turn = 0; turn < 4; ++turn) {
        EXPECT_EQ(solid_properly(tetrahedron(inside), cube), Answer::yes) << turn;
        EXPECT_EQ(solid_properly(tetrahedron(outside), cube), Answer::no) << turn;
        const TestMesh both = joined(tetrahedron(outside), cube_at(20, 21));
        EXPECT_EQ(solid_properly(both, cube), Answer::no) << turn;
        EXPECT_EQ(solid_properly(joined(both, tetrahedron(inside)), cube), Answer::yes) << turn;
        std::rotate(inside.begin(), inside.begin() + 1, inside.end());
        std::rotate(outside.begin(), outside.begin() + 1, outside.end());
    }
}

// By hand: with all vertices on the other surface, a component may be inside or outside.
TEST(CollideSolid, AComponentWithAllVerticesOnTheSurfaceIsUnknown) {
    const TestMesh cube = cube_at(0, 10);
    const TestMesh inscribed = tetrahedron({{{0, 0, 5}, {10, 0, 6}, {0, 10, 6}, {5, 5, 10}}});
    EXPECT_EQ(solid_properly(inscribed, cube), Answer::unknown);
    EXPECT_EQ(solid_properly(joined(inscribed, cube_at(20, 21)), cube), Answer::unknown);
}

// An open container never proves that a touching component is outside.
TEST(CollideSolid, AVertexOnAnOpenSurfaceAnswersUnknown) {
    TestMesh open = cube_at(0, 10);
    open.triangles.resize(10);
    const TestMesh touching = tetrahedron({{{5, 5, 0}, {4, 4, 3}, {6, 4, 3}, {5, 6, 3}}});
    EXPECT_EQ(solid_properly(touching, open), Answer::unknown);
}

TEST(CollideSolid, OpenContainersAnswerUnknown) {
    TestMesh open = cube_at(0, 3);
    open.triangles.resize(10);
    const Collision found = solid(open, cube_at(1, 2), Placement::b_moves(Pose()));
    EXPECT_EQ(found.hit, Answer::unknown);
    EXPECT_EQ(found.containment.answer, Answer::unknown);
    EXPECT_GT(std::fabs(found.containment.winding), 0.5);
}

}  // namespace
}  // namespace cdprep::test
