// SPDX-License-Identifier: MIT
#include "export/export_report.h"

#include <gtest/gtest.h>

#include <string>

namespace cdprep::report {
namespace {

// By hand: the nearest numbers of six digits are smaller than these bounds.
TEST(ExportText, RoundsUpperBoundsUpwards) {
    ExportReport report;
    report.growth = 0.12345611;
    report.rounding = 1 / 3.0;
    report.outer_error = 1.2345611;
    const std::string text = export_text(report);
    EXPECT_NE(text.find("parts grew by at most 0.123457\n"), std::string::npos) << text;
    EXPECT_NE(text.find("rounded to floats, by at most 0.333334:"), std::string::npos) << text;
    EXPECT_NE(text.find("they stick out by at most 1.23457\n"), std::string::npos) << text;
}

}  // namespace
}  // namespace cdprep::report
