// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh.h"

namespace cdprep::mesh {

/// The triangles around each vertex, ascending.
class VertexStars {
public:
    /// Uses the triangles that are not marked (one bit each, or no words at all). None of these
    /// may repeat a corner.
    VertexStars(const Mesh& mesh, std::span<const std::uint64_t> marked);

    [[nodiscard]] std::span<const std::uint32_t> around(std::size_t vertex) const {
        return std::span(triangles_).subspan(first_[vertex], first_[vertex + 1] - first_[vertex]);
    }

private:
    std::vector<std::uint32_t> first_;
    std::vector<std::uint32_t> triangles_;
};

}  // namespace cdprep::mesh
