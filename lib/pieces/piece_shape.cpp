// SPDX-License-Identifier: MIT
#include "pieces/piece_shape.h"

#include <algorithm>

#include "core/numbers.h"
#include "hull/hull_edges.h"
#include "hull/hull_points.h"
#include "pieces/contact_side.h"

namespace cdprep {

bool PieceShape::set(const ContactSide& side, const Double3& origin) noexcept {
    const auto facets = side.facets();
    corners_ = faces_ = edges_ = 0;
    // A hull of f triangles has 3 f / 2 edges.
    if (facets.empty() || side.points().count > kMostCorners) return false;
    if (facets.size() * 3 / 2 > kMostEdges) return false;
    set_corners(side, origin);
    if (!(reach_ < kLongest)) return false;
    const HullEdges edges(facets, side.adjacency());
    for (std::uint32_t f = 0; f < facets.size(); f = edges.end_of_face(f)) {
        if (faces_ == kMostFaces) return false;
        if (!add_face(facets.subspan(f, edges.end_of_face(f) - f))) return false;
    }
    add_edges(side);
    set_inward();
    return true;
}

void PieceShape::set_corners(const ContactSide& side, const Double3& origin) noexcept {
    position_error_ = side.position_error();
    reach_ = 0;
    corners_ = side.points().count;
    box_ = {{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
    for (std::uint32_t i = 0; i < corners_; ++i) {
        const Double3 p = side.corner(i) - origin;
        corner_[i] = p;
        reach_ = std::max(reach_, length(p));
        box_ = {
            {std::min(box_.lower.x, p.x), std::min(box_.lower.y, p.y), std::min(box_.lower.z, p.z)},
            {std::max(box_.upper.x, p.x), std::max(box_.upper.y, p.y),
             std::max(box_.upper.z, p.z)}};
    }
}

/// Takes the normal of the largest facet: that of a sliver is the least certain.
bool PieceShape::add_face(std::span<const format::PieceFacet> facets) noexcept {
    double most = 0, shortest = 0;
    for (const format::PieceFacet& facet : facets) {
        const Double3& p = corner_[facet.corner[0]];
        const Double3 e = corner_[facet.corner[1]] - p, f = corner_[facet.corner[2]] - p;
        const Double3 n = cross(e, f);
        const double area = length(n);
        if (!(area > most)) continue;
        most = area;
        const double sides = length(e) + length(f);
        const double product = length(e) * length(f);
        shortest = std::min(length(e), length(f));
        face_[faces_] = {(1 / area) * n,
                         (4 * position_error_ * sides + 16 * kUnit * product) / area,
                         facet.corner[0], (facet.flags & format::facet_virtual) == 0};
    }
    if (!(most > kLeastArea && shortest > kShortest)) return false;
    ++faces_;
    return true;
}

void PieceShape::add_edges(const ContactSide& side) noexcept {
    const HullEdges edges(side.facets(), side.adjacency());
    const auto third = [&](const FacetPlace& p) {
        return static_cast<std::uint8_t>(side.facets()[p.facet].corner[(p.corner + 2) % 3]);
    };
    for (std::uint32_t f = 0; f < side.facets().size(); ++f) {
        for (std::uint32_t k = 0; k < 3; ++k) {
            const FacetPlace p = {f, k};
            if (side.adjacency()[f].across[k] < f || !edges.is_edge(p)) continue;
            edge_[edges_++] = {static_cast<std::uint8_t>(edges.start(p)),
                               static_cast<std::uint8_t>(edges.end(p)), third(p),
                               third(edges.twin(p))};
        }
    }
}

void PieceShape::set_inward() noexcept {
    for (std::size_t i = 0; i < format::kHullLanes * inward().size(); ++i) {
        set_hull_point(inward_, i, i < faces_ ? -face_[i].normal : Double3{});
    }
}

}  // namespace cdprep
