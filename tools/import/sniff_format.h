// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace cdprep::import {

/// Who reads a file.
enum class MeshFormat : std::uint8_t { obj, stl, ply, off, other };

/// Decides by the name's ending: many text formats look alike. The first bytes decide against it
/// only where they are of one format alone (PLY, GLB, binary FBX); the content decides where the
/// ending is unknown. Looks at the first 64 KiB.
[[nodiscard]] MeshFormat sniff_format(std::string_view bytes, const std::filesystem::path& path);

}  // namespace cdprep::import
