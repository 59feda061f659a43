// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "import/import_file.h"
#include "import/source_file.h"

namespace cdprep::import {

/// Reads any format that assimp supports, in a child process.
///
/// The child is the program cdprep-import-child, found beside the running program,
/// in ../libexec/cdprep, or in the build tree. It gets no descriptors except the one
/// for its result. It may open only files in the folder of `path` and below. It is
/// killed if it exceeds options.time or options.memory_bytes. Every failure of the child
/// becomes one error message here. Its result is checked like an untrusted file.
[[nodiscard]] Result<mesh::TriangleSoup> import_in_child(const SourceFile& file,
                                                         const std::filesystem::path& path,
                                                         const ImportOptions& options);

}  // namespace cdprep::import
