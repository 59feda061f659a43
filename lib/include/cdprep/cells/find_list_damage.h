// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "cdprep/format/api.h"
#include "cdprep/format/find_damage.h"
#include "cdprep/model.h"

namespace cdprep {

/// Checks the lists of the octrees and the tetra-tree completely. Returns nothing if all are
/// correct, or if there are no such trees. Each leaf must list exactly the triangles that have a
/// point in its closed cell or cone. The first references of a tetra-tree must be exactly the
/// triangles that contain the centre, which no leaf lists.
///
/// A reference must be marked as shared if and only if other leaves list the same triangle. An
/// octree's root must contain every corner of a triangle, and its tables must find every node.
/// These checks are exact: no rounding changes a sign. Radii of a tetra-tree count as damage if
/// they exclude more of a triangle than rounding can explain. If a cone's planes cut the triangle,
/// the radii may exclude a millionth of the size of the part inside. The boxes of an octree's cells
/// must contain the contents of the cells, up to rounding. The box of a cone must contain, up to
/// rounding, the triangle corners that lie in this cone. Other points of triangles are not checked.
///
/// format::find_deep_damage() must find nothing in `file`. `model` is this file, opened with all
/// its sections. Takes O(references * levels) steps of about a microsecond. Allocates.
[[nodiscard]] CDPREP_API std::optional<format::Damage> find_list_damage(
    std::span<const std::byte> file, const Model& model);

}  // namespace cdprep
