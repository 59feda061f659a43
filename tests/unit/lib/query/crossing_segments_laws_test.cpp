// SPDX-License-Identifier: MIT
#include "cdprep/pairs.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "support/brute_force.h"
#include "support/exact_contact.h"
#include "support/exact_distance.h"
#include "support/hard_triangles.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"

namespace cdprep::test {
namespace {

using Point = std::array<ExactRational, 3>;

Point rational(const Double3& p) {
    return {ExactRational(p.x), ExactRational(p.y), ExactRational(p.z)};
}

/// Where the edge meets the plane of t, in rational numbers, when that lies in t.
void add_piercing(const Double3& from, const Double3& to, const Corners& t,
                  std::vector<Point>& points) {
    const ExactTriangle<ExactNumber> e = exact<ExactNumber>({from, to, to});
    const ExactTriangle<ExactNumber> c = exact<ExactNumber>(t);
    const auto n = cross(minus(c[1], c[0]), minus(c[2], c[0]));
    const ExactNumber at_from = dot(n, minus(e[0], c[0]));
    const ExactNumber at_to = dot(n, minus(e[1], c[0]));
    if ((at_from - at_to).sign() == 0 || at_from.sign() * at_to.sign() > 0) return;
    const ExactNumber all = at_from - at_to;
    ExactPoint<ExactNumber> place;  // times `all`
    for (std::size_t i = 0; i < 3; ++i) place[i] = e[1][i] * at_from - e[0][i] * at_to;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto side =
            cross(minus(c[(i + 1) % 3], c[i]),
                  {place[0] - c[i][0] * all, place[1] - c[i][1] * all, place[2] - c[i][2] * all});
        if (dot(n, side).sign() * all.sign() < 0) return;
    }
    points.push_back(
        {ExactRational(place[0], all), ExactRational(place[1], all), ExactRational(place[2], all)});
}

/// All points in which an edge of one meets the other: those of the common segment's
/// ends among them.
std::vector<Point> piercing_points(const Corners& a, const Corners& b) {
    std::vector<Point> points;
    for (std::size_t i = 0; i < 3; ++i) {
        add_piercing(a[i], a[(i + 1) % 3], b, points);
        add_piercing(b[i], b[(i + 1) % 3], a, points);
    }
    return points;
}

bool precedes(const Point& p, const Point& q) {
    for (std::size_t i = 0; i < 3; ++i) {
        if (p[i] != q[i]) return p[i] < q[i];
    }
    return false;
}

/// Half a unit in the last place, and no more than the promise says.
void expect_rounded(double found, const ExactRational& truth, const std::string& where) {
    const double nearest = static_cast<double>(truth.approximation());
    EXPECT_TRUE(found == nearest || std::nextafter(found, nearest) == nearest) << where;
    const ExactRational off = ExactRational(found) - truth;
    const double above = std::nextafter(std::fabs(found), 1e308) - std::fabs(found);
    const ExactRational limit(0.5 * above * (1 + 0x1p-44));
    EXPECT_TRUE(off <= limit && ExactRational(0.0) - limit <= off) << where << ": " << found;
}

void expect_point(const Double3& found, const Point& truth, const std::string& where) {
    expect_rounded(found.x, truth[0], where);
    expect_rounded(found.y, truth[1], where);
    expect_rounded(found.z, truth[2], where);
}

struct Seen {
    int segments = 0;
    int points = 0;
    int flat = 0;
};

/// The oracle: the first and the last of all piercing points.
void expect_segment(const Corners& a, const Corners& b, const Crossing& crossing,
                    const std::string& where, Seen& seen) {
    const std::vector<Point> points = piercing_points(a, b);
    const ExactTriangle<ExactNumber> s = exact<ExactNumber>(a), t = exact<ExactNumber>(b);
    const auto n = cross(minus(s[1], s[0]), minus(s[2], s[0]));
    const auto m = cross(minus(t[1], t[0]), minus(t[2], t[0]));
    ASSERT_EQ(crossing.is_flat, is_zero(cross(n, m))) << where;
    if (crossing.is_flat) {
        ++seen.flat;
        EXPECT_EQ(crossing.from, (Double3{0, 0, 0})) << where;
        EXPECT_EQ(crossing.to, crossing.from) << where;
        return;
    }
    ASSERT_FALSE(points.empty()) << where;
    const auto [first, last] = std::minmax_element(points.begin(), points.end(), precedes);
    const bool is_point = !precedes(*first, *last);
    ++(is_point ? seen.points : seen.segments);
    EXPECT_EQ(crossing.from == crossing.to, is_point) << where;
    const Point from = rational(crossing.from), to = rational(crossing.to);
    const bool turned = precedes(to, from);
    expect_point(turned ? crossing.to : crossing.from, *first, where);
    expect_point(turned ? crossing.from : crossing.to, *last, where);
}

/// What is visited, sorted; lists, long and short, hold the same.
std::vector<Crossing> all_crossings(const Pair& pair) {
    Workspace workspace;
    std::vector<Crossing> found;
    const auto visit = [&](const Crossing& crossing) {
        found.push_back(crossing);
        return true;
    };
    EXPECT_TRUE(visit_crossings(pair, workspace, visit));
    std::sort(found.begin(), found.end(),
              [](const Crossing& x, const Crossing& y) { return x.pair < y.pair; });
    for (const std::size_t room : {std::size_t{0}, found.size() / 3, found.size() + 1}) {
        std::vector<Crossing> listed(room);
        EXPECT_EQ(crossings(pair, workspace, listed), found.size());
        for (std::size_t i = 0; i < std::min(room, found.size()); ++i) {
            EXPECT_EQ(listed[i].pair, found[i].pair);
            EXPECT_EQ(listed[i].from, found[i].from);
            EXPECT_EQ(listed[i].to, found[i].to);
        }
    }
    return found;
}

void expect_all(const TestMesh& a, const TestMesh& b, const Placement& placement,
                const std::string& where, Seen& seen) {
    const OpenModel model_a = open_tiny(a, {.double_precision = true});
    const OpenModel model_b = open_tiny(b, {.double_precision = true});
    const auto found = all_crossings({model_a.model, model_b.model, placement});
    const auto pairs = boxed_pairs(a, b, placement, triangles_touch_by_segments);
    ASSERT_EQ(found.size(), pairs.size()) << where;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        ASSERT_EQ(found[i].pair, pairs[i]) << where;
        expect_segment(corners_of(a, pairs[i].a, nullptr),
                       corners_of(b, pairs[i].b, &placement.pose_b()), found[i], where, seen);
    }
}

