// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "cli/load_mesh.h"
#include "cli/program_threads.h"
#include "cli/progress.h"
#include "decompose/enclose/approximate_report.h"

namespace cdprep::cli {

struct EncloseOptions {
    std::filesystem::path output;     ///< empty: none
    std::optional<double> max_error;  ///< model units
    std::optional<std::size_t> parts;
    std::optional<std::size_t> max_parts;
    std::uint32_t max_vertices = 0;
    std::size_t work = convex::ApproximateOptions{}.work;
    bool to_surface = false;
    bool merge_components = false;
    double density = 1000;   ///< kilograms per cubic metre; the default is that of water
    bool has_visual = true;  ///< URDF and SDF show the mesh itself
    bool has_table = false;
    bool strict = false;  ///< refuses to take an unknown unit as the metre
    LoadOptions load;
};

/// Searches on these threads. Returns nothing soon after a signal.
[[nodiscard]] std::optional<convex::ApproximateParts> search_parts(const mesh::Mesh& mesh,
                                                                   convex::ApproximateOptions how,
                                                                   const Threads& threads);

/// Encloses a file's mesh in convex parts and writes them. find_nodes() decides which nodes stay
/// separate and which become one part. Fails with `interrupted` soon after a signal, and then
/// writes nothing.
[[nodiscard]] Result<report::ApproximateReport> enclose(const std::filesystem::path& input,
                                                        const EncloseOptions& options,
                                                        const Threads& threads, Progress& progress);

}  // namespace cdprep::cli
