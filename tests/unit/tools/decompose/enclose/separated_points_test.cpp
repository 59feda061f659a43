// SPDX-License-Identifier: MIT
#include "decompose/enclose/separated_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <tuple>
#include <utility>
#include <vector>

#include "hull/convex_hull.h"
#include "support/meshes.h"

#include "exact/predicates.h"

namespace cdprep::convex {
namespace {

using Points = std::vector<Double3>;

/// Exact: on the surface counts as within.
bool is_within(const ConvexHull& hull, const Double3& p) {
    return std::all_of(hull.facets.begin(), hull.facets.end(), [&](const auto& f) {
        return orient3d(hull.points[f[0]], hull.points[f[1]], hull.points[f[2]], p) >= 0;
    });
}

/// As a caller adds them, with a ball around their box.
bool add(SeparatedPoints& hull, const Points& points) {
    mesh::Box box;
    for (const Double3& p : points) box.add(p);
    const Double3 centre = {(box.lower.x + box.upper.x) / 2, (box.lower.y + box.upper.y) / 2,
                            (box.lower.z + box.upper.z) / 2};
    return hull.add(points, centre, box.diagonal() / 2);
}

PointGroups one_group(const Points& points) {
    PointGroups groups;
    groups.add(points);
    return groups;
}

const Points kTetrahedron = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}};

TEST(SeparatedPoints, RefuseWhatWouldTakeInAPointThatIsKeptOut) {
    const PointGroups within = one_group({{1, 1, 1}});
    SeparatedPoints refuses(within);
    EXPECT_FALSE(add(refuses, kTetrahedron));
    EXPECT_TRUE(refuses.outer_points().empty());
    const PointGroups beyond = one_group({{2, 1, 1.5}});
    SeparatedPoints takes(beyond);
    EXPECT_TRUE(add(takes, kTetrahedron));
    EXPECT_EQ(takes.outer_points(), kTetrahedron);
}

// The refused corner would have made a hull that (2, 2, 2) is in; without it there is room.
TEST(SeparatedPoints, AreAsBeforeAfterARefusal) {
    const PointGroups groups = one_group({{2, 2, 2}});
    SeparatedPoints hull(groups);
    ASSERT_TRUE(add(hull, kTetrahedron));
    EXPECT_FALSE(add(hull, {{6, 6, 6}}));
    EXPECT_EQ(hull.outer_points(), kTetrahedron);
    EXPECT_TRUE(add(hull, {{5, 1, 0}}));
    EXPECT_FALSE(add(hull, {{0, 4, 4}}));  // (2, 2, 2) is in the middle of (4, 0, 0) - (0, 4, 4)
}

// A group around the hull has no plane for all of it; each of its points has one.
TEST(SeparatedPoints, KeepOutPointsOfAGroupOneByOne) {
    const Points around = {{-1, 1, 1}, {5, 1, 1}, {1, -1, 1}, {1, 5, 1}, {1, 1, -1}, {1, 1, 5}};
    const PointGroups groups = one_group(around);
    SeparatedPoints hull(groups);
    EXPECT_TRUE(add(hull, kTetrahedron));
    EXPECT_FALSE(add(hull, {{6, 1, 1}}));
    EXPECT_TRUE(add(hull, {{2, 2, 2}}));
}

// Each answer against the exact hull of what there would be: integer points on both sides, so
// that a point that is not within is far enough from the hull for rounding not to matter.
TEST(SeparatedPoints, AnswerAsTheExactHullDoes) {
    std::mt19937 random(5);
    std::array<std::size_t, 2> answers{};
    for (int round = 0; round < 60; ++round) {
        const auto any = [&](int most) {
            std::uniform_int_distribution<int> at(-most, most);
            return Double3{static_cast<double>(at(random)), static_cast<double>(at(random)),
                           static_cast<double>(at(random))};
        };
        // The first few in a base, the others besides.
        PointGroups base;
        PointGroups groups(&base);
        Points out;
        for (int group = 0; group < 12; ++group) {
            if (group == 4) groups = PointGroups(&base);
            const Double3 middle = any(20);
            Points points;
            for (int i = 0; i < 1 + group; ++i) {
                const Double3 off = any(2);
                points.push_back({middle.x + off.x, middle.y + off.y, middle.z + off.z});
            }
            (group < 4 ? base : groups).add(points);
            out.insert(out.end(), points.begin(), points.end());
        }
        SeparatedPoints hull(groups);
        Points taken;
        for (int step = 0; step < 40; ++step) {
            const Double3 middle = any(16);
            Points more;
            for (const Double3& corner : kTetrahedron) {
                const Double3 off = any(1);
                more.push_back({middle.x + corner.x + off.x, middle.y + corner.y + off.y,
                                middle.z + corner.z + off.z});
            }
            Points all = taken;
            all.insert(all.end(), more.begin(), more.end());
            const ConvexHull exact = convex_hull(all);
            if (exact.dimension < 3) continue;
            const bool is_free = std::none_of(
                out.begin(), out.end(), [&](const Double3& p) { return is_within(exact, p); });
            ASSERT_EQ(add(hull, more), is_free) << "round " << round << ", step " << step;
            if (is_free) taken = std::move(all);
            ++answers[is_free ? 1 : 0];
        }
    }
    EXPECT_GT(answers[0], 500u);
    EXPECT_GT(answers[1], 100u);
}

