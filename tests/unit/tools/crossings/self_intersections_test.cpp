// SPDX-License-Identifier: GPL-3.0-or-later
#include "crossings/self_intersections.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>

#include "mesh/weld.h"
#include "unit/tools/soup_of.h"

namespace cdprep::mesh {
namespace {

using Meetings = std::vector<TriangleMeeting>;

/// A mesh of these corners, equal ones made one vertex.
Mesh mesh_of(std::vector<std::array<Double3, 3>> triangles) {
    TriangleSoup soup;
    for (const auto& corners : triangles) {
        const auto first = static_cast<std::uint32_t>(soup.positions.size());
        soup.positions.insert(soup.positions.end(), corners.begin(), corners.end());
        soup.triangles.push_back({{first, first + 1, first + 2}});
    }
    return weld(soup).mesh;
}

/// How the second triangle meets the first, which is (0, 0), (4, 0), (0, 4) at height 0.
/// Whatever the order, the winding and the corner that each begins with.
std::optional<Meeting> meets(const std::array<Double3, 3>& other) {
    const std::array<Double3, 3> base = {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};
    std::optional<Meeting> answer;
    for (unsigned turn = 0; turn < 72; ++turn) {
        const auto turned = [](const std::array<Double3, 3>& t, unsigned how) {
            const bool flip = how >= 3;
            const auto at = [&](unsigned i) { return t[(how + (flip ? 3 - i : i)) % 3]; };
            return std::array{at(0), at(1), at(2)};
        };
        auto first = turned(base, turn % 6);
        auto second = turned(other, turn / 6 % 6);
        if (turn >= 36) std::swap(first, second);
        const Meetings found = find_self_intersections(mesh_of({first, second}));
        EXPECT_LE(found.size(), 1u);
        const auto meeting = found.empty() ? std::nullopt : std::optional(found[0].meeting);
        if (meeting) {
            EXPECT_EQ(found[0].a, 0u);
            EXPECT_EQ(found[0].b, 1u);
        }
        if (turn == 0) answer = meeting;
        EXPECT_EQ(meeting, answer) << turn;
    }
    return answer;
}

TEST(SelfIntersections, TrianglesApartDoNotMeet) {
    EXPECT_EQ(meets({{{1, 1, 1}, {2, 1, 1}, {1, 2, 1}}}), std::nullopt);
    EXPECT_EQ(meets({{{5, 5, 0}, {6, 5, 0}, {5, 6, 0}}}), std::nullopt);
    EXPECT_EQ(meets({{{5, 5, -1}, {6, 5, 1}, {5, 6, 1}}}), std::nullopt);
}

TEST(SelfIntersections, AnEdgeThroughTheInsideIsACrossing) {
    EXPECT_EQ(meets({{{1, 1, -1}, {1, 1, 1}, {9, 9, 0.5}}}), Meeting::crossing);
    EXPECT_EQ(meets({{{1, 1, -1}, {1, 2, -1}, {1, 1, 1}}}), Meeting::crossing);
    EXPECT_EQ(meets({{{-1, 1, -1}, {-1, 1, 1}, {9, 1, 0}}}), Meeting::crossing);
}

// In the plane y = 1 the first spans x from 0 to 3 at height 0; the other as much or more.
TEST(SelfIntersections, InsidesThatCrossOnlyBetweenEdgesAreAnEdgeCrossing) {
    EXPECT_EQ(meets({{{-1, 1, -1}, {1, 1, 1}, {7, 1, 1}}}), Meeting::edge_crossing);
    EXPECT_EQ(meets({{{-1, 1, -1}, {1, 1, 1}, {8, 1, 1}}}), Meeting::crossing);
    EXPECT_EQ(meets({{{-1, 1, -1}, {1, 1, 1}, {5, 1, 1}}}), Meeting::crossing);
    EXPECT_EQ(meets({{{0, 1, -1}, {0, 1, 1}, {3, 1, 0}}}), Meeting::edge_crossing);
    EXPECT_EQ(meets({{{0, 0, -1}, {0, 0, 1}, {2, 2, 0}}}), Meeting::edge_crossing);
    EXPECT_EQ(meets({{{-1, -1, -2}, {-1, -1, 2}, {3, 3, 0}}}), Meeting::crossing);
}

TEST(SelfIntersections, PointsAndEdgesTouch) {
    EXPECT_EQ(meets({{{1, 1, 0}, {1, 1, 2}, {2, 2, 2}}}), Meeting::touching);      // in the inside
    EXPECT_EQ(meets({{{2, 0, 0}, {2, 0, 2}, {2, -1, 2}}}), Meeting::touching);     // on an edge
    EXPECT_EQ(meets({{{-1, -1, 2}, {1, 1, -2}, {5, -5, 0}}}), Meeting::touching);  // a corner
    EXPECT_EQ(meets({{{1, 0, 0}, {3, 0, 0}, {2, 0, 2}}}), Meeting::touching);      // edge on edge
    EXPECT_EQ(meets({{{1, 1, 0}, {2, 1, 0}, {1, 1, 2}}}), Meeting::touching);      // edge inside
    EXPECT_EQ(meets({{{2, -1, -1}, {2, 1, 1}, {2, -1, 1}}}), Meeting::touching);   // edges cross
}

TEST(SelfIntersections, InOnePlaneTheyTouchOrShareArea) {
    EXPECT_EQ(meets({{{2, 0, 0}, {3, -1, 0}, {1, -1, 0}}}), Meeting::flat_touching);
    EXPECT_EQ(meets({{{1, 0, 0}, {3, 0, 0}, {2, -1, 0}}}), Meeting::flat_touching);
    EXPECT_EQ(meets({{{1, 1, 0}, {2, 1, 0}, {1, 2, 0}}}), Meeting::coplanar_overlap);
    EXPECT_EQ(meets({{{1, 1, 0}, {5, 1, 0}, {5, 2, 0}}}), Meeting::coplanar_overlap);
    EXPECT_EQ(meets({{{-9, -9, 0}, {19, -9, 0}, {-9, 19, 0}}}), Meeting::coplanar_overlap);
}

TEST(SelfIntersections, WithOneCommonCornerAnythingMoreIsNamed) {
    EXPECT_EQ(meets({{{0, 0, 0}, {-1, 0, 1}, {0, -1, 1}}}), std::nullopt);
    EXPECT_EQ(meets({{{0, 0, 0}, {-2, -1, 1}, {-1, -2, -1}}}), std::nullopt);  // the other way
    EXPECT_EQ(meets({{{0, 0, 0}, {1, 1, 1}, {1, 1, -1}}}), Meeting::corner_crossing);
    EXPECT_EQ(meets({{{0, 0, 0}, {9, 9, 1}, {9, 9, -1}}}), Meeting::corner_crossing);
    EXPECT_EQ(meets({{{0, 0, 0}, {1, 1, 0}, {1, 1, 1}}}),
              Meeting::corner_crossing);  // a corner on it
    EXPECT_EQ(meets({{{0, 0, 0}, {2, 0, 0}, {1, 0, 1}}}),
              Meeting::corner_crossing);                                    // along an edge
    EXPECT_EQ(meets({{{0, 0, 0}, {-2, 0, 0}, {-1, 0, 1}}}), std::nullopt);  // straight on
    EXPECT_EQ(meets({{{0, 0, 0}, {-1, 0, 0}, {0, -1, 0}}}), std::nullopt);  // in the plane
    EXPECT_EQ(meets({{{0, 0, 0}, {2, 0, 0}, {1, -1, 0}}}), Meeting::edge_overlap);
    EXPECT_EQ(meets({{{0, 0, 0}, {8, 0, 0}, {1, -1, 0}}}), Meeting::edge_overlap);
    EXPECT_EQ(meets({{{0, 0, 0}, {3, 1, 0}, {1, 3, 0}}}), Meeting::fold);
    EXPECT_EQ(meets({{{0, 0, 0}, {3, 0, 0}, {1, 1, 0}}}), Meeting::fold);
}

TEST(SelfIntersections, WithACommonEdgeOnlyAFoldIsNamed) {
    EXPECT_EQ(meets({{{0, 0, 0}, {4, 0, 0}, {2, 2, 1}}}), std::nullopt);
    EXPECT_EQ(meets({{{0, 0, 0}, {4, 0, 0}, {2, -2, 0}}}), std::nullopt);
    EXPECT_EQ(meets({{{0, 0, 0}, {4, 0, 0}, {1, 1, 0}}}), Meeting::fold);
    EXPECT_EQ(meets({{{0, 0, 0}, {4, 0, 0}, {9, 9, 0}}}), Meeting::fold);
    EXPECT_EQ(meets({{{0, 0, 0}, {4, 0, 0}, {1, 0x1p-500, 0x1p-1000}}}), std::nullopt);
}

TEST(SelfIntersections, TheSameCornersAreADuplicateInEitherWinding) {
    EXPECT_EQ(meets({{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}}), Meeting::duplicate);
}

TEST(SelfIntersections, TrianglesWithoutAreaAreInNone) {
    EXPECT_EQ(meets({{{1, 1, -1}, {1, 1, 0}, {1, 1, 1}}}), std::nullopt);
    EXPECT_EQ(meets({{{1, 1, 0}, {1, 1, 0}, {2, 2, 0}}}), std::nullopt);
    EXPECT_EQ(meets({{{0, 0, 0}, {4, 0, 0}, {2, 0, 0}}}), std::nullopt);
    EXPECT_EQ(meets({{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}}), std::nullopt);
}

// Each of three copies with each of the two others.
TEST(SelfIntersections, EveryTwoTrianglesAtAnEdgeAreAsked) {
    const std::array<Double3, 3> t = {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};
    const Mesh copies = mesh_of({t, {t[1], t[0], t[2]}, t, {{t[0], t[1], {1, 1, 0}}}});
    EXPECT_EQ(find_self_intersections(copies), (Meetings{{0, 1, Meeting::duplicate},
                                                         {0, 2, Meeting::duplicate},
                                                         {0, 3, Meeting::fold},
                                                         {1, 2, Meeting::duplicate},
                                                         {1, 3, Meeting::fold},
                                                         {2, 3, Meeting::fold}}));
}

// A spiral stair about one vertex, 25 steps a turn: steps lie side by side with their
// neighbours alone, and beyond one turn each lies over others, touching in the vertex.
TEST(SelfIntersections, AStarThatTurnsMoreThanOnceMeetsNowhereElse) {
    for (const int steps : {5, 30, 200}) {
        std::vector<std::array<Double3, 3>> triangles;
        const auto spoke = [&](int i) {
            return Double3{std::cos(0.25 * i), std::sin(0.25 * i), 0.01 * i};
        };
        for (int i = 0; i < steps; ++i)
            triangles.push_back({Double3{0, 0, 0}, spoke(i), spoke(i + 1)});
        EXPECT_TRUE(find_self_intersections(mesh_of(triangles)).empty()) << steps;
    }
}

// In one plane the 13 steps of two turns overlap where their sectors do: 1 radian each.
TEST(SelfIntersections, AFlatStarThatTurnsTwiceIsFoldedOverItself) {
    std::vector<std::array<Double3, 3>> triangles;
    const auto spoke = [&](int i) { return Double3{std::cos(1.0 * i), std::sin(1.0 * i), 0}; };
    for (int i = 0; i < 13; ++i) triangles.push_back({Double3{0, 0, 0}, spoke(i), spoke(i + 1)});
    std::size_t expected = 0;
    for (int i = 0; i < 13; ++i) {
        for (int j = i + 1; j < 13; ++j) {
            const double apart = std::fmod(j - i, 2 * std::acos(-1.0));
            expected += apart < 1 - 1e-9 || apart > 2 * std::acos(-1.0) - 1 + 1e-9 ? 1 : 0;
        }
    }
    const Meetings found = find_self_intersections(mesh_of(triangles));
    EXPECT_EQ(found.size(), expected);
    EXPECT_GT(expected, 10u);
    for (const TriangleMeeting& meeting : found) EXPECT_EQ(meeting.meeting, Meeting::fold);
}

// Fans of every size, open and closed, flat and as a cone, in one order or another; of
// those that close, one more triangle between two spokes lies over what is there.
TEST(SelfIntersections, FansOfAnySizeLieSideBySide) {
    std::mt19937 random(5);
    for (const int count : {3, 4, 7, 8, 9, 16, 17, 64, 65, 2000}) {
        for (const double height : {0.0, 0.7}) {
            std::vector<std::array<Double3, 3>> triangles;
            const double step = 2 * std::acos(-1.0) / count;
            const auto spoke = [&](int i) {
                return Double3{std::cos(step * (i % count)), std::sin(step * (i % count)), height};
            };
            for (int i = 0; i < count; ++i) {
                triangles.push_back({Double3{0, 0, 0}, spoke(i), spoke(i + 1)});
                std::rotate(triangles.back().begin(), triangles.back().begin() + random() % 3,
                            triangles.back().end());
            }
            std::shuffle(triangles.begin(), triangles.end(), random);
            EXPECT_TRUE(find_self_intersections(mesh_of(triangles)).empty()) << count;
            const auto last = triangles.back();
            triangles.pop_back();
            EXPECT_TRUE(find_self_intersections(mesh_of(triangles)).empty()) << count;
            triangles.push_back(last);
            triangles.push_back({last[0], last[2], last[1]});
            EXPECT_EQ(find_self_intersections(mesh_of(triangles)).size(), 1u) << count;
        }
    }
}

TEST(SelfIntersections, AnEmptyMeshHasNone) {
    EXPECT_TRUE(find_self_intersections({}).empty());
}

TEST(SelfIntersections, AClosedConvexSurfaceHasNone) {
    for (const test::TestMesh& mesh : {test::unit_cube(), test::icosphere(4),
                                       test::grid_sheet(9, 7), test::torus(3, 1, 40, 20)}) {
        EXPECT_TRUE(find_self_intersections(test::welded(mesh)).empty());
    }
}

}  // namespace
}  // namespace cdprep::mesh