TEST(CrossingSegmentsLaws, AreTheExactOnesRoundedOnce) {
    constexpr std::uint32_t kSeed = 6;
    std::mt19937 random(kSeed);
    Seen coarse, fine;
    for (int round = 0; round < 60; ++round) {
        const std::string where = "seed 6, round " + std::to_string(round);
        expect_all(coarse_grid_soup(random(), 14, 2), coarse_grid_soup(random(), 14, 2),
                   Placement::b_moves(Pose()), where, coarse);
        expect_all(random_soup(random(), 40, 0.5), random_soup(random(), 40, 0.5),
                   Placement::b_moves(random_pose(random, 0.25)), where, fine);
    }
    EXPECT_GT(coarse.segments, 300);
    EXPECT_GT(coarse.points, 150);
    EXPECT_GT(coarse.flat, 50);
    EXPECT_GT(fine.segments, 300);
}

// Every way of touching, at sizes from one end of double to the other.
TEST(CrossingSegmentsLaws, TheCatalogueHasThemToo) {
    Seen seen;
    for (const HardPair& pair : hard_triangles()) {
        for (const int exponent : {-900, -40, 0, 40, 900}) {
            const auto changed = scaled(pair, exponent);
            if (!changed) continue;
            const TestMesh a{{changed->a[0], changed->a[1], changed->a[2]}, {{{0, 1, 2}}}};
            const TestMesh b{{changed->b[0], changed->b[1], changed->b[2]}, {{{0, 1, 2}}}};
            expect_all(a, b, Placement::b_moves(Pose()), changed->id, seen);
        }
    }
    EXPECT_GT(seen.segments, 30);
    EXPECT_GT(seen.points, 30);
    EXPECT_GT(seen.flat, 30);
}

// By hand: a triangle stands on the diagonal of another.
TEST(CrossingSegments, OfAStandingTriangle) {
    const OpenModel lying = open_tiny(TestMesh{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{{0, 1, 2}}}});
    const OpenModel standing =
        open_tiny(TestMesh{{{1, 1, -1}, {1, 1, 1}, {-3, -3, 0}}, {{{0, 1, 2}}}});
    const auto found = all_crossings({lying.model, standing.model, Placement::b_moves(Pose())});
    ASSERT_EQ(found.size(), 1u);
    EXPECT_FALSE(found[0].is_flat);
    const Double3 corner = {0, 0, 0}, inside = {1, 1, 0};
    EXPECT_TRUE((found[0].from == corner && found[0].to == inside) ||
                (found[0].from == inside && found[0].to == corner));
}

}  // namespace
}  // namespace cdprep::test
