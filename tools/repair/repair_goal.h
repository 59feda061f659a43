// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "mesh/mesh.h"
#include "repair/repair_step.h"
#include "crossings/self_intersections.h"
#include "repair/stored_verdict.h"

namespace cdprep::mesh {

/// Pairs of triangles of a mesh that cross, touch or overlap where they are no neighbours.
struct SelfCrossing {
    std::uint64_t pairs = 0;
    /// Those of triangles without a common corner. A triangle counts once with its copies and
    /// its pieces: cutting a triangle makes nothing worse.
    std::uint64_t apart = 0;
    std::uint32_t first = 0;  ///< the lowest pair, by number in the soup; 0 when there is none
    std::uint32_t second = 0;
    bool is_complete = true;  ///< else the limits ended the search: there may be more pairs
};

/// Vertices with equal positions count as one; triangles with bad numbers, repeated corners
/// or no area are in no pair. Exact. Copies of a triangle are counted, not listed: see
/// search_distinct_meetings() for the cost.
[[nodiscard]] SelfCrossing find_self_crossing(const TriangleSoup& soup,
                                              const SearchOptions& options = {});

/// The same of what a repair made of `input`. Triangles of which a common corner is known
/// from the input count as neighbours, whatever became of them. 24 bytes of scratch for each
/// pair of `apart`, up to some millions; with more the result is not complete.
[[nodiscard]] SelfCrossing find_output_crossing(const TriangleSoup& input, const RepairMesh& output,
                                                const SearchOptions& options = {});

/// What a preset of find_repair_preset() promises and its output lacks, in words: "not
/// solid: 12 pairs of triangles still cross or touch; first 310 and 1877". Empty when the
/// goal is reached; never of an output without triangles. "solid" asks that nothing crosses,
/// the others that not more crosses than in the input.
[[nodiscard]] std::string missed_goal(std::string_view preset, const StoredVerdict& after,
                                      const SelfCrossing& crossing_before,
                                      const SelfCrossing& crossing_after);

/// Says in words that the output has more crossings than the input; empty when not, or
/// where a limit ended the search in the input.
[[nodiscard]] std::string worse_crossing(const SelfCrossing& before, const SelfCrossing& after);

}  // namespace cdprep::mesh
