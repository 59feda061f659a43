// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "crossings/self_intersections.h"
#include "mesh/component_numbers.h"
#include "mesh/nesting.h"
#include "validate/defects/component_pairs.h"
#include "validate/defects/copies.h"
#include "validate/defects/finding_list.h"
#include "validate/defects/sound_mesh.h"

namespace cdprep::mesh {

/// The facts about components that follow from meetings of triangles.
struct ComponentMeetings {
    std::vector<bool> self_crossing;  ///< per component: two of its triangles meet
    std::vector<bool> overlapping;    ///< per nested pair: the two components overlap
    bool any = false;                 ///< any two triangles meet
    bool is_complete = true;          ///< all pairs of triangles were examined
};

/// The inputs of list_meetings(). References must outlive the use.
struct MeetingGrounds {
    const Copies& copies;
    const SoundMesh& sound;
    const ComponentNumbers& components;
    const std::vector<Nested>& nested;  ///< sorted by inner, then outer
};

/// Lists CDP0403 and CDP0501 to CDP0503, and counts the pairs. Counts and lists the same pairs
/// as find_self_intersections(). The cost depends only on the distinct meetings and on the kept
/// places. If the limits end the search, the result covers the part done until then. Memory is
/// linear in the mesh and in the places, whatever the number of pairs.
[[nodiscard]] ComponentMeetings list_meetings(const MeetingGrounds& grounds,
                                              const SearchOptions& options, FindingList& findings,
                                              DefectCounts& counts);

}  // namespace cdprep::mesh
