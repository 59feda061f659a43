// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>
#include <string>

#include "cells/tetra_cones.h"
#include "support/exact_cone.h"

namespace cdprep::test {
namespace {

using format::kMaxTetraLevel;

bool touches_by_cutting(const Corners& t, const Double3& centre, const TetraCone& cone) {
    return !cut_by_cone(t, centre, cone).empty();
}

Double3 scaled(const Double3& p, double factor) {
    return {p.x * factor, p.y * factor, p.z * factor};
}

Double3 plus(const Double3& a, const Double3& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}

Double3 point_of(const Generator& g) {
    return {double(g[0]), double(g[1]), double(g[2])};
}

std::uint32_t random_key(std::mt19937& random, std::uint32_t level) {
    const std::uint32_t first = 8U << (2 * level);
    return first + random() % first;
}

/// A random point about a centre, fine or on a coarse grid.
Double3 random_point(std::mt19937& random, bool coarse) {
    if (coarse) {
        std::uniform_int_distribution<int> grid(-4, 4);
        return {double(grid(random)), double(grid(random)), double(grid(random))};
    }
    std::uniform_real_distribution<double> fine(-1, 1);
    return {fine(random), fine(random), fine(random)};
}

/// A point in the cone, or on its planes: whole weights of the generators, not all zero.
Double3 point_in(std::mt19937& random, const TetraCone& cone, int most) {
    std::uniform_int_distribution<int> weight(0, most);
    Double3 p{};
    while (p == Double3{0, 0, 0}) {
        for (const Generator& g : cone.generator) p = plus(p, scaled(point_of(g), weight(random)));
    }
    return p;
}

std::string shown(const Corners& t) {
    std::string text;
    for (const Double3& p : t) {
        text += std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + "; ";
    }
    return text;
}

/// Holds both answers to be common.
class Tally {
public:
    void expect(const Corners& t, const Double3& centre, std::uint32_t key) {
        const TetraCone cone = tetra_cone(key);
        const bool expected = touches_by_cutting(t, centre, cone);
        ++(expected ? yes_ : no_);
        EXPECT_EQ(triangle_touches_cone(t, centre, cone), expected)
            << "key " << key << " centre " << centre.x << " " << centre.y << " " << centre.z
            << " triangle " << shown(t);
    }
    void expect_both() const {
        const double share = double(yes_) / double(yes_ + no_);
        EXPECT_GT(share, 0.3) << yes_ << " of " << yes_ + no_;
        EXPECT_LT(share, 0.7) << yes_ << " of " << yes_ + no_;
    }

private:
    int yes_ = 0;
    int no_ = 0;
};

// By hand: the middle one of the four has the middles as generators.
TEST(TetraCones, AChildHasMiddlesOfItsParentsGenerators) {
    EXPECT_EQ(tetra_level(8), 0U);
    EXPECT_EQ(tetra_level(8 << 2 | 3), 1U);
    EXPECT_EQ(tetra_level(15U << 28), kMaxTetraLevel);
    const TetraCone octant = tetra_cone(8 + 5);  // -x, +y, -z
    EXPECT_EQ(octant.generator[0], (Generator{-1, 0, 0}));
    EXPECT_EQ(octant.generator[1], (Generator{0, 1, 0}));
    EXPECT_EQ(octant.generator[2], (Generator{0, 0, -1}));
    const TetraCone child = tetra_cone((8 + 5) << 2 | 3);
    EXPECT_EQ(child.generator[0], (Generator{-1, 1, 0}));
    EXPECT_EQ(child.generator[1], (Generator{0, 1, -1}));
    EXPECT_EQ(child.generator[2], (Generator{-1, 0, -1}));
    const TetraCone deep = tetra_cone((8U << 4) | (0U << 2) | 1U);
    EXPECT_EQ(deep.generator[0], (Generator{3, 1, 0}));
    EXPECT_EQ(deep.generator[1], (Generator{2, 2, 0}));
    EXPECT_EQ(deep.generator[2], (Generator{2, 1, 1}));
}

// A point of whole weights of the generators, all positive, lies inside the cone and in
// no other. 160,000 steps of the descent and more, at all levels.
TEST(TetraCones, KeyIsThatOfTheConeThatAPointWasMadeIn) {
    std::mt19937 random(1);
    for (int i = 0; i < 22000; ++i) {
        const std::uint32_t level = random() % (kMaxTetraLevel + 1);
        const std::uint32_t key = random_key(random, level);
        const TetraCone cone = tetra_cone(key);
        Double3 p{};
        for (const Generator& g : cone.generator) {
            p = plus(p, scaled(point_of(g), 1 + random() % 1000));
        }
        ASSERT_EQ(tetra_key({0, 0, 0}, p, level), key);
    }
}

/// The definition: of the cones that hold the direction, the one that comes first when at
/// each split children are asked in order, and octants with zeros positive.
std::uint32_t key_by_cutting(const Double3& centre, const Double3& p, std::uint32_t level) {
    std::uint32_t key =
        8U | (p.x < centre.x ? 1U : 0U) | (p.y < centre.y ? 2U : 0U) | (p.z < centre.z ? 4U : 0U);
    for (std::uint32_t i = 0; i < level; ++i) {
        std::uint32_t child = 0;
        while (child < 4 && !touches_by_cutting({p, p, p}, centre, tetra_cone(key << 2 | child))) {
            ++child;
        }
        EXPECT_LT(child, 4U) << "no child holds the point";
        key = key << 2 | child;
    }
    return key;
}

TEST(TetraCones, TiesGoToTheFirstChild) {
    EXPECT_EQ(tetra_key({0, 0, 0}, {1, 1, 0}, 1), 8U << 2 | 0U);
    EXPECT_EQ(tetra_key({0, 0, 0}, {0, 1, 1}, 1), 8U << 2 | 1U);
    EXPECT_EQ(tetra_key({0, 0, 0}, {-1, -0.0, 0}, 1), 9U << 2 | 0U);
    std::mt19937 random(2);
    for (int i = 0; i < 3000; ++i) {
        const std::uint32_t level = 1 + random() % 5;
        // On the grid's lines and points, seen from an offset too.
        const TetraCone cone = tetra_cone(random_key(random, level));
        Double3 p = point_in(random, cone, 2);
        const Double3 centre = i % 2 == 0 ? Double3{0, 0, 0} : Double3{1000, -3, 0.5};
        p = plus(p, centre);
        for (const std::uint32_t l : {level, kMaxTetraLevel}) {
            if (l == kMaxTetraLevel && i % 20 != 0) continue;
            ASSERT_EQ(tetra_key(centre, p, l), key_by_cutting(centre, p, l));
        }
    }
}

// A step of one unit in the last place beside a plane: no rounded number tells.
TEST(TetraCones, KeysAreExactBesideAPlane) {
    std::mt19937 random(3);
    int changed = 0;
    int all = 0;
    for (int i = 0; i < 2000; ++i) {
        const std::uint32_t level = 1 + random() % 6;
        const TetraCone cone = tetra_cone(random_key(random, level));
        const double factor = std::ldexp(1.0 + 0.1 * (random() % 10), int(random() % 2001) - 1000);
        Double3 p = scaled(point_of(cone.generator[random() % 3]), factor);
        const std::uint32_t before = tetra_key({0, 0, 0}, p, level);
        p.x = std::nextafter(p.x, p.x + (random() % 2 == 0 ? 1 : -1) * std::fabs(p.x));
        const std::uint32_t key = tetra_key({0, 0, 0}, p, level);
        ASSERT_EQ(key, key_by_cutting({0, 0, 0}, p, level));
        changed += key != before ? 1 : 0;
        ++all;
    }
    EXPECT_GT(changed, all / 10);
    EXPECT_LT(changed, all * 9 / 10);
}

TEST(TetraCones, ContactIsThatOfExactCutting) {
    for (const bool coarse : {false, true}) {
        std::mt19937 random(4);
        Tally tally;
        for (int i = 0; i < 6000; ++i) {
            const std::uint32_t level = random() % 3;
            const Double3 centre = i % 3 == 0 ? Double3{0, 0, 0} : random_point(random, coarse);
            Corners t{};
            for (Double3& p : t) p = plus(centre, random_point(random, coarse));
            // A cone that a corner lies in, or any: a third.
            const std::uint32_t key = random_key(random, level);
            tally.expect(t, centre, key);
        }
        if (coarse) tally.expect_both();
    }
}

// Corners on the planes and generators of the cone and of its neighbours.
TEST(TetraCones, TrianglesOnTheGridOfACone) {
    std::mt19937 random(5);
    Tally tally;
    for (int i = 0; i < 6000; ++i) {
        const std::uint32_t level = 1 + random() % 3;
        const std::uint32_t parent = random_key(random, level - 1);
        Corners t{};
        for (Double3& p : t) {
            p = scaled(point_in(random, tetra_cone(parent << 2 | random() % 4), 2),
                       random() % 4 == 0 ? -1 : 1);
        }
        tally.expect(t, {0, 0, 0},
                     i % 3 == 0 ? random_key(random, level) : parent << 2 | random() % 4);
    }
    tally.expect_both();
}

Double3 nudged(std::mt19937& random, Double3 p) {
    for (double* x : {&p.x, &p.y, &p.z}) {
        const std::uint32_t way = random() % 3;
        if (way != 0) *x = std::nextafter(*x, way == 1 ? 1e300 : -1e300);
    }
    return p;
}

// One unit in the last place off those: filters cannot tell.
TEST(TetraCones, TrianglesAUnitInTheLastPlaceOffTheGrid) {
    std::mt19937 random(6);
    Tally tally;
    for (int i = 0; i < 4000; ++i) {
        const std::uint32_t level = 1 + random() % 3;
        const std::uint32_t parent = random_key(random, level - 1);
        const Double3 centre = i % 2 == 0 ? Double3{0, 0, 0} : Double3{0.1, 1e6, -3};
        Corners t{};
        for (Double3& p : t) {
            p = nudged(
                random,
                plus(centre, scaled(point_in(random, tetra_cone(parent << 2 | random() % 4), 2),
                                    random() % 4 == 0 ? -1 : 1)));
        }
        tally.expect(t, centre, parent << 2 | random() % 4);
    }
    tally.expect_both();
}

// Any cone at all touches a triangle that holds its apex.
TEST(TetraCones, TheCentreInATriangleIsInEveryCone) {
    int asked = 0;
    const std::vector<Corners> holders = {
        {{{1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}}},  // inside, in a plane of octants
        {{{1, 2, 3}, {-1, -2, -3}, {0, 5, 1}}},  // on an edge
        {{{0, 0, 0}, {1, 2, 3}, {-5, 0, 1}}},    // a corner
        {{{3, 1, -2}, {-3, 1, 1}, {0, -2, 1}}},  // inside
        {{{1, 2, 3}, {-2, -4, -6}, {2, 4, 6}}},  // a segment
        {{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}},     // a point
    };
    for (const Corners& t : holders) {
        for (std::uint32_t key = 8; key < 16U << 4; ++key) {
            if (std::bit_width(key) % 2 != 0) continue;
            ++asked;
            EXPECT_TRUE(triangle_touches_cone(t, {0, 0, 0}, tetra_cone(key))) << key << shown(t);
        }
    }
    EXPECT_EQ(asked, 6 * 8 * (1 + 4 + 16));
}

// The same at any size: signs do not change, filters do.
TEST(TetraCones, ContactIsTheSameAtAnyScale) {
    int asked = 0;
    std::mt19937 random(7);
    for (int i = 0; i < 400; ++i) {
        const std::uint32_t level = random() % 4;
        const std::uint32_t key = random_key(random, level);
        Corners t{};
        for (Double3& p : t) p = random_point(random, i % 2 == 0);
        const TetraCone cone = tetra_cone(key);
        const bool expected = triangle_touches_cone(t, {0, 0, 0}, cone);
        for (const double factor : {0x1p-1020, 0x1p-1000, 0x1p-500, 0x1p500, 0x1p997}) {
            Corners other = t;
            // Exact but where digits fall off below the least double.
            if (i % 2 != 0 && factor < 0x1p-999) continue;
            ++asked;
            for (Double3& p : other) p = scaled(p, factor);
            EXPECT_EQ(triangle_touches_cone(other, {0, 0, 0}, cone), expected);
            const Double3 corner = other[0];
            EXPECT_EQ(tetra_key({0, 0, 0}, corner, 14), tetra_key({0, 0, 0}, t[0], 14));
        }
    }
    EXPECT_EQ(asked, 200 * 5 + 200 * 3);
}

// Corners of sizes that no double holds side by side.
TEST(TetraCones, CornersMayDifferInSizeByAnyPower) {
    std::mt19937 random(8);
    Tally tally;
    for (int i = 0; i < 600; ++i) {
        const std::uint32_t key = random_key(random, random() % 2);
        Corners t{};
        for (Double3& p : t) {
            p = scaled(random_point(random, true), std::ldexp(1.0, int(random() % 1900) - 950));
        }
        const Double3 centre = scaled(random_point(random, true), i % 2 == 0 ? 0 : 0x1p-990);
        tally.expect(t, centre, key);
    }
    tally.expect_both();
}

}  // namespace
}  // namespace cdprep::test
