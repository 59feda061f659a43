// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <span>

#include "cdprep/advanced/build_image.h"
#include "cdprep/format/file_header.h"
#include "cdprep/result.h"

namespace cdprep::write {

using build::Section;

/// Writes a baked file: HDF5 behind a user block with header and section table.
///
/// `facts` gives the header fields that describe the model (counts, flags, units,
/// frame, normalisation); the writer fills in the rest. The file appears under
/// its name only when it is whole and synced: a temporary beside it is renamed.
/// A temporary that a killed bake left is removed when its lock is free. Fails
/// with `unwritable`; the old file is then as it was. Byte-identical for equal
/// arguments and one HDF5 release. Sections that build::make_section_table() refuses fail
/// with `bad_argument`.
[[nodiscard]] Result<Done> write_file(const std::filesystem::path& path,
                                      const format::FileHeader& facts,
                                      std::span<const Section> sections);

/// Makes a new section table for a baked file that another HDF5 tool rewrote:
/// finds every dataset by its name, checks its type and that its bytes are the
/// baked ones, takes its offset, and replaces the user block. Datasets that are
/// chunked, compressed, changed or of another type fail with `unreadable`, each
/// named; those that were removed drop out of the table. The file is replaced as
/// write_file() does; where the tool broke the alignment, the data moves again.
[[nodiscard]] Result<Done> reindex_file(const std::filesystem::path& path);

}  // namespace cdprep::write
