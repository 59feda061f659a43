// SPDX-License-Identifier: MIT
#include "decompose/enclose/body_mass.h"

#include <gtest/gtest.h>

#include <vector>

#include "unit/tools/soup_of.h"

namespace cdprep::cli {
namespace {

using convex::ConvexHull;
using test::joined;
using test::moved_by;
using test::reversed;
using test::TestMesh;
using test::unit_cube;

/// Weighs with one part for each of the boxes.
std::optional<WeighedBody> weigh_boxes(const TestMesh& mesh, const std::vector<TestMesh>& boxes,
                                       const WeighOptions& options = {.is_balanced = true}) {
    std::vector<ConvexHull> parts;
    for (const TestMesh& box : boxes) parts.push_back(convex::convex_hull(box.positions));
    return weigh(test::welded(mesh), parts, options);
}

const TestMesh kSmall = unit_cube();
const TestMesh kLarge = moved_by(unit_cube(), 2, {5, 0, 0});

TEST(Weigh, ASolidIsExact) {
    const TestMesh both = joined(kSmall, kLarge);
    for (const TestMesh& mesh : {both, reversed(both)}) {
        const auto weighed =
            weigh_boxes(mesh, {moved_by(unit_cube(), 7, {})},
                        {.is_balanced = true, .density = 1000, .metres_per_unit = 0.5});
        ASSERT_TRUE(weighed);
        EXPECT_EQ(weighed->of, MassOf::solid);
        EXPECT_NEAR(weighed->body.mass, 9000 * 0.125, 1e-9);
    }
}

// Volumes 1 and 8. The search encloses either.
TEST(Weigh, AComponentInsideOutIsNotSubtracted) {
    for (const TestMesh& mesh :
         {joined(reversed(kSmall), kLarge), joined(kSmall, reversed(kLarge))}) {
        const auto weighed = weigh_boxes(mesh, {kSmall, kLarge});
        ASSERT_TRUE(weighed);
        EXPECT_EQ(weighed->of, MassOf::parts);
        EXPECT_NEAR(weighed->body.mass, 9, 1e-12);
    }
}

// Volumes of 8 overlap in 4: the solid has 12.
TEST(Weigh, OverlapsAreToldOf) {
    const TestMesh one = moved_by(unit_cube(), 2, {}), other = moved_by(unit_cube(), 2, {1, 0, 0});
    const auto weighed = weigh_boxes(joined(one, other), {one, other});
    ASSERT_TRUE(weighed);
    EXPECT_EQ(weighed->of, MassOf::mesh);
    EXPECT_NEAR(weighed->body.mass, 16, 1e-12);
    EXPECT_NE(text_of(weighed->of).find("by its winding number"), std::string::npos);
}

// By hand: half of the small box is in the large one and counts 0 times; the rest of it counts -1
// times. So 8 - 1/2 - 1/2.
TEST(Weigh, AnInvertedBoxThatCrossesAnotherIsToldOf) {
    const TestMesh large = moved_by(unit_cube(), 2, {});
    const TestMesh small = moved_by(unit_cube(), 1, {0.5, 0.5, 1.5});
    const auto weighed = weigh_boxes(joined(large, reversed(small)), {large, small});
    ASSERT_TRUE(weighed);
    EXPECT_EQ(weighed->of, MassOf::mesh);
    EXPECT_NEAR(weighed->body.mass, 7, 1e-12);
    EXPECT_NE(text_of(weighed->of).find("which may be negative"), std::string::npos);
}

TEST(Weigh, WhatIsNotBalancedHasTheMassOfTheParts) {
    const auto weighed = weigh_boxes(kSmall, {kLarge}, {.is_balanced = false});
    ASSERT_TRUE(weighed);
    EXPECT_EQ(weighed->of, MassOf::parts);
    EXPECT_NEAR(weighed->body.mass, 8, 1e-12);
}

// A sheet with two sides has the volume 0, and so has its hull. Rounded sums say otherwise.
TEST(Weigh, ASheetWithTwoSidesHasNoMass) {
    for (int i = 0; i < 20; ++i) {
        const TestMesh sheet = test::turned(test::grid_sheet(4, 4), 0.3 * i + 0.1);
        EXPECT_FALSE(weigh_boxes(joined(sheet, reversed(sheet)), {sheet})) << i;
        const auto weighed = weigh_boxes(joined(sheet, reversed(sheet)), {kSmall});
        ASSERT_TRUE(weighed);
        EXPECT_EQ(weighed->of, MassOf::parts);
    }
}

TEST(Weigh, WordsAreThoseOfTheSchema) {
    EXPECT_STREQ(word_of(MassOf::solid), "solid");
    EXPECT_STREQ(word_of(MassOf::mesh), "mesh");
    EXPECT_STREQ(word_of(MassOf::parts), "parts");
    EXPECT_EQ(text_of(MassOf::solid), "the solid");
}

}  // namespace
}  // namespace cdprep::cli
