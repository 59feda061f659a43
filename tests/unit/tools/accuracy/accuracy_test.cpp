// SPDX-License-Identifier: MIT
#include "accuracy/accuracy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "accuracy/accuracy_chart.h"
#include "accuracy/accuracy_report.h"
#include "unit/tools/soup_of.h"

namespace cdprep::study {
namespace {

const Rung& rung_of(const Ladder& ladder, const std::string& name) {
    const auto at = std::ranges::find(ladder.rungs, name, &Rung::name);
    EXPECT_NE(at, ladder.rungs.end()) << ladder.name << ", " << name;
    return *at;
}

/// Shares of the work and steps as they were told, one after the other.
struct Told {
    std::vector<double> shares;
    std::vector<std::string> steps;  ///< each once where it came several times in a row
};
Told& told() {
    static Told all;
    return all;
}
void keep(double share, const std::string& step) {
    told().shares.push_back(share);
    if (told().steps.empty() || told().steps.back() != step) told().steps.push_back(step);
}

/// One study serves all tests: it takes seconds.
const AccuracyStudy& studied() {
    static const AccuracyStudy study =
        study_accuracy(test::mesh_of(test::torus(1, 0.4, 24, 12)),
                       test::mesh_of(test::icosphere(2)),
                       {.is_quick = true, .seed = 7, .progress = keep})
            .value();
    return study;
}

TEST(StudyAccuracy, ProgressRisesFromNothingToAllButTheLastStep) {
    EXPECT_FALSE(studied().ladders.empty());
    const std::vector<double>& shares = told().shares;
    ASSERT_GT(shares.size(), 10U);
    EXPECT_EQ(shares.front(), 0);
    EXPECT_TRUE(std::ranges::is_sorted(shares));
    EXPECT_NEAR(shares.back(), 0.82, 0.01);  // the rest is the last step
    const std::vector<std::string> expected = {"models",
                                               "poses",
                                               "self-check",
                                               "shapes",
                                               "2 parts",
                                               "8 parts",
                                               "tetra-tree level 0",
                                               "tetra-tree level 2",
                                               "tetra-tree level 4",
                                               "octree level 3",
                                               "octree level 5",
                                               "geometry: queries",
                                               "distance: queries",
                                               "predicates: queries",
                                               "storage: 16-bit grid",
                                               "storage: 21-bit grid",
                                               "storage: 24-bit grid",
                                               "storage: float",
                                               "storage: double",
                                               "storage: queries",
                                               "coherence: queries"};
    EXPECT_EQ(told().steps, expected);
}

// Promises are those of exact arithmetic; what they are of is asserted by judge_answers().
TEST(StudyAccuracy, NoPromiseBreaksAndEveryLadderIsClimbed) {
    EXPECT_TRUE(studied().broken.empty()) << studied().broken.front();
    ASSERT_EQ(studied().ladders.size(), kLadderNames.size());
    for (std::size_t i = 0; i < kLadderNames.size(); ++i) {
        const Ladder& ladder = studied().ladders[i];
        EXPECT_EQ(ladder.name, kLadderNames[i]);
        EXPECT_GE(ladder.rungs.size(), 5U);
        for (const Rung& rung : ladder.rungs) {
            EXPECT_GT(rung.time.median_s, 0) << ladder.name << ", " << rung.name;
            EXPECT_LE(rung.time.median_s, rung.time.p999_s);
            EXPECT_TRUE(rung.error);
        }
    }
    EXPECT_EQ(studied().set.poses.size(), studied().rigid);
}

// The rungs of coherence ask two questions; those of any other ladder ask the ladder's.
TEST(StudyAccuracy, EveryRungSaysWhatIsAskedAndHow) {
    for (const Ladder& ladder : studied().ladders) {
        EXPECT_FALSE(ladder.question.empty()) << ladder.name;
        for (const Rung& rung : ladder.rungs) {
            EXPECT_FALSE(rung.name.empty()) << ladder.name;
            EXPECT_FALSE(rung.how.empty()) << ladder.name << ", " << rung.name;
            EXPECT_EQ(rung.question.empty(), ladder.name != "coherence") << rung.name;
        }
    }
}

// A hull lies in its sphere and box, and parts in the hull: they err less, or as much.
TEST(StudyAccuracy, ShapesThatFitBetterErrLess) {
    const Ladder& ladder = studied().ladders[0];
    EXPECT_GE(*rung_of(ladder, "sphere").error, *rung_of(ladder, "hull").error);
    EXPECT_GE(*rung_of(ladder, "26-DOP").error, *rung_of(ladder, "hull").error);
    EXPECT_GE(*rung_of(ladder, "box").outer, *rung_of(ladder, "26-DOP").outer);
    EXPECT_GE(*rung_of(ladder, "box").error, *rung_of(ladder, "hull").error);
    EXPECT_GT(*rung_of(ladder, "sphere").error, 0);
    EXPECT_GT(*rung_of(ladder, "hull").outer, *rung_of(ladder, "8 parts").outer);
    EXPECT_GT(*rung_of(ladder, "octree 3").outer, *rung_of(ladder, "octree 5").outer);
    EXPECT_EQ(*rung_of(ladder, "exact").error, 0);
    EXPECT_EQ(rung_of(ladder, "float, doubt hits").pairs->recall.share, 1);
    EXPECT_EQ(rung_of(ladder, "float, doubt misses").pairs->precision.share, 1);
}

TEST(StudyAccuracy, IntervalsHoldTheTruthAndShrink) {
    const Ladder& ladder = studied().ladders[1];
    for (const Rung& rung : ladder.rungs) {
        EXPECT_EQ(rung.distance->holds.count, rung.distance->holds.of) << rung.name;
        EXPECT_GT(rung.distance->holds.of, 20U);
    }
    EXPECT_LE(rung_of(ladder, "within 10 %").distance->worst, 0.1);
    EXPECT_LE(rung_of(ladder, "within 1 %").distance->worst, 0.01);
    EXPECT_EQ(rung_of(ladder, "exact").distance->worst, 0);
}

TEST(StudyAccuracy, ExactArithmeticIsNeverWrong) {
    const Ladder& ladder = studied().ladders[2];
    EXPECT_EQ(*rung_of(ladder, "filter, then exact").error, 0);
    EXPECT_GE(*rung_of(ladder, "float").error, *rung_of(ladder, "double").error);
    const Ladder& storage = studied().ladders[3];
    EXPECT_EQ(*rung_of(storage, "double").displacement, 0);
    EXPECT_GT(*rung_of(storage, "16-bit grid").displacement,
              *rung_of(storage, "24-bit grid").displacement);
}

TEST(StudyAccuracy, SaysWhatItCannotStudy) {
    const mesh::Mesh ball = test::mesh_of(test::icosphere(1));
    const auto nothing = study_accuracy(ball, {});
    ASSERT_FALSE(nothing);
    EXPECT_EQ(nothing.error().code, ErrorCode::bad_argument);
    EXPECT_NE(nothing.error().message.find("second model has no triangles"), std::string::npos);
    const mesh::Mesh point = test::mesh_of({{{1, 2, 3}}, {{{0, 0, 0}}}});
    EXPECT_EQ(study_accuracy(point, point).error().code, ErrorCode::bad_argument);
    const auto stopped = study_accuracy(ball, ball, {.stop = [] { return true; }});
    EXPECT_EQ(stopped.error().code, ErrorCode::interrupted);
}

report::AccuracyReport report_of(const AccuracyStudy& study) {
    report::AccuracyReport report;
    report.input = "a</script><b>\".obj";
    report.input_b = "b.obj";
    report.version = "1";
    report.study = study;
    return report;
}

std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
        ++count;
    }
    return count;
}

