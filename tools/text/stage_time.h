// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

namespace cdprep::report {

/// The duration of a stage.
struct StageTime {
    std::string stage;
    double seconds;
};

/// The choice to show or hide the times of stages in a report.
enum class Timings : std::uint8_t { hide, show };

}  // namespace cdprep::report
