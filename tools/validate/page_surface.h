// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "validate/defects/finding.h"
#include "mesh/mesh.h"

namespace cdprep::report {

/// Where a page draws a mesh: so that floats serve for every extent, the box of the
/// drawn triangles is moved to the origin and scaled by a power of two, which loses
/// nothing, until its longest half side lies in [0.5, 1).
struct PageFrame {
    mesh::Double3 centre{};           ///< of the box, model units
    int exponent = 0;                 ///< a page unit is 2^exponent model units
    std::array<float, 3> half_box{};  ///< page units

    /// The point in page units, to the nearest float; beyond 2^40 it stays there.
    [[nodiscard]] std::array<float, 3> from_model(const mesh::Double3& point) const noexcept;
};

/// Whether the triangle can be drawn: corners that exist and are finite.
[[nodiscard]] bool is_drawable(std::span<const mesh::Double3> positions,
                               const mesh::Triangle& triangle) noexcept;

/// The frame of a mesh; nothing when no triangle of it can be drawn.
[[nodiscard]] std::optional<PageFrame> find_page_frame(std::span<const mesh::Double3> positions,
                                                       std::span<const mesh::Triangle> triangles);

/// Triangles as a page draws them: three floats a vertex, three indices a triangle.
struct DrawnTriangles {
    std::vector<float> positions;
    std::vector<std::uint32_t> indices;
};

/// Those triangles (source numbers) of the mesh, with the vertices that they use.
[[nodiscard]] DrawnTriangles draw_triangles(std::span<const mesh::Double3> positions,
                                            std::span<const mesh::Triangle> triangles,
                                            const PageFrame& frame,
                                            std::span<const std::uint32_t> chosen);

/// The drawable triangles if they are at most `limit`; else at most `limit` of them that
/// lie nearest around the places of the findings, within cells as large as the limit
/// allows. Source numbers, ascending.
[[nodiscard]] std::vector<std::uint32_t> choose_triangles(std::span<const mesh::Double3> positions,
                                                          std::span<const mesh::Triangle> triangles,
                                                          const PageFrame& frame,
                                                          std::span<const mesh::Finding> findings,
                                                          std::size_t limit);

/// A coarse stand-in for all triangles but those left out (ascending): vertices in one cell of a
/// grid become one, with `cells` (half as many at least) along the longest side. Some cells^2
/// triangles for a plain surface.
[[nodiscard]] DrawnTriangles coarse_triangles(std::span<const mesh::Double3> positions,
                                              std::span<const mesh::Triangle> triangles,
                                              const PageFrame& frame,
                                              std::span<const std::uint32_t> left_out,
                                              std::uint32_t cells);

}  // namespace cdprep::report
