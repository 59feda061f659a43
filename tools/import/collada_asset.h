// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "mesh/mesh.h"

namespace cdprep::import {

/// Sets unit and up axis of a soup read from a COLLADA file; assimp does not return them.
/// They are <unit meter="..."> and <up_axis> of the document's <asset>. Without them the unit
/// is 1 m and the axis is Y, as the format specifies. Leaves other formats unchanged.
void add_collada_asset(std::string_view bytes, mesh::TriangleSoup& soup);

/// Returns the first reference of a COLLADA file to a mesh or node in another file, such as
/// "other.dae#arm". assimp does not follow these. Empty if there is none, and for other formats.
[[nodiscard]] std::string find_outside_reference(std::string_view bytes);

}  // namespace cdprep::import
