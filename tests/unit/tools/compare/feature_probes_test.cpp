// SPDX-License-Identifier: MIT
#include "compare/feature_probes.h"

#include <gtest/gtest.h>

#include "study/cells.h"

namespace cdprep::study {
namespace {

// The paper's ticks, and what this library can more: hulls know tolerances, pieces triangles,
// the hierarchy all but contacts.
TEST(FeatureTable, TicksWhatAProbePassed) {
    const auto table = feature_table();
    ASSERT_TRUE(table) << table.error().message;
    ASSERT_EQ(table.value().rows.size(), 5U);
    const std::vector<std::string> expected = {"XXXXXXX", "XXX-XXX", "---XXXX", "---XXXX",
                                               "-----X-"};
    for (std::size_t r = 0; r < expected.size(); ++r) {
        std::string found;
        for (const Cell& cell : table.value().rows[r].cells) {
            found += cell.is_filled() ? cell.text : "-";
            EXPECT_NE(cell.is_filled(), !cell.reason.empty());
        }
        EXPECT_EQ(found, expected[r]) << table.value().rows[r].label;
    }
    const Check check = feature_check(table.value());
    EXPECT_EQ(check.verdict, Verdict::holds) << check.evidence;
}

// A tick of the paper's that is taken away is missed.
TEST(FeatureCheck, FailsWhereAPublishedFeatureIsMissing) {
    auto table = feature_table();
    ASSERT_TRUE(table);
    Cell& cell = table.value().rows[0].cells[2];
    cell.text = "";
    cell.reason = "the probe failed: by hand";
    const Check check = feature_check(table.value());
    EXPECT_EQ(check.verdict, Verdict::fails);
    EXPECT_NE(check.evidence.find("by hand"), std::string::npos);
}

/// A cell with a tick or a reason, beside what the paper has: nothing for a null.
Cell cell_of(bool is_filled, const char* published) {
    Cell cell = is_filled ? word("X") : without("by hand");
    if (published != nullptr) cell.published = Published{.text = published};
    return cell;
}

// A tick counts as more only beside a feature that the paper says it does not have.
TEST(FeatureCheck, CountsTicksThatThePaperDoesNotHave) {
    Table table;
    table.columns = {{"a", "A"}, {"b", "B"}, {"c", "C"}, {"d", "D"}};
    table.rows.push_back(
        {"found",
         {cell_of(true, "X"), cell_of(true, "-"), cell_of(true, nullptr), cell_of(true, nullptr)}});
    const Check holds = feature_check(table);
    EXPECT_EQ(holds.verdict, Verdict::holds);
    EXPECT_EQ(holds.evidence,
              "4 probes passed, 1 of them for features that the comparative study does not have");
    table.rows.push_back(
        {"missing",
         {cell_of(false, "X"), cell_of(false, "-"), cell_of(false, nullptr), cell_of(true, "-")}});
    const Check fails = feature_check(table);
    EXPECT_EQ(fails.verdict, Verdict::fails);
    EXPECT_EQ(fails.evidence,
              "missing, A: by hand; 5 probes passed, 2 of them for features that the comparative "
              "study does not have");
}

}  // namespace
}  // namespace cdprep::study
