// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "import/import_file.h"
#include "import/source_file.h"

namespace cdprep::import {

/// Reads any format that assimp knows, in a child process.
///
/// The child is the program cdprep-import-child, found beside the running program,
/// in ../libexec/cdprep, or in the build tree. It gets no descriptors but the one
/// for its result, may open files of the folder of `path` and below only, and is
/// killed when it passes options.time or options.memory_bytes. Whatever happens to
/// it is one sentence here; what it hands back is checked as a stranger's file.
[[nodiscard]] Result<mesh::TriangleSoup> import_in_child(const SourceFile& file,
                                                         const std::filesystem::path& path,
                                                         const ImportOptions& options);

}  // namespace cdprep::import
