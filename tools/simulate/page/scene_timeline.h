// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "simulate/run/effect_counts.h"
#include "simulate/run/simulation.h"
#include "text/stage_time.h"

namespace cdprep::report {

/// Returns the parts of the last frame's time, the same ones for each frame. They are the response,
/// model changes, boxes, the queries of each effect, the rest of the pairs, and lists. Queries
/// are means over the threads. A part with the name of an effect is drawn in its lane.
[[nodiscard]] std::vector<StageTime> stage_times(const scenes::Simulation& simulation);

/// What happened in some frames that follow each other. Arrays are by kSimulatedEffects.
struct TimelineSpan {
    using ByEffect = std::array<std::uint64_t, kSimulatedEffects.size()>;

    std::uint64_t frames = 0;
    ByEffect begins{};
    ByEffect ends{};
    /// The most pairs of objects for which it holds in a frame. `response` holds for those that
    /// push each other at its end.
    ByEffect holds{};
    std::vector<double> seconds;  ///< of each stage, in all frames together
    double longest = 0;           ///< of a frame, in seconds
};

/// The course of a run, in memory that does not grow with it. All spans but the last have the same
/// number of frames, at first one. Whenever there are too many spans, this number doubles.
class SceneTimeline {
public:
    static constexpr std::size_t kMostSpans = 4096;

    /// Adds the last frame of a simulation.
    void add(const scenes::Simulation& simulation);

    [[nodiscard]] const std::vector<std::string>& stages() const noexcept {
        return stages_;
    }
    [[nodiscard]] const std::vector<TimelineSpan>& spans() const noexcept {
        return spans_;
    }
    [[nodiscard]] std::uint64_t frames_per_span() const noexcept {
        return frames_per_span_;
    }

private:
    void join_spans();

    std::vector<std::string> stages_;
    std::vector<TimelineSpan> spans_;
    std::uint64_t frames_per_span_ = 1;
};

}  // namespace cdprep::report
