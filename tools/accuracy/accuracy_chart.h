// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "accuracy/accuracy_report.h"

namespace cdprep::report {

/// One chart: the content of an SVG element of kChartWidth by `height` units, drawn with the
/// classes of chart_style().
struct Chart {
    std::string title;
    std::string explanation;  ///< a sentence on how to read it
    int height;
    std::string body;
};

inline constexpr int kChartWidth = 860;

/// Returns the charts of a study, ladder by ladder. One shows time against error, both logarithmic:
/// dominated rungs are hollow, and rungs without error are on their own strip at the bottom. Others
/// show time by stratum and, for shapes, time against how far they stick out. If all errors are 0,
/// bars show the times. Points have data-ladder and data-rung, the numbers of their rung.
[[nodiscard]] std::vector<Chart> accuracy_charts(const AccuracyReport& report);

/// Returns the CSS for the elements of the charts.
[[nodiscard]] std::string chart_style();

/// Returns all charts, one below the other, as one SVG file.
[[nodiscard]] std::string accuracy_svg(const AccuracyReport& report);

}  // namespace cdprep::report
