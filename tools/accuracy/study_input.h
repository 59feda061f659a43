// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "cli/load_mesh.h"

namespace cdprep::cli {

/// The mesh of a mesh file, as load_mesh() gives it, or of a baked file, as it was baked: told
/// by what the file begins with. A baked file needs triangles and positions, and is taken as it
/// is: bad_argument when it has none, and when the options ask for more.
[[nodiscard]] Result<mesh::Mesh> load_for_study(const std::filesystem::path& input,
                                                const LoadOptions& options);

}  // namespace cdprep::cli
