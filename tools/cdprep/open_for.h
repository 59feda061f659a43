// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "cdprep/model.h"
#include "cdprep/structure.h"

namespace cdprep::cli {

/// Opens a baked file with the sections that a question needs, and those of the
/// structure through which it is asked, no others. bad_argument names those that the
/// file was baked without, and says how to bake it.
[[nodiscard]] Result<Model> open_for(const std::filesystem::path& path, SectionSet needed,
                                     Structure through = Structure::bvh);

}  // namespace cdprep::cli
