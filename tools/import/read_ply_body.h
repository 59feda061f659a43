// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "import/import_file.h"
#include "import/ply_header.h"
#include "import/polygon_chunk.h"
#include "import/source_file.h"

namespace cdprep::import {

/// Reads the content after the header of a text PLY file.
[[nodiscard]] Result<std::vector<PolygonChunk>> read_ply_text(const SourceFile& file,
                                                              const PlyHeader& header,
                                                              const ImportOptions& options);

/// Reads the content after the header of a binary PLY file.
[[nodiscard]] Result<std::vector<PolygonChunk>> read_ply_binary(const SourceFile& file,
                                                                const PlyHeader& header,
                                                                const ImportOptions& options);

/// Adds the triangles of a strip to `chunk`: 0 1 2, 2 1 3, ... ; -1 starts a new strip.
void add_strip(const std::vector<std::int64_t>& strip, PolygonChunk& chunk);

}  // namespace cdprep::import
