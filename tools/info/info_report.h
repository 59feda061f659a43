// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "cdprep/model.h"

namespace cdprep::report {

/// Returns the report of `cdprep info` on an open file: sections with name, offset and bytes,
/// counts, guarantees, provenance. The report names `file`.
[[nodiscard]] std::string info_text(const std::string& file, const Model& model,
                                    std::span<const format::SectionEntry> sections);

/// Returns the same as one JSON object, which info.schema.json describes.
[[nodiscard]] std::string info_json(const std::string& file, const Model& model,
                                    std::span<const format::SectionEntry> sections);

}  // namespace cdprep::report
