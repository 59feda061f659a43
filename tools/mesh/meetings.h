// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/component_numbers.h"
#include "mesh/copies.h"
#include "mesh/finding_list.h"
#include "mesh/self_intersections.h"
#include "mesh/sound_mesh.h"

namespace cdprep::mesh {

/// What meetings of triangles say of components.
struct ComponentMeetings {
    /// Two components with triangles that cross or share area in a plane.
    struct Pair {
        std::uint32_t a;  ///< a < b
        std::uint32_t b;
        std::uint32_t first_triangle;  ///< the lowest pair of them, of the mesh
        std::uint32_t second_triangle;
        std::uint64_t meetings;
    };
    std::vector<Pair> overlapping;    ///< sorted by (a, b)
    std::vector<bool> self_crossing;  ///< per component: two of its triangles meet
    bool any = false;                 ///< any two triangles meet

    [[nodiscard]] bool overlap(std::uint32_t a, std::uint32_t b) const;
};

/// CDP0403 and CDP0501 to 0503, and the counts of pairs, from find_distinct_meetings().
/// Counts and lists what find_self_intersections() would have found, pair by pair, at the
/// cost of the distinct meetings and of the places that are kept.
[[nodiscard]] ComponentMeetings list_meetings(std::span<const TriangleMeeting> distinct,
                                              const Copies& copies, const SoundMesh& sound,
                                              const ComponentNumbers& components,
                                              FindingList& findings, DefectCounts& counts);

}  // namespace cdprep::mesh
