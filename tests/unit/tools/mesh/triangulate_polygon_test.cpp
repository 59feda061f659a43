// SPDX-License-Identifier: MIT
#include "mesh/triangulate_polygon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <utility>
#include <vector>

namespace cdprep::mesh {
namespace {

using Corners = std::array<std::uint32_t, 3>;
using Grid = std::vector<std::array<long, 2>>;  // an outline on whole numbers

struct Cut {
    PolygonCut how;
    std::vector<Corners> triangles;
};

Cut cut(const std::vector<Double3>& outline) {
    Cut result{};
    result.how = triangulate_polygon(outline, result.triangles);
    return result;
}

std::vector<Double3> in_plane_z(const Grid& grid) {
    std::vector<Double3> outline;
    for (const auto& p : grid) {
        outline.push_back({static_cast<double>(p[0]), static_cast<double>(p[1]), 0});
    }
    return outline;
}

long twice_area(const std::array<long, 2>& a, const std::array<long, 2>& b,
                const std::array<long, 2>& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// Every side of the polygon is a side of one triangle, and every cut of two, in
/// opposite directions. If moreover no triangle turns right, the triangles cover
/// each point as often as the polygon goes round it.
void expect_cover(const Grid& grid, const std::vector<Corners>& triangles) {
    const auto n = static_cast<std::uint32_t>(grid.size());
    ASSERT_EQ(triangles.size(), n - 2);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
    for (const Corners& t : triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            ++uses[{t[i], t[(i + 1) % 3]}];
            --uses[{t[(i + 1) % 3], t[i]}];
        }
        EXPECT_GE(twice_area(grid[t[0]], grid[t[1]], grid[t[2]]), 0)
            << t[0] << ' ' << t[1] << ' ' << t[2];
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        --uses[{i, (i + 1) % n}];
        ++uses[{(i + 1) % n, i}];
    }
    for (const auto& [edge, count] : uses) EXPECT_EQ(count, 0) << edge.first << ' ' << edge.second;
}

int count_flat(const Grid& grid, const std::vector<Corners>& triangles) {
    return static_cast<int>(std::count_if(
        triangles.begin(), triangles.end(),
        [&](const Corners& t) { return twice_area(grid[t[0]], grid[t[1]], grid[t[2]]) == 0; }));
}

void expect_ears(const Grid& grid) {
    const Cut result = cut(in_plane_z(grid));
    EXPECT_NE(result.how, PolygonCut::forced);
    expect_cover(grid, result.triangles);
}

TEST(TriangulatePolygon, FewerThanThreeCornersGiveNothing) {
    EXPECT_TRUE(cut({}).triangles.empty());
    EXPECT_TRUE(cut({{0, 0, 0}}).triangles.empty());
    EXPECT_TRUE(cut({{0, 0, 0}, {1, 0, 0}}).triangles.empty());
}

TEST(TriangulatePolygon, AConvexOutlineIsAFanAroundItsFirstCorner) {
    const Cut square = cut({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    EXPECT_EQ(square.how, PolygonCut::convex);
    EXPECT_EQ(square.triangles, (std::vector<Corners>{{0, 1, 2}, {0, 2, 3}}));
    std::vector<Double3> circle;
    for (int i = 0; i < 100'000; ++i) {
        const double angle = 6.283185307179586 * i / 100'000;
        circle.push_back({std::cos(angle), 3, std::sin(angle)});
    }
    const Cut fan = cut(circle);
    EXPECT_EQ(fan.how, PolygonCut::convex);
    EXPECT_EQ(fan.triangles.size(), circle.size() - 2);
}

// An arrow head: the corner that points inwards must end the cut.
TEST(TriangulatePolygon, AConcaveQuadIsCutAtItsReflexCornerWhereverItStarts) {
    const std::vector<Double3> arrow = {{0, 0, 0}, {2, 1, 0}, {0, 2, 0}, {1, 1, 0}};
    for (std::size_t turn = 0; turn < 4; ++turn) {
        std::vector<Double3> outline = arrow;
        std::rotate(outline.begin(), outline.begin() + static_cast<long>(turn), outline.end());
        const auto reflex = static_cast<std::uint32_t>((3 + 4 - turn) % 4);
        const Cut result = cut(outline);
        EXPECT_EQ(result.how, PolygonCut::ears);
        ASSERT_EQ(result.triangles.size(), 2u);
        for (const Corners& t : result.triangles) {
            EXPECT_NE(std::find(t.begin(), t.end(), reflex), t.end());
        }
    }
}

// The same outline in every coordinate plane and both directions.
TEST(TriangulatePolygon, TurnsTrianglesLikeThePolygonInEveryPlane) {
    const Grid comb = {{0, 0}, {6, 0}, {6, 5}, {5, 1}, {4, 5}, {3, 1}, {2, 5}, {1, 1}, {0, 5}};
    for (int axis = 0; axis < 3; ++axis) {
        for (const bool reversed : {false, true}) {
            std::vector<Double3> outline;
            for (const auto& p : comb) {
                const auto u = static_cast<double>(p[0]);
                const auto v = static_cast<double>(p[1]);
                outline.push_back(axis == 0   ? Double3{7, u, v}
                                  : axis == 1 ? Double3{v, 7, u}
                                              : Double3{u, v, 7});
            }
            if (reversed) std::reverse(outline.begin(), outline.end());
            Cut result = cut(outline);
            EXPECT_EQ(result.how, PolygonCut::ears);
            Grid grid = comb;
            if (reversed) {
                std::reverse(grid.begin(), grid.end());
                for (auto& p : grid) p[0] = -p[0];  // seen from behind
            }
            expect_cover(grid, result.triangles);
        }
    }
}

TEST(TriangulatePolygon, StraightCornersGiveNoFlatTriangles) {
    const Grid square = {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
    expect_ears(square);
    EXPECT_EQ(count_flat(square, cut(in_plane_z(square)).triangles), 0);
    const Grid triangle = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {0, 3}};
    expect_ears(triangle);
    EXPECT_EQ(count_flat(triangle, cut(in_plane_z(triangle)).triangles), 0);
}

// A square with a square hole, joined by a bridge that is walked both ways.
TEST(TriangulatePolygon, AHoleOnABridgeStaysEmpty) {
    const Grid keyhole = {{0, 0}, {6, 0}, {6, 6}, {0, 6}, {0, 0},
                          {2, 2}, {2, 4}, {4, 4}, {4, 2}, {2, 2}};
    for (std::size_t turn = 0; turn < keyhole.size(); ++turn) {
        Grid outline = keyhole;
        std::rotate(outline.begin(), outline.begin() + static_cast<long>(turn), outline.end());
        expect_ears(outline);
        EXPECT_EQ(count_flat(outline, cut(in_plane_z(outline)).triangles), 0);
    }
}

TEST(TriangulatePolygon, SpikesAndRepeatedCornersAddOnlyFlatTriangles) {
    // Outwards, inwards, along a side, and doubled corners.
    expect_ears({{0, 0}, {4, 0}, {4, 4}, {7, 7}, {4, 4}, {0, 4}});
    expect_ears({{0, 0}, {4, 0}, {4, 4}, {2, 2}, {4, 4}, {0, 4}});
    expect_ears({{0, 0}, {4, 0}, {6, 0}, {4, 0}, {4, 4}, {0, 4}});
    expect_ears({{0, 0}, {4, 0}, {2, 0}, {4, 0}, {4, 4}, {0, 4}});
    expect_ears({{0, 0}, {0, 0}, {4, 0}, {4, 4}, {4, 4}, {4, 4}, {0, 4}});
    const Grid doubled = {{0, 0}, {0, 0}, {4, 0}, {4, 4}, {4, 4}, {4, 4}, {0, 4}};
    EXPECT_EQ(count_flat(doubled, cut(in_plane_z(doubled)).triangles), 3);
}

// Two squares that share a corner, walked as one outline; and a ring that touches
// itself in a corner.
TEST(TriangulatePolygon, PartsThatTouchInACornerAreBothCovered) {
    expect_ears({{0, 0}, {2, 0}, {2, 2}, {4, 2}, {4, 4}, {2, 4}, {2, 2}, {0, 2}});
    expect_ears({{0, 0}, {6, 0}, {6, 6}, {0, 6}, {0, 0}, {2, 4}, {4, 4}, {4, 2}});
}

TEST(TriangulatePolygon, OutlinesWithoutAreaOrWithCrossingsAreForcedButComplete) {
    const Cut line = cut({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}, {5, 5, 5}});
    EXPECT_EQ(line.triangles.size(), 3u);
    const Cut point = cut({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}});
    EXPECT_EQ(point.triangles.size(), 2u);
    const Cut bow = cut({{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 3, 0}});
    EXPECT_EQ(bow.triangles.size(), 2u);
    EXPECT_EQ(bow.how, PolygonCut::forced);
    const Cut star = cut({{0, 3, 0}, {2, -3, 0}, {-3, 1, 0}, {3, 1, 0}, {-2, -3, 0}});
    EXPECT_EQ(star.triangles.size(), 3u);
    EXPECT_EQ(star.how, PolygonCut::forced);
}

TEST(TriangulatePolygon, ScaleDoesNotMatter) {
    const Grid comb = {{0, 0}, {6, 0}, {6, 5}, {5, 1}, {4, 5}, {3, 1}, {2, 5}, {1, 1}, {0, 5}};
    const std::vector<Corners> expected = cut(in_plane_z(comb)).triangles;
    for (const int exponent : {-1060, -300, 300, 997}) {
        std::vector<Double3> outline = in_plane_z(comb);
        for (Double3& p : outline) {
            p = {std::scalbn(p.x, exponent), std::scalbn(p.y, exponent), 0};
        }
        EXPECT_EQ(cut(outline).triangles, expected) << exponent;
    }
}

/// A comb of `corners` corners, and two more.
Grid comb_of(long corners) {
    Grid comb = {{-1, -2}, {corners, -2}};
    for (long i = corners; i-- > 0;) comb.push_back({i, i % 2 ? 1 : 10 + 2 * (i % 7)});
    return comb;
}

// Quadratic time would need more steps than are allowed.
TEST(TriangulatePolygon, AConcaveOutlineOfAHundredThousandCornersIsCut) {
    expect_ears(comb_of(100'000));
    Grid doubled;
    for (const auto& p : comb_of(50'000)) doubled.insert(doubled.end(), {p, p});
    expect_ears(doubled);
}

/// A slot along an S: two half rings of radius 1 to 3 with fine inner and coarse outer walls.
std::vector<Double3> s_slot(int fine) {
    constexpr double kPi = 3.14159265358979323846;
    std::vector<Double3> slot;
    const auto add_arc = [&](double centre, double radius, double from, double to, int count) {
        for (int i = 0; i < count; ++i) {
            const double angle = from + (to - from) * i / count;
            slot.push_back({centre + radius * std::cos(angle), radius * std::sin(angle), 0});
        }
    };
    add_arc(0, 1, kPi, 0, fine);
    add_arc(4, 3, kPi, 2 * kPi, 6);
    slot.push_back({7, 0, 0});
    add_arc(4, 1, 2 * kPi, kPi, fine);
    add_arc(0, 3, 0, kPi, 6);
    slot.push_back({-3, 0, 0});
    return slot;
}

// In one of the directions, each ear is the corner before the last one.
TEST(TriangulatePolygon, EarsMayAppearInEitherDirection) {
    std::vector<Double3> slot = s_slot(2000);
    for (int direction = 0; direction < 2; ++direction) {
        std::vector<Corners> triangles;
        EXPECT_EQ(triangulate_polygon(slot, triangles, 150 * slot.size()), PolygonCut::ears);
        EXPECT_EQ(triangles.size(), slot.size() - 2);
        std::reverse(slot.begin(), slot.end());
    }
}

// Past the limit of steps the rest is a fan: hostile polygons end in time.
TEST(TriangulatePolygon, AnOutlineThatTakesTooManyStepsIsUnfinished) {
    const std::vector<Double3> comb = in_plane_z(comb_of(1000));
    for (const std::uint64_t max_steps : {0U, 1000U, 26'000U}) {
        std::vector<Corners> triangles;
        EXPECT_EQ(triangulate_polygon(comb, triangles, max_steps), PolygonCut::unfinished);
        EXPECT_EQ(triangles.size(), comb.size() - 2) << max_steps;
    }
    std::vector<Corners> triangles;
    EXPECT_EQ(triangulate_polygon(comb, triangles, 1'000'000), PolygonCut::ears);
    triangles.clear();
    const std::vector<Double3> square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    EXPECT_EQ(triangulate_polygon(square, triangles, 0), PolygonCut::convex);
}

bool segments_meet(const Grid& g, std::size_t i, std::size_t j) {
    const auto& a = g[i];
    const auto& b = g[(i + 1) % g.size()];
    const auto& c = g[j];
    const auto& d = g[(j + 1) % g.size()];
    const auto sign = [](long x) { return (x > 0) - (x < 0); };
    const auto on = [&](const auto& p, const auto& q, const auto& r) {
        return twice_area(p, q, r) == 0 && std::min(p[0], q[0]) <= r[0] &&
               r[0] <= std::max(p[0], q[0]) && std::min(p[1], q[1]) <= r[1] &&
               r[1] <= std::max(p[1], q[1]);
    };
    if (sign(twice_area(a, b, c)) * sign(twice_area(a, b, d)) < 0 &&
        sign(twice_area(c, d, a)) * sign(twice_area(c, d, b)) < 0) {
        return true;
    }
    return on(a, b, c) || on(a, b, d) || on(c, d, a) || on(c, d, b);
}

/// Straightens crossings out; false when some contact stays.
bool untangle(Grid& grid) {
    const std::size_t n = grid.size();
    for (int round = 0; round < 200; ++round) {
        bool found = false;
        for (std::size_t i = 0; i < n && !found; ++i) {
            for (std::size_t j = i + 2; j < n && !found; ++j) {
                if ((j + 1) % n == i || !segments_meet(grid, i, j)) continue;
                std::reverse(grid.begin() + static_cast<long>(i) + 1,
                             grid.begin() + static_cast<long>(j) + 1);
                found = true;
            }
        }
        if (!found) break;
        if (round == 199) return false;
    }
    for (std::size_t i = 0; i < n; ++i) {  // no spikes, no repeated corners
        const auto& a = grid[i];
        const auto& b = grid[(i + 1) % n];
        const auto& c = grid[(i + 2) % n];
        const long forward = (b[0] - a[0]) * (c[0] - b[0]) + (b[1] - a[1]) * (c[1] - b[1]);
        if (a == b || (twice_area(a, b, c) == 0 && forward < 0)) return false;
    }
    long area = 0;
    for (std::size_t i = 1; i + 1 < n; ++i) area += twice_area(grid[0], grid[i], grid[i + 1]);
    if (area < 0) std::reverse(grid.begin(), grid.end());
    return area != 0;
}

TEST(TriangulatePolygon, CoversRandomSimplePolygonsOnACoarseGrid) {
    constexpr unsigned kSeed = 314;
    SCOPED_TRACE(kSeed);
    std::mt19937 random(kSeed);
    int concave = 0;
    int straight = 0;
    int tried = 0;
    for (int round = 0; round < 20'000 && !HasFailure(); ++round) {
        const long size = 2 + static_cast<long>(random() % 12);
        Grid grid;
        const std::size_t n = 4 + random() % 12;
        for (std::size_t i = 0; i < n; ++i) {
            grid.push_back(
                {static_cast<long>(random()) % size, static_cast<long>(random()) % size});
        }
        if (!untangle(grid)) continue;
        ++tried;
        const Cut result = cut(in_plane_z(grid));
        EXPECT_NE(result.how, PolygonCut::forced);
        expect_cover(grid, result.triangles);
        EXPECT_EQ(count_flat(grid, result.triangles), 0);
        concave += result.how == PolygonCut::ears;
        for (std::size_t i = 0; i < n; ++i) {
            straight += twice_area(grid[i], grid[(i + 1) % n], grid[(i + 2) % n]) == 0;
        }
        if (!HasFailure()) continue;
        for (const auto& p : grid) ADD_FAILURE() << p[0] << ' ' << p[1];
    }
    EXPECT_GT(tried, 3000);
    EXPECT_GT(concave, tried / 2);
    EXPECT_LT(concave, tried);
    EXPECT_GT(straight, 500);
}

// A simple polygon, into which spikes, doubled corners and bridged holes are put:
// what it covers stays known.
TEST(TriangulatePolygon, CoversRandomWeaklySimplePolygons) {
    constexpr unsigned kSeed = 2718;
    SCOPED_TRACE(kSeed);
    std::mt19937 random(kSeed);
    int tried = 0;
    for (int round = 0; round < 20'000 && !HasFailure(); ++round) {
        Grid grid;
        const std::size_t n = 4 + random() % 6;
        for (std::size_t i = 0; i < n; ++i) {
            grid.push_back({static_cast<long>(random() % 9), static_cast<long>(random() % 9)});
        }
        if (!untangle(grid)) continue;
        for (int change = 0; change < 3; ++change) {
            const std::size_t at = random() % grid.size();
            const auto corner = grid[at];
            const auto place = grid.begin() + static_cast<long>(at) + 1;
            switch (random() % 3) {
                case 0:
                    grid.insert(place, corner);
                    break;
                case 1: {  // a spike out of the corner, along the side before it
                    const auto before = grid[(at + grid.size() - 1) % grid.size()];
                    const std::array<long, 2> tip = {2 * corner[0] - before[0],
                                                     2 * corner[1] - before[1]};
                    grid.insert(place, {tip, corner});
                    break;
                }
                case 2: {  // back along the side before it
                    const auto before = grid[(at + grid.size() - 1) % grid.size()];
                    grid.insert(place, {before, corner});
                    break;
                }
            }
        }
        ++tried;
        const Cut result = cut(in_plane_z(grid));
        EXPECT_NE(result.how, PolygonCut::forced);
        expect_cover(grid, result.triangles);
        if (!HasFailure()) continue;
        for (const auto& p : grid) ADD_FAILURE() << p[0] << ' ' << p[1];
    }
    EXPECT_GT(tried, 3000);
}

// Squares on a coarse grid, some of them cut out of a frame by bridges from the
// frame's corner: all corners of all holes may be in line with each other.
TEST(TriangulatePolygon, CoversFramesWithBridgedHoles) {
    int asked = 0;
    constexpr unsigned kSeed = 1618;
    SCOPED_TRACE(kSeed);
    std::mt19937 random(kSeed);
    for (int round = 0; round < 3000 && !HasFailure(); ++round) {
        const long size = 20;
        // Holes in separate columns; bridges run along the free bottom row.
        Grid grid = {{0, 0}};
        int holes = 0;
        for (long x = 1; x + 3 < size; x += 4) {
            if (random() % 3 == 0) continue;
            const long left = x + static_cast<long>(random() % 2);
            const long low = 1 + static_cast<long>(random() % 8);
            const long high = low + 1 + static_cast<long>(random() % 8);
            grid.push_back({left, 0});
            grid.push_back({left, low});
            grid.push_back({left, high});
            grid.push_back({left + 2, high});
            grid.push_back({left + 2, low});
            grid.push_back({left, low});
            grid.push_back({left, 0});
            ++holes;
        }
        grid.push_back({size, 0});
        grid.push_back({size, size});
        grid.push_back({0, size});
        if (holes == 0) continue;
        ++asked;
        std::rotate(grid.begin(), grid.begin() + static_cast<long>(random() % grid.size()),
                    grid.end());
        expect_ears(grid);
        if (!HasFailure()) continue;
        for (const auto& p : grid) ADD_FAILURE() << p[0] << ' ' << p[1];
    }
    EXPECT_GT(asked, 2'500);
}

}  // namespace
}  // namespace cdprep::mesh
