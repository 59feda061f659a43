// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "crossings/self_intersections.h"
#include "mesh/mesh.h"
#include "repair/repair_step.h"
#include "repair/stored_verdict.h"

namespace cdprep::mesh {

/// Pairs of triangles of a mesh that cross, touch or overlap, other than as neighbours do.
struct SelfCrossing {
    std::uint64_t pairs = 0;
    /// Pairs of triangles without a common corner. A triangle counts once with its copies and
    /// its fragments, so cutting a triangle makes nothing worse.
    std::uint64_t apart = 0;
    std::uint32_t first = 0;  ///< the lowest pair, by number in the soup; 0 if there is none
    std::uint32_t second = 0;
    bool is_complete = true;  ///< false: a limit ended the search, and there may be more pairs
};

/// Returns the crossing pairs of a soup. Vertices with equal positions count as one. Triangles
/// with bad numbers, repeated corners or zero area are in no pair. Exact. Copies of a triangle
/// are counted, not listed; search_distinct_meetings() states the cost.
[[nodiscard]] SelfCrossing find_self_crossing(const TriangleSoup& soup,
                                              const SearchOptions& options = {});

/// Returns the crossing pairs of the output of a repair of `input`. Triangles with a common
/// corner in the input count as neighbours, whatever the repair did to them. Uses 24 bytes of
/// scratch memory per pair of `apart`, up to some millions of pairs. With more the result is not
/// complete.
[[nodiscard]] SelfCrossing find_output_crossing(const TriangleSoup& input, const RepairMesh& output,
                                                const SearchOptions& options = {});

/// Returns the promises of a find_repair_preset() preset that the output breaks, in words. An
/// example is "not solid: 12 pairs of triangles still cross or touch; first 310 and 1877". Empty
/// if the goal is reached. Never empty for an output without triangles. "solid" requires that
/// nothing crosses; the other presets require no more crossings than in the input.
[[nodiscard]] std::string missed_goal(std::string_view preset, const StoredVerdict& after,
                                      const SelfCrossing& crossing_before,
                                      const SelfCrossing& crossing_after);

/// Returns a text if the output has more crossings than the input; empty otherwise. Also empty
/// if a limit ended the search in the input.
[[nodiscard]] std::string worse_crossing(const SelfCrossing& before, const SelfCrossing& after);

}  // namespace cdprep::mesh
