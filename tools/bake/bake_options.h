// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "bake/effects.h"
#include "bake/structures.h"
#include "cdprep/advanced/build_bvh.h"
#include "crossings/self_intersections.h"
#include "import/import_file.h"

namespace cdprep::cli {

struct BakeOptions {
    Effects effects;
    StructureChoice structures;
    bool normalize = false;
    double weld_distance = 0;    ///< model units
    std::string repair;          ///< a preset of mesh::find_repair_preset(), or empty
    double piece_tolerance = 0;  ///< for the effect "pieces"; model units, as baked; 0: exact
    /// The search for crossings ends at this number of pairs.
    std::uint64_t max_pairs = mesh::kDefaultMaxPairs;
    bool strict = false;  ///< refuse a mesh with a warning or error, or not fully examined
    build::BvhBounds bounds = build::BvhOptions{}.bounds;
    import::ImportOptions import;
    /// Reads the input. Another function may read a part of it, which `part` then names.
    std::function<Result<mesh::TriangleSoup>(const std::filesystem::path& input,
                                             const import::ImportOptions& options)>
        read = import::import_file;
    std::string part;  ///< for the provenance, after reading; empty: the whole input
};

}  // namespace cdprep::cli
