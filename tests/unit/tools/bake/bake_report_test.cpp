// SPDX-License-Identifier: MIT
#include "bake/bake_report.h"

#include <gtest/gtest.h>

#include <string>

namespace cdprep::report {
namespace {

// By hand: the nearest number of six digits is smaller than the bound.
TEST(BakeText, RoundsTheErrorOfPartsUpwards) {
    BakeReport report;
    report.parts = BakedParts{.count = 2, .outer_error = 0.12345611};
    const std::string text = bake_text(report, Timings::hide);
    EXPECT_NE(text.find("2 convex parts enclose the mesh and stick out by at most 0.123457\n"),
              std::string::npos)
        << text;
}

}  // namespace
}  // namespace cdprep::report
