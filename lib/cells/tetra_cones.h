// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "cdprep/format/tetra_tree.h"
#include "exact/triangle_contact.h"

namespace cdprep {

/// A generator of a cone, times 2^level: whole numbers whose sizes add up to 2^level.
using Generator = std::array<std::int32_t, 3>;

/// A cone of the octahedral map: directions from the centre.
struct TetraCone {
    std::array<Generator, 3> generator;
    std::uint32_t level;
};

using format::tetra_level;

/// Returns the cone of a key.
[[nodiscard]] TetraCone tetra_cone(std::uint32_t key) noexcept;

/// Returns the key of the half-open cone of `level` that holds the direction from `centre` to `p`,
/// which must differ. Exact, in O(level), without reading a tree. Ties go to the child of the
/// lowest number, zeros to the positive octant.
[[nodiscard]] std::uint32_t tetra_key(const Double3& centre, const Double3& p,
                                      std::uint32_t level) noexcept;

/// Returns whether the triangle and the closed cone with its apex at `centre` have a
/// common point. Exact. Corners may be collinear or equal; a triangle that holds the
/// centre touches every cone.
[[nodiscard]] bool triangle_touches_cone(const Corners& t, const Double3& centre,
                                         const TetraCone& cone) noexcept;

/// Returns a point from which the centre lies in the direction of the middle of the cone's
/// generators. The direction is rounded by a few units in the last place. The ray that starts at
/// the centre and runs away from the point is then inside the cone (winding.h). Never returns the
/// centre.
[[nodiscard]] Double3 behind_centre(const Double3& centre, const TetraCone& cone) noexcept;

}  // namespace cdprep