// Groups along a line, more than are bundled together, some in a base: each box meets those
// that it should, in their order, and far from all of them few are looked at.
TEST(PointGroups, TellWhichMeetABox) {
    PointGroups base;
    for (int i = 0; i < 500; ++i) base.add(Points{{i + 0.0, 0, 0}, {i + 0.5, 0, 0}});
    PointGroups all(&base);
    for (int i = 500; i < 1000; ++i) all.add(Points{{i + 0.0, 0, 0}, {i + 0.5, 0, 0}});
    ASSERT_EQ(all.size(), 1000u);
    for (const auto& [from, to] : {std::pair(10, 20), std::pair(480, 520), std::pair(990, 2000)}) {
        std::vector<std::size_t> met;
        const std::size_t looks =
            all.in_box({{from + 0.25, -1, -1}, {to + 0.25, 1, 1}}, [&](std::size_t i) {
                EXPECT_EQ(all.points_of(i).front().x, static_cast<double>(i));
                met.push_back(i);
            });
        std::vector<std::size_t> expected;
        for (int i = from; i <= std::min(to, 999); ++i)
            expected.push_back(static_cast<std::size_t>(i));
        EXPECT_EQ(met, expected);
        EXPECT_LT(looks, 200u);
    }
}

// Many points are pruned; none of those that span the hull is lost.
TEST(SeparatedPoints, KeepThePointsThatSpanTheHull) {
    const PointGroups nothing;
    SeparatedPoints hull(nothing);
    Points all = test::lattice_sphere(65);
    for (int i = 0; i < 2'000; ++i) {
        all.push_back({static_cast<double>(i % 13 - 6), static_cast<double>(i % 17 - 8),
                       static_cast<double>(i % 11 - 5)});
    }
    for (std::size_t i = 0; i < all.size(); i += 50) {
        const auto end = std::min(i + 50, all.size());
        EXPECT_TRUE(add(hull, Points(all.begin() + static_cast<std::ptrdiff_t>(i),
                                     all.begin() + static_cast<std::ptrdiff_t>(end))));
    }
    EXPECT_LT(hull.outer_points().size(), all.size() / 2);
    Points left = convex_hull(hull.outer_points()).points;
    Points spanning = convex_hull(all).points;
    const auto before = [](const Double3& a, const Double3& b) {
        return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
    };
    std::sort(left.begin(), left.end(), before);
    std::sort(spanning.begin(), spanning.end(), before);
    EXPECT_EQ(left, spanning);
}

// The first of equals, with every number of points left over from blocks of sixteen.
TEST(PointRows, NameTheFirstOfTheFarthest) {
    std::mt19937 random(9);
    std::uniform_int_distribution<int> coordinate(-3, 3);
    const auto any = [&] { return static_cast<double>(coordinate(random)); };
    PointRows rows;
    Points points;
    while (points.size() < 70) {
        points.push_back({any(), any(), any()});
        rows.add(points.back());
        const Double3 along = {any(), any(), any()};
        const auto height = [&](const Double3& p) {
            return along.x * p.x + along.y * p.y + along.z * p.z;
        };
        const auto first = std::max_element(
            points.begin(), points.end(),
            [&](const Double3& a, const Double3& b) { return height(a) < height(b); });
        EXPECT_EQ(rows.farthest(along), static_cast<std::size_t>(first - points.begin()));
        EXPECT_EQ(rows.at(points.size() - 1), points.back());
    }
}

}  // namespace
}  // namespace cdprep::convex
