// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cdprep/format/geometry.h"

namespace cdprep::report {

/// The map from model units to page units. It moves the box of the drawn triangles to the
/// origin, and scales it by a power of two, which is exact. The longest half side then lies in
/// [0.5, 1), so that floats suffice for every extent.
struct PageFrame {
    format::Double3 centre{};         ///< of the box, model units
    int exponent = 0;                 ///< a page unit is 2^exponent model units
    std::array<float, 3> half_box{};  ///< page units

    /// Returns the point in page units, as the nearest float; clamped at 2^40.
    [[nodiscard]] std::array<float, 3> from_model(const format::Double3& point) const noexcept;
};

/// A cube around the box of a mesh, divided into equal cells.
class PageGrid {
public:
    explicit PageGrid(int cells) noexcept : cells_(cells) {}

    /// Returns the cell of a point in page units. Points beyond the cube are in the nearest cell.
    [[nodiscard]] std::array<int, 3> cell_of(const std::array<float, 3>& point) const noexcept;
    /// Returns the number of a cell, below cells()^3.
    [[nodiscard]] std::size_t number(int x, int y, int z) const noexcept;
    [[nodiscard]] int cells() const noexcept {  ///< along an axis
        return cells_;
    }

private:
    int cells_;
};

/// Returns whether the triangle can be drawn: its corners exist and are finite.
[[nodiscard]] bool is_drawable(std::span<const format::Double3> positions,
                               const format::Triangle& triangle) noexcept;

/// Returns the frame of a mesh; nothing if none of its triangles can be drawn.
[[nodiscard]] std::optional<PageFrame> find_page_frame(std::span<const format::Double3> positions,
                                                       std::span<const format::Triangle> triangles);

/// The triangles as a page draws them: three floats per vertex, three indices per triangle.
struct DrawnTriangles {
    std::vector<float> positions;
    std::vector<std::uint32_t> indices;
};

/// Returns these triangles of the mesh (source numbers), with the vertices that they use.
[[nodiscard]] DrawnTriangles draw_triangles(std::span<const format::Double3> positions,
                                            std::span<const format::Triangle> triangles,
                                            const PageFrame& frame,
                                            std::span<const std::uint32_t> chosen);

/// Returns a coarse surface for all triangles except those left out (ascending). The vertices in
/// one cell of a grid become one. The grid has `cells` cells along the axes; the longest side
/// spans at least half of them. A plain surface gives about cells^2 triangles.
[[nodiscard]] DrawnTriangles coarse_triangles(std::span<const format::Double3> positions,
                                              std::span<const format::Triangle> triangles,
                                              const PageFrame& frame,
                                              std::span<const std::uint32_t> left_out,
                                              std::uint32_t cells);

/// Shares a number of triangles among meshes of these sizes. No mesh gets less than an even share
/// unless it has fewer triangles.
[[nodiscard]] std::vector<std::size_t> share_triangles(std::span<const std::size_t> sizes,
                                                       std::size_t triangles);

}  // namespace cdprep::report
