// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh.h"

namespace cdprep::mesh {

/// Examines the triangles around one vertex after the other. Reuses its memory.
class Fan {
public:
    /// Returns whether the triangles of a star certainly lie side by side. That is: seen along
    /// some direction, they form one open or closed fan around the vertex without overlap. Any
    /// two of them then share only corners and edges. False proves nothing. The triangles must
    /// have area. O(k log k) for k triangles.
    [[nodiscard]] bool lies_side_by_side(const Mesh& mesh, std::uint32_t vertex,
                                         std::span<const std::uint32_t> star);

private:
    void find_rays(const Mesh& mesh, std::uint32_t vertex, std::span<const std::uint32_t> star);

    /// Finds the successor of each sector. Returns false unless each ray begins one sector and
    /// ends one; a first and a last ray are exceptions. The first function is for up to kFew
    /// sectors, the second for any number.
    bool chain_few();
    bool chain_many();

    /// Computes the edge vectors along the rays, and the direction of view. Returns false if
    /// numbers are too large, or if a sector may turn the other way.
    bool look(const Mesh& mesh, std::uint32_t vertex);

    /// Returns whether the least possible number of sectors passes the first ray or arrives at
    /// it.
    bool is_simple();

    [[nodiscard]] std::size_t rays() const {
        return is_open_ ? count_ + 1 : count_;
    }

    /// Most stars have fewer sectors: a loop of this length needs no branch.
    static constexpr std::size_t kFew = 8;

    std::size_t count_ = 0;
    std::size_t first_ = 0;  ///< a sector without a predecessor, if there is one
    bool is_open_ = false;
    Double3 along_{};  ///< the direction
    double size_ = 0;  ///< sum of the absolute values of its components
    // By sector, for the ray that begins it; for an open fan, the last ray is at the end.
    std::vector<std::uint32_t> from_;   ///< vertex of the ray
    std::vector<std::uint32_t> to_;     ///< vertex of the ray that ends the sector
    std::vector<std::uint32_t> next_;   ///< index of that ray
    std::vector<Double3> way_;          ///< vector from the star's vertex
    std::vector<double> far_;           ///< its largest component
    std::vector<Double3> normal_;       ///< of the sector
    std::vector<std::uint8_t> before_;  ///< on the negative side of the first ray
    std::vector<std::uint32_t> order_;  ///< sectors by vertex
};

}  // namespace cdprep::mesh
