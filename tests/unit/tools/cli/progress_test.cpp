// SPDX-License-Identifier: MIT
#include "cli/progress.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>

#include "cli/quiet.h"

namespace cdprep::cli {
namespace {

// This program was not asked to be quiet.
TEST(ParseProgress, KnowsEveryWord) {
    ASSERT_FALSE(is_quiet());
    EXPECT_EQ(parse_progress("none").value(), ProgressStyle::none);
    EXPECT_EQ(parse_progress("plain").value(), ProgressStyle::plain);
    EXPECT_EQ(parse_progress("bar").value(), ProgressStyle::bar);
}

TEST(ParseProgress, DrawsNoBarByItselfOutsideATerminal) {
    testing::internal::CaptureStderr();  // into a file
    const Result<ProgressStyle> style = parse_progress("auto");
    testing::internal::GetCapturedStderr();
    EXPECT_EQ(style.value(), ProgressStyle::none);
}

TEST(ParseProgress, RefusesAnotherWord) {
    for (const char* word : {"", "Bar", "plainer"}) {
        const Result<ProgressStyle> style = parse_progress(word);
        ASSERT_FALSE(style) << word;
        EXPECT_EQ(style.error().code, ErrorCode::bad_argument) << word;
    }
}

// The pause covers two updates of a bar.
TEST(Progress, DrawsNothingAfterClear) {
    testing::internal::CaptureStderr();
    Progress progress(ProgressStyle::bar, 2);
    progress.show(1, "a mesh");
    progress.clear();
    const std::string before = testing::internal::GetCapturedStderr();
    EXPECT_NE(before.find("1/2 a mesh"), std::string::npos);
    testing::internal::CaptureStderr();
    std::this_thread::sleep_for(std::chrono::milliseconds(700));
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace cdprep::cli
