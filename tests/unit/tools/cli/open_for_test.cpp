// SPDX-License-Identifier: MIT
#include "cli/open_for.h"

#include <gtest/gtest.h>

namespace cdprep::cli {
namespace {

// FBX stores its unit as a float, and so other tools may round a unit too.
TEST(UnlikeUnits, RoundingToAFloatDoesNotCount) {
    for (const double unit : {0.001, 0.01, 0.0254, 0.3048, 1.0}) {
        EXPECT_FALSE(are_unlike_units(unit, unit));
        EXPECT_FALSE(are_unlike_units(unit, static_cast<double>(static_cast<float>(unit))));
        EXPECT_FALSE(are_unlike_units(static_cast<double>(static_cast<float>(unit)), unit));
        EXPECT_FALSE(are_unlike_units(unit, 0)) << "an unknown unit";
        EXPECT_FALSE(are_unlike_units(0, unit)) << "an unknown unit";
        EXPECT_TRUE(are_unlike_units(unit, unit * (1 + 2e-6)));
        EXPECT_TRUE(are_unlike_units(unit * (1 + 2e-6), unit));
    }
    EXPECT_TRUE(are_unlike_units(0.001, 0.0254));
}

TEST(UnlikeUnits, TheErrorNamesBothFilesAndUnits) {
    EXPECT_FALSE(find_unlike_units("a.obj", 0.001, "b.obj", 0.001));
    const auto error = find_unlike_units("a.obj", 0.001, "b.obj", 0.0254);
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code, ErrorCode::bad_argument);
    EXPECT_EQ(error->message.find("a.obj is in mm, but b.obj is in in. "), 0U) << error->message;
}

}  // namespace
}  // namespace cdprep::cli
