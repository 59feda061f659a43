// SPDX-License-Identifier: GPL-3.0-or-later
#include "write/mesh_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <charconv>
#include <string>

#include "write/output_file.h"

namespace cdprep::write {
namespace {

using format::Double3;
using format::Triangle;

static_assert(std::endian::native == std::endian::little, "binary files are written as they lie");

void append_number(std::string& text, double value, bool single) {
    std::array<char, 32> digits;
    const auto end = single ? std::to_chars(digits.data(), digits.data() + digits.size(),
                                            static_cast<float>(value))
                            : std::to_chars(digits.data(), digits.data() + digits.size(), value);
    text.append(digits.data(), end.ptr);
}

void append_integer(std::string& text, std::uint64_t value) {
    std::array<char, 24> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    text.append(digits.data(), end.ptr);
}

template <class T>
void append_bytes(std::string& bytes, const T& value) {
    const auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
    bytes.append(raw.data(), raw.size());
}

void append_positions(std::string& text, const MeshArrays& mesh, const char* lead) {
    for (const Double3& p : mesh.positions) {
        text += lead;
        append_number(text, p.x, mesh.single_precision);
        text += ' ';
        append_number(text, p.y, mesh.single_precision);
        text += ' ';
        append_number(text, p.z, mesh.single_precision);
        text += '\n';
    }
}

void append_triangles(std::string& text, const MeshArrays& mesh, const char* lead,
                      std::uint64_t first) {
    for (const Triangle& t : mesh.triangles) {
        text += lead;
        for (std::size_t k = 0; k < 3; ++k) {
            if (k > 0) text += ' ';
            append_integer(text, first + t.vertex[k]);
        }
        text += '\n';
    }
}

std::string obj_text(const MeshArrays& mesh) {
    std::string text;
    append_positions(text, mesh, "v ");
    append_triangles(text, mesh, "f ", 1);
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
    const std::string type = mesh.single_precision ? "float" : "double";
    std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex ";
    append_integer(bytes, mesh.positions.size());
    for (const char* axis : {"x", "y", "z"}) bytes += "\nproperty " + type + " " + axis;
    bytes += "\nelement face ";
    append_integer(bytes, mesh.triangles.size());
    bytes += "\nproperty list uchar int vertex_indices\nend_header\n";
    for (const Double3& p : mesh.positions) {
        for (const double value : {p.x, p.y, p.z}) {
            if (mesh.single_precision) {
                append_bytes(bytes, static_cast<float>(value));
            } else {
                append_bytes(bytes, value);
            }
        }
    }
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
        // A normal of 0 asks readers to take it from the corners.
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

Result<Done> write_mesh_file(const std::filesystem::path& path, MeshFormat format,
                             const MeshArrays& mesh) {
    if (format == MeshFormat::stl && !mesh.single_precision) {
        return Error{ErrorCode::bad_argument,
                     path.string() +
                         ": STL holds floats only, and this mesh has other coordinates. Write "
                         "PLY, OBJ or OFF."};
    }
    Result<OutputFile> file = OutputFile::create(path);
    if (!file) return file.error();
    const std::string bytes = bytes_of(format, mesh);
    const Result<Done> written = file.value().write_at(0, std::as_bytes(std::span(bytes)));
    if (!written) return written.error();
    return file.value().commit();
}

}  // namespace cdprep::write
