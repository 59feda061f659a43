// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "cdprep/advanced/build_bvh.h"
#include "cdprep/result.h"
#include "bake/effects.h"
#include "import/import_file.h"
#include "crossings/self_intersections.h"
#include "cli/program_threads.h"
#include "bake/bake_report.h"
#include "bake/structures.h"

namespace cdprep::cli {

struct BakeOptions {
    Effects effects;
    StructureChoice structures;
    bool normalize = false;
    double weld_distance = 0;    ///< model units
    std::string repair;          ///< a preset of mesh::find_repair_preset(), or empty
    double piece_tolerance = 0;  ///< of the effect "pieces"; model units, as baked; 0: exact
    std::uint64_t max_pairs = mesh::kDefaultMaxPairs;  ///< that meet: the search ends there
    bool strict = false;  ///< refuse a mesh of which something is found
    build::BvhBounds bounds = build::BvhOptions{}.bounds;
    import::ImportOptions import;
};

/// Bakes one file: import, weld, build, measure, structure, write. Called back with the
/// name of each stage as it begins. Fails with the code that tells why;
/// `interrupted` between two stages when the person stopped the program.
[[nodiscard]] Result<report::BakeReport> bake(const std::filesystem::path& input,
                                              const std::filesystem::path& output,
                                              const BakeOptions& options, const Threads& threads,
                                              const std::function<void(const char*)>& begins);

}  // namespace cdprep::cli
