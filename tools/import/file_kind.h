// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace cdprep::import {

/// The reader of a file: one of ours, or `other` for the child process.
enum class MeshFormat : std::uint8_t { obj, stl, ply, off, other };

/// Returns the reader of a file. The extension decides, because many text formats look alike. The
/// first bytes override it only if they belong to exactly one format (PLY, GLB, binary FBX). The
/// content decides if the extension is unknown. Reads at most the first 64 KiB.
[[nodiscard]] MeshFormat sniff_format(std::string_view bytes, const std::filesystem::path& path);

/// Returns a message about a file that is not a mesh or has an unsupported format, with advice:
/// "is a web page, not a mesh. ...". Returns nothing for all other files. Tests the first bytes
/// and the extension.
[[nodiscard]] std::optional<std::string> find_other_kind(std::string_view bytes,
                                                         const std::filesystem::path& path);

}  // namespace cdprep::import
