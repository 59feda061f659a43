// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "cdprep/contacts.h"
#include "cdprep/pairs.h"
#include "cdprep/plan.h"
#include "scene/list_pages.h"

namespace cdprep {

/// Where one thread writes its lists.
struct ListWriters {
    ListPages<TrianglePair>::Writer* triangle_pairs;  ///< null: nothing asks for them
    ListPages<Contact>::Writer* contacts;             ///< null: as above
    std::span<Contact> contact_room;                  ///< for the contacts of two objects
};

/// What is known of two objects.
struct PairAnswer {
    Ask holds = Ask::nothing;   ///< effects that hold
    Ask called = Ask::nothing;  ///< effects whose query was called; others followed from these
    Collision collision;
    Distance distance{};            ///< if `distance` holds
    ContactsVerdict contacts{};     ///< of the list of contacts
    std::uint64_t overlapping = 0;  ///< triangle pairs in the list
};

/// Computes `effects` of two objects; `asks` has their options.
[[nodiscard]] PairAnswer ask_pair(const Pair& pair, const LayerPair& asks, Ask effects,
                                  Workspace& workspace, const ListWriters& lists) noexcept;

}  // namespace cdprep
