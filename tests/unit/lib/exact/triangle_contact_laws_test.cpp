// SPDX-License-Identifier: MIT
#include "exact/triangle_contact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <string>

#include "support/exact_contact.h"
#include "support/exact_rational.h"

#include "exact/predicates.h"

namespace cdprep::test {
namespace {

std::size_t pattern(const std::array<int, 3>& signs) {
    return static_cast<std::size_t>((signs[0] + 1) + 3 * (signs[1] + 1) + 9 * (signs[2] + 1));
}

/// Both implementations against the definition.
template <class Number>
TriangleContact expect_agreement(const Corners& a, const Corners& b, const std::string& where) {
    const TriangleContact truth = contact_by_definition(exact<Number>(a), exact<Number>(b));
    const bool closed = truth != TriangleContact::disjoint;
    EXPECT_EQ(classify_contact(a, b), truth) << where;
    EXPECT_EQ(classify_contact(b, a), truth) << where;
    EXPECT_EQ(triangles_touch(a, b), closed) << where;
    EXPECT_EQ(triangles_touch_by_segments(a, b), closed) << where;
    return truth;
}

class Kinds {
public:
    void add(TriangleContact kind) {
        ++count_[kind];
    }
    /// Smallest number of times that one of the four kinds was seen.
    [[nodiscard]] int rarest() {
        using enum TriangleContact;
        return std::min({count_[disjoint], count_[touch], count_[cross], count_[coplanar_overlap]});
    }
    int operator[](TriangleContact kind) {
        return count_[kind];
    }

private:
    std::map<TriangleContact, int> count_;
};

Corners grid_triangle(std::mt19937& random, int size) {
    std::uniform_int_distribution<int> grid(-size, size);
    Corners t;
    for (Double3& p : t) {
        p = {static_cast<double>(grid(random)), static_cast<double>(grid(random)),
             static_cast<double>(grid(random))};
    }
    return t;
}

// Small integers: every way in which two planes can part the corners of the
// other triangle occurs, 26 x 26 besides the coplanar ones.
TEST(TriangleContactLaws, BothTestsFollowTheDefinitionForAllSignPatterns) {
    constexpr std::uint32_t kSeed = 676;
    std::mt19937 random(kSeed);
    std::bitset<std::size_t{27} * 27> seen;
    Kinds kinds;
    for (int round = 0; round < 400'000 && !HasFailure(); ++round) {
        const Corners a = grid_triangle(random, 2 + round % 2);
        const Corners b = grid_triangle(random, 2 + round % 2);
        if (is_degenerate(a) || is_degenerate(b)) continue;
        seen.set(pattern(plane_signs(b, a)) + 27 * pattern(plane_signs(a, b)));
        kinds.add(expect_agreement<std::int64_t>(a, b, "round " + std::to_string(round)));
    }
    EXPECT_EQ(seen.count(), 676U + 1U);  // and one for coplanar pairs
    EXPECT_GT(kinds[TriangleContact::disjoint], 100'000);
    EXPECT_GT(kinds[TriangleContact::cross], 20'000);
    EXPECT_GT(kinds.rarest(), 100) << "seed " << kSeed;
}

// Segments and points among them, in the plane z = 0 and in space.
TEST(TriangleContactLaws, BothTestsFollowTheDefinitionWithoutArea) {
    constexpr std::uint32_t kSeed = 7;
    std::mt19937 random(kSeed);
    int degenerate = 0;
    Kinds kinds;
    for (int round = 0; round < 200'000 && !HasFailure(); ++round) {
        Corners a = grid_triangle(random, 2);
        Corners b = grid_triangle(random, 2);
        if (round % 3 == 0) a[2] = a[static_cast<std::size_t>(round / 3 % 2)];
        if (round % 3 == 1) {
            b[2] = {2 * b[1].x - b[0].x, 2 * b[1].y - b[0].y, 2 * b[1].z - b[0].z};
        }
        if (round % 5 == 0) {
            for (std::size_t i = 0; i < 3; ++i) a[i].z = b[i].z = 0;
        }
        if (round % 7 == 0) a[1] = a[2] = a[0];
        if (round % 11 == 0) b[1] = b[2] = b[0];
        degenerate += is_degenerate(a) || is_degenerate(b) ? 1 : 0;
        kinds.add(expect_agreement<std::int64_t>(a, b, "round " + std::to_string(round)));
    }
    EXPECT_GT(degenerate, 100'000);
    EXPECT_GT(kinds[TriangleContact::touch], 20'000);
    EXPECT_GT(kinds[TriangleContact::disjoint], 60'000);
}

TEST(TriangleContactLaws, BothTestsFollowTheDefinitionInOnePlane) {
    constexpr std::uint32_t kSeed = 8;
    std::mt19937 random(kSeed);
    std::uniform_int_distribution<int> slope(-2, 2);
    Kinds kinds;
    for (int round = 0; round < 100'000 && !HasFailure(); ++round) {
        Corners a = grid_triangle(random, 3);
        Corners b = grid_triangle(random, 3);
        const int u = slope(random), v = slope(random);
        for (Corners* t : {&a, &b}) {
            for (Double3& p : *t) p.z = u * p.x + v * p.y;
        }
        kinds.add(expect_agreement<std::int64_t>(a, b, "round " + std::to_string(round)));
    }
    EXPECT_GT(kinds[TriangleContact::disjoint], 20'000);
    EXPECT_GT(kinds[TriangleContact::touch], 10'000);
    EXPECT_GT(kinds[TriangleContact::coplanar_overlap], 20'000);
}

Double3 uniform_point(std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    return {uniform(random), uniform(random), uniform(random)};
}

// Doubles whose differences round: turned copies of flat and touching figures.
TEST(TriangleContactLaws, BothTestsFollowTheDefinitionWhereRoundingDecides) {
    constexpr std::uint32_t kSeed = 9;
    std::mt19937 random(kSeed);
    Kinds kinds;
    for (int round = 0; round < 4'000 && !HasFailure(); ++round) {
        Corners a{uniform_point(random), uniform_point(random), uniform_point(random)};
        Corners b{uniform_point(random), uniform_point(random), uniform_point(random)};
        const double s = 0.5 + 0.4 * uniform_point(random).x;
        if (round % 4 == 0) b[0] = a[0];
        if (round % 4 == 1) {  // a corner of b nearly on an edge of a
            b[0] = {a[0].x + s * (a[1].x - a[0].x), a[0].y + s * (a[1].y - a[0].y),
                    a[0].z + s * (a[1].z - a[0].z)};
        }
        if (round % 4 == 2) {  // both nearly in one plane
            for (Corners* t : {&a, &b}) {
                for (Double3& p : *t) p.z = 0.3 * p.x + 0.7 * p.y + 0.1;
            }
        }
        if (round % 8 >= 4) b[2] = a[1];
        kinds.add(expect_agreement<ExactNumber>(a, b, "round " + std::to_string(round)));
    }
    EXPECT_GT(kinds[TriangleContact::disjoint], 500) << "seed " << kSeed;
    EXPECT_GT(kinds[TriangleContact::touch], 500) << "seed " << kSeed;
    EXPECT_GT(kinds[TriangleContact::cross], 200) << "seed " << kSeed;
}

/// Two triangles of which corners, edges or insides lead past each other at a distance
/// between nothing and a hundredth, on either side.
std::array<Corners, 2> near_contact(std::mt19937& random) {
    std::uniform_real_distribution<double> part(0, 1), exponent(-56, -7);
    std::uniform_int_distribution<int> kind(0, 3);
    // A point of a triangle: a corner, on an edge, inside, anywhere in the plane.
    const auto point_of = [&](const Corners& t) {
        const int of = kind(random);
        const double u = of == 0 ? 0 : part(random);
        const double v = of < 2 ? 0 : of == 2 ? (1 - u) * part(random) : 2 * part(random) - 1;
        return Double3{t[0].x + u * (t[1].x - t[0].x) + v * (t[2].x - t[0].x),
                       t[0].y + u * (t[1].y - t[0].y) + v * (t[2].y - t[0].y),
                       t[0].z + u * (t[1].z - t[0].z) + v * (t[2].z - t[0].z)};
    };
    const Corners a{uniform_point(random), uniform_point(random), uniform_point(random)};
    Corners b{uniform_point(random), uniform_point(random), uniform_point(random)};
    const Double3 at = point_of(a), from = point_of(b), aside = uniform_point(random);
    const double gap = kind(random) == 0 ? 0 : std::exp2(exponent(random));
    for (Double3& p : b) {
        p = {p.x - from.x + at.x + gap * aside.x, p.y - from.y + at.y + gap * aside.y,
             p.z - from.z + at.z + gap * aside.z};
    }
    return {a, b};
}

// The definition in exact numbers is too slow for so many: it is asked about a hundredth.
TEST(TriangleContactLaws, BothTestsAgreeOnAMillionPairsNearContact) {
    constexpr std::uint32_t kSeed = 13;
    constexpr int kRounds = 1'000'000;
    std::mt19937 random(kSeed);
    int hits = 0, beyond_filter = 0;
    for (int round = 0; round < kRounds; ++round) {
        const auto [a, b] = near_contact(random);
        const bool touch = triangles_touch(a, b);
        ASSERT_EQ(triangles_touch_by_segments(a, b), touch) << kSeed << ", round " << round;
        ASSERT_EQ(triangles_touch(b, a), touch) << kSeed << ", round " << round;
        if (round % 100 == 0) {
            expect_agreement<ExactNumber>(a, b, "round " + std::to_string(round));
        }
        hits += touch ? 1 : 0;
        beyond_filter += contact_by_filter(a, b) ? 0 : 1;
    }
    EXPECT_GT(hits, kRounds * 3 / 10);
    EXPECT_LT(hits, kRounds * 7 / 10);
    EXPECT_GT(beyond_filter, kRounds / 20);
}

// Slivers 2^-40 thick on a grid of their own thickness.
TEST(TriangleContactLaws, BothTestsFollowTheDefinitionForSlivers) {
    constexpr std::uint32_t kSeed = 10;
    std::mt19937 random(kSeed);
    std::uniform_int_distribution<int> step(-2, 2);
    Kinds kinds;
    for (int round = 0; round < 4'000 && !HasFailure(); ++round) {
        std::array<Corners, 2> t = {grid_triangle(random, 1), grid_triangle(random, 1)};
        for (Corners& corners : t) {
            corners[2] = corners[1];
            for (Double3& p : corners) {
                p.x += 0x1p-40 * step(random);
                p.y += 0x1p-40 * step(random);
                p.z += round % 2 == 0 ? 0x1p-40 * step(random) : 0;
            }
        }
        kinds.add(expect_agreement<ExactNumber>(t[0], t[1], "round " + std::to_string(round)));
    }
    EXPECT_GT(kinds[TriangleContact::disjoint], 1'000) << "seed " << kSeed;
    EXPECT_GT(kinds[TriangleContact::touch] + kinds[TriangleContact::cross], 30);
}

// Exponents from one end of double to the other, in one triangle.
TEST(TriangleContactLaws, BothTestsFollowTheDefinitionForAllExponents) {
    constexpr std::uint32_t kSeed = 11;
    std::mt19937 random(kSeed);
    std::uniform_int_distribution<int> exponent(-2, 2);
    Kinds kinds;
    for (int round = 0; round < 3'000 && !HasFailure(); ++round) {
        std::array<Corners, 2> t = {grid_triangle(random, 1), grid_triangle(random, 1)};
        for (Corners& corners : t) {
            for (Double3& p : corners) {
                p.x = std::ldexp(p.x, 490 * exponent(random));
                p.y = std::ldexp(p.y, 490 * exponent(random));
                p.z = std::ldexp(p.z, 490 * exponent(random));
            }
        }
        kinds.add(expect_agreement<ExactNumber>(t[0], t[1], "round " + std::to_string(round)));
    }
    EXPECT_GT(kinds[TriangleContact::disjoint], 600) << "seed " << kSeed;
    EXPECT_GT(kinds[TriangleContact::touch] + kinds[TriangleContact::cross], 150);
}

// Scaling a small-integer figure by odd factors keeps every sign.
TEST(TriangleContactLaws, AreInvariantUnderShearsThatIntegersSurvive) {
    constexpr std::uint32_t kSeed = 12;
    std::mt19937 random(kSeed);
    int hits = 0;
    constexpr int kRounds = 50'000;
    for (int round = 0; round < kRounds; ++round) {
        const Corners a = grid_triangle(random, 2);
        const Corners b = grid_triangle(random, 2);
        const auto sheared = [](Corners t) {
            for (Double3& p : t) {
                p = {p.x + 1e6 * p.y - 3 * p.z, p.y + 7 * p.z, p.z - 12345 * (p.y + 7 * p.z)};
            }
            return t;
        };
        const TriangleContact kind = classify_contact(a, b);
        ASSERT_EQ(classify_contact(sheared(a), sheared(b)), kind)
            << "seed " << kSeed << ", round " << round;
        hits += kind != TriangleContact::disjoint ? 1 : 0;
    }
    EXPECT_GT(hits, kRounds / 5);
    EXPECT_LT(hits, kRounds * 7 / 10);
}

TEST(TriangleContactLaws, RelabellingChangesNothing) {
    std::mt19937 random(5);
    for (int i = 0; i < 3000; ++i) {
        const Corners a = grid_triangle(random, 2), b = grid_triangle(random, 2);
        const TriangleContact expected = classify_contact(a, b);
        std::array<int, 3> p = {0, 1, 2};
        do {
            std::array<int, 3> q = {0, 1, 2};
            do {
                const auto at = [](const Corners& t, const std::array<int, 3>& order) {
                    return Corners{t[static_cast<std::size_t>(order[0])],
                                   t[static_cast<std::size_t>(order[1])],
                                   t[static_cast<std::size_t>(order[2])]};
                };
                ASSERT_EQ(classify_contact(at(a, p), at(b, q)), expected) << "pair " << i;
                ASSERT_EQ(classify_contact(at(b, q), at(a, p)), expected) << "pair " << i;
            } while (std::next_permutation(q.begin(), q.end()));
        } while (std::next_permutation(p.begin(), p.end()));
    }
}

// Powers of two and shifts of small integers are exact, so nothing may change.
TEST(TriangleContactLaws, ScalingAndShiftingChangeNothing) {
    int asked = 0;
    std::mt19937 random(6);
    for (int i = 0; i < 2000; ++i) {
        const Corners a = grid_triangle(random, 2), b = grid_triangle(random, 2);
        const TriangleContact expected = classify_contact(a, b);
        for (const double scale :
             {0x1p-1060, 0x1p-300, 0x1p-40, 0x1p-20, 0x1p20, 0x1p300, 0x1p990}) {
            for (const double shift : {0.0, 0x1p20}) {
                const auto changed = [&](Corners t) {
                    for (Double3& p : t) {
                        p = {(p.x + shift) * scale, (p.y - shift) * scale, (p.z + shift) * scale};
                    }
                    return t;
                };
                if (shift != 0 && scale > 0x1p980) continue;  // beyond kMaxCoordinate
                ++asked;
                ASSERT_EQ(classify_contact(changed(a), changed(b)), expected)
                    << "pair " << i << ", scale " << scale << ", shift " << shift;
            }
        }
    }
    EXPECT_EQ(asked, 2000 * (2 * 7 - 1));
}

}  // namespace
}  // namespace cdprep::test
