// SPDX-License-Identifier: MIT
#include "hull/hull_report.h"

#include <gtest/gtest.h>

#include <string>

namespace cdprep::report {
namespace {

// By hand: the nearest number of six digits is smaller than the bound.
TEST(HullText, RoundsTheBoundOnTheDistanceUpwards) {
    HullReport report;
    report.hulls.push_back({.name = "whole", .exact = false, .distance = 0.12345611});
    const std::string text = hull_text(report, 1);
    EXPECT_NE(text.find(", at most 0.123457 outside the exact hull\n"), std::string::npos) << text;
}

}  // namespace
}  // namespace cdprep::report
