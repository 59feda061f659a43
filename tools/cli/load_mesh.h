// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>

#include "cdprep/result.h"
#include "import/import_file.h"
#include "mesh/mesh.h"
#include "mesh/normalize.h"

namespace cdprep::cli {

/// Returns why no mesh can be made of what a file held, in a sentence: a number that is
/// not finite or out of range, or a coordinate beyond what the runtime promises.
[[nodiscard]] std::optional<Error> find_refusal(const std::filesystem::path& input,
                                                const mesh::TriangleSoup& soup);

/// Refuses a distance that would weld the whole mesh into one point. Of a soup in the units in
/// which it is welded.
[[nodiscard]] std::optional<Error> find_wide_weld(const std::filesystem::path& input,
                                                  const mesh::TriangleSoup& soup, double distance);

struct LoadOptions {
    bool normalize = false;
    double weld_distance = 0;  ///< model units
    import::ImportOptions import;
};

/// What a file holds, normalised when asked to; fails when no mesh can be made of it.
[[nodiscard]] Result<mesh::TriangleSoup> load_soup(const std::filesystem::path& input,
                                                   const LoadOptions& options);

/// The mesh of a file as bake makes it: that soup, welded.
[[nodiscard]] Result<mesh::Mesh> load_mesh(const std::filesystem::path& input,
                                           const LoadOptions& options);

}  // namespace cdprep::cli
