// SPDX-License-Identifier: MIT
#include "compare/feature_probes.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace cdprep::study
