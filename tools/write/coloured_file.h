// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "cdprep/result.h"
#include "write/mesh_file.h"

namespace cdprep::write {

/// A class of triangles or points: its name and its colour.
struct Shade {
    std::string name;                    ///< of an OBJ material: letters, digits, '_' and '-'
    std::array<std::uint8_t, 3> colour;  ///< red, green, blue
};

/// Writes a mesh with a colour per triangle: `shade_of[i]` is the number of triangle i's
/// shade. PLY stores the colours as properties of the faces. OBJ names materials, which a
/// second file of the same name with the extension .mtl defines. A file of that name that cdprep
/// did not write stays; this fails with `bad_argument`. So do other formats, which have no colours.
[[nodiscard]] Result<Done> write_coloured_mesh(const std::filesystem::path& path,
                                               const MeshArrays& mesh,
                                               std::span<const Shade> shades,
                                               std::span<const std::uint8_t> shade_of);

/// Writes points with a colour each. PLY stores the colours as properties of the vertices. OBJ
/// stores them after the coordinates, which most readers accept, with a point element for each.
[[nodiscard]] Result<Done> write_coloured_points(const std::filesystem::path& path,
                                                 std::span<const format::Double3> points,
                                                 std::span<const Shade> shades,
                                                 std::span<const std::uint8_t> shade_of);

}  // namespace cdprep::write
