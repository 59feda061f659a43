// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace cdprep::import {

/// ".obj" of "arm.OBJ"; "" without one.
[[nodiscard]] std::string lower_extension(const std::filesystem::path& path);

/// Whether a name ends as mesh files do, in any case of letters: what a search through
/// folders takes up. Endings that other kinds of files share, such as .stp and .raw, are
/// left out; import_file() reads such files all the same.
[[nodiscard]] bool has_mesh_ending(const std::filesystem::path& path);

}  // namespace cdprep::import
