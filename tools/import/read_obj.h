// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "import/import_file.h"
#include "import/source_file.h"

namespace cdprep::import {

/// Reads Wavefront OBJ: v and f in all spellings, g, o and usemtl; lines may end
/// in LF or CR LF and be continued with a backslash. Everything else (normals,
/// points, lines, free forms) is skipped. Faces may use vertices that follow.
[[nodiscard]] Result<mesh::TriangleSoup> read_obj(const SourceFile& file,
                                                  const ImportOptions& options);

/// True when the first lines are those of an OBJ file with vertices.
[[nodiscard]] bool looks_like_obj(std::string_view bytes) noexcept;

}  // namespace cdprep::import
