// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>

#include "bake/bake_options.h"
#include "cdprep/result.h"
#include "cli/program_threads.h"

namespace cdprep::scenes {

/// Returns the baked file of a mesh in a folder. Bakes it unless the folder has a file of the same
/// mesh, other files that the mesh refers to, options and version. The folder is made if there is
/// none. Files are never removed.
[[nodiscard]] Result<std::filesystem::path> find_or_bake(
    const std::filesystem::path& mesh, const std::filesystem::path& folder,
    const cli::BakeOptions& options, const cli::Threads& threads,
    const std::function<void(const char*)>& begins);

}  // namespace cdprep::scenes
