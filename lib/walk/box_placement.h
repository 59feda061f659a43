// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "cdprep/format/api.h"
#include "cdprep/model.h"
#include "cdprep/pose.h"
#include "exact/powers_of_two.h"
#include "kernels/kernels.h"

namespace cdprep {

/// The relative placement of the two hierarchies' boxes, in float. Its slack makes every box test
/// conservative for the vertices as the query moves them: no test separates a pair that shares a
/// point.
struct PlacedBoxes {
    kernels::BoxPlacement placement;
    bool apart;  ///< the root boxes are too far apart to overlap

    /// The same map in double: pair = rotation * (scale_b * frame_b) + shift.
    std::array<double, 9> rotation;
    std::array<double, 3> shift;
    double scale_a;
    double scale_b;
    int exponent;  ///< of two: a pair unit is 2^-exponent model units
    /// The largest relative error of vertices of the two models before any rounding to float. Pair
    /// units.
    double double_slack;
};

/// Returns the largest relative error of vertices of the two models, in model units.
[[nodiscard]] double double_slack(const Model& a, const Model& b,
                                  const Placement& placement) noexcept;

[[nodiscard]] CDPREP_API PlacedBoxes place_boxes(const Model& a, const Model& b,
                                                 const Placement& placement) noexcept;
/// The same for the frames of two headers.
[[nodiscard]] PlacedBoxes place_boxes(const format::FileHeader& a, const format::FileHeader& b,
                                      const Placement& placement) noexcept;

/// In pair units; beyond this, squares of lengths would leave the range of float.
inline constexpr double kMostReach = 0x1p60;

/// Rounds a distance in pair units up. Returns infinity, which excludes nothing, where float could
/// not compare larger distances.
[[nodiscard]] float float_reach(double distance) noexcept;

/// The answer that the places of two models give for all their triangles before any walk.
enum class Outlook : std::uint8_t {
    none,  ///< no two are within the tolerance
    some,  ///< not known
    all,   ///< any two are within the tolerance
};

/// Returns the outlook for a tolerance in model units. Requires that neither model is empty.
[[nodiscard]] Outlook outlook(const PlacedBoxes& placed, double tolerance) noexcept;

/// Returns the placement of a hierarchy with this frame relative to itself.
[[nodiscard]] PlacedBoxes place_upon_itself(const Double3& frame_origin,
                                            std::int32_t frame_exponent) noexcept;

}  // namespace cdprep
