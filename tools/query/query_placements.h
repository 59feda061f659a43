// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cdprep/pose.h"
#include "cli/command.h"

namespace cdprep::cli {

/// Where B is, as the command line has it.
struct PlacementWords {
    std::filesystem::path poses;
    std::string pose;
    std::string pose_a;
    std::string pose_b;
    std::string placement = "relative";
};

/// Adds --pose, --poses, --pose-a, --pose-b and --placement. `words` lives as long as the command.
void add_placements(const Command& command, PlacementWords& words);

/// All placements that are asked about: one pose of B a line, one pose, two
/// world poses, or none for B as it stands.
[[nodiscard]] Result<std::vector<Placement>> placements_of(const PlacementWords& words);

}  // namespace cdprep::cli
