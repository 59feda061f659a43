// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>

#include "simulate/run/simulation.h"

namespace cdprep::report {

/// Returns an event of the last frame of a simulation as JSON (simulate.schema.json). It has the
/// frame and its time, "begins", "stays" or "ends", the effect, the two objects and the reason.
/// Unless it ends, it has what the effect found: bounds, or the length of a list.
[[nodiscard]] nlohmann::ordered_json event_json(std::uint64_t frame, double time_s,
                                                const SceneEvent& event,
                                                const scenes::Simulation& simulation);

/// Returns an event of two objects that push each other as JSON (simulate.schema.json). It has the
/// frame and its time, "begins", "stays" or "ends", and the objects.
[[nodiscard]] nlohmann::ordered_json push_event_json(std::uint64_t frame, double time_s,
                                                     const scenes::PushEvent& event,
                                                     const scenes::SceneFile& scene);

/// Returns an event of a body in the last frame as JSON (simulate.schema.json). It has the frame
/// and its time, "sleeps", "wakes" or "impact", and the body. An impact also has the object that
/// was met, and its own time.
[[nodiscard]] nlohmann::ordered_json body_event_json(std::uint64_t frame, double time_s,
                                                     const scenes::BodyEvent& event,
                                                     const scenes::SceneFile& scene);

}  // namespace cdprep::report
