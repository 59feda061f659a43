// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "cdprep/advanced/structure.h"
#include "cdprep/model.h"

namespace cdprep::cli {

/// Returns `why`, or for a mesh file an error that advises to bake it first.
[[nodiscard]] Error baked_first(const std::filesystem::path& path, Error why);

/// Opens a baked file with the sections that a query and its structure need or use, and no
/// others. Fails with bad_argument if the file was baked without a needed section; the message
/// states how to bake it.
[[nodiscard]] Result<Model> open_for(const std::filesystem::path& path, Ask asks,
                                     Structure through = Structure::bvh);

}  // namespace cdprep::cli
