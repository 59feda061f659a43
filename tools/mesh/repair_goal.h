// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "mesh/mesh.h"
#include "mesh/self_intersections.h"
#include "mesh/stored_verdict.h"

namespace cdprep::mesh {

/// Pairs of triangles of a mesh that cross, touch or overlap where they are no neighbours.
struct SelfCrossing {
    std::uint64_t pairs = 0;
    std::uint32_t first = 0;  ///< the lowest pair, by number in the soup; 0 when there is none
    std::uint32_t second = 0;
    bool is_complete = true;  ///< else the limits ended the search: there may be more pairs
};

/// Vertices with equal positions count as one; triangles with bad numbers, repeated corners
/// or no area are in no pair. Exact. Copies of a triangle are counted, not listed: see
/// search_distinct_meetings() for the cost.
[[nodiscard]] SelfCrossing find_self_crossing(const TriangleSoup& soup,
                                              const SearchOptions& options = {});

/// What a preset of find_repair_preset() promises and its output lacks, in words: "not
/// solid: 12 pairs of triangles still cross or touch; first 310 and 1877". Empty when the
/// goal is reached; never of an output without triangles. `crossing` is of the output, and
/// asked of "solid" alone.
[[nodiscard]] std::string missed_goal(std::string_view preset, const StoredVerdict& after,
                                      const std::optional<SelfCrossing>& crossing);

}  // namespace cdprep::mesh
