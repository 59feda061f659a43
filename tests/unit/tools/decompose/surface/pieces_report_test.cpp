// SPDX-License-Identifier: MIT
#include "decompose/surface/pieces_report.h"

#include <gtest/gtest.h>

#include <string>

namespace cdprep::report {
namespace {

// By hand: the nearest number of six digits is smaller than the bound.
TEST(PiecesText, RoundsTheBoundOnTheDepthUpwards) {
    SurfacePiecesReport report;
    report.tolerance = 0.125;
    report.pieces.triangles = {0};
    report.pieces.first = {0, 1};
    report.pieces.pieces = {{.contained = false, .outer_error = 0.12345611}};
    report.has_table = true;
    const std::string text = pieces_text(report);
    EXPECT_NE(text.find("lie at most 0.123457 below their hulls"), std::string::npos) << text;
    EXPECT_NE(text.find("  0 1 0 no 0.123457\n"), std::string::npos) << text;
}

// The bound meets the tolerance, so its text may not seem to exceed it.
TEST(PiecesText, RoundsTheToleranceAsTheBound) {
    SurfacePiecesReport report;
    report.tolerance = 0.33333333;
    report.pieces.triangles = {0};
    report.pieces.first = {0, 1};
    report.pieces.pieces = {{.contained = false, .outer_error = 0.33333333}};
    const std::string text = pieces_text(report);
    EXPECT_NE(text.find("at most 0.333334 below their hulls (tolerance 0.333334)"),
              std::string::npos)
        << text;
}

}  // namespace
}  // namespace cdprep::report
