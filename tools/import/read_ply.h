// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "import/import_file.h"
#include "import/source_file.h"

namespace cdprep::import {

/// Reads PLY, text and binary of either byte order: x, y and z of the vertices
/// and the vertex lists of faces and triangle strips, of any number type, between
/// any other properties and elements.
///
/// In text files an element is a line; numbers behind those that the header
/// announces are skipped. Counts that the file is too short for are unreadable,
/// before anything is allocated by them.
[[nodiscard]] Result<mesh::TriangleSoup> read_ply(const SourceFile& file,
                                                  const ImportOptions& options);

}  // namespace cdprep::import
