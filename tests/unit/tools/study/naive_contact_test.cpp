// SPDX-License-Identifier: MIT
#include "study/naive_contact.h"

#include <gtest/gtest.h>

#include <random>

#include "exact/triangle_contact.h"

namespace cdprep::study {
namespace {

using Double = NaiveContact<double>;
using Float = NaiveContact<float>;

// On small integers double is exact; planes in common apart, which it takes to be apart.
TEST(NaiveContact, IsRightWhereItsArithmeticIsExact) {
    std::mt19937 random(77);
    std::uniform_int_distribution<int> grid(-5, 5);
    const auto corner = [&] {
        return Double3{double(grid(random)), double(grid(random)), double(grid(random))};
    };
    const Double test(0);
    int touches = 0;
    int cases = 0;
    for (int i = 0; i < 20'000; ++i) {
        const Corners a = {corner(), corner(), corner()};
        const Corners b = {corner(), corner(), corner()};
        if (is_degenerate(a) || is_degenerate(b)) continue;
        const TriangleContact exact = classify_contact(a, b);
        const bool found = test.touch(Double::rounded(a), Double::rounded(b));
        if (exact == TriangleContact::cross || exact == TriangleContact::disjoint) {
            EXPECT_EQ(found, exact == TriangleContact::cross);
        }
        ++cases;
        touches += exact != TriangleContact::disjoint ? 1 : 0;
    }
    EXPECT_GT(touches, cases / 20);
    EXPECT_LT(touches, cases / 2);
}

// By hand: a gap of 1e-9 beside coordinates of 1 is lost in float, and seen in double.
TEST(NaiveContact, FloatLosesWhatDoubleSees) {
    const Corners floor = {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};
    const Corners above = {{{1, 1, 1 + 1e-9}, {1, 1, 3}, {1.5, 1, 3}}};
    const Corners raised = {{{0, 0, 1}, {4, 0, 1}, {0, 4, 1}}};
    EXPECT_FALSE(Double(0).touch(Double::rounded(raised), Double::rounded(above)));
    EXPECT_TRUE(Float(0).touch(Float::rounded(raised), Float::rounded(above)));
    EXPECT_FALSE(Float(0).touch(Float::rounded(floor), Float::rounded(above)));
}

}  // namespace
}  // namespace cdprep::study
