// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "cdprep/contacts.h"
#include "cdprep/hulls.h"
#include "cdprep/pairs.h"
#include "cdprep/scene.h"
#include "scene/list_pages.h"
#include "scene/scene_records.h"
#include "walk/find_contact.h"

namespace cdprep {

/// Where one thread writes its lists and its times.
struct ListWriters {
    ListPages<TrianglePair>::Writer* triangle_pairs;  ///< null: nothing asks for them
    ListPages<Contact>::Writer* contacts;             ///< null: as above
    std::span<Contact> contact_room;                  ///< for the contacts of two objects
    SceneClock clock;                                 ///< null: no times
    std::uint64_t* ticks;                             ///< by effect
};

/// What is asked of two objects.
struct PairQuestion {
    const Pair& pair;
    const LayerPair& asks;  ///< the options of the effects
    SearchStarts starts;    ///< that the last step found
    const Pose& last_a;     ///< the poses at the begin of the step, of `continuous`
    const Pose& last_b;
    HapticRecord* haptic;           ///< of `haptic`, otherwise null
    double max_error;               ///< of `distance`: PairRung::error
    const EnclosingParts* parts_a;  ///< null: the rung is the walk
    const EnclosingParts* parts_b;
};

/// What is known of two objects.
struct PairAnswer {
    Ask holds = Ask::nothing;   ///< effects that hold
    Ask called = Ask::nothing;  ///< effects whose query was called; others followed from these
    Collision collision;
    Distance distance{};            ///< if `distance` holds
    Impact impact{};                ///< of `continuous`
    ContactsVerdict contacts{};     ///< of the list of contacts
    std::uint64_t overlapping = 0;  ///< triangle pairs in the list
    SearchStarts starts;
};

/// The queries about two objects: see ask_pair.cpp.
class PairQueries;

/// Asks one set of effects. There is an instance for each set, and none decides what to ask while
/// it runs.
using PairKernel = void (*)(PairQueries& queries) noexcept;

/// Returns the instance for a set of effects of two objects. Null for a set that Plan refuses.
[[nodiscard]] PairKernel pair_kernel(Ask effects) noexcept;

/// Asks the effects of a kernel.
[[nodiscard]] PairAnswer ask_pair(const PairQuestion& question, PairKernel kernel,
                                  Workspace& workspace, const ListWriters& lists) noexcept;

/// Finds the triangles of one object that overlap each other.
[[nodiscard]] PairAnswer ask_self(const Model& model, Workspace& workspace,
                                  const ListWriters& lists) noexcept;

}  // namespace cdprep
