// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "cdprep/result.h"
#include "import/source_file.h"

namespace cdprep::import {

enum class PlyType : std::uint8_t { none, i8, u8, i16, u16, i32, u32, f32, f64 };

/// Returns the bytes of one number; 0 for `none`.
[[nodiscard]] std::size_t size_of(PlyType type) noexcept;

struct PlyProperty {
    std::string_view name;
    PlyType type = PlyType::none;        ///< of the number, or of each number in the list
    PlyType count_type = PlyType::none;  ///< none: no list
};

/// The role of an element in a mesh.
enum class PlyRole : std::uint8_t { other, vertices, faces, strips };

struct PlyElement {
    std::string_view name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
    PlyRole role = PlyRole::other;
    std::size_t x = 0, y = 0, z = 0;  ///< places of the coordinates: vertices only
    std::size_t indices = 0;          ///< place of the vertex list: faces and strips only

    /// Returns the minimum bytes of one element in a binary file, reached if its lists are empty.
    [[nodiscard]] std::size_t least_bytes() const noexcept;
};

struct PlyHeader {
    enum class Format : std::uint8_t { text, little_endian, big_endian };
    Format format = Format::text;
    std::vector<PlyElement> elements;
    const char* body = nullptr;  ///< the first byte after the header
};

/// Reads the header of a file that begins with "ply". Fails with `unreadable` if it is truncated,
/// has a line that is not PLY, or has no vertices with x, y and z.
[[nodiscard]] Result<PlyHeader> read_ply_header(const SourceFile& file);

}  // namespace cdprep::import
