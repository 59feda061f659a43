// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "text/stage_time.h"
#include "text/structure_report.h"

namespace cdprep::report {

/// Convex parts that enclose the mesh.
struct BakedParts {
    std::size_t count = 0;
    double outer_error = 0;  ///< proved: no point of a part is farther from the solid, model units
    bool is_as_asked = true;
    std::uint64_t fragments = 0;  ///< fragments of triangles, each proved to lie in a part
    std::uint64_t outside = 0;    ///< corners of fragments that lie in no part: 0
};

/// The result of baking one file.
struct BakeReport {
    std::string input;
    std::string output;
    std::uint64_t triangles = 0;
    std::uint64_t vertices = 0;
    std::uint64_t components = 0;
    std::uint64_t merged_vertices = 0;
    std::uint64_t degenerate_triangles = 0;
    bool balanced = false;
    std::string repaired;               ///< the preset, or empty
    std::vector<std::string> promises;  ///< the guarantees of queries on it, as promise_words()
    bool crossings_complete = true;     ///< all pairs of triangles were examined
    std::vector<std::string> remarks;   ///< on the import, colliders left out, limits reached
    std::uint64_t warnings = 0;         ///< rules that found a warning or an error
    bool single_precision = false;
    std::vector<StructureReport> structures;
    std::optional<BakedParts> parts;
    std::uint64_t bytes = 0;
    double seconds = 0;
    std::vector<StageTime> stages;
    int exit = 0;                      ///< exit code for this file
    std::optional<std::string> error;  ///< the message, when the bake failed
};

/// Returns a line of text, and lines for remarks, structures and parts if there are any. With
/// `timings`, a line for each stage follows.
[[nodiscard]] std::string bake_text(const BakeReport& report, Timings timings);

/// Returns {"models": [...]} with one object per file, which bake.schema.json describes.
[[nodiscard]] std::string bake_json(const std::vector<BakeReport>& reports);

}  // namespace cdprep::report
