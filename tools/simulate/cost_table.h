// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "simulate/run/effect_counts.h"
#include "simulate/run/simulation.h"
#include "simulate/time_histogram.h"

namespace cdprep::report {

/// What an effect took in a run. Times are means over the threads, so that rows add up.
struct EffectRow {
    Ask effect = Ask::nothing;
    std::vector<std::string> asked_by;  ///< pairs of layers
    std::uint64_t calls = 0;
    std::uint64_t begins = 0;  ///< events, also those that are not reported
    std::uint64_t ends = 0;
    std::uint64_t nanoseconds = 0;  ///< of all frames
    std::uint64_t p99 = 0;          ///< nanoseconds: 99 % of the frames took less
    std::uint64_t state_bytes = 0;  ///< by which the scene would be smaller without it
    std::uint64_t read_bytes = 0;   ///< of the sections that it reads, in all models
};

/// A part of the frames that is of no effect alone.
struct PartRow {
    const char* name;
    std::uint64_t nanoseconds;  ///< of all frames
};

/// Adds up the frames of a run.
class CostTable {
public:
    /// Both must outlive the object.
    CostTable(const scenes::SceneFile& scene, const Plan& plan);

    /// Adds the last frame of a simulation.
    void add(const scenes::Simulation& simulation);

    /// Returns a row for each effect that some pair of layers asks for.
    [[nodiscard]] std::vector<EffectRow> effects(const scenes::Simulation& simulation) const;
    /// Returns boxes, the rest of the pairs, lists and, if models change, the time of that.
    [[nodiscard]] std::vector<PartRow> parts() const;
    /// Returns the share of the frames' time that the rows add up to.
    [[nodiscard]] double explained() const;

    [[nodiscard]] std::uint64_t frames() const noexcept {
        return frame_times_.count();
    }
    /// The sums of all frames.
    [[nodiscard]] const SceneCounts& counts() const noexcept {
        return counts_;
    }
    [[nodiscard]] const dynamics::DynamicsCounts& body_counts() const noexcept {
        return body_counts_;
    }
    /// Of the library and `response`.
    [[nodiscard]] const TimeHistogram& frame_times() const noexcept {
        return frame_times_;
    }
    [[nodiscard]] const TimeHistogram& refit_times() const noexcept {
        return refit_times_;
    }
    [[nodiscard]] const scenes::ChangeWork& change_work() const noexcept {
        return change_work_;
    }
    [[nodiscard]] const TimeHistogram& times_of(Ask effect) const noexcept;

private:
    void add_event(std::size_t effect, EventKind kind);
    void add_bodies(const scenes::Simulation& simulation);

    const scenes::SceneFile& scene_;
    const Plan& plan_;
    SceneCounts counts_;
    dynamics::DynamicsCounts body_counts_;
    scenes::ChangeWork change_work_;
    std::array<std::uint64_t, kSimulatedEffects.size()> begins_{};
    std::array<std::uint64_t, kSimulatedEffects.size()> ends_{};
    std::array<TimeHistogram, kSimulatedEffects.size()> times_;  ///< means over the threads
    TimeHistogram frame_times_;
    TimeHistogram refit_times_;
    std::uint64_t rest_nanoseconds_ = 0;  ///< of the pairs
};

}  // namespace cdprep::report
