// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "cdprep/model.h"

namespace cdprep::report {

/// What `cdprep info` says of a file that opened: sections with name, offset
/// and bytes, counts, guarantees, provenance. `file` stands in the text.
[[nodiscard]] std::string info_text(const std::string& file, const Model& model,
                                    std::span<const format::SectionEntry> sections);
[[nodiscard]] std::string info_json(const std::string& file, const Model& model,
                                    std::span<const format::SectionEntry> sections);

}  // namespace cdprep::report
