// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "cdprep/format/geometry.h"
#include "cdprep/result.h"

namespace cdprep::write {

enum class MeshFormat : std::uint8_t { obj, ply, stl, off };

/// By the extension, in any case of letters; nothing for another one.
[[nodiscard]] std::optional<MeshFormat> mesh_format_of(const std::filesystem::path& path);

/// Triangles from `first_triangle` on, up to the next part, under one name.
struct NamedPart {
    std::string name;  ///< without blanks and line ends
    std::uint64_t first_triangle = 0;
};

/// Vertices and triangles as they are to stand in the file, in their order.
struct MeshArrays {
    std::span<const format::Double3> positions;
    std::span<const format::Triangle> triangles;
    bool single_precision = false;          ///< every coordinate is a float
    std::span<const NamedPart> parts = {};  ///< rising; groups of an OBJ file, else not stored
};

/// The bytes of a file of this format, as write_mesh_file() writes them.
[[nodiscard]] std::string bytes_of(MeshFormat format, const MeshArrays& mesh);

/// Writes a mesh so that it is read back the same to the last bit: text in the fewest
/// digits that do so for readers of doubles, PLY in little-endian floats or doubles. STL is binary;
/// it has floats only and no shared vertices, and is refused with `bad_argument` where a coordinate
/// is not a float. The file appears under its name when it is whole.
[[nodiscard]] Result<Done> write_mesh_file(const std::filesystem::path& path, MeshFormat format,
                                           const MeshArrays& mesh);

}  // namespace cdprep::write
