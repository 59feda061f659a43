// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "cdprep/model.h"

namespace cdprep::cli {

/// Opens a baked file with the sections that a question needs, no others.
/// bad_argument names those that the file was baked without.
[[nodiscard]] Result<Model> open_for(const std::filesystem::path& path, SectionSet needed);

}  // namespace cdprep::cli
