// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "cdprep/contacts.h"
#include "cdprep/pairs.h"
#include "cdprep/plan.h"
#include "scene/list_pages.h"
#include "walk/find_contact.h"

namespace cdprep {

/// Where one thread writes its lists.
struct ListWriters {
    ListPages<TrianglePair>::Writer* triangle_pairs;  ///< null: nothing asks for them
    ListPages<Contact>::Writer* contacts;             ///< null: as above
    std::span<Contact> contact_room;                  ///< for the contacts of two objects
};

/// What is asked of two objects.
struct PairQuestion {
    const Pair& pair;
    const LayerPair& asks;  ///< the options of the effects
    Ask effects;
    TreePair touched;  ///< triangles that touched in the last step, or kNoPair
};

/// What is known of two objects.
struct PairAnswer {
    Ask holds = Ask::nothing;   ///< effects that hold
    Ask called = Ask::nothing;  ///< effects whose query was called; others followed from these
    Collision collision;
    Distance distance{};            ///< if `distance` holds
    ContactsVerdict contacts{};     ///< of the list of contacts
    std::uint64_t overlapping = 0;  ///< triangle pairs in the list
    TreePair touched = kNoPair;     ///< triangles found to touch
};

[[nodiscard]] PairAnswer ask_pair(const PairQuestion& question, Workspace& workspace,
                                  const ListWriters& lists) noexcept;

}  // namespace cdprep
