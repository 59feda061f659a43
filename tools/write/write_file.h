// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <span>

#include "cdprep/advanced/build_image.h"
#include "cdprep/format/file_header.h"
#include "cdprep/result.h"

namespace cdprep::write {

using build::Section;

/// Writes a baked file: HDF5 after a user block with header and section table.
///
/// `facts` provides the header fields that describe the model (counts, flags, units, frame,
/// normalisation); the writer fills in the rest. The file appears under its name only when it is
/// complete and synced: a temporary beside it is renamed. A temporary left by a killed bake is
/// removed if its lock is free. Fails with `unwritable`; the old file is then unchanged. Fails
/// with `bad_argument` on sections that build::make_section_table() rejects. Equal arguments and
/// one HDF5 release give equal bytes.
[[nodiscard]] Result<Done> write_file(const std::filesystem::path& path,
                                      const format::FileHeader& facts,
                                      std::span<const Section> sections);

/// Makes a new section table for a baked file that another HDF5 tool rewrote. Finds every
/// dataset by its name and checks its type. Compares its bytes with the baked ones and puts its
/// offset into a new user block. Fails with `unreadable` on a dataset that is chunked,
/// compressed, changed or of another type; the message names it. Removed datasets are omitted
/// from the table. The file is replaced as in write_file(). If the tool broke the alignment, the
/// data moves again.
[[nodiscard]] Result<Done> reindex_file(const std::filesystem::path& path);

}  // namespace cdprep::write
