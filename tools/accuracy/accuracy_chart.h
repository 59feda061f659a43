// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "accuracy/accuracy_report.h"

namespace cdprep::report {

/// One picture: the inside of an SVG element of kChartWidth by `height` units, drawn with the
/// classes of chart_style().
struct Chart {
    std::string title;
    std::string explanation;  ///< a sentence: how to read it
    int height;
    std::string body;
};

inline constexpr int kChartWidth = 860;

/// The pictures of a study, ladder by ladder: time against error, log by log, with the rungs
/// that another one beats hollow and rungs without error on a floor of their own; time by
/// stratum; for shapes, time against how far they stick out; bars where the error is
/// always 0. Points have data-ladder and data-rung, the numbers of their rung.
[[nodiscard]] std::vector<Chart> accuracy_charts(const AccuracyReport& report);

/// CSS of what the charts consist of.
[[nodiscard]] std::string chart_style();

/// All charts, one below the other, as one SVG file.
[[nodiscard]] std::string accuracy_svg(const AccuracyReport& report);

}  // namespace cdprep::report
