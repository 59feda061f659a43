// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace cdprep::import {

/// Who reads a file.
enum class MeshFormat : std::uint8_t { obj, stl, ply, off, other };

/// ".obj" of "arm.OBJ"; "" without one.
[[nodiscard]] std::string lower_extension(const std::filesystem::path& path);

/// Decides by the content and, where that says nothing, by the name's ending.
/// Looks at the first 64 KiB.
[[nodiscard]] MeshFormat sniff_format(std::string_view bytes, const std::filesystem::path& path);

}  // namespace cdprep::import
