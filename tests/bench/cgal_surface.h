// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "cdprep/format/geometry.h"

namespace cdprep {

/// A mesh as CGAL has it, without triangles that repeat a corner.
class CgalSurface {
public:
    using Pair = std::array<std::uint32_t, 2>;

    /// Returns nothing if CGAL cannot hold it.
    template <class Positions>
    static std::optional<CgalSurface> of(const Positions& positions,
                                         std::span<const format::Triangle> triangles) {
        CgalSurface surface;
        for (const auto& p : positions) surface.mesh_.add_vertex({p.x, p.y, p.z});
        for (std::uint32_t i = 0; i < triangles.size(); ++i) {
            const auto& v = triangles[i].vertex;
            if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
            const auto face = surface.mesh_.add_face(Vertex(v[0]), Vertex(v[1]), Vertex(v[2]));
            if (face == Mesh::null_face()) return std::nullopt;
            surface.number_.push_back(i);
        }
        return surface;
    }

    template <class Positions>
    void move(const Positions& positions) {
        for (std::uint32_t i = 0; i < positions.size(); ++i) {
            const auto& p = positions[i];
            mesh_.point(Vertex(i)) = {p.x, p.y, p.z};
        }
    }

    /// Returns the pairs in order, without what CGAL says of triangles of zero area.
    [[nodiscard]] std::vector<Pair> self_intersections() const {
        std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> found;
        CGAL::Polygon_mesh_processing::self_intersections(mesh_, std::back_inserter(found));
        std::vector<Pair> pairs;
        for (const auto& [f, g] : found) {
            if (f == g) continue;
            const auto [a, b] = std::minmax({number_[f], number_[g]});
            pairs.push_back({a, b});
        }
        std::sort(pairs.begin(), pairs.end());
        return pairs;
    }

private:
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
    using Vertex = Mesh::Vertex_index;

    Mesh mesh_;
    std::vector<std::uint32_t> number_;  ///< of each face, in ours
};

}  // namespace cdprep
