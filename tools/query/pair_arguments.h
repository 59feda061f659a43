// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "cdprep/pairs.h"
#include "cli/command.h"
#include "query/query_placements.h"
#include "query/query_scene.h"
#include "query/query_structure.h"

namespace cdprep::cli {

enum class PairQuestion : std::uint8_t { collide, overlap, distance, within };

/// The command-line arguments of a query about two models, or about the objects of a scene.
struct PairArguments {
    PairQuestion question = PairQuestion::collide;
    std::filesystem::path a;
    std::filesystem::path b;
    PlacementWords placement;
    StructureWords structure;
    std::string format;  ///< empty: text, or ndjson for a scene
    std::string as = "surface";
    std::string contact = "closed";
    std::optional<double> tolerance;
    DistanceOptions errors;
    SceneArguments scene;
    std::optional<std::uint32_t> level_of_detail;
    std::size_t repeat = 1;
    bool timings = false;
    bool count = false;
    bool pairs = false;
    bool segments = false;
    bool counts = false;
    bool skip_degenerate = false;
};

/// Returns true for a query that the convex hulls of two models can answer.
[[nodiscard]] bool serves_hulls(PairQuestion question);

/// Queries the convex hulls of the whole models, always as solids.
Exit run_hulls(const PairArguments& arguments);

}  // namespace cdprep::cli
