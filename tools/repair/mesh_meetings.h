// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "repair/repair_step.h"
#include "crossings/self_intersections.h"

namespace cdprep::mesh {

/// search_self_intersections() of the mesh. Vertices with equal positions count as one: what
/// was parted touches, and is no finding.
bool search_meetings(const RepairMesh& mesh, const SearchOptions& options,
                     const TakeMeetings& take);

/// Any two triangles meet. False also when a limit or a stop ended the search before.
[[nodiscard]] bool has_meetings(const RepairMesh& mesh, const SearchOptions& options);

struct Meetings {
    std::vector<TriangleMeeting> pairs;  ///< sorted by (a, b)
    bool is_complete;                    ///< else there are more
};

/// All of them: 12 bytes a pair.
[[nodiscard]] Meetings find_meetings(const RepairMesh& mesh, const SearchOptions& options);

/// "triangle 17", or that a step made it.
[[nodiscard]] std::string triangle_in_words(const RepairMesh& mesh, std::uint32_t triangle);

}  // namespace cdprep::mesh
