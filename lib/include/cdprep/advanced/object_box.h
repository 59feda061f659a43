// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "cdprep/broad_phase.h"
#include "cdprep/format/api.h"
#include "cdprep/model.h"
#include "cdprep/pose.h"

namespace cdprep {

/// The root box of a moved model, along the axes of the model, enlarged by a reach on all sides.
struct RootBox {
    std::array<double, 3> middle{};
    std::array<double, 9> axes{};  ///< column k is axis k of the model in the world
    std::array<double, 3> half{};  ///< negative if there are no triangles
    double size = 0;               ///< scale of rounding errors: >= sum of all inputs' magnitudes
};

/// Returns a box that contains all points of a moved model, as transform_point() rounds them. The
/// box extends at least `reach` beyond them, in model units. If two models are at most d apart,
/// their boxes with a reach of d / 2 each meet. The reach must be finite and at least 0, and the
/// model must be opened with its BVH. Otherwise, the program is aborted with a message.
[[nodiscard]] CDPREP_API RootBox root_box(const Model& model, const Pose& world_from_model,
                                          double reach) noexcept;

/// Returns the axis-aligned box around a root box, for BroadPhase; absent if there are no
/// triangles. The box is relative to `origin`, which must be the same for all boxes. The
/// coordinates of `origin` must be finite and at most 2^1000 in magnitude. Rounding to float widens
/// the box: at a distance of 10^7 from the origin, by about one unit on each side.
[[nodiscard]] CDPREP_API WorldBox world_box(const RootBox& root,
                                            const Double3& origin = {}) noexcept;

/// Returns false if two root boxes are certainly apart. Tests the fifteen axes of Gottschalk, Lin
/// and Manocha (1996).
[[nodiscard]] CDPREP_API bool may_meet(const RootBox& a, const RootBox& b) noexcept;

}  // namespace cdprep
