// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "support/meshes.h"

namespace cdprep::test {

/// One of the large test models, normalised: centred, its box's diagonal 1, then
/// rounded to floats. Nothing where a checkout has no test models beside it (or in
/// $CDPREP_SHARED). Reads what those files are: binary PLY, float x, y, z, triangles.
[[nodiscard]] std::optional<TestMesh> seed_mesh(const std::string& name);

/// The same with the file's own coordinates.
[[nodiscard]] std::optional<TestMesh> seed_mesh_as_read(const std::string& name);

}  // namespace cdprep::test
