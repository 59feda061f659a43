// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "crossings/meeting_search.h"
#include "mesh/vertex_stars.h"

namespace cdprep::mesh {

/// Vertices with very many triangles. The boxes of these triangles all overlap at the vertex, so
/// a BVH would test every two of them.
class Hubs {
public:
    /// References must outlive the object. O(n).
    Hubs(const Mesh& mesh, const VertexStars& stars);

    [[nodiscard]] bool empty() const {
        return hub_.empty();
    }

    /// Returns whether a corner of the triangle is a hub.
    [[nodiscard]] bool has(std::uint32_t triangle) const {
        return !home_.empty() && home_[triangle] != kNowhere;
    }

private:
    friend class HubSearch;
    static constexpr std::uint32_t kNowhere = 0xffffffff;

    std::vector<std::uint32_t> hub_;   ///< vertices, by descending number of triangles
    std::vector<std::uint32_t> home_;  ///< by triangle: the first of its hubs; empty: no hubs
};

/// Searches the meetings of triangles for which Hubs::has() is true with triangles that share no
/// vertex with them. `flat` marks triangles without area, as find_degenerate() does.
///
/// Takes each triangle that overlaps the box of a hub's triangles. Finds those of the hub's
/// triangles that appear in the same direction from the hub. O(n log k) for hubs with k
/// triangles, and O(pairs) for those that overlap as seen from the hub.
void search_hub_meetings(const Mesh& mesh, std::span<const std::uint64_t> flat,
                         const VertexStars& stars, const Hubs& hubs, MeetingSearch& search);

}  // namespace cdprep::mesh
