// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "simulate/run/effect_counts.h"
#include "simulate/run/simulation.h"

namespace cdprep::scenes {

struct CostOptions {
    std::uint64_t frames = 1;
    std::uint32_t rounds = 5;
    std::uint32_t threads = 1;
    ParallelFor parallel_for = serial_for;
    /// Called before each frame, with the number of frames before and of all, in all runs. An error
    /// ends the measurement.
    std::function<Result<Done>(std::uint64_t done, std::uint64_t all)> begins =
        [](std::uint64_t /*done*/, std::uint64_t /*all*/) { return Done{}; };
};

/// Measures each effect of a scene by running the scene without it. A round runs the whole scene
/// and then each scene that lacks an effect, over the same frames. So slow changes of the machine
/// do not count as costs. Every other round runs them backwards. Without `response`, the bodies
/// move as in the whole scene: their poses are kept for all frames.
[[nodiscard]] Result<std::vector<report::EffectCost>> measure_costs(
    const SceneFile& file, std::span<const SceneModel> models, const CostOptions& options);

/// Fails with over_budget if these poses take more than a gigabyte.
[[nodiscard]] Result<Done> check_cost_room(const SceneFile& file, std::uint64_t frames);

}  // namespace cdprep::scenes
