// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "simulate/page/scene_timeline.h"

namespace cdprep::report {

inline constexpr int kSceneChartWidth = 860;
inline constexpr int kSceneChartHeight = 360;

/// Returns a chart of the time of a frame. The stages are stacked, and a line shows the longest
/// frame of each span. It is the content of an SVG element of kSceneChartWidth by kSceneChartHeight
/// units, drawn with the classes of scene_chart_style().
[[nodiscard]] std::string scene_chart(const SceneTimeline& timeline, double step_s);

/// Returns a sentence on how to read the chart.
[[nodiscard]] std::string scene_chart_words(const SceneTimeline& timeline);

/// Returns the CSS for the elements of the chart.
[[nodiscard]] std::string scene_chart_style();

/// Returns the chart as an SVG file.
[[nodiscard]] std::string scene_svg(const SceneTimeline& timeline, const std::string& scene,
                                    double step_s);

}  // namespace cdprep::report
