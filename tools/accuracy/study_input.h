// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "cli/load_mesh.h"
#include "cli/progress.h"

namespace cdprep::cli {

/// Returns the mesh of a mesh file by load_mesh(), or the mesh of a baked file as it was baked. The
/// first bytes decide which kind the file is. Shows that it is read. Fails with bad_argument if a
/// baked file has no triangles or positions, or if the options ask to normalize or weld it.
[[nodiscard]] Result<mesh::Mesh> load_for_study(const std::filesystem::path& input,
                                                const LoadOptions& options, Progress& progress);

}  // namespace cdprep::cli
