// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cdprep/result.h"
#include "cli/output_path.h"
#include "compare/comparison.h"
#include "study/pose_set.h"

/// Poses of a comparison's pairs, in one file per pair, so that other programs can query the same
/// poses.
namespace cdprep::cli {

/// Returns the path of "A-B.pose" in that folder.
[[nodiscard]] std::filesystem::path pose_path(const std::filesystem::path& folder,
                                              const std::string& a, const std::string& b);

/// Reads one pose per line: R by rows, then T. A point b of B is at R b + T in A's frame; both
/// models are scaled to a diagonal of 1. A comment with the name of a stratum gives the stratum of
/// the poses below it. Fails with `unreadable` if there is no pose, or if a line is not a pose.
[[nodiscard]] Result<std::vector<study::GivenPose>> read_pair_poses(
    const std::filesystem::path& path);

/// Writes such a file for every pair into a folder, which is created if necessary. The poses read
/// back are the same to the last bit. Fails with `unwritable`, or with `bad_argument` if a file is
/// among those used.
[[nodiscard]] Result<Done> write_pair_poses(const std::filesystem::path& folder,
                                            const study::Comparison& comparison, UsedFiles& used);

}  // namespace cdprep::cli
