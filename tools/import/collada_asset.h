// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "mesh/mesh.h"

namespace cdprep::import {

/// Sets unit and up axis of a soup read from a COLLADA file, which assimp keeps
/// to itself: <unit meter="..."> and <up_axis> of the document's <asset>; without
/// them 1 m and Y, as the format says. Leaves other formats alone.
void add_collada_asset(std::string_view bytes, mesh::TriangleSoup& soup);

/// The first mesh or node that a COLLADA file takes from another file, "other.dae#arm", which
/// assimp does not follow. Empty where there is none, and for other files.
[[nodiscard]] std::string find_outside_reference(std::string_view bytes);

}  // namespace cdprep::import
