// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <optional>
#include <string>

#include "write/mesh_file.h"

namespace cdprep::write {

static_assert(std::endian::native == std::endian::little,
              "binary files are written in the byte order of memory");

/// Appends a number in the fewest digits that a reader of doubles reads back exactly. A reader of
/// floats also reads a float value back exactly. The double 0.1F is written as
/// 0.10000000149011612, because 0.1 is another double.
template <class Real>
void append_number(std::string& text, Real value) {
    std::array<char, 32> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    text.append(digits.data(), end.ptr);
}

inline void append_integer(std::string& text, std::uint64_t value) {
    std::array<char, 24> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    text.append(digits.data(), end.ptr);
}

template <class T>
void append_bytes(std::string& bytes, const T& value) {
    const auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
    bytes.append(raw.data(), raw.size());
}

/// Appends a point of a binary file, in floats if `single`.
inline void append_point(std::string& bytes, const format::Double3& p, bool single) {
    for (const double value : {p.x, p.y, p.z}) {
        if (single) {
            append_bytes(bytes, static_cast<float>(value));
        } else {
            append_bytes(bytes, value);
        }
    }
}

/// Appends three numbers, separated by blanks.
inline void append_point_text(std::string& text, const format::Double3& p) {
    append_number(text, p.x);
    text += ' ';
    append_number(text, p.y);
    text += ' ';
    append_number(text, p.z);
}

/// Appends a line per vertex. Each line begins with `lead`.
inline void append_positions(std::string& text, const MeshArrays& mesh, const char* lead) {
    for (const format::Double3& p : mesh.positions) {
        text += lead;
        append_point_text(text, p);
        text += '\n';
    }
}

/// Appends a line for a triangle. `first` is the number of the first vertex.
inline void append_triangle(std::string& text, const format::Triangle& t, const char* lead,
                            std::uint64_t first) {
    text += lead;
    for (std::size_t k = 0; k < 3; ++k) {
        if (k > 0) text += ' ';
        append_integer(text, first + t.vertex[k]);
    }
    text += '\n';
}

/// Appends a line per triangle.
inline void append_triangles(std::string& text, const MeshArrays& mesh, const char* lead,
                             std::uint64_t first) {
    for (const format::Triangle& t : mesh.triangles) append_triangle(text, t, lead, first);
}

/// Returns the header of a binary PLY. `of_vertex` and `of_face` are additional properties, each
/// with a line end in front.
inline std::string ply_header(std::size_t vertices, bool single, const char* of_vertex,
                              std::optional<std::size_t> faces, const char* of_face) {
    const std::string type = single ? "float" : "double";
    std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex ";
    append_integer(text, vertices);
    for (const char* axis : {"x", "y", "z"}) text += "\nproperty " + type + " " + axis;
    text += of_vertex;
    if (faces) {
        text += "\nelement face ";
        append_integer(text, *faces);
        text += "\nproperty list uchar int vertex_indices";
        text += of_face;
    }
    return text + "\nend_header\n";
}

}  // namespace cdprep::write
