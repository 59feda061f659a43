// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/mesh.h"

namespace cdprep::mesh {

/// Returns the face of each triangle within its instance. If `soup.face` is empty, each triangle is
/// a face: its number in its instance, or in the whole file without instances.
[[nodiscard]] std::vector<std::uint32_t> source_faces(const TriangleSoup& soup);

}  // namespace cdprep::mesh
