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

/// Whether a report tells the times of stages.
enum class Timings : std::uint8_t { hide, show };

}  // namespace cdprep::report
