// SPDX-License-Identifier: GPL-3.0-or-later
#include "write/mesh_file.h"

#include <algorithm>
#include <cctype>
#include <string>

#include "write/mesh_bytes.h"
#include "write/output_file.h"

namespace cdprep::write {
namespace {

using format::Double3;
using format::Triangle;

std::string obj_text(const MeshArrays& mesh) {
    std::string text;
    append_positions(text, mesh, "v ");
    if (mesh.parts.empty()) append_triangles(text, mesh, "f ", 1);
    for (std::size_t i = 0; i < mesh.parts.size(); ++i) {
        text += "g " + mesh.parts[i].name + "\n";
        const std::uint64_t first = mesh.parts[i].first_triangle;
        const std::uint64_t end =
            i + 1 < mesh.parts.size() ? mesh.parts[i + 1].first_triangle : mesh.triangles.size();
        for (const Triangle& triangle : mesh.triangles.subspan(first, end - first)) {
            append_triangle(text, triangle, "f ", 1);
        }
    }
    return text;
}

std::string off_text(const MeshArrays& mesh) {
    std::string text = "OFF\n";
    append_integer(text, mesh.positions.size());
    text += ' ';
    append_integer(text, mesh.triangles.size());
    text += " 0\n";
    append_positions(text, mesh, "");
    append_triangles(text, mesh, "3 ", 0);
    return text;
}

std::string ply_bytes(const MeshArrays& mesh) {
    std::string bytes =
        ply_header(mesh.positions.size(), mesh.single_precision, "", mesh.triangles.size(), "");
    for (const Double3& p : mesh.positions) append_point(bytes, p, mesh.single_precision);
    for (const Triangle& t : mesh.triangles) {
        bytes += '\3';
        for (const std::uint32_t vertex : t.vertex) append_bytes(bytes, vertex);
    }
    return bytes;
}

std::string stl_bytes(const MeshArrays& mesh) {
    constexpr std::size_t kHeader = 80;
    std::string bytes = "binary STL";
    bytes.resize(kHeader, ' ');
    append_bytes(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
    for (const Triangle& t : mesh.triangles) {
        // A normal of 0 asks readers to compute it from the corners.
        for (int i = 0; i < 3; ++i) append_bytes(bytes, 0.0F);
        for (const std::uint32_t vertex : t.vertex) {
            const Double3& p = mesh.positions[vertex];
            for (const double value : {p.x, p.y, p.z}) {
                append_bytes(bytes, static_cast<float>(value));
            }
        }
        append_bytes(bytes, std::uint16_t{0});
    }
    return bytes;
}

}  // namespace

std::optional<MeshFormat> mesh_format_of(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension == ".obj") return MeshFormat::obj;
    if (extension == ".ply") return MeshFormat::ply;
    if (extension == ".stl") return MeshFormat::stl;
    if (extension == ".off") return MeshFormat::off;
    return std::nullopt;
}

std::string bytes_of(MeshFormat format, const MeshArrays& mesh) {
    switch (format) {
        case MeshFormat::obj:
            return obj_text(mesh);
        case MeshFormat::off:
            return off_text(mesh);
        case MeshFormat::stl:
            return stl_bytes(mesh);
        case MeshFormat::ply:
            break;
    }
    return ply_bytes(mesh);
}

Result<Done> write_mesh_file(const std::filesystem::path& path, MeshFormat format,
                             const MeshArrays& mesh) {
    if (format == MeshFormat::stl && !mesh.single_precision) {
        return Error{ErrorCode::bad_argument,
                     path.string() +
                         ": STL stores floats only, and this mesh has other coordinates. Write "
                         "PLY, OBJ or OFF."};
    }
    return write_whole(path, bytes_of(format, mesh));
}

}  // namespace cdprep::write
