// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mesh/mesh.h"
#include "validate/defects/finding.h"

namespace cdprep::report {

/// The map from model units to page units. It moves the box of the drawn triangles to the
/// origin, and scales it by a power of two, which is exact. The longest half side then lies in
/// [0.5, 1), so that floats suffice for every extent.
struct PageFrame {
    mesh::Double3 centre{};           ///< of the box, model units
    int exponent = 0;                 ///< a page unit is 2^exponent model units
    std::array<float, 3> half_box{};  ///< page units

    /// Returns the point in page units, as the nearest float; clamped at 2^40.
    [[nodiscard]] std::array<float, 3> from_model(const mesh::Double3& point) const noexcept;
};

/// Returns whether the triangle can be drawn: its corners exist and are finite.
[[nodiscard]] bool is_drawable(std::span<const mesh::Double3> positions,
                               const mesh::Triangle& triangle) noexcept;

/// Returns the frame of a mesh; nothing if none of its triangles can be drawn.
[[nodiscard]] std::optional<PageFrame> find_page_frame(std::span<const mesh::Double3> positions,
                                                       std::span<const mesh::Triangle> triangles);

/// The triangles as a page draws them: three floats per vertex, three indices per triangle.
struct DrawnTriangles {
    std::vector<float> positions;
    std::vector<std::uint32_t> indices;
};

/// Returns these triangles of the mesh (source numbers), with the vertices that they use.
[[nodiscard]] DrawnTriangles draw_triangles(std::span<const mesh::Double3> positions,
                                            std::span<const mesh::Triangle> triangles,
                                            const PageFrame& frame,
                                            std::span<const std::uint32_t> chosen);

/// Returns all drawable triangles of a mesh of at most `limit` triangles. Otherwise returns at most
/// `limit` of them near the places of the findings, within the largest cells that the limit allows.
/// The result holds source numbers, ascending.
[[nodiscard]] std::vector<std::uint32_t> choose_triangles(std::span<const mesh::Double3> positions,
                                                          std::span<const mesh::Triangle> triangles,
                                                          const PageFrame& frame,
                                                          std::span<const mesh::Finding> findings,
                                                          std::size_t limit);

/// Returns a coarse surface for all triangles except those left out (ascending). The vertices in
/// one cell of a grid become one. The grid has `cells` cells along the axes; the longest side
/// spans at least half of them. A plain surface gives about cells^2 triangles.
[[nodiscard]] DrawnTriangles coarse_triangles(std::span<const mesh::Double3> positions,
                                              std::span<const mesh::Triangle> triangles,
                                              const PageFrame& frame,
                                              std::span<const std::uint32_t> left_out,
                                              std::uint32_t cells);

}  // namespace cdprep::report
