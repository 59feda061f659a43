// SPDX-License-Identifier: MIT
#include "study/timing.h"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <thread>

namespace cdprep::study {
namespace {

// By hand: of 1, 2, 3, 4 two are at most 2; 95 % of 20 values are 19.
TEST(Quantile, IsTheNearestRank) {
    EXPECT_EQ(quantile({4, 1, 3, 2}, 0.5), 2);
    EXPECT_EQ(quantile({4, 1, 3, 2}, 1), 4);
    EXPECT_EQ(quantile({4, 1, 3, 2}, 0), 1);
    EXPECT_EQ(quantile({}, 0.5), 0);
    std::vector<double> twenty;
    for (int i = 20; i > 0; --i) twenty.push_back(i);
    EXPECT_EQ(quantile(twenty, 0.95), 19);
    EXPECT_EQ(quantile(twenty, 0.999), 20);
}

// By hand: the medians of the cases are 2, 20 and 3, theirs is 3.
TEST(TimingOf, ACaseIsTheMedianOfItsRounds) {
    const Timings timings{{{2, 1, 90}, {20, 20, 10}, {3, 3, 3}}, {5, 1, 1}};
    const Timing timing = timing_of(timings);
    EXPECT_EQ(timing.median_s, 3);
    EXPECT_EQ(timing.p95_s, 20);
    EXPECT_EQ(timing.p999_s, 20);
    EXPECT_EQ(timing.cases, 3U);
    EXPECT_EQ(timing.rounds, 3U);
    EXPECT_EQ(timing.asked, 3U * 5 + 3 + 3);
    EXPECT_LE(timing.low_s, timing.median_s);
    EXPECT_GE(timing.high_s, timing.median_s);
    const std::array<std::size_t, 1> second = {1};
    EXPECT_EQ(timing_of(timings, second).median_s, 20);
    EXPECT_EQ(timing_of({}).median_s, 0);
}

// Stopped in the middle, some cases have no rounds.
TEST(TimingOf, LeavesOutCasesThatWereNotMeasured) {
    const Timings timings{{{2}, {}, {}}, {1}};
    const Timing timing = timing_of(timings);
    EXPECT_EQ(timing.median_s, 2);
    EXPECT_EQ(timing.cases, 1U);
    EXPECT_EQ(timing_of(Timings{{{}, {}}, {}}).median_s, 0);
}

// By hand: the rounds' sums are 3 and 6, of the other 2 and 2.
TEST(RatioOf, ComparesRoundByRound) {
    const Timings slow{{{1, 2}, {2, 4}}, {1, 1}};
    const Timings fast{{{1, 1}, {1, 1}}, {1, 1}};
    const TimeRatio ratio = ratio_of(slow, fast);
    EXPECT_EQ(ratio.low, 1.5);
    EXPECT_EQ(ratio.high, 3);
    EXPECT_FALSE(ratio.holds_one());
    const TimeRatio same = ratio_of(slow, slow);
    EXPECT_EQ(same.ratio, 1);
    EXPECT_TRUE(same.holds_one());
}

TEST(TimeQuestions, AsksEveryCaseInEveryRound) {
    std::array<std::size_t, 3> asked{};
    const std::vector<Question> questions = {question_of([&](std::size_t i) { return ++asked[i]; }),
                                             question_of([](std::size_t i) { return i; })};
    const auto timings =
        time_questions(asked.size(), questions, {.rounds = 4, .least_sample_s = 1e-6});
    ASSERT_EQ(timings.size(), 2U);
    for (const Timings& one : timings) {
        ASSERT_EQ(one.seconds.size(), asked.size());
        for (const auto& rounds : one.seconds) EXPECT_EQ(rounds.size(), 4U);
    }
    for (std::size_t i = 0; i < asked.size(); ++i) EXPECT_GE(asked[i], 4 * timings[0].times[i]);
}

// A question that takes 1 us of counting is asked until the sample is long enough.
TEST(TimeQuestions, AsksShortQuestionsOften) {
    const Question question = question_of([](std::size_t i) { return i; });
    const auto timings =
        time_questions(1, std::span(&question, 1), {.rounds = 1, .least_sample_s = 1e-3});
    EXPECT_GT(timings[0].times[0], 100U);
}

// By hand: once to find out, then once a round.
TEST(TimeQuestions, AsksLongQuestionsOnceARound) {
    std::size_t asked = 0;
    const Question question = question_of([&](std::size_t) { return ++asked; });
    const auto timings =
        time_questions(3, std::span(&question, 1), {.rounds = 2, .least_sample_s = 0});
    EXPECT_EQ(asked, 9U);
    EXPECT_EQ(timings[0].times, (std::vector<std::size_t>{1, 1, 1}));
}

TEST(TimeQuestions, EndsWhenItIsToStop) {
    std::size_t asked = 0;
    const Question question = question_of([&](std::size_t) { return ++asked; });
    static_cast<void>(time_questions(100, std::span(&question, 1),
                                     {.rounds = 1'000'000, .stop = [&] { return asked > 500; }}));
    EXPECT_GT(asked, 500U);
}

// A thread that sleeps takes time by the wall, and next to none of the processor.
TEST(TimeQuestions, TheWallCountsWhatTheThreadDoesNot) {
    const std::array<Question, 1> sleeps = {question_of([](std::size_t) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        return 0;
    })};
    TimingOptions options = {.rounds = 1, .least_sample_s = 0, .by = TimedBy::wall};
    EXPECT_GE(time_questions(1, sleeps, options)[0].seconds[0][0], 0.005);
    options.by = TimedBy::thread;
    EXPECT_LT(time_questions(1, sleeps, options)[0].seconds[0][0], 0.005);
}

// By hand: two questions, three cases, two rounds, and none asked twice in a measurement.
TEST(TimeQuestions, WhatComesBeforeComesBeforeEveryQuestion) {
    std::array<int, 2> before{};
    std::array<int, 2> asked{};
    const auto question = [&](std::size_t q) {
        return question_of([&asked, q](std::size_t) { return ++asked[q]; });
    };
    const std::array<Question, 2> questions = {question(0), question(1)};
    TimingOptions options = {.rounds = 2};
    options.before = [&](std::size_t q) {
        EXPECT_EQ(before[q], asked[q]);
        ++before[q];
    };
    const auto timings = time_questions(3, questions, options);
    EXPECT_EQ(asked, (std::array<int, 2>{6, 6}));
    EXPECT_EQ(before, asked);
    EXPECT_EQ(timings[1].times, (std::vector<std::size_t>{1, 1, 1}));
}

}  // namespace
}  // namespace cdprep::study
