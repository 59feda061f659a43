// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cdprep/pose.h"

namespace cdprep::cli {

/// Reads a pose of twelve numbers: R row by row, then T. Fails with `unreadable` on other than
/// twelve numbers and with bad_argument on a motion that is not rigid. The message begins with
/// `place`.
[[nodiscard]] Result<Pose> parse_pose(const std::string& text, const std::string& place);

/// Reads one pose per line. Skips empty lines and lines that start with #.
[[nodiscard]] Result<std::vector<Pose>> read_poses(const std::filesystem::path& path);

}  // namespace cdprep::cli
