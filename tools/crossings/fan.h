// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh.h"

namespace cdprep::mesh {

/// Looks at the triangles around one vertex after the other. Keeps its memory.
class Fan {
public:
    /// Whether the triangles of a star, which have area, surely lie side by side: seen
    /// along some direction they turn around the vertex in one open or closed fan that
    /// overlaps nowhere. Any two of them then have nothing in common but shared corners
    /// and edges. False says nothing. O(k log k) for k triangles.
    [[nodiscard]] bool lies_side_by_side(const Mesh& mesh, std::uint32_t vertex,
                                         std::span<const std::uint32_t> star);

private:
    void find_rays(const Mesh& mesh, std::uint32_t vertex, std::span<const std::uint32_t> star);

    /// Finds the sector that follows each; false unless each ray begins one sector and
    /// ends one, but a first and a last. For up to kFew sectors, and for any number.
    bool chain_few();
    bool chain_many();

    /// Works out the ways along the rays, and the direction that the star is seen along;
    /// false where numbers are too large, or a sector may turn the other way.
    bool look(const Mesh& mesh, std::uint32_t vertex);

    /// Whether no more sectors than need be pass the first ray or arrive at it.
    bool is_simple();

    [[nodiscard]] std::size_t rays() const {
        return is_open_ ? count_ + 1 : count_;
    }

    /// Most stars have less: a loop so long needs no branch.
    static constexpr std::size_t kFew = 8;

    std::size_t count_ = 0;
    std::size_t first_ = 0;  ///< a sector that follows none, if there is one
    bool is_open_ = false;
    Double3 along_{};  ///< the direction
    double size_ = 0;  ///< sum of its components' sizes
    // By sector, for the ray that it begins with; the last ray of an open fan at the end.
    std::vector<std::uint32_t> from_;   ///< vertex
    std::vector<std::uint32_t> to_;     ///< vertex of the ray that the sector ends with
    std::vector<std::uint32_t> next_;   ///< that ray
    std::vector<Double3> way_;          ///< from the star's vertex
    std::vector<double> far_;           ///< its largest component
    std::vector<Double3> normal_;       ///< of the sector
    std::vector<std::uint8_t> before_;  ///< on the negative side of the first ray
    std::vector<std::uint32_t> order_;  ///< sectors by vertex
};

}  // namespace cdprep::mesh
