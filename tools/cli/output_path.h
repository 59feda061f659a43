// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <iosfwd>
#include <optional>

#include "cdprep/result.h"
#include "write/mesh_file.h"

namespace cdprep::cli {

/// Returns why `output` must not be written when it is the file `input`, however they are
/// spelled.
[[nodiscard]] std::optional<Error> find_replaced_input(const std::filesystem::path& input,
                                                       const std::filesystem::path& output);

/// The format that the extension of `output` names; OBJ for "-", standard output. Fails before
/// anything is read: when there is none, or when `output` is the input.
[[nodiscard]] Result<write::MeshFormat> mesh_output(const std::filesystem::path& input,
                                                    const std::filesystem::path& output);

/// Writes a mesh where mesh_output() said: into the file, or to standard output for "-".
[[nodiscard]] Result<Done> write_mesh(const std::filesystem::path& output, write::MeshFormat format,
                                      const write::MeshArrays& mesh);

/// Where a report goes: standard output, unless that takes the mesh.
[[nodiscard]] std::ostream& report_stream(const std::filesystem::path& mesh_output);

}  // namespace cdprep::cli
