// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cdprep/pose.h"
#include "cli/command.h"

namespace cdprep::cli {

/// The command-line arguments for the poses of both models.
struct PlacementWords {
    std::filesystem::path poses;
    std::string pose;
    std::string pose_a;
    std::string pose_b;
    std::string placement = "relative";
};

/// Adds --pose, --poses, --pose-a, --pose-b and --placement. `words` must outlive the command.
void add_placements(const Command& command, PlacementWords& words);

/// Returns all placements that the arguments give: a file with one pose of B per line, one pose, or
/// two world poses. Without any, returns one placement with B in its own coordinates.
[[nodiscard]] Result<std::vector<Placement>> placements_of(const PlacementWords& words);

}  // namespace cdprep::cli
