// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "cdprep/format/geometry.h"
#include "cdprep/result.h"

namespace cdprep::write {

enum class MeshFormat : std::uint8_t { obj, ply, stl, off };

/// Returns the format that the extension names, in upper or lower case; nothing for another one.
[[nodiscard]] std::optional<MeshFormat> mesh_format_of(const std::filesystem::path& path);

/// A named run of triangles, from `first_triangle` up to the next part.
struct NamedPart {
    std::string name;  ///< without blanks and line ends
    std::uint64_t first_triangle = 0;
};

/// Vertices and triangles in the order in which the file stores them.
struct MeshArrays {
    std::span<const format::Double3> positions;
    std::span<const format::Triangle> triangles;
    bool single_precision = false;          ///< every coordinate is a float
    std::span<const NamedPart> parts = {};  ///< rising; groups of an OBJ file, not stored by others
};

/// Returns the bytes of a file of this format, as write_mesh_file() writes them.
[[nodiscard]] std::string bytes_of(MeshFormat format, const MeshArrays& mesh);

/// Writes a mesh that reads back bit for bit. Text has the fewest digits for which readers of
/// doubles achieve this; PLY has little-endian floats or doubles. STL is binary, with floats only
/// and no shared vertices; it fails with `bad_argument` if a coordinate is not a float. The file
/// appears under its name when it is complete.
[[nodiscard]] Result<Done> write_mesh_file(const std::filesystem::path& path, MeshFormat format,
                                           const MeshArrays& mesh);

}  // namespace cdprep::write
