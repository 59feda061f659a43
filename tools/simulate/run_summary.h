// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "simulate/cost_table.h"

namespace cdprep::report {

/// What the summary of a run is about. All must outlive it.
struct RunSummary {
    const scenes::SceneFile& scene;
    const scenes::Simulation& simulation;  ///< after the last frame
    const CostTable& table;
    std::span<const EffectCost> costs;          ///< of --cost, else empty
    std::span<const std::string> not_computed;  ///< effects
    std::uint64_t frames;                       ///< that were asked for
};

/// Returns what made the response less exact: lists that were cut short, bodies that were too fast.
[[nodiscard]] std::vector<std::string> response_warnings(const dynamics::DynamicsCounts& counts);

/// Returns the summary as text: a table of effects and parts, and what was not computed.
[[nodiscard]] std::string summary_text(const RunSummary& summary);

/// Returns the same as JSON on one line (simulate.schema.json).
[[nodiscard]] std::string summary_json(const RunSummary& summary);

}  // namespace cdprep::report
