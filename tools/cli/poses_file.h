// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cdprep/pose.h"

namespace cdprep::cli {

/// Reads twelve numbers: R row by row, then T. `place` begins the sentence when
/// they are not twelve numbers (`unreadable`) or no rigid motion (bad_argument).
[[nodiscard]] Result<Pose> parse_pose(const std::string& text, const std::string& place);

/// Reads one pose a line; empty lines and lines that start with # are skipped.
[[nodiscard]] Result<std::vector<Pose>> read_poses(const std::filesystem::path& path);

}  // namespace cdprep::cli
