// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "simulate/effect_costs.h"
#include "simulate/effect_counts.h"
#include "simulate/simulation.h"

namespace cdprep::report {

enum class EventFormat : std::uint8_t { text, json, ndjson };

/// Collects the frames of a simulation and words its report.
class SimulationReport {
public:
    /// `scene` must outlive the object.
    SimulationReport(const scenes::SceneFile& scene, const Plan& plan, EventFormat format);

    /// Returns the text that begins the report.
    [[nodiscard]] std::string begin() const;
    /// Adds the last frame of a simulation. Returns the text of its events, which is empty in the
    /// text format.
    [[nodiscard]] std::string add_frame(std::uint64_t frame, const scenes::Simulation& simulation);
    /// Adds what the scene saves without single effects.
    void set_costs(std::vector<scenes::EffectCost> costs) {
        costs_ = std::move(costs);
    }
    /// Returns the text that ends the report: the summary of all frames.
    [[nodiscard]] std::string finish(const scenes::Simulation& simulation);

private:
    struct Changes {
        std::uint64_t begins = 0;
        std::uint64_t ends = 0;
    };

    /// The work of `response` in all frames.
    struct ResponseWork {
        dynamics::DynamicsCounts counts;  ///< sums
        double seconds = 0;
    };

    struct ModelWork {
        scenes::ChangeWork work;           ///< the sum of all frames
        std::vector<double> milliseconds;  ///< of each frame; sorted at the end
    };

    [[nodiscard]] bool is_told(const SceneEvent& event) const;
    void count(const scenes::Simulation& simulation);
    void count_response(const scenes::Simulation& simulation);
    [[nodiscard]] std::string summary_text(const scenes::Simulation& simulation) const;
    [[nodiscard]] double milliseconds_a_frame(std::uint64_t nanoseconds) const;
    [[nodiscard]] std::string time_text(std::uint64_t nanoseconds) const;
    [[nodiscard]] std::vector<std::string> asked_by(Ask effect) const;
    [[nodiscard]] std::string effects_text(const scenes::Simulation& simulation) const;
    [[nodiscard]] std::string costs_text() const;
    [[nodiscard]] std::string changes_text(const scenes::Simulation& simulation) const;
    [[nodiscard]] std::string response_text(const scenes::Simulation& simulation) const;
    [[nodiscard]] std::string summary_json(const scenes::Simulation& simulation) const;

    const scenes::SceneFile& scene_;
    EventFormat format_;
    std::vector<std::string> not_computed_;
    std::vector<const scenes::AskedPair*> pairs_;  ///< by their numbers in the plan
    std::uint64_t frames_ = 0;
    SceneCounts counts_;  ///< sums of all frames
    std::array<Changes, kSceneEffects.size()> changes_{};
    std::vector<double> milliseconds_;  ///< of each frame; sorted at the end
    ModelWork models_;
    ResponseWork response_;
    std::vector<scenes::EffectCost> costs_;
    bool has_event_ = false;
};

}  // namespace cdprep::report
