// SPDX-License-Identifier: MIT
#include "validate/defects/rule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

namespace cdprep::mesh {
namespace {

const char* word_of(Severity severity) {
    switch (severity) {
        case Severity::error:
            return "error";
        case Severity::warning:
            return "warning";
        case Severity::note:
            return "note";
        case Severity::off:
            break;
    }
    return "off";
}

/// Words with one space between them: how lines are broken does not count.
std::string one_line(const std::string& text) {
    std::istringstream words(text);
    std::string line;
    for (std::string word; words >> word;) line += (line.empty() ? "" : " ") + word;
    return line;
}

/// The section of RULES.md that says what the table says.
std::string section_of(const RuleText& text) {
    std::string section = "## " + id_of(text.rule) + " " + text.name + "\n\n";
    section += std::string("**") + text.title + "** (" + word_of(text.severity) + ")\n\n";
    section += std::string("- What it is: ") + text.meaning + "\n";
    section += std::string("- Decided: ") + text.decided + "\n";
    section += std::string("- Why it matters: ") + text.why + "\n";
    section += std::string("- Remedy: ") + text.remedy + "\n";
    section += std::string("- Measure: ") + (*text.measure != 0 ? text.measure : "none") + "\n";
    return section;
}

std::string rules_document() {
    std::ifstream file(CDPREP_SOURCE_DIR "/tools/validate/RULES.md");
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

TEST(Rule, DocumentSaysWhatTheTableSays) {
    const std::string document = rules_document();
    ASSERT_FALSE(document.empty());
    std::string sections;
    for (const RuleText& text : all_rules()) sections += section_of(text);
    const std::size_t first = document.find("## CDP");
    ASSERT_NE(first, std::string::npos);
    const std::size_t end = document.find("## Retired");
    ASSERT_NE(end, std::string::npos);
    EXPECT_EQ(one_line(document.substr(first, end - first)), one_line(sections));
}

TEST(Rule, IdsAscendAndIdsAndNamesAreUsedOnce) {
    std::set<std::string> names;
    for (const RuleText& text : all_rules()) {
        EXPECT_TRUE(names.insert(text.name).second) << text.name;
        EXPECT_TRUE(names.insert(id_of(text.rule)).second);
    }
    EXPECT_TRUE(
        std::is_sorted(all_rules().begin(), all_rules().end(),
                       [](const RuleText& a, const RuleText& b) { return a.rule < b.rule; }));
    EXPECT_EQ(all_rules().size(), 27U);
}

// PRODUCT's promise: what fails a run by default.
TEST(Rule, OnlyNumbersThatNoMeshMayHoldAreErrors) {
    for (const RuleText& text : all_rules()) {
        const bool bad_number =
            text.rule == Rule::non_finite_coordinate || text.rule == Rule::index_out_of_range;
        EXPECT_EQ(text.severity == Severity::error, bad_number) << text.name;
        EXPECT_NE(text.severity, Severity::off) << text.name;
    }
}

TEST(Rule, TextsAreWholeSentences) {
    for (const RuleText& text : all_rules()) {
        for (const std::string sentence : {text.meaning, text.why, text.remedy}) {
            EXPECT_TRUE(std::isupper(static_cast<unsigned char>(sentence.front())) != 0)
                << sentence;
            EXPECT_EQ(sentence.back(), '.') << sentence;
        }
    }
}

TEST(Rule, IsFoundByIdAndByNameInAnyCase) {
    for (const RuleText& text : all_rules()) {
        EXPECT_EQ(find_rule(text.name), text.rule);
        EXPECT_EQ(find_rule(id_of(text.rule)), text.rule);
        EXPECT_EQ(text_of(text.rule).rule, text.rule);
    }
    EXPECT_EQ(id_of(Rule::sliver), "CDP0203");
    EXPECT_EQ(find_rule("cdp0203"), Rule::sliver);
    EXPECT_EQ(find_rule("Zero-AREA"), Rule::zero_area);
    for (const char* unknown : {"", "CDP", "CDP9999", "203", "CDP02030", "zero_area"}) {
        EXPECT_EQ(find_rule(unknown), std::nullopt) << unknown;
    }
}

}  // namespace
}  // namespace cdprep::mesh
