// SPDX-License-Identifier: MIT
#include "cdprep/hulls.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "cdprep/advanced/find_falsehood.h"
#include "cdprep/cells/find_list_damage.h"
#include "cdprep/format/find_damage.h"
#include "support/more_sections.h"
#include "support/open_tiny.h"

namespace cdprep::test {
namespace {

using format::HullScope;

AlignedBytes baked(const TestMesh& mesh) {
    return bake_tiny(mesh.positions, mesh.triangles, {.double_precision = true});
}

OpenModel with_hulls_of(const TestMesh& mesh) {
    return open_tiny(with_hulls(baked(mesh)));
}

// By hand: the file has the hull of the whole and of component 0, and no others.
TEST(FindHull, AnswersByScopeAndNumber) {
    const OpenModel ball = with_hulls_of(icosphere(2));
    ASSERT_EQ(ball.model.hulls().hulls.size(), 2U);
    EXPECT_EQ(find_hull(ball.model, HullScope::whole), 0U);
    EXPECT_EQ(find_hull(ball.model, HullScope::component, 0), 1U);
    EXPECT_FALSE(find_hull(ball.model, HullScope::whole, 1));
    EXPECT_FALSE(find_hull(ball.model, HullScope::component, 1));
    EXPECT_FALSE(find_hull(ball.model, HullScope::instance, 0));
}

// By the table of needs: a file without hulls does not serve Ask::hulls.
TEST(FindHullDeathTest, StopsWhereAModelWasNotBakedForIt) {
    const OpenModel bare = open_tiny(icosphere(2));
    EXPECT_DEATH((void)find_hull(bare.model, HullScope::whole), "hull needs");
}

// A ball's vertices are all corners of its hull, in any order.
TEST(ConvexPoints, AreThoseOfTheFile) {
    const TestMesh mesh = icosphere(2);
    const OpenModel ball = with_hulls_of(mesh);
    for (std::uint32_t hull = 0; hull < 2; ++hull) {
        const ConvexPoints points = convex_points(ball.model, hull);
        ASSERT_EQ(points.count, mesh.positions.size());
        ASSERT_EQ(points.neighbour_begins.size(), points.count + std::size_t{1});
        EXPECT_EQ(points.neighbours.size(), points.neighbour_begins[points.count]);
        EXPECT_EQ(points.starts.size(), std::size_t{kDirectionStarts});
        std::vector<std::array<double, 3>> expected, found;
        for (std::uint32_t i = 0; i < points.count; ++i) {
            const Double3 p = points.point(i);
            found.push_back({p.x, p.y, p.z});
        }
        for (const Double3& p : builder_input(ball.model).positions) {
            expected.push_back({p.x, p.y, p.z});
        }
        std::sort(found.begin(), found.end());
        std::sort(expected.begin(), expected.end());
        EXPECT_EQ(found, expected);
    }
}

TEST(ConvexPoints, OfNothingAreNone) {
    const OpenModel nothing = with_hulls_of({});
    EXPECT_EQ(
        convex_points(nothing.model, find_hull(nothing.model, HullScope::whole).value()).count, 0U);
}

// What tests are fed is what the baker would make: nothing false is found in it.
TEST(TinyBaker, MakesHullsAndPiecesThatAreTrue) {
    for (const TestMesh& mesh : {TestMesh{}, unit_cube(), icosphere(1), icosphere(2),
                                 coarse_grid_soup(1, 40, 2), copies_of_one_triangle(20)}) {
        const AlignedBytes file = baked(mesh);
        for (const AlignedBytes& more : {with_hulls(file), with_pieces(with_hulls(file))}) {
            EXPECT_FALSE(format::find_deep_damage(more.span()));
            const OpenModel open = open_tiny(AlignedBytes(more.span()));
            EXPECT_FALSE(find_list_damage(more.span(), open.model));
            EXPECT_FALSE(find_hull_falsehood(more.span(), open.model));
        }
    }
    for (const TestMesh& mesh : {unit_cube(), icosphere(2)}) {
        const AlignedBytes file = with_one_piece(baked(mesh));
        EXPECT_FALSE(format::find_deep_damage(file.span()));
        EXPECT_EQ(open_tiny(AlignedBytes(file.span())).model.pieces().pieces.size(), 1U);
    }
}

// By the headers: numbers end at the count, in every build.
TEST(ConvexPointsDeathTest, ANumberBeyondTheLastStopsTheProgram) {
    const OpenModel ball = with_hulls_of(icosphere(1));
    const auto count = static_cast<std::uint32_t>(ball.model.hulls().hulls.size());
    EXPECT_GT(convex_points(ball.model, count - 1).count, 0u);
    EXPECT_DEATH((void)convex_points(ball.model, count), "no hull with this number");
}

}  // namespace
}  // namespace cdprep::test
