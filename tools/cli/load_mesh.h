// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "cdprep/result.h"
#include "import/import_file.h"
#include "mesh/mesh.h"
#include "mesh/normalize.h"

namespace cdprep::cli {

/// Returns the reason why no mesh can be made of a file's content, or nothing. Reasons are a
/// number that is not finite or out of range, and a coordinate above format::kMaxCoordinate.
[[nodiscard]] std::optional<Error> find_refusal(const std::filesystem::path& input,
                                                const mesh::TriangleSoup& soup);

/// Returns an error if `distance` would weld the whole mesh into one point. The soup must be in
/// the units in which it is welded.
[[nodiscard]] std::optional<Error> find_wide_weld(const std::filesystem::path& input,
                                                  const mesh::TriangleSoup& soup, double distance);

struct LoadOptions {
    bool normalize = false;
    double weld_distance = 0;        ///< model units
    bool without_colliders = false;  ///< leaves out what leave_out_colliders() does
    /// Called with the remarks of the import, and with sentences about colliders that stay a part
    /// of the mesh. May be empty.
    std::function<void(const std::string&)> tell;
    import::ImportOptions import;
};

/// Returns the triangles of a file, normalised with options.normalize. Fails if no mesh can be
/// made of them.
[[nodiscard]] Result<mesh::TriangleSoup> load_soup(const std::filesystem::path& input,
                                                   const LoadOptions& options);

/// Returns the mesh of a file as bake makes it: the result of load_soup(), welded.
[[nodiscard]] Result<mesh::Mesh> load_mesh(const std::filesystem::path& input,
                                           const LoadOptions& options);

}  // namespace cdprep::cli
