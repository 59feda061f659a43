// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/exact_box.h"

#include "exact/triangle_box.h"
#include "exact/triangle_box_filter.h"

namespace cdprep::test {
namespace {

/// Every coordinate of a triangle and a box times 2^exponent.
struct Case {
    Corners t;
    Box3 box;

    [[nodiscard]] Case scaled(int exponent) const {
        const auto at = [&](const Double3& p) {
            return Double3{std::ldexp(p.x, exponent), std::ldexp(p.y, exponent),
                           std::ldexp(p.z, exponent)};
        };
        return {{at(t[0]), at(t[1]), at(t[2])}, {at(box.lower), at(box.upper)}};
    }
};

/// Corners on a grid; some triangles degenerate, some boxes flat.
Case coarse_case(std::mt19937& random, int reach) {
    std::uniform_int_distribution<int> grid(-reach, reach);
    const auto point = [&] {
        const double x = grid(random), y = grid(random), z = grid(random);
        return Double3{x, y, z};
    };
    Case c{{point(), point(), point()}, {}};
    const Double3 a = point(), b = point();
    c.box = {{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)},
             {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}};
    if (random() % 4 == 0) c.box.upper.z = c.box.lower.z;
    if (random() % 8 == 0) c.t[2] = random() % 2 == 0 ? c.t[0] : c.t[1];
    return c;
}

/// A triangle in [-1, 1]^3 and a box of half extents from 0.2 to 1.
Case fine_case(std::mt19937& random) {
    std::uniform_real_distribution<double> place(-1, 1), size(0.2, 1);
    const auto point = [&] {
        const double x = place(random), y = place(random), z = place(random);
        return Double3{x, y, z};
    };
    Case c{{point(), point(), point()}, {}};
    const Double3 m = point();
    const double x = size(random), y = size(random), z = size(random);
    c.box = {{m.x - x, m.y - y, m.z - z}, {m.x + x, m.y + y, m.z + z}};
    return c;
}

void expect_two_sided(int hits, int cases) {
    EXPECT_GT(hits, cases * 3 / 10);
    EXPECT_LT(hits, cases * 7 / 10);
}

// The oracle: what is left of the triangle after cutting at the faces, in exact numbers.
TEST(TriangleBoxLaws, AgreesWithCuttingOnACoarseGrid) {
    std::mt19937 random(71);
    int hits = 0;
    constexpr int kCases = 20'000;
    for (int i = 0; i < kCases; ++i) {
        const Case c = coarse_case(random, i % 2 == 0 ? 2 : 4);
        const bool truth = touches_box_by_cutting(c.t, c.box);
        ASSERT_EQ(triangle_touches_box(c.t, c.box), truth) << "seed 71, case " << i;
        hits += truth ? 1 : 0;
    }
    expect_two_sided(hits, kCases);
}

TEST(TriangleBoxLaws, AgreesWithCuttingOnFineNumbers) {
    std::mt19937 random(72);
    int hits = 0;
    constexpr int kCases = 3000;
    for (int i = 0; i < kCases; ++i) {
        const Case c = fine_case(random);
        const bool truth = touches_box_by_cutting(c.t, c.box);
        ASSERT_EQ(triangle_touches_box(c.t, c.box), truth) << "seed 72, case " << i;
        hits += truth ? 1 : 0;
    }
    expect_two_sided(hits, kCases);
}

/// A fine case of which one coordinate of the box lies within a few last bits of where
/// the triangle begins or ends in the others' range.
Case close_case(std::mt19937& random) {
    Case c = fine_case(random);
    const double step = std::ldexp(1.0, -40 - static_cast<int>(random() % 10));
    // Shrink towards the nearest box that the triangle does not touch.
    double touching = c.box.upper.x;
    double apart = c.box.lower.x;
    while (touching - apart > step) {
        const double middle = apart + (touching - apart) / 2;
        c.box.upper.x = middle;
        (triangle_touches_box(c.t, c.box) ? touching : apart) = middle;
    }
    c.box.upper.x = random() % 2 == 0 ? touching : apart;
    return c;
}

// Of each pair of boxes that differ in the last bits, one touches: by bisection.
TEST(TriangleBoxLaws, AgreesWithCuttingWhereTheLastBitsDecide) {
    std::mt19937 random(74);
    int hits = 0;
    constexpr int kCases = 1500;
    for (int i = 0; i < kCases; ++i) {
        Case c = close_case(random);
        if (i % 3 == 1) c = c.scaled(-900);
        if (i % 3 == 2) c = c.scaled(900);
        const bool truth = touches_box_by_cutting(c.t, c.box);
        ASSERT_EQ(triangle_touches_box(c.t, c.box), truth) << "seed 74, case " << i;
        hits += truth ? 1 : 0;
    }
    expect_two_sided(hits, kCases);
}

using FilterCase = Case (*)(std::mt19937&);

// What doubles say is so; and they seldom leave anything open, but near a change.
TEST(TriangleBoxLaws, TheFilterIsRightWhenItAnswers) {
    std::mt19937 random(75);
    const std::array<FilterCase, 3> kinds = {&fine_case, &close_case,
                                             [](std::mt19937& r) { return coarse_case(r, 3); }};
    std::array<int, 3> open{};
    constexpr int kCases = 700;
    for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
        for (int i = 0; i < kCases; ++i) {
            const Case c = kinds[kind](random);
            if (!overlap(box_around(c.t), c.box)) continue;
            for (const int exponent : {-1070, -500, 0, 500, 998}) {
                const Case s = c.scaled(exponent);
                if (kind != 2 && exponent < -900) continue;  // no longer the same
                const TouchesBox seen = TriangleBoxFilter(s.t, s.box).touches();
                if (seen == TouchesBox::unknown) {
                    open[kind] += exponent == 0 ? 1 : 0;
                    continue;
                }
                ASSERT_EQ(seen == TouchesBox::yes, touches_box_by_cutting(c.t, c.box))
                    << "seed 75, kind " << kind << ", case " << i << ", exponent " << exponent;
            }
        }
    }
    EXPECT_LT(open[0], kCases / 100);
    EXPECT_GT(open[1], kCases / 20);
    EXPECT_GT(open[2], kCases / 10);
}

