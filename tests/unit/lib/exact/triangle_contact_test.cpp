// SPDX-License-Identifier: MIT
#include "exact/triangle_contact.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "support/hard_triangles.h"

namespace cdprep::test {
namespace {

bool is_proper(TriangleContact kind) {
    return kind == TriangleContact::cross || kind == TriangleContact::coplanar_overlap;
}

void expect_answers(const HardPair& pair, const std::string& change) {
    ASSERT_EQ(triangles_touch(pair.a, pair.b), pair.closed) << pair.id << change;
    ASSERT_EQ(triangles_touch_by_segments(pair.a, pair.b), pair.closed) << pair.id << change;
    const TriangleContact kind = classify_contact(pair.a, pair.b);
    ASSERT_EQ(kind != TriangleContact::disjoint, pair.closed) << pair.id << change;
    ASSERT_EQ(is_proper(kind), pair.proper) << pair.id << change;
}

// The catalogue knows the answers (by hand, or by the definition).
TEST(TriangleContact, KnowsTheHardCases) {
    for (const HardPair& pair : hard_triangles()) expect_answers(pair, "");
}

TEST(TriangleContact, HardCasesAreNotOneSided) {
    int touching = 0, crossing = 0, apart = 0;
    std::set<std::string> families;
    for (const HardPair& pair : hard_triangles()) {
        ++(pair.proper ? crossing : pair.closed ? touching : apart);
        families.insert(pair.id.substr(0, 3));
    }
    EXPECT_GE(touching, 15);
    EXPECT_GE(crossing, 15);
    EXPECT_GE(apart, 5);
    EXPECT_EQ(families.size(), 19U);  // all but T15, T17, T18 and T20: tests of their own
}

TEST(TriangleContact, DoesNotDependOnTheOrderOfCornersOrTriangles) {
    for (const HardPair& pair : hard_triangles()) {
        for (std::size_t i = 0; i < kRelabellings; ++i) {
            expect_answers(relabelled(pair, i), ", relabelling " + std::to_string(i));
        }
    }
}

TEST(TriangleContact, DoesNotDependOnTheAxes) {
    for (const HardPair& pair : hard_triangles()) {
        for (std::size_t i = 0; i < kAxisTurns; ++i) {
            for (const std::size_t label : {0U, 11U, 41U, 58U}) {
                expect_answers(relabelled(turned(pair, i), label), ", turn " + std::to_string(i));
            }
        }
    }
}

// T17, T18 and every size between.
TEST(TriangleContact, DoesNotDependOnTheUnitOfLength) {
    for (const int exponent : {-1060, -1030, -700, -400, -40, -20, 20, 40, 300, 500, 990}) {
        int tested = 0;
        for (const HardPair& pair : hard_triangles()) {
            const auto changed = scaled(pair, exponent);
            if (!changed) continue;
            ++tested;
            for (std::size_t i = 0; i < kRelabellings; ++i) {
                expect_answers(relabelled(*changed, i), ", times 2^" + std::to_string(exponent));
            }
        }
        EXPECT_GE(tested, 10) << exponent;
    }
}

// T15: shifts that every coordinate survives.
TEST(TriangleContact, DoesNotDependOnTheOrigin) {
    for (const double shift : {0x1p10, -0x1p20, 0x1p20, 0x1p30, 0x1p40}) {
        int tested = 0;
        for (const HardPair& pair : hard_triangles()) {
            const auto changed = shifted(pair, shift);
            if (!changed) continue;
            ++tested;
            for (std::size_t i = 0; i < kRelabellings; ++i) {
                expect_answers(relabelled(*changed, i), ", plus " + std::to_string(shift));
            }
        }
        EXPECT_GE(tested, 12) << shift;
    }
}

// Kinds that are told apart beyond closed and proper, by hand.
TEST(TriangleContact, TellsCrossingFromSharedArea) {
    const Corners a = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    EXPECT_EQ(classify_contact(a, a), TriangleContact::coplanar_overlap);
    EXPECT_EQ(classify_contact(a, {{{0.25, 0.25, -1}, {0.25, 0.25, 1}, {3, 3, 1}}}),
              TriangleContact::cross);
    EXPECT_EQ(classify_contact(a, {{{0.25, 0.25, 0}, {0.25, 0.25, 1}, {0.5, 0.25, 1}}}),
              TriangleContact::touch);
    EXPECT_EQ(classify_contact(a, {{{2, 2, -1}, {2, 2, 1}, {3, 3, 1}}}), TriangleContact::disjoint);
}

TEST(TriangleContact, CollinearCornersAreDegenerate) {
    EXPECT_TRUE(is_degenerate({{{0, 0, 0}, {1, 2, 3}, {2, 4, 6}}}));
    EXPECT_TRUE(is_degenerate({{{1, 2, 3}, {1, 2, 3}, {2, 4, 7}}}));
    EXPECT_TRUE(is_degenerate({{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}}));
    EXPECT_FALSE(is_degenerate({{{0, 0, 0}, {1, 0, 0}, {2, 0x1p-1074, 0}}}));
    EXPECT_FALSE(is_degenerate({{{0, 0, 0}, {0.1, 0.2, 0.3}, {0.2, 0.4, 0.6000000000000001}}}));
}

}  // namespace
}  // namespace cdprep::test
