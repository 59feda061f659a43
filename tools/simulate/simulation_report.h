// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "simulate/cost_table.h"
#include "simulate/run/simulation.h"

namespace cdprep::report {

enum class EventFormat : std::uint8_t { text, json, ndjson };

/// Collects the frames of a simulation and words its report.
class SimulationReport {
public:
    /// `scene` and `plan` must outlive the object. `frames` are asked for.
    SimulationReport(const scenes::SceneFile& scene, const Plan& plan, EventFormat format,
                     std::uint64_t frames);

    /// Returns the text that begins the report.
    [[nodiscard]] std::string begin() const;
    /// Adds the last frame of a simulation. Returns the text of its events, which is empty in the
    /// text format.
    [[nodiscard]] std::string add_frame(std::uint64_t frame, const scenes::Simulation& simulation);
    /// Adds what the scene saves without single effects.
    void set_costs(std::span<const EffectCost> costs) {
        costs_.assign(costs.begin(), costs.end());
    }
    /// Returns the text that ends the report: the summary of all frames.
    [[nodiscard]] std::string finish(const scenes::Simulation& simulation) const;
    /// Returns sentences about frames that are less exact than others, and what to change.
    [[nodiscard]] std::vector<std::string> warnings(bool is_gltf) const;

private:
    [[nodiscard]] static bool tells(const scenes::AskedPair& pair, EventKind kind);
    [[nodiscard]] bool is_told(const scenes::PushEvent& event) const;
    [[nodiscard]] std::string event_text(const nlohmann::ordered_json& event);

    const scenes::SceneFile& scene_;
    EventFormat format_;
    std::uint64_t frames_;
    std::vector<const scenes::AskedPair*> pairs_;  ///< by their numbers in the plan
    CostTable table_;
    std::vector<std::string> not_computed_;
    std::vector<EffectCost> costs_;
    bool has_event_ = false;
};

}  // namespace cdprep::report
