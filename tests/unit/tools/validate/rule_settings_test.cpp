// SPDX-License-Identifier: MIT
#include "validate/rule_settings.h"

#include <gtest/gtest.h>

namespace cdprep::report {
namespace {

using mesh::Rule;
using mesh::Severity;

RuleSettings settings(const std::vector<std::string>& rules,
                      const std::vector<std::string>& fail_on) {
    const Result<RuleSettings> parsed = RuleSettings::parse(rules, fail_on);
    EXPECT_TRUE(parsed) << parsed.error().message;
    return parsed.value();
}

TEST(RuleSettings, WithoutWordsErrorsFail) {
    for (const mesh::RuleText& rule : mesh::all_rules()) {
        for (const RuleSettings& chosen : {RuleSettings{}, settings({}, {})}) {
            EXPECT_EQ(chosen.severity(rule.rule), rule.severity);
            EXPECT_EQ(chosen.fails(rule.rule), rule.severity == Severity::error);
        }
    }
}

TEST(RuleSettings, TheLastWordOnARuleWins) {
    const RuleSettings chosen = settings({"CDP0301=off", "boundary-edge=error"}, {});
    EXPECT_EQ(chosen.severity(Rule::boundary_edge), Severity::error);
    EXPECT_TRUE(chosen.fails(Rule::boundary_edge));
}

TEST(RuleSettings, ASeverityFailsWithAllAboveIt) {
    for (const mesh::RuleText& rule : mesh::all_rules()) {
        EXPECT_EQ(settings({}, {"warning"}).fails(rule.rule), rule.severity >= Severity::warning);
        EXPECT_EQ(settings({}, {"error", "note"}).fails(rule.rule),
                  rule.severity >= Severity::note);
    }
}

TEST(RuleSettings, ARuleToFailOnReplacesTheSeverity) {
    const RuleSettings chosen = settings({}, {"sliver"});
    EXPECT_TRUE(chosen.fails(Rule::sliver));
    EXPECT_FALSE(chosen.fails(Rule::non_finite_coordinate));
    EXPECT_TRUE(settings({}, {"sliver", "error"}).fails(Rule::non_finite_coordinate));
}

TEST(RuleSettings, WhatIsOffNeverFails) {
    EXPECT_FALSE(settings({"CDP0101=off"}, {"note"}).fails(Rule::non_finite_coordinate));
}

TEST(RuleSettings, RefuseOtherWords) {
    EXPECT_FALSE(RuleSettings::parse({"sliver"}, {}));
    EXPECT_FALSE(RuleSettings::parse({"=off"}, {}));
    EXPECT_FALSE(RuleSettings::parse({"sliver=fatal"}, {}));
    EXPECT_FALSE(RuleSettings::parse({"CDP0999=off"}, {}));
    EXPECT_FALSE(RuleSettings::parse({}, {"off"}));
    EXPECT_FALSE(RuleSettings::parse({}, {""}));
    const Result<RuleSettings> contrary = RuleSettings::parse({"sliver=off"}, {"sliver"});
    ASSERT_FALSE(contrary);
    EXPECT_EQ(contrary.error().code, ErrorCode::bad_argument);
    EXPECT_NE(contrary.error().message.find("CDP0203"), std::string::npos);
}

}  // namespace
}  // namespace cdprep::report
