// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "support/meshes.h"

namespace cdprep::test {

/// Returns one of the large test models, normalised: centred, with a box of diagonal 1, then
/// rounded to floats. Returns nothing if there are no test models beside the checkout (or in
/// $CDPREP_SHARED). Reads only the form of those files: binary PLY, float x, y, z, triangles.
[[nodiscard]] std::optional<TestMesh> seed_mesh(const std::string& name);

/// Returns the same model with the file's own coordinates.
[[nodiscard]] std::optional<TestMesh> seed_mesh_as_read(const std::string& name);

}  // namespace cdprep::test