/// Commas in quotes part no cells.
std::size_t cells_of(const std::string& line) {
    std::size_t cells = 1;
    bool is_quoted = false;
    for (const char letter : line) {
        is_quoted ^= letter == '"';
        cells += letter == ',' && !is_quoted ? 1 : 0;
    }
    return cells;
}

// A line for each rung, as many cells in each as the head has names.
TEST(AccuracyReport, CsvHasALineForEachRung) {
    const std::string csv = report::accuracy_csv(report_of(studied()));
    std::size_t rungs = 0;
    for (const Ladder& ladder : studied().ladders) rungs += ladder.rungs.size();
    EXPECT_EQ(count_of(csv, "\n"), rungs + 1);
    EXPECT_TRUE(csv.starts_with("ladder,rung,"));
    std::istringstream lines(csv);
    std::string head;
    std::getline(lines, head);
    for (std::string line; std::getline(lines, line);) {
        EXPECT_EQ(cells_of(line), cells_of(head)) << line;
    }
}

// Names of files are text, and every rung with an error is a mark on some chart.
TEST(AccuracyReport, PicturesMarkEveryRungAndKeepNamesText) {
    const report::AccuracyReport report = report_of(studied());
    const std::string svg = report::accuracy_svg(report);
    for (const std::string& text : {svg, report::accuracy_page(report)}) {
        EXPECT_EQ(text.find("<b>\""), std::string::npos);
        for (std::size_t l = 0; l < studied().ladders.size(); ++l) {
            for (std::size_t r = 0; r < studied().ladders[l].rungs.size(); ++r) {
                const std::string mark = "data-ladder=\"" + std::to_string(l) + "\" data-rung=\"" +
                                         std::to_string(r) + "\"";
                EXPECT_NE(text.find(mark), std::string::npos) << mark;
            }
        }
    }
    EXPECT_EQ(count_of(svg, "<g "), count_of(svg, "</g>"));
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(svg.find("inf"), std::string::npos);
}

Rung rung_at(const std::string& name, double time, double error) {
    Rung rung;
    rung.name = name;
    rung.time.median_s = time;
    rung.error = error;
    return rung;
}

// By hand: twice the time for a hundredth of the error is the root of two a digit.
TEST(NextDigits, GoAlongTheFront) {
    Ladder ladder;
    ladder.rungs = {rung_at("exact", 8, 0), rung_at("coarse", 1, 0.5), rung_at("beaten", 3, 0.4),
                    rung_at("fine", 2, 0.005)};
    const auto steps = report::next_digits(ladder);
    ASSERT_EQ(steps.size(), 2U);
    EXPECT_EQ(steps[0].from, 1U);
    EXPECT_EQ(steps[0].to, 3U);
    EXPECT_DOUBLE_EQ(steps[0].error, 100);
    EXPECT_NEAR(steps[0].time_a_digit, std::sqrt(2.0), 1e-12);
    EXPECT_EQ(steps[1].to, 0U);
    EXPECT_EQ(steps[1].time, 4);
    EXPECT_TRUE(std::isinf(steps[1].error));
}

// The clock may be too coarse for the quickest: nothing is a number of times slower than that.
TEST(NextDigits, NoStepBeginsAtARungOfNoTime) {
    Ladder ladder;
    ladder.rungs = {rung_at("at once", 0, 0.5), rung_at("fine", 2, 0.005), rung_at("exact", 8, 0)};
    const auto steps = report::next_digits(ladder);
    ASSERT_EQ(steps.size(), 1U);
    EXPECT_EQ(steps[0].from, 1U);
    EXPECT_EQ(steps[0].to, 2U);
}

}  // namespace
}  // namespace cdprep::study
