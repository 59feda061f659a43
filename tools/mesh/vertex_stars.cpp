// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/vertex_stars.h"

namespace cdprep::mesh {
namespace {

bool is_marked(std::span<const std::uint64_t> marked, std::uint32_t triangle) {
    return !marked.empty() && ((marked[triangle / 64] >> (triangle % 64)) & 1) != 0;
}

}  // namespace

VertexStars::VertexStars(const Mesh& mesh, std::span<const std::uint64_t> marked)
    : first_(mesh.positions.size() + 1) {
    const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
    for (std::uint32_t triangle = 0; triangle < count; ++triangle) {
        if (is_marked(marked, triangle)) continue;
        for (const std::uint32_t vertex : mesh.triangles[triangle].vertex) ++first_[vertex];
    }
    std::uint32_t end = 0;
    for (std::uint32_t& first : first_) first = end += first;
    triangles_.resize(end);
    // From the back: each entry ends at the beginning of its star.
    for (std::uint32_t triangle = count; triangle-- > 0;) {
        if (is_marked(marked, triangle)) continue;
        for (const std::uint32_t vertex : mesh.triangles[triangle].vertex) {
            triangles_[--first_[vertex]] = triangle;
        }
    }
}

}  // namespace cdprep::mesh
