// SPDX-License-Identifier: MIT
#include "validate/judge.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "unit/tools/soup_of.h"
#include "validate/fingerprint.h"

namespace cdprep::report {
namespace {

using mesh::Rule;

/// A report with slivers at these triangles of the cube, and more without a place.
ValidationReport slivers(const std::vector<std::uint32_t>& triangles, std::uint64_t more = 0) {
    ValidationReport report;
    mesh::Finding finding{Rule::sliver, triangles.size() + more, {}};
    for (const std::uint32_t triangle : triangles) {
        finding.places.push_back({{triangle}, {}, {}, 0});
    }
    report.defects.findings.push_back(finding);
    return report;
}

/// What a baseline knows of such a report.
KnownMesh known(const ValidationReport& report) {
    const mesh::TriangleSoup soup = test::soup_of(test::unit_cube());
    KnownMesh mesh;
    for (const mesh::Finding& finding : report.defects.findings) {
        KnownFinding& entry = mesh.findings[finding.rule];
        entry.count = finding.count;
        for (const mesh::Place& place : finding.places) {
            entry.fingerprints.push_back(Fingerprints(soup).of(finding.rule, place));
        }
        std::sort(entry.fingerprints.begin(), entry.fingerprints.end());
    }
    return mesh;
}

bool judged(ValidationReport& report, const KnownMesh* known, std::size_t max_places = 100) {
    const RuleSettings rules = RuleSettings::parse({}, {"note"}).value();
    return judge(report, test::soup_of(test::unit_cube()), {rules, known, max_places});
}

TEST(Judge, WithoutABaselineAllIsNew) {
    ValidationReport report = slivers({0, 3}, 5);
    EXPECT_TRUE(judged(report, nullptr));
    ASSERT_EQ(report.judgements.size(), 1U);
    EXPECT_EQ(report.judgements[0].fresh, 7U);
    EXPECT_EQ(report.judgements[0].fingerprints.size(), 2U);
    EXPECT_EQ(report.known, 0U);
}

TEST(Judge, LeavesOutARuleThatIsOff) {
    ValidationReport report = slivers({0});
    const RuleSettings rules = RuleSettings::parse({"sliver=off"}, {"note"}).value();
    EXPECT_FALSE(judge(report, test::soup_of(test::unit_cube()), {rules, nullptr, 100}));
    EXPECT_TRUE(report.defects.findings.empty());
    EXPECT_TRUE(report.judgements.empty());
}

TEST(Judge, KeepsTheFirstPlaces) {
    ValidationReport report = slivers({4, 2, 7});
    EXPECT_TRUE(judged(report, nullptr, 1));
    EXPECT_EQ(report.judgements[0].fresh, 3U);
    ASSERT_EQ(report.defects.findings[0].places.size(), 1U);
    EXPECT_EQ(report.defects.findings[0].places[0].triangles[0], 4U);
    EXPECT_EQ(report.judgements[0].fingerprints.size(), 1U);
}

TEST(Judge, WhatTheBaselineHasIsNotNew) {
    const KnownMesh old = known(slivers({1, 2, 3}));
    ValidationReport same = slivers({3, 1, 2});
    EXPECT_FALSE(judged(same, &old));
    EXPECT_TRUE(same.defects.findings.empty());
    EXPECT_EQ(same.known, 3U);

    ValidationReport other = slivers({3, 5, 1});
    EXPECT_TRUE(judged(other, &old));
    EXPECT_EQ(other.judgements[0].fresh, 1U);
    EXPECT_EQ(other.defects.findings[0].places[0].triangles[0], 5U);
    EXPECT_EQ(other.known, 2U);
    EXPECT_TRUE(other.remarks.empty());
}

// Two slivers in one place are one for one: a third is new.
TEST(Judge, EqualPlacesAreComparedOneForOne) {
    const KnownMesh old = known(slivers({1, 1}));
    ValidationReport report = slivers({1, 1, 1});
    EXPECT_TRUE(judged(report, &old));
    EXPECT_EQ(report.judgements[0].fresh, 1U);
    EXPECT_EQ(report.known, 2U);
}

TEST(Judge, ComparesNumbersWhereTheBaselineWasCutShort) {
    const KnownMesh old = known(slivers({1, 2}, 8));
    ValidationReport fewer = slivers({4, 5, 6});
    EXPECT_FALSE(judged(fewer, &old));
    EXPECT_EQ(fewer.known, 3U);
    EXPECT_EQ(fewer.remarks.size(), 1U);

    ValidationReport more = slivers({1, 4, 5, 6}, 8);
    EXPECT_TRUE(judged(more, &old));
    EXPECT_EQ(more.judgements[0].fresh, 2U);
    EXPECT_EQ(more.defects.findings[0].places.size(), 2U);
    EXPECT_EQ(more.defects.findings[0].places[0].triangles[0], 4U) << "1 is known";
    EXPECT_EQ(more.known, 10U);
}

TEST(Judge, ComparesNumbersWhereTheReportWasCutShort) {
    const KnownMesh old = known(slivers({1, 2}));
    ValidationReport report = slivers({1, 3, 4}, 6);
    EXPECT_TRUE(judged(report, &old));
    EXPECT_EQ(report.judgements[0].fresh, 7U);
    EXPECT_EQ(report.known, 2U);
    EXPECT_EQ(report.remarks.size(), 1U);
}

TEST(Judge, ARuleThatTheBaselineLacksIsNew) {
    const KnownMesh old;
    ValidationReport report = slivers({1});
    EXPECT_TRUE(judged(report, &old));
    EXPECT_EQ(report.judgements[0].fresh, 1U);
}

// By hand: each of the four rules about pairs, and one that is about none.
TEST(Judge, ARunFailsOnPairsWhenOneOfTheirRulesFails) {
    const auto fails = [](const std::string& rule, const std::string& fail_on) {
        return fails_on_pairs(RuleSettings::parse({rule}, {fail_on}).value());
    };
    EXPECT_FALSE(fails("sliver=error", "error"));
    for (const char* rule : {"CDP0403", "CDP0501", "CDP0502", "CDP0503"}) {
        EXPECT_TRUE(fails("sliver=off", rule)) << rule;
        EXPECT_TRUE(fails(std::string(rule) + "=error", "error")) << rule;
    }
    EXPECT_FALSE(fails("sliver=off", "CDP0402"));
}

}  // namespace
}  // namespace cdprep::report
