// SPDX-License-Identifier: MIT
#include "decompose/enclose/approximate_report.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace cdprep::report
