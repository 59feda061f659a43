// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace cdprep::report {

/// Returns a length in units of a chart.
[[nodiscard]] std::string units(double value);

/// Returns a line of a class.
[[nodiscard]] std::string line(double x1, double y1, double x2, double y2, const std::string& look);

/// Returns a text of a class. The anchor is "start", "middle" or "end".
[[nodiscard]] std::string words(double x, double y, const std::string& anchor,
                                const std::string& look, const std::string& text);

}  // namespace cdprep::report
