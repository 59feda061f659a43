// SPDX-License-Identifier: MIT
#include "cdprep/format/portable.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <random>

namespace cdprep::format {
namespace {

TEST(Portable, CastsBits) {
    EXPECT_EQ(bit_cast<std::uint32_t>(1.0F), 0x3f800000U);
    EXPECT_EQ(bit_cast<double>(std::uint64_t{0x4000000000000000}), 2.0);
}

TEST(Portable, FindsAndCountsBits) {
    for (unsigned i = 0; i < 32; ++i) {
        EXPECT_EQ(lowest_set_bit(std::uint32_t{1} << i), i);
        EXPECT_EQ(lowest_set_bit(0xffffffffU << i), i);
        EXPECT_EQ(count_set_bits(0xffffffffU << i), 32 - i);
    }
    for (unsigned i = 0; i < 64; ++i) EXPECT_EQ(lowest_set_bit(~std::uint64_t{0} << i), i);
    EXPECT_EQ(count_set_bits(0), 0u);
}

// By hand: products and sums that carry from the lower word into the upper one.
TEST(Portable, TwoWordsCarry) {
    const TwoWordInteger most = ~std::uint64_t{0};
    EXPECT_EQ(static_cast<std::uint64_t>(most + TwoWordInteger(1)), 0u);
    EXPECT_EQ(upper_word(most + TwoWordInteger(1)), TwoWordInteger(1));
    EXPECT_EQ(upper_word(most * most), TwoWordInteger(-2));  // it wraps around
    EXPECT_EQ(static_cast<std::uint64_t>(most * most), 1u);
    EXPECT_EQ(upper_word(TwoWordInteger(-1)), TwoWordInteger(-1));
    EXPECT_LT(TwoWordInteger(-1), TwoWordInteger(0));
    EXPECT_LT(TwoWordInteger(0) - most, TwoWordInteger(-1));
}

#if defined(__SIZEOF_INT128__)
/// Whether the words of both numbers are the same.
testing::AssertionResult are_same(const TwoWordInteger& a, Int128 b) {
    const bool same =
        static_cast<std::uint64_t>(a) == static_cast<std::uint64_t>(b) &&
        static_cast<std::uint64_t>(upper_word(a)) == static_cast<std::uint64_t>(upper_word(b));
    return same ? testing::AssertionSuccess() : testing::AssertionFailure();
}

TEST(Portable, TwoWordsComputeAsTheCompilersInteger) {
    std::mt19937_64 random(1);
    // Numbers of all lengths, so that every carry occurs.
    const auto draw = [&] { return static_cast<std::int64_t>(random()) >> (random() % 64); };
    for (int i = 0; i < 20000; ++i) {
        const std::array<std::int64_t, 4> n = {draw(), draw(), draw(), draw()};
        const TwoWordInteger a = TwoWordInteger(n[0]) * n[1], b = TwoWordInteger(n[2]) * n[3];
        const Int128 c = Int128{n[0]} * n[1], d = Int128{n[2]} * n[3];
        ASSERT_TRUE(are_same(a, c)) << n[0] << " " << n[1];
        ASSERT_TRUE(are_same(a + b, c + d));
        ASSERT_TRUE(are_same(a - b, c - d));
        ASSERT_TRUE(are_same(upper_word(a) * n[2], upper_word(c) * n[2]));
        const auto word = static_cast<std::uint64_t>(n[3]);
        ASSERT_TRUE(are_same(TwoWordInteger(word) * n[0], Int128{word} * n[0]));
        ASSERT_EQ(a < b, c < d);
        ASSERT_EQ(a == TwoWordInteger(0), c == 0);
    }
}
#endif

}  // namespace
}  // namespace cdprep::format
