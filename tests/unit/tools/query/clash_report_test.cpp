// SPDX-License-Identifier: MIT
#include "query/clash_report.h"

#include <gtest/gtest.h>

#include <string>

namespace cdprep::report {
namespace {

constexpr TrianglePair kPairs[] = {{17, 4}, {18, 4}};

PairAnswer two_pairs() {
    PairAnswer answer;
    answer.hit = true;
    answer.count = 2;
    answer.pairs = kPairs;
    return answer;
}

ClashSummary summary() {
    ClashSummary summary;
    summary.scene = "s.json";
    summary.objects = 3;
    summary.models = 1;
    summary.possible = 3;
    summary.candidates = 2;
    summary.counts = {.queried = 2, .clashes = 1, .undecided = 0, .seconds = 0.00024681};
    return summary;
}

TEST(ClashReport, ALineHasTheMembersOfTheQuery) {
    const ClashReport report(Ask::overlap, AnswerFormat::ndjson);
    EXPECT_EQ(report.begin(), "");
    EXPECT_EQ(report.line("a\"b", "c", two_pairs()),
              "{\"a\": \"a\\\"b\", \"b\": \"c\", \"effect\": \"overlap\", \"hit\": true, "
              "\"count\": 2, \"pairs\": [[17, 4], [18, 4]]}\n");
    const ClashReport within(Ask::within, AnswerFormat::ndjson);
    WithinAnswer near;
    near.within = true;
    EXPECT_EQ(within.line("a", "b", near),
              "{\"a\": \"a\", \"b\": \"b\", \"effect\": \"within\", \"within\": true}\n");
}

TEST(ClashReport, TextNamesBothObjects) {
    ClashReport report(Ask::overlap, AnswerFormat::text);
    EXPECT_EQ(report.line("a\nb", "c", two_pairs()), "a\\nb and c: hit, 2 pairs\n  17 4\n  18 4\n");
    EXPECT_EQ(report.finish(summary()),
              "3 objects of 1 model, 3 possible pairs: 2 candidates, 2 queried, 1 clash; 0.000123 "
              "s a pair\n");
    ClashSummary more = summary();
    more.counts = {.queried = 2, .clashes = 2, .undecided = 1, .seconds = 0};
    more.largest = 0.5;
    more.rounding = 1e-7;
    const ClashReport within(Ask::within, AnswerFormat::text);
    EXPECT_EQ(within.finish(more),
              "3 objects of 1 model, 3 possible pairs: 2 candidates, 2 queried, 2 clashes, 1 "
              "undecided; tolerance 0.5; transforms were rounded to rigid ones by 1e-07; 0 s a "
              "pair\n");
}

// The first line has no comma before it, whichever chunk it is in.
TEST(ClashReport, JsonIsOneObject) {
    ClashReport report(Ask::distance, AnswerFormat::json);
    std::string text = report.begin() + report.next("");
    const DistanceAnswer found{.distance = Distance{}};
    text += report.next(report.line("a", "b", found) + report.line("a", "c", found));
    text += report.next("") + report.next(report.line("b", "c", found)) + report.finish(summary());
    EXPECT_EQ(text.substr(0, 34), "{\"clashes\": [\n {\"a\": \"a\", \"b\": \"b\"");
    EXPECT_NE(text.find("},\n {\"a\": \"b\", \"b\": \"c\""), std::string::npos) << text;
    EXPECT_NE(text.find("}],\n\"summary\": {\"scene\":\"s.json\""), std::string::npos) << text;
    EXPECT_NE(text.find("\"max_distance\":0.0,\"rounding\":0.0,\"seconds_per_pair\":0.000123}}\n"),
              std::string::npos)
        << text;
}

}  // namespace
}  // namespace cdprep::report
