// SPDX-License-Identifier: MIT
#include "cdprep/cells.h"
#include "cdprep/points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/every_structure.h"
#include "support/hard_points.h"
#include "support/meshes.h"

#include "cdprep/advanced/query_counts.h"

namespace cdprep::test {
namespace {

/// A model with every structure, asked through each of them in turn.
class Asked {
public:
    explicit Asked(const TestMesh& mesh, const Division& division = {})
        : open_(open_with_every_structure(mesh, division)) {}

    [[nodiscard]] const Model& model() const {
        return open_.model;
    }
    /// The answer of points_inside(), which all structures must share.
    Inclusion at(const Double3& p) {
        const Inclusion expected = points_inside(open_.model, p, workspace_);
        for (const Structure structure : kStructures) {
            const Inclusion found = points_inside(open_.model, p, workspace_, structure);
            EXPECT_EQ(found.answer, expected.answer) << name_of(structure);
            EXPECT_EQ(found.on_surface, expected.on_surface) << name_of(structure);
            EXPECT_EQ(found.winding, expected.winding) << name_of(structure);
        }
        return expected;
    }
    /// Triangles that a question through one structure looks at.
    std::uint64_t triangles_for(Structure structure, const Double3& p) {
        QueryCounts counts;
        workspace_.count_into(&counts);
        (void)points_inside(open_.model, p, workspace_, structure);
        workspace_.count_into(nullptr);
        return counts.ray_triangles;
    }

private:
    OpenModel open_;
    Workspace workspace_{cells()};
};

// P02, P03: by hand, a cube's inside, seen from its centre along diagonals and edges; the
// centre itself is where the rays of the tetra-tree begin.
TEST(IncludesThrough, HalfIntegerProbesOfACube) {
    for (const std::uint32_t level : {0U, 1U, 3U, 6U}) {
        Asked cube(cube_at(-2, 2), {.level = level});
        ASSERT_EQ(cube.model().tetra_tree().tree->centre, (Double3{0, 0, 0}));
        for (int i = 0; i < 729; ++i) {
            const Double3 p{i % 9 * 0.5 - 2, i / 9 % 9 * 0.5 - 2, i / 81 * 0.5 - 2};
            const double farthest = std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
            const Inclusion found = cube.at(p);
            ASSERT_EQ(found.on_surface, farthest == 2) << i;
            ASSERT_EQ(found.winding, farthest < 2 ? 1 : 0) << i;
            const Inclusion outside = cube.at({1.5 * p.x, 1.5 * p.y, 1.5 * p.z});
            ASSERT_EQ(outside.answer, farthest * 1.5 <= 2 ? Answer::yes : Answer::no) << i;
        }
    }
}

// P04: in the plane of a face or on the line of an edge, but outside.
TEST(IncludesThrough, ExtensionsOfFacesAndEdgesAreOutside) {
    Asked cube(unit_cube());
    for (const Double3& p : {Double3{-1, 0, 0}, Double3{-1, 1, 1}, Double3{-1, 0.5, 0},
                             Double3{-1, 0.5, 1}, Double3{0.5, -1, 0}, Double3{0, 0, -3},
                             Double3{2, 1, 1}, Double3{1, 2, 0}, Double3{2, 0.5, 0.5}}) {
        EXPECT_EQ(cube.at(p).answer, Answer::no);
    }
}

// P05: dyadic points of a face, an edge and a corner.
TEST(IncludesThrough, TheBoundaryIsOnTheSurface) {
    Asked cube(unit_cube());
    for (const Double3& p :
         {Double3{0.25, 0.5, 0}, Double3{1, 0.25, 0.5}, Double3{0.5, 0, 0}, Double3{1, 1, 1},
          Double3{1, 0, 0.125}, Double3{0, 0, 0}, Double3{0.5, 0.5, 1}}) {
        const Inclusion found = cube.at(p);
        EXPECT_TRUE(found.on_surface);
        EXPECT_EQ(found.answer, Answer::yes);
    }
}

// P06, P09: by counting shells.
TEST(IncludesThrough, WindingNumbersAddUp) {
    const Double3 core{1.5, 1.5, 1.5};
    EXPECT_EQ(Asked(joined(cube_at(0, 3), cube_at(1, 2))).at(core).winding, 2);
    Asked hollow(joined(cube_at(0, 3), reversed(cube_at(1, 2))));
    EXPECT_EQ(hollow.at(core).answer, Answer::no);
    EXPECT_EQ(hollow.at({0.5, 1.5, 1.5}).winding, 1);
    Asked inverted(reversed(cube_at(1, 2)));
    EXPECT_EQ(inverted.at(core).winding, -1);
    EXPECT_EQ(inverted.at({1.25, 1.75, 1.5}).winding, -1);
    Asked shifted(joined(unit_cube(), cube_at(0.5, 1.5)));
    EXPECT_EQ(shifted.at({0.75, 0.75, 0.75}).winding, 2);
    EXPECT_EQ(shifted.at({0.25, 0.75, 0.75}).winding, 1);
    EXPECT_EQ(shifted.at({0.25, 0.75, 1.25}).winding, 0);
}

// P01: the ray from the origin leaves through a folded vertex, where once-per-sign rules
// fail; winding_laws_test knows the numbers.
TEST(IncludesThrough, AFoldedVertexIsCountedOnce) {
    const TestMesh folded = folded_corner();
    Asked asked(folded);
    for (const double z : {-0.5, -0.25, -1.0}) EXPECT_EQ(asked.at({0, 0, z}).winding, 1) << z;
    const Double3 c = asked.model().tetra_tree().tree->centre;
    for (const Double3& v : folded.positions) {
        for (const double part : {0.25, 0.5, 0.75, 1.0, 1.25}) {
            asked.at(
                {c.x + part * (v.x - c.x), c.y + part * (v.y - c.y), c.z + part * (v.z - c.z)});
        }
    }
}

// P07: four faces at one edge, and two cubes that share a corner.
TEST(IncludesThrough, SolidsThatShareAnEdgeOrACornerAreNotRefused) {
    Asked edge(joined(cube_at(0, 1), moved_by(unit_cube(), 1, {1, 1, 0})));
    EXPECT_EQ(edge.at({0.5, 0.5, 0.5}).winding, 1);
    EXPECT_EQ(edge.at({1.5, 1.5, 0.5}).winding, 1);
    EXPECT_EQ(edge.at({1.5, 0.5, 0.5}).winding, 0);
    EXPECT_TRUE(edge.at({1, 1, 0.5}).on_surface);  // the centre of the tetra-tree, on it
    Asked corner(joined(cube_at(0, 1), cube_at(1, 2)));
    EXPECT_EQ(corner.at({0.5, 0.5, 0.5}).winding, 1);
    EXPECT_EQ(corner.at({1.5, 1.5, 1.5}).winding, 1);
    EXPECT_EQ(corner.at({1.5, 0.5, 0.5}).winding, 0);
    EXPECT_TRUE(corner.at({1, 1, 1}).on_surface);
}

// P08: by symmetry, five of six equal faces make 5/6; nothing is guessed.
TEST(IncludesThrough, OpenModelsAreAnsweredAsIncludesDoes) {
    TestMesh open = unit_cube();
    open.triangles.resize(10);
    Asked cube(open);
    const Inclusion centre = cube.at({0.5, 0.5, 0.5});
    EXPECT_EQ(centre.answer, Answer::unknown);
    EXPECT_NEAR(centre.winding, 5.0 / 6, 1e-12);
    EXPECT_EQ(cube.at({5, 5, 5}).answer, Answer::no);

    // A band of one side.
    TestMesh band;
    constexpr std::uint32_t kSteps = 12;
    for (std::uint32_t i = 0; i < kSteps; ++i) {
        const double u = 2 * 3.141592653589793 * i / kSteps;
        for (const double w : {-0.25, 0.25}) {
            const double r = 1 + w * std::cos(u / 2);
            band.positions.push_back({r * std::cos(u), r * std::sin(u), w * std::sin(u / 2)});
        }
    }
    for (std::uint32_t i = 0; i < kSteps; ++i) {
        const bool turns = i + 1 == kSteps;
        const std::uint32_t a = 2 * i, b = a + 1;
        const std::uint32_t c = turns ? 1 : a + 2, d = turns ? 0 : a + 3;
        band.triangles.push_back({{a, b, d}});
        band.triangles.push_back({{a, d, c}});
    }
    EXPECT_EQ(Asked(band).at({0, 0, 0}).answer, Answer::unknown);
    EXPECT_EQ(Asked(random_soup(5, 40, 1)).at({0, 0, 0}).answer, Answer::unknown);
}

TEST(IncludesThrough, NothingIsInsideAnEmptyModel) {
    EXPECT_EQ(Asked(TestMesh{}).at({0, 0, 0}).answer, Answer::no);
}

/// (x, y, z) with the axes renamed `turn` times.
Double3 turned(const Double3& p, int turn) {
    if (turn == 0) return p;
    return turned({p.z, p.x, p.y}, turn - 1);
}

// Flat and closed: a sheet whose two sides are triangles of their own encloses nothing,
// but holds points. Structures leave such an axis whole, whichever it is.
TEST(IncludesThrough, AFlatModelHoldsItsPointsAlone) {
    for (const int turn : {0, 1, 2}) {
        TestMesh sheet = grid_sheet(4, 4);
        const TestMesh back = reversed(sheet);
        sheet.triangles.insert(sheet.triangles.end(), back.triangles.begin(), back.triangles.end());
        for (Double3& p : sheet.positions) p = turned(p, turn);
        for (const std::uint32_t level : {0U, 2U, 5U}) {
            Asked flat(sheet, {.level = level});
            ASSERT_TRUE(flat.model().is_balanced());
            EXPECT_TRUE(flat.at(turned({1, 1, 0}, turn)).on_surface);
            EXPECT_TRUE(flat.at(turned({4, 0.25, 0}, turn)).on_surface);
            EXPECT_TRUE(flat.at(flat.model().tetra_tree().tree->centre).on_surface);
            EXPECT_EQ(flat.at(turned({1, 1, 0.5}, turn)).answer, Answer::no);
            EXPECT_EQ(flat.at(turned({4.5, 3, 0}, turn)).answer, Answer::no);
            EXPECT_EQ(flat.at(turned({-1, 0, 0}, turn)).answer, Answer::no);
        }
    }
}

TEST(IncludesThrough, AnyFinitePointIsAnswered) {
    Asked cube(cube_at(-2, 2), {.level = 4});
    constexpr double kLargest = std::numeric_limits<double>::max();
    constexpr double kLeast = std::numeric_limits<double>::denorm_min();
    for (const double x : {kLargest, -kLargest, kLeast, -kLeast, 0x1p1000, 0.0, -0.0}) {
        EXPECT_EQ(cube.at({x, 0, 0}).answer, std::fabs(x) < 2 ? Answer::yes : Answer::no);
        EXPECT_EQ(cube.at({x, x, -x}).answer, std::fabs(x) < 2 ? Answer::yes : Answer::no);
        EXPECT_EQ(cube.at({1, x, kLeast}).answer, std::fabs(x) < 2 ? Answer::yes : Answer::no);
        EXPECT_EQ(cube.at({x, 2, 1}).on_surface, std::fabs(x) < 2);
    }
}

// By symmetry: of a ball's triangles one cone of 512 holds a few, and so do the cells
// along a ray; each structure is indeed what answers.
TEST(IncludesThrough, LooksAtOneConeOrOneRowOfCells) {
    Asked ball(icosphere(4), {.level = 3, .threshold = 16});  // 5,120 triangles
    const Double3 q{0.1, 0.2, 0.3};
    EXPECT_EQ(ball.at(q).winding, 1);
    EXPECT_LT(ball.triangles_for(Structure::tetra_tree, q), 60U);
    EXPECT_GE(ball.triangles_for(Structure::tetra_tree, q), 5'120U / 512);
    for (const Structure structure :
         {Structure::octree, Structure::adaptive_octree, Structure::hashed_octree}) {
        EXPECT_GT(ball.triangles_for(structure, q), 5U) << name_of(structure);
        EXPECT_LT(ball.triangles_for(structure, q), 400U) << name_of(structure);
    }
    EXPECT_EQ(ball.triangles_for(Structure::octree, q),
              ball.triangles_for(Structure::hashed_octree, q));
    EXPECT_NE(ball.triangles_for(Structure::octree, q), ball.triangles_for(Structure::bvh, q));
    // Beyond all that the cone holds, and beside the cube.
    EXPECT_EQ(ball.triangles_for(Structure::tetra_tree, {0.7, 0.7, 0.7}), 0U);
    EXPECT_EQ(ball.triangles_for(Structure::octree, {0.7, 3, 0.7}), 0U);
}

// By the table of needs: a file without a structure does not serve questions through it.
TEST(IncludesThroughDeathTest, StopsWhereAModelWasNotBakedForIt) {
    int asked = 0;
    const OpenModel cube = open_tiny(cube_at(-2, 2), {.double_precision = true});
    Workspace workspace(cells());
    for (const Structure structure : kStructures) {
        if (structure == Structure::bvh) continue;
        ++asked;
        EXPECT_DEATH((void)points_inside(cube.model, {1, 0, 0}, workspace, structure),
                     " needs section");
    }
    EXPECT_EQ(asked, static_cast<int>(kStructures.size()) - 1);
}

}  // namespace
}  // namespace cdprep::test
