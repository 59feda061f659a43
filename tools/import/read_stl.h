// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

#include "import/import_file.h"
#include "import/source_file.h"

namespace cdprep::import {

/// Reads STL, binary or text. Every triangle has three vertices of its own;
/// normals and colours are skipped; the solids of a text file are its groups.
///
/// A file is binary when its length is what its count says, whatever its first
/// word; else it is text when it looks like it. A binary file of another length
/// and a text file that ends inside a solid are unreadable.
[[nodiscard]] Result<mesh::TriangleSoup> read_stl(const SourceFile& file,
                                                  const ImportOptions& options);

/// True when the length is that of a binary STL file with its count.
[[nodiscard]] bool is_binary_stl(std::string_view bytes) noexcept;

/// True when the text begins with a solid and, soon, a facet or its end.
[[nodiscard]] bool looks_like_text_stl(std::string_view bytes) noexcept;

}  // namespace cdprep::import
