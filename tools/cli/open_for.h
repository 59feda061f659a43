// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "cdprep/advanced/structure.h"
#include "cdprep/model.h"

namespace cdprep::cli {

/// For a mesh file in the place of a baked one: what to do, in place of `why` it is no model.
[[nodiscard]] Error baked_first(const std::filesystem::path& path, Error why);

/// Opens a baked file with the sections that a question and the structure it goes through need or
/// use, and no others. Fails with bad_argument when the file was baked without one of them; the
/// message says how to bake it.
[[nodiscard]] Result<Model> open_for(const std::filesystem::path& path, Ask asks,
                                     Structure through = Structure::bvh);

}  // namespace cdprep::cli