// The oracle: exact numbers. The products of two small edges underflow, and the large coordinates
// along the third axis magnify the loss.
TEST(TriangleBoxLaws, AgreesWithCuttingWhereAxesDifferInScale) {
    std::mt19937 random(76);
    std::uniform_int_distribution<int> large(-100, 300), small(-600, -450);
    int hits = 0, cases = 0;
    while (cases < 4000) {
        const int turn = cases % 3;
        const std::array<int, 3> by = {large(random), small(random), small(random)};
        const auto at = [&](const Double3& p) {
            const std::array<double, 3> q = {std::ldexp(p.x, by[0]), std::ldexp(p.y, by[1]),
                                             std::ldexp(p.z, by[2])};
            return Double3{q[turn], q[(turn + 1) % 3], q[(turn + 2) % 3]};
        };
        const Case c = fine_case(random);
        const Case s = {{at(c.t[0]), at(c.t[1]), at(c.t[2])}, {at(c.box.lower), at(c.box.upper)}};
        const bool truth = touches_box_by_cutting(s.t, s.box);
        ASSERT_EQ(triangle_touches_box(s.t, s.box), truth) << "seed 76, case " << cases;
        hits += truth ? 1 : 0;
        ++cases;
    }
    expect_two_sided(hits, cases);
}

// By symmetry: sizes change nothing.
TEST(TriangleBoxLaws, SizeDoesNotMatter) {
    std::mt19937 random(73);
    for (int i = 0; i < 500; ++i) {
        const Case c = coarse_case(random, 3);
        const bool truth = triangle_touches_box(c.t, c.box);
        for (const int exponent : {-1070, -600, 500, 998}) {
            const Case s = c.scaled(exponent);
            ASSERT_EQ(triangle_touches_box(s.t, s.box), truth) << "seed 73, case " << i;
        }
    }
}

// By hand: a triangle across a corner of the unit box, its plane through the corner or
// one step beyond.
TEST(TriangleBoxLaws, TheLastBitDecides) {
    const Box3 box = {{0, 0, 0}, {1, 1, 1}};
    EXPECT_TRUE(triangle_touches_box({{{3, 0, 0}, {0, 3, 0}, {0, 0, 3}}}, box));
    const double more = std::nextafter(3.0, 4.0);
    EXPECT_FALSE(triangle_touches_box({{{more, 0, 0}, {0, more, 0}, {0, 0, more}}}, box));
    EXPECT_TRUE(triangle_touches_box({{{2, 0, 0.5}, {0, 2, 0.5}, {2, 2, 0.5}}}, box));
    EXPECT_FALSE(triangle_touches_box(
        {{{std::nextafter(2.0, 3.0), 0, 0.5}, {0, std::nextafter(2.0, 3.0), 0.5}, {2, 2, 0.5}}},
        box));
}

}  // namespace
}  // namespace cdprep::test
