// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

#include "import/import_file.h"
#include "import/source_file.h"

namespace cdprep::import {

/// Reads text OFF with any of the prefixes ST, C and N: one vertex or face a
/// line; normals, colours and texture coordinates are skipped. Without a prefix, rows may
/// be wrapped or joined where there are numbers of vertices and faces alone. Counts that the
/// file is too short for are unreadable, before anything is allocated by them;
/// so are binary files and those of other dimensions than 3.
[[nodiscard]] Result<mesh::TriangleSoup> read_off(const SourceFile& file,
                                                  const ImportOptions& options);

/// True when the first word that is no comment is OFF with any prefix.
[[nodiscard]] bool looks_like_off(std::string_view bytes) noexcept;

}  // namespace cdprep::import
