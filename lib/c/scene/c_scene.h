// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstddef>

#include "c/memory.h"
#include "c/scene/c_plan.h"
#include "cdprep/c/scene.h"
#include "cdprep/scene.h"

namespace cdprep::c {

// Boxes and their pairs have the same members in C and in C++.
static_assert(sizeof(cdprep_world_box) == sizeof(WorldBox) &&
              offsetof(cdprep_world_box, upper) == offsetof(WorldBox, upper));
static_assert(sizeof(cdprep_box_pair) == sizeof(BoxPair) &&
              offsetof(cdprep_box_pair, b) == offsetof(BoxPair, b));

/// The results of the last complete step, as C structs. The room is that of the scene.
struct SceneResults {
    cdprep_scene_hit* hits = nullptr;
    cdprep_scene_overlap* overlaps = nullptr;    ///< without room if the plan asks for none
    cdprep_scene_distance* distances = nullptr;  ///< likewise
    cdprep_scene_contact* contacts = nullptr;    ///< likewise
    cdprep_contact* contact_items = nullptr;     ///< of all lists of contacts
    cdprep_event* events = nullptr;
    cdprep_scene_self_overlap* self_overlaps = nullptr;  ///< without room if none are asked for
    cdprep_scene_impact* impacts = nullptr;              ///< likewise
    cdprep_scene_bounded* bounded_distances = nullptr;   ///< likewise
    std::size_t hit_count = 0, overlap_count = 0, distance_count = 0, contact_count = 0;
    std::size_t event_count = 0, self_overlap_count = 0, impact_count = 0;
    std::size_t bounded_distance_count = 0;
};

/// Copies the results of a step.
void store_results(cdprep_scene& scene) noexcept;

}  // namespace cdprep::c

/// A scene. The object, the results and the memory of the C++ scene lie one after another in one
/// block.
struct cdprep_scene {
    cdprep::Scene scene;
    cdprep_plan* plan;
    cdprep::c::SceneResults results;
    const cdprep_model** models;  ///< by slot; of free slots, anything
    cdprep::c::Memory memory;     ///< none if it is the caller's
    std::atomic<bool> in_use = false;
};
