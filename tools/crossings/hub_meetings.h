// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "crossings/meeting_search.h"
#include "mesh/vertex_stars.h"

namespace cdprep::mesh {

/// Vertices with very many triangles. The boxes of those triangles all overlap at the
/// vertex: a hierarchy of boxes would look at every two of them.
class Hubs {
public:
    /// References must outlive the object. O(n).
    Hubs(const Mesh& mesh, const VertexStars& stars);

    [[nodiscard]] bool empty() const {
        return hub_.empty();
    }

    /// The triangle has a hub for a corner.
    [[nodiscard]] bool has(std::uint32_t triangle) const {
        return !home_.empty() && home_[triangle] != kNowhere;
    }

private:
    friend class HubSearch;
    static constexpr std::uint32_t kNowhere = 0xffffffff;

    std::vector<std::uint32_t> hub_;   ///< vertices, those with most triangles first
    std::vector<std::uint32_t> home_;  ///< per triangle: the first of its hubs; empty: no hubs
};

/// Searches the meetings of triangles that Hubs::has() with triangles that share no vertex
/// with them. `flat` marks triangles without area, as find_degenerate() does.
///
/// Looks from the hub at each triangle that overlaps the box of the hub's triangles, and
/// finds those of them that are seen in the same direction. O(n log k) for hubs with k
/// triangles, and O(pairs) for those that overlap as seen from the hub.
void search_hub_meetings(const Mesh& mesh, std::span<const std::uint64_t> flat,
                         const VertexStars& stars, const Hubs& hubs, MeetingSearch& search);

}  // namespace cdprep::mesh
