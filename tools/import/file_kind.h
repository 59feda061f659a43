// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace cdprep::import {

/// Who reads a file.
enum class MeshFormat : std::uint8_t { obj, stl, ply, off, other };

/// Decides by the name's ending: many text formats look alike. The first bytes decide against it
/// only where they are of one format alone (PLY, GLB, binary FBX); the content decides where the
/// ending is unknown. Looks at the first 64 KiB.
[[nodiscard]] MeshFormat sniff_format(std::string_view bytes, const std::filesystem::path& path);

/// Says what a file is that is no mesh, or in a format that nobody here reads, and what to do:
/// "is a web page, not a mesh. ...". Nothing for all others. Looks at the first bytes and at the
/// name's ending.
[[nodiscard]] std::optional<std::string> find_other_kind(std::string_view bytes,
                                                         const std::filesystem::path& path);

}  // namespace cdprep::import
