// SPDX-License-Identifier: MIT
// A study of fixed numbers, and the hashes of all that is written about it.
#include <gtest/gtest.h>

#include <string>

#include "accuracy/accuracy_chart.h"
#include "accuracy/accuracy_report.h"
#include "unit/tools/recorded_text.h"

namespace cdprep::study {
namespace {

constexpr std::size_t kPoses = 10;

Timing time_of(double median) {
    return {.median_s = median,
            .p95_s = 1.5 * median,
            .p999_s = 2.25 * median,
            .spread_s = 0.125 * median,
            .low_s = 0.9 * median,
            .high_s = 1.2 * median,
            .cases = kPoses,
            .rounds = 5,
            .asked = 700};
}

PoseSet poses() {
    PoseSet set;
    set.seed = 11;
    set.diagonal = 2.5;
    for (std::size_t i = 0; i < kPoses; ++i) {
        StudyPose pose;
        const double x = 0.25 * static_cast<double>(i);
        pose.quaternion = {0.5, 0.5, 0.5, -0.5};
        pose.a_from_b = Pose::from_quaternion(0.5, 0.5, 0.5, -0.5, {x, 1, -2}).value();
        pose.stratum = static_cast<Stratum>(i / 2);
        pose.hit = i < 5;
        pose.solid = i < 5 ? Answer::yes : (i == 9 ? Answer::unknown : Answer::no);
        pose.gap_lower = pose.hit ? 0 : 0.5 * x;
        pose.gap_upper = pose.hit ? 0 : 0.75 * x;
        pose.depth = pose.hit ? 0.125 : 0;
        pose.is_rigid = i != 4;
        set.poses.push_back(pose);
    }
    set.missing = {0, 1, 0, 0, 2};
    return set;
}

/// A rung with every figure that rungs of geometry can have.
Rung shape(const PoseSet& set, double median, std::size_t wrong, Broken& broken) {
    Rung rung;
    rung.name = std::to_string(wrong) + " wrong";
    rung.how = "calls the first " + std::to_string(wrong) + " poses apart that touch, or a hit";
    rung.promise = wrong == 0 ? Promise::exact : Promise::none;
    rung.time = time_of(median);
    for (std::size_t i = 0; i < kPoses; ++i) {
        rung.seconds.push_back(median * (1 + 0.1 * static_cast<double>(i)));
        const bool is_wrong = i % 5 < wrong;
        rung.answers.push_back(set.poses[i].hit != is_wrong ? Answer::yes : Answer::no);
    }
    judge_answers("geometry", set, rung, broken);
    for (std::size_t i = 0; i < kStrata; ++i) {
        rung.strata[i].median_s = median * (2 - 0.3 * static_cast<double>(i));
    }
    rung.build_s = 3e-3 * static_cast<double>(wrong + 1);
    rung.bytes = 12'345 * (wrong + 1);
    rung.touched = 1234.5 * static_cast<double>(wrong + 1);
    rung.outer = 0.0625 * static_cast<double>(wrong);
    rung.inner = 0.03125 * static_cast<double>(wrong);
    return rung;
}

Rung estimate(const std::string& name, double median, double error) {
    Rung rung;
    rung.name = name;
    rung.how = "within " + name;
    rung.promise = Promise::interval;
    rung.time = time_of(median);
    rung.seconds.assign(kPoses, median);
    rung.distance = {error / 2, error, error / 4, clopper_pearson(10, kPoses)};
    rung.error = error;
    rung.worst_pose = 7;
    rung.worst = "0.5 for 0.25";
    return rung;
}

Rung stored(const std::string& name, double median, std::size_t found) {
    Rung rung;
    rung.name = name;
    rung.how = "positions rounded";
    rung.question = "all pairs";
    rung.time = time_of(median);
    rung.seconds.assign(kPoses, median);
    for (std::size_t i = 0; i < kPoses; ++i) rung.pair_counts.push_back({100, found, found - 1});
    rung.pairs = pair_errors(rung.pair_counts);
    keep_error(rung.pairs->wrong, rung);
    rung.displacement = 1.5e-6;
    rung.degenerate = 3;
    return rung;
}

/// Every kind of ladder, sentences about what is left out, and a promise that broke.
report::AccuracyReport fixed_report() {
    report::AccuracyReport report;
    report.input = "a.obj";
    report.input_b = "b & c.obj";
    report.version = "1.2.3";
    AccuracyStudy& study = report.study;
    study.machine = {"A processor",  8,         16ULL << 30, 32ULL << 20, "System 1",
                     "A compiler 2", "Release", "scalar"};
    study.a = {1000, 502, 2.5, true, true};
    study.b = {20'000, 10'002, 40, false, false};
    study.timing.rounds = 5;
    study.set = poses();
    study.rigid = 9;
    study.self = {1.001, 0.98, 1.02};
    study.seconds = 12.5;
    Ladder geometry = {"geometry", "Do the models touch",    "the share of wrong answers", "pose",
                       {},         {"Sheets are not boxed."}};
    for (const std::size_t wrong : {5, 3, 4, 1, 0}) {
        const double median = wrong == 3 ? 6.5e-6 : 1e-6 * static_cast<double>(7 - wrong);
        geometry.rungs.push_back(shape(study.set, median, wrong, study.broken));
    }
    Ladder distance = {"distance",
                       "How far apart are they",
                       "the worst relative error",
                       "pose",
                       {estimate("0.1", 2e-6, 0.08), estimate("0.01", 3e-6, 0.009),
                        estimate("1e-6", 5e-6, 4e-7), estimate("0", 7e-6, 0)},
                       {}};
    Ladder storage = {"storage",
                      "Which triangles overlap",
                      "the share of wrong pairs",
                      "pose",
                      {stored("16 bits", 4e-5, 90), stored("float", 5e-5, 99)},
                      {}};
    Ladder coherence = {"coherence",
                        "Do they still touch",
                        "the share of wrong answers",
                        "frame",
                        {estimate("cold", 6e-4, 0), estimate("warm", 2e-5, 0)},
                        {}};
    study.ladders = {geometry, distance, storage, coherence};
    study.broken.emplace_back("geometry, 0 wrong: deep 1 (pose 0) is called apart");
    report.exit = 6;
    return report;
}

TEST(RecordedReport, TextJsonAndTablesAreAsRecorded) {
    const report::AccuracyReport report = fixed_report();
    const std::string text = report::accuracy_text(report);
    EXPECT_EQ(test::hash_of_text(text), 0xbf3f2f9f078c5f3d) << text;
    const std::string json = report::accuracy_json(report);
    EXPECT_EQ(test::hash_of_text(json), 0xfb466caafa6910b) << json;
    const std::string csv = report::accuracy_csv(report);
    EXPECT_EQ(test::hash_of_text(csv), 0xce69acafa5099cb2) << csv;
    const std::string data = report::accuracy_page_data(report);
    EXPECT_EQ(test::hash_of_text(data), 0xd5391727c24d0c49) << data;
    const std::string page = report::accuracy_page(report);
    EXPECT_EQ(test::hash_of_text(page), 0x7330f2fdc03b6b15) << page;
}

TEST(RecordedReport, ChartsAreAsRecorded) {
    const std::string svg = report::accuracy_svg(fixed_report());
    EXPECT_EQ(test::hash_of_text(svg), 0x7ef901e9f897951a) << svg;
}

// Axes are then as long as half a power of ten, with the numbers in the middle.
TEST(RecordedReport, ChartsOfNearlyEqualNumbersAreAsRecorded) {
    report::AccuracyReport report = fixed_report();
    AccuracyStudy& study = report.study;
    study.ladders.resize(2);
    study.ladders[1].rungs = {estimate("0.1", 2e-6, 0.08), estimate("0.01", 2.5e-6, 0.085),
                              estimate("1e-6", 2.2e-6, 0.09)};
    for (Rung& rung : study.ladders[0].rungs) {
        rung.time = time_of(3e-6 + 1e-7 * static_cast<double>(*rung.bytes % 7));
        for (double& seconds : rung.seconds) seconds = rung.time.median_s;
    }
    const std::string svg = report::accuracy_svg(report);
    EXPECT_EQ(test::hash_of_text(svg), 0x462dc7cf71207b03) << svg;
}

}  // namespace
}  // namespace cdprep::study
