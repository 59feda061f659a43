// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "predicates.h"
#include "triangle_contact.h"

namespace cdprep {
namespace {

Corners grid_triangle(std::mt19937& random, int grid) {
    std::uniform_int_distribution<int> step(-grid, grid);
    Corners t{};
    for (Double3& p : t) {
        const int x = step(random), y = step(random), z = step(random);
        p = {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
    }
    return t;
}

/// The signs of each triangle's corners against the other's plane, in one number.
int sign_pattern(const Corners& a, const Corners& b) {
    int pattern = 0;
    for (const Double3& p : a) pattern = 3 * pattern + orient3d(b[0], b[1], b[2], p) + 1;
    for (const Double3& p : b) pattern = 3 * pattern + orient3d(a[0], a[1], a[2], p) + 1;
    return pattern;
}

// Two implementations that share no test but the predicates must agree always.
// Small integers reach every pair of sign patterns that two planes can show.
TEST(TriangleContactLaws, BothTestsAgreeOverAllSignPatterns) {
    constexpr std::uint32_t kSeed = 20261121;
    constexpr int kPairs = 1'200'000;
    constexpr int kAllZero = 13;  // three zeros in base 3 with digits 1
    std::mt19937 random(kSeed);
    std::set<int> patterns;
    int touching = 0;
    for (int i = 0; i < kPairs; ++i) {
        const int grid = 1 + i % 4;
        const Corners a = grid_triangle(random, grid), b = grid_triangle(random, grid);
        const bool touch = triangles_touch(a, b);
        ASSERT_EQ(touch, triangles_touch_by_segments(a, b)) << "seed " << kSeed << ", pair " << i;
        const int pattern = sign_pattern(a, b);
        if (pattern / 27 != kAllZero && pattern % 27 != kAllZero) patterns.insert(pattern);
        touching += touch ? 1 : 0;
    }
    EXPECT_EQ(patterns.size(), 26u * 26u);
    EXPECT_GT(touching, kPairs * 2 / 10);
    EXPECT_LT(touching, kPairs * 8 / 10);
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
                ASSERT_EQ(classify_contact(changed(a), changed(b)), expected)
                    << "pair " << i << ", scale " << scale << ", shift " << shift;
            }
        }
    }
}

}  // namespace
}  // namespace cdprep
