// SPDX-License-Identifier: GPL-3.0-or-later
#include "write/coloured_file.h"

#include <array>
#include <optional>

#include "write/mesh_bytes.h"
#include "write/output_file.h"
#include "write/own_file.h"

namespace cdprep::write {
namespace {

namespace fs = std::filesystem;

constexpr double kFull = 255;

/// Returns OBJ or PLY, or an error for another format.
Result<MeshFormat> coloured_format(const fs::path& path) {
    const std::optional<MeshFormat> format = mesh_format_of(path);
    if (format == MeshFormat::obj || format == MeshFormat::ply) return *format;
    return Error{ErrorCode::bad_argument,
                 path.string() + ": colours can be written as .ply or .obj only."};
}

void append_colour(std::string& bytes, const Shade& shade) {
    for (const std::uint8_t part : shade.colour) append_bytes(bytes, part);
}

void append_colour_text(std::string& text, const Shade& shade) {
    for (const std::uint8_t part : shade.colour) {
        text += ' ';
        append_number(text, static_cast<float>(part / kFull));
    }
}

constexpr const char* kColourProperties =
    "\nproperty uchar red\nproperty uchar green\nproperty uchar blue";

std::string coloured_ply(const MeshArrays& mesh, std::span<const Shade> shades,
                         std::span<const std::uint8_t> shade_of) {
    std::string bytes = ply_header(mesh.positions.size(), mesh.single_precision, "",
                                   mesh.triangles.size(), kColourProperties);
    for (const format::Double3& p : mesh.positions) append_point(bytes, p, mesh.single_precision);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        append_bytes(bytes, std::uint8_t{3});
        for (const std::uint32_t vertex : mesh.triangles[i].vertex) append_bytes(bytes, vertex);
        append_colour(bytes, shades[shade_of[i]]);
    }
    return bytes;
}

std::string material_text(std::span<const Shade> shades) {
    std::string text(kOwnLine);
    for (const Shade& shade : shades) {
        text += "newmtl " + shade.name + "\nKd";
        append_colour_text(text, shade);
        text += '\n';
    }
    return text;
}

/// Returns an OBJ file with the triangles grouped by material, in their order within each.
std::string coloured_obj(const fs::path& materials, const MeshArrays& mesh,
                         std::span<const Shade> shades, std::span<const std::uint8_t> shade_of) {
    std::string text = "mtllib " + materials.filename().string() + "\n";
    append_positions(text, mesh, "v ");
    for (std::size_t shade = 0; shade < shades.size(); ++shade) {
        text += "usemtl " + shades[shade].name + "\n";
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
            if (shade_of[i] == shade) append_triangle(text, mesh.triangles[i], "f ", 1);
        }
    }
    return text;
}

}  // namespace

Result<Done> write_coloured_mesh(const fs::path& path, const MeshArrays& mesh,
                                 std::span<const Shade> shades,
                                 std::span<const std::uint8_t> shade_of) {
    const Result<MeshFormat> format = coloured_format(path);
    if (!format) return format.error();
    if (format.value() == MeshFormat::ply) {
        return write_whole(path, coloured_ply(mesh, shades, shade_of));
    }
    fs::path materials = path;
    materials.replace_extension(".mtl");
    if (const auto error = find_foreign(materials)) return *error;
    const std::array<FileBytes, 2> files = {
        {{materials, material_text(shades)},
         {path, coloured_obj(materials, mesh, shades, shade_of)}}};
    return write_all(files);
}

Result<Done> write_coloured_points(const fs::path& path, std::span<const format::Double3> points,
                                   std::span<const Shade> shades,
                                   std::span<const std::uint8_t> shade_of) {
    const Result<MeshFormat> format = coloured_format(path);
    if (!format) return format.error();
    const bool is_ply = format.value() == MeshFormat::ply;
    std::string bytes =
        is_ply ? ply_header(points.size(), false, kColourProperties, {}, "") : std::string();
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Shade& shade = shades[shade_of[i]];
        if (is_ply) {
            append_point(bytes, points[i], false);
            append_colour(bytes, shade);
            continue;
        }
        bytes += "v ";
        append_point_text(bytes, points[i]);
        append_colour_text(bytes, shade);
        bytes += "\np ";
        append_integer(bytes, i + 1);
        bytes += '\n';
    }
    return write_whole(path, bytes);
}

}  // namespace cdprep::write
