// SPDX-License-Identifier: MIT
#include "cdprep/result.h"

#include <gtest/gtest.h>

#include <string>

namespace cdprep {
namespace {

Result<std::string> failed() {
    return Error{ErrorCode::unreadable, "box.obj: vertex 7 is not a number."};
}

TEST(Result, HasEitherAValueOrAnError) {
    Result<std::string> made = std::string("made");
    EXPECT_TRUE(made);
    EXPECT_EQ(made.value(), "made");
    EXPECT_EQ(made->size(), 4U);
    EXPECT_EQ(*std::move(made), "made");
    EXPECT_FALSE(failed());
    EXPECT_EQ(failed().error().code, ErrorCode::unreadable);
}

// By the header: in every build, with the message of the error.
TEST(ResultDeathTest, UsingTheValueOfAnErrorStopsTheProgram) {
    Result<std::string> wrong = failed();
    const Result<std::string>& fixed = wrong;
    constexpr auto kSentence = "box.obj: vertex 7 is not a number";
    EXPECT_DEATH((void)wrong.value(), kSentence);
    EXPECT_DEATH((void)fixed.value(), kSentence);
    EXPECT_DEATH((void)failed().value(), kSentence);
    EXPECT_DEATH((void)*wrong, kSentence);
    EXPECT_DEATH((void)fixed->size(), kSentence);
}

TEST(ResultDeathTest, UsingTheErrorOfAValueStopsTheProgram) {
    const Result<std::string> made = std::string("made");
    EXPECT_DEATH((void)made.error(), "holds a value");
}

}  // namespace
}  // namespace cdprep
