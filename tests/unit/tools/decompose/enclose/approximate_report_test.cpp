// SPDX-License-Identifier: MIT
#include "decompose/enclose/approximate_report.h"

#include <gtest/gtest.h>

namespace cdprep::report {
namespace {

// Components that are not closed are news only where the error refers to the solid.
TEST(ApproximateText, NamesOpenComponentsOfASolid) {
    const std::string sentence = "1 component is not closed and counts as a surface;";
    for (const bool to_surface : {false, true}) {
        for (const std::size_t open : {0U, 1U}) {
            ApproximateReport report;
            report.to_surface = to_surface;
            report.open_components = open;
            const std::string text = approximate_text(report);
            EXPECT_EQ(text.find(sentence) != std::string::npos, !to_surface && open > 0)
                << to_surface << ", " << open;
            EXPECT_EQ(text.find("not closed") != std::string::npos, !to_surface && open > 0);
            EXPECT_NE(text.find(to_surface ? "of the surface by" : "of the solid by"),
                      std::string::npos);
        }
    }
}

}  // namespace
}  // namespace cdprep::report
