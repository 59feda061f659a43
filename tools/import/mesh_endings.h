// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace cdprep::import {

/// Returns the extension in lower case: ".obj" for "arm.OBJ", "" if there is none.
[[nodiscard]] std::string lower_extension(const std::filesystem::path& path);

/// Returns true if a search through folders takes a file: it has an extension of mesh files, in
/// upper or lower case. Extensions that other kinds of files share, such as .stp and .raw, do not
/// count; import_file() reads such files all the same.
[[nodiscard]] bool has_mesh_ending(const std::filesystem::path& path);

}  // namespace cdprep::import
