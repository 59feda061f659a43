// SPDX-License-Identifier: MIT
#include "cli/progress.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <thread>

#include "cli/quiet.h"

namespace cdprep::cli {
namespace {

// This program was not asked to be quiet.
TEST(ParseProgress, KnowsEveryWord) {
    ASSERT_FALSE(is_quiet());
    EXPECT_EQ(parse_progress("none"), ProgressStyle::none);
    EXPECT_EQ(parse_progress("plain"), ProgressStyle::plain);
    EXPECT_EQ(parse_progress("bar"), ProgressStyle::bar);
}

TEST(ParseProgress, DrawsNoBarByItselfOutsideATerminal) {
    testing::internal::CaptureStderr();  // into a file
    const ProgressStyle style = parse_progress("auto");
    testing::internal::GetCapturedStderr();
    EXPECT_EQ(style, ProgressStyle::none);
}

// By hand: 3 of 4 steps in 6 seconds, so 2 seconds for the last.
TEST(TimeLeft, IsThatOfTheMeanStep) {
    using std::chrono::seconds;
    EXPECT_EQ(time_left_text(seconds(6), 3, 4), ", 2 s left");
    EXPECT_EQ(time_left_text(seconds(10), 1, 19), ", 3 min left");
    EXPECT_EQ(time_left_text(seconds(3600), 1, 3), ", 2 h left");
    EXPECT_EQ(time_left_text(seconds(6), 4, 4), ", 0 s left");
    EXPECT_EQ(time_left_text(seconds(6), 0, 4), "") << "not known yet";
    EXPECT_EQ(time_left_text(seconds(6), 5, 4), "");
}

// A loop whose steps take 1, 2, 3, ... seconds. After 40 of 80 steps 820 s have passed and 2420 s
// remain. The mean promises 820 s; the last steps promise much more.
TEST(LoopPace, IsThatOfTheLastSteps) {
    using std::chrono::seconds;
    LoopPace pace;
    LoopPace::Clock::time_point now{};
    pace.begin({now, 0});
    for (std::size_t done = 1; done <= 40; ++done) {
        now += seconds(done);
        pace.advance({now, done});
    }
    const LoopPace::Mark& base = pace.base(40);
    EXPECT_GE(base.done, 30u) << "at about four fifths of the time";
    EXPECT_LT(base.done, 40u);
    const std::chrono::duration<double> passed = now - base.time;
    const double left = passed.count() / static_cast<double>(40 - base.done) * 40;
    EXPECT_GT(left, 1300);
    EXPECT_LT(left, 1600) << "steps get slower still";
}

// A step that takes longer than all others before it.
TEST(LoopPace, BeginsWithTheLoop) {
    using std::chrono::seconds;
    LoopPace pace;
    const LoopPace::Clock::time_point now{};
    pace.begin({now, 5});
    EXPECT_EQ(pace.base(5).done, 5u);
    pace.advance({now, 5});
    pace.advance({now + seconds(10), 6});
    pace.advance({now + seconds(100), 6});
    pace.advance({now + seconds(1000), 6});
    EXPECT_EQ(pace.base(6).done, 5u) << "no step since";
}

// A fast loop would otherwise write a line for each step.
TEST(Progress, ALoopIsDrawnSeldom) {
    testing::internal::CaptureStderr();
    {
        Progress progress(ProgressStyle::plain, 100'000);
        for (std::size_t i = 0; i < 100'000; ++i) progress.advance(i, "frame");
    }
    const std::string drawn = testing::internal::GetCapturedStderr();
    EXPECT_EQ(drawn.find("0/100000 frame"), 0u);
    EXPECT_LE(std::count(drawn.begin(), drawn.end(), '\n'), 3) << drawn;
}

// A bar moves several times a second; lines of a log are far apart.
TEST(Progress, ABarIsDrawnMoreOftenThanLines) {
    const auto drawn_by = [](ProgressStyle style) {
        testing::internal::CaptureStderr();
        {
            Progress progress(style, 3);
            for (std::size_t i = 0; i < 3; ++i) {
                progress.advance(i, "frame");
                std::this_thread::sleep_for(std::chrono::milliseconds(300));
            }
        }
        const std::string drawn = testing::internal::GetCapturedStderr();
        return std::count(drawn.begin(), drawn.end(), '/');
    };
    EXPECT_GE(drawn_by(ProgressStyle::bar), 3);
    EXPECT_LE(drawn_by(ProgressStyle::plain), 2);
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
