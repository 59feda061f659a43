// SPDX-License-Identifier: MIT
#include "decompose/enclose/approximate_report.h"

#include <gtest/gtest.h>

#include <string>

namespace cdprep::report {
namespace {

// Components that are not balanced are news only where the error refers to the solid.
TEST(ApproximateText, NamesUnbalancedComponentsOfASolid) {
    const std::string sentence = "1 component is not balanced and counts as a surface;";
    for (const bool to_surface : {false, true}) {
        for (const std::size_t unbalanced : {0U, 1U}) {
            ApproximateReport report;
            report.to_surface = to_surface;
            report.unbalanced_components = unbalanced;
            const std::string text = approximate_text(report);
            EXPECT_EQ(text.find(sentence) != std::string::npos, !to_surface && unbalanced > 0)
                << to_surface << ", " << unbalanced;
            EXPECT_EQ(text.find("not balanced") != std::string::npos,
                      !to_surface && unbalanced > 0);
            EXPECT_NE(text.find(to_surface ? "of the surface by" : "of the solid by"),
                      std::string::npos);
        }
    }
}

// By hand: the nearest numbers of six digits are on the other side of these bounds.
TEST(ApproximateText, RoundsUpperBoundsUpwardsAndLowerBoundsDownwards) {
    ApproximateReport report;
    report.diagonal = 1;
    report.result.outer_error = 0.12345611;
    report.result.outer_lower = 0.12345599;
    report.has_table = true;
    report.result.parts.resize(1);
    report.result.parts[0].error.upper = 0.12345611;
    const std::string text = approximate_text(report);
    EXPECT_NE(text.find("by at most 0.123457 (12.3457 % of the diagonal; at least 0.123455)"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("  0 0 0 0 0.123457\n"), std::string::npos) << text;
}

// More parts do not help where floats are too coarse.
TEST(ApproximateText, TellsWhatMakesARequestUnmet) {
    for (const bool by_rounding : {false, true}) {
        ApproximateReport report;
        report.result.is_as_asked = false;
        report.is_missed_by_rounding = by_rounding;
        const std::string text = approximate_text(report);
        EXPECT_EQ(text.find("because corners were rounded") != std::string::npos, by_rounding);
        EXPECT_EQ(text.find("it needs more parts") != std::string::npos, !by_rounding);
    }
}

}  // namespace
}  // namespace cdprep::report
