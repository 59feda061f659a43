// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "page/page_surface.h"
#include "simulate/page/scene_frames.h"

namespace cdprep::report {

/// A model as the page draws it, in page units relative to its centre.
struct ModelDrawing {
    std::size_t triangles = 0;  ///< of the model
    bool is_drawn = false;      ///< false: no positions, or no object is on the page
    bool is_exact = true;       ///< false: `drawn` is coarse, and `lit` has what is ever lit
    Double3 centre{};           ///< model units
    std::array<float, 3> half{};
    DrawnTriangles drawn;                ///< exact: triangle i has the i-th source number
    std::vector<std::uint32_t> numbers;  ///< source numbers of `drawn`, or of `lit` if coarse
    std::vector<float> lit;              ///< nine floats a triangle
    std::size_t lit_left_out = 0;        ///< lit triangles for which there is no room
};

/// What the page draws, and its unit.
struct SceneGeometry {
    PageFrame frame;  ///< of the box around all objects in all shown frames
    std::vector<ModelDrawing> models;
};

/// Draws at most `most` triangles exactly; models share them. Larger models are drawn coarsely.
[[nodiscard]] SceneGeometry draw_scene(const scenes::SceneFile& file,
                                       std::span<const scenes::SceneModel> models,
                                       const SceneFrames& frames,
                                       std::span<const scenes::ChangingObjects> changing,
                                       std::size_t most);

/// Returns the unit quaternion w, x, y, z of a rotation (Shepperd 1978), with w >= 0.
[[nodiscard]] std::array<double, 4> quaternion_of(const std::array<double, 9>& rotation) noexcept;

}  // namespace cdprep::report
