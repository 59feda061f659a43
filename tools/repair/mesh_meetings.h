// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "crossings/self_intersections.h"
#include "repair/repair_step.h"

namespace cdprep::mesh {

/// Runs search_self_intersections() on the mesh. Vertices with equal positions count as one:
/// separated copies touch, but are no finding.
bool search_meetings(const RepairMesh& mesh, const SearchOptions& options,
                     const TakeMeetings& take);

/// Returns whether any two triangles meet. Also false if a limit or a stop ended the search
/// first.
[[nodiscard]] bool has_meetings(const RepairMesh& mesh, const SearchOptions& options);

struct Meetings {
    std::vector<TriangleMeeting> pairs;  ///< sorted by (a, b)
    bool is_complete;                    ///< false: there may be more
};

/// Returns all meetings; 12 bytes per pair.
[[nodiscard]] Meetings find_meetings(const RepairMesh& mesh, const SearchOptions& options);

/// Returns "triangle 17", or that a step made the triangle.
[[nodiscard]] std::string triangle_in_words(const RepairMesh& mesh, std::uint32_t triangle);

}  // namespace cdprep::mesh
