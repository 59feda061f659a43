// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cdprep/result.h"
#include "compare/comparison.h"
#include "study/pose_set.h"

/// Poses of a comparison's pairs, a file each, so that others can ask at the same ones.
namespace cdprep::cli {

/// "A-B.pose" in that folder.
[[nodiscard]] std::filesystem::path pose_path(const std::filesystem::path& folder,
                                              const std::string& a, const std::string& b);

/// Reads a pose a line, R row by row and T: a point b of B is at R b + T in A's frame, both
/// models fitted to a diagonal of 1. A comment that is a stratum's name says of which stratum the
/// poses below it are. `unreadable` when there is no pose, or a line is none.
[[nodiscard]] Result<std::vector<study::GivenPose>> read_pair_poses(
    const std::filesystem::path& path);

/// Writes such a file for every pair into a folder, which is made if there is none. Read again
/// they are the same poses to the last bit. Fails with `unwritable`.
[[nodiscard]] Result<Done> write_pair_poses(const std::filesystem::path& folder,
                                            const study::Comparison& comparison);

}  // namespace cdprep::cli
