// SPDX-License-Identifier: MIT
#include "compare/comparison_report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "compare/comparison_page.h"
#include "study/cells.h"
#include "unit/tools/recorded_text.h"

namespace cdprep::report {
namespace {

using study::Mark;
using study::Unit;
using study::Verdict;

/// Two rows with every kind of cell, and a name that no format may take at its word.
study::Comparison small_comparison() {
    study::Comparison comparison;
    comparison.settings = {"1.2", true, 7, 3, "", 1, 4};
    comparison.models.push_back({"a<b>\"\n,c", "x.obj", 3, 1, 255, 3, 1, 16, "it is \"one\""});
    study::Table table = {
        "2",     "Sizes",
        "model", {{"time", "time", Unit::seconds}, {"size", "size, MiB", Unit::mebibytes}},
        {},      {"A note."}};
    study::Cell time = study::seconds_cell(1.5e-6);
    time.published = study::Published{.value = 0.25, .mark = Mark::stand_in, .remark = "not it"};
    study::Cell size = study::number(0.5);
    size.published = study::Published{.value = 0.125, .mark = Mark::erratum, .remark = "cannot be"};
    table.rows.push_back({"a<b>\"\n,c", {time, size}});
    study::Cell word = study::word("refused");
    word.published = study::Published{.text = "-", .mark = Mark::not_comparable, .remark = "fewer"};
    table.rows.push_back({"none", {study::without("left out"), word}});
    comparison.tables.push_back(table);
    comparison.checks.push_back({"One holds", "by hand", Verdict::holds});
    comparison.checks.push_back({"One fails", "1 of 2", Verdict::fails});
    comparison.errata = {"A slip."};
    return comparison;
}

// By hand.
TEST(SecondsText, HasThreeDigitsAndTheUnitThatFits) {
    EXPECT_EQ(study::seconds_text(0), "0.00 ns");
    EXPECT_EQ(study::seconds_text(4.2e-10), "0.42 ns");
    EXPECT_EQ(study::seconds_text(1.5e-6), "1.50 us");
    EXPECT_EQ(study::seconds_text(0.0425), "42.5 ms");
    EXPECT_EQ(study::seconds_text(0.9999), "1.00 s");
    EXPECT_EQ(study::seconds_text(380.121), "380 s");
}

TEST(ComparisonText, SetsThePapersFiguresBesideOursAndSaysWhyCellsAreEmpty) {
    const std::string text = comparison_text(small_comparison());
    for (const char* part :
         {"Table 2. Sizes", "1.50 us", "250 ms~", "0.5000", "0.1250!", "stand-in: not it",
          "erratum: cannot be", "[1] left out", "refused", "A note.", "holds", "fails", "A slip.",
          "1 hold here, 1 do not", "Seed 7", "-#", "not comparable: fewer", "a<b>\"\\n,c"}) {
        EXPECT_NE(text.find(part), std::string::npos) << part;
    }
}

TEST(ComparisonText, GoesOnBelowWhereATableIsTooWide) {
    study::Comparison comparison = small_comparison();
    study::Table& table = comparison.tables[0];
    for (int i = 0; i < 30; ++i) {
        table.columns.push_back({"more" + std::to_string(i), "a long title", Unit::count});
        for (study::Row& row : table.rows) row.cells.push_back(study::count_cell(1));
    }
    const std::string text = comparison_text(comparison);
    const std::size_t begin = text.find("Table 2");
    std::size_t longest = 0;
    for (std::size_t at = begin; at < text.find("A note");) {
        const std::size_t end = text.find('\n', at);
        longest = std::max(longest, end - at);
        at = end + 1;
    }
    EXPECT_LE(longest, 118U);
    EXPECT_GT(longest, 80U);
}

TEST(ComparisonJson, HasEveryCellWithItsReasonOrItsNumbers) {
    ComparisonReport report;
    report.comparison = small_comparison();
    const auto json = nlohmann::json::parse(comparison_json(report));
    const auto& rows = json.at("tables").at(0).at("rows");
    EXPECT_EQ(rows.at(0).at("label"), "a<b>\"\n,c");
    const auto& time = rows.at(0).at("cells").at("time");
    EXPECT_EQ(time.at("value"), 1.5e-6);
    EXPECT_EQ(time.at("published").at("mark"), "stand-in");
    EXPECT_EQ(time.at("published_ratio"), 0.25 / 1.5e-6);
    EXPECT_EQ(rows.at(1).at("cells").at("time").at("reason"), "left out");
    EXPECT_EQ(json.at("checks").at(1).at("verdict"), "fails");
    EXPECT_EQ(json.at("models").at(0).at("read_hash"), "00000000000000ff");
    EXPECT_EQ(json.at("settings").at("seed"), 7);
}

TEST(ComparisonJson, SaysWhyNothingCame) {
    ComparisonReport report;
    report.exit = 3;
    report.error = "It is bad.";
    const auto json = nlohmann::json::parse(comparison_json(report));
    EXPECT_EQ(json.at("error"), "It is bad.");
    EXPECT_EQ(json.at("exit"), 3);
}

TEST(ComparisonCsv, IsALineACellWhateverNamesHold) {
    const std::string csv = comparison_csv(small_comparison());
    EXPECT_TRUE(csv.starts_with("table,row,column,"));
    EXPECT_EQ(csv.find("\n#"), std::string::npos) << csv;
    EXPECT_NE(csv.find("\n\"provenance\","), std::string::npos) << csv;
    EXPECT_NE(
        csv.find("\n\"2\",\"a<b>\"\" ,c\",time,s,1.5e-06,,,0.25,stand-in,\"not it\",,,,,1.0,1.0\n"),
        std::string::npos)
        << csv;
    EXPECT_NE(csv.find("\n\"2\",\"none\",time,s,,,\"left out\",,,,"), std::string::npos) << csv;
}

TEST(ComparisonPage, IsSafeAndWhole) {
    const std::string page = comparison_page(small_comparison());
    EXPECT_EQ(page.find("a<b>"), std::string::npos);
    EXPECT_NE(page.find("a&lt;b&gt;&quot;"), std::string::npos);
    EXPECT_NE(page.find("title=\"left out\""), std::string::npos);
    EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
    EXPECT_EQ(page.find("<script"), std::string::npos);
    EXPECT_TRUE(page.ends_with("</html>\n"));
}

// What pairs took is drawn, the paper's beside it.
TEST(ComparisonPage, DrawsWhatPairsTake) {
    study::Comparison comparison = small_comparison();
    EXPECT_EQ(comparison_page(comparison).find("<svg"), std::string::npos);
    study::Table& table = comparison.tables[0];
    table.columns = {{"collide_deep", "collide", Unit::seconds},
                     {"overlap_deep", "overlap", Unit::seconds}};
    const std::string page = comparison_page(comparison);
    EXPECT_NE(page.find("<svg"), std::string::npos);
    EXPECT_NE(page.find("collide: 1.50 us</title>"), std::string::npos);
    EXPECT_NE(page.find("collide, published: 250 ms</title>"), std::string::npos);
    const std::size_t begin = page.find("<svg"), end = page.rfind("</svg>");
    const std::string chart = page.substr(begin, end - begin);
    EXPECT_EQ(test::hash_of_text(chart), 0x44cf180d36d2a973) << chart;
}

TEST(RecordedComparison, TextJsonTableAndPageAreAsRecorded) {
    const study::Comparison comparison = small_comparison();
    const std::string text = comparison_text(comparison);
    EXPECT_EQ(test::hash_of_text(text), 0x6e1f1d30d2ba271a) << text;
    const std::string json =
        comparison_json({.input = "", .exit = 0, .error = "", .comparison = comparison});
    EXPECT_EQ(test::hash_of_text(json), 0xd6633df60bb03210) << json;
    const std::string csv = comparison_csv(comparison);
    EXPECT_EQ(test::hash_of_text(csv), 0xef8c817fc0bbf159) << csv;
}

}  // namespace
}  // namespace cdprep::report
