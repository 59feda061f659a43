// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "cdprep/points.h"

namespace cdprep::cli {

/// Reads one point per line, x y z in model units. The error `unreadable` names the line.
[[nodiscard]] Result<std::vector<Double3>> read_points(const std::filesystem::path& path);

/// Reads one ray per line, origin then direction; the direction must not be zero. The error
/// `unreadable` names the line.
[[nodiscard]] Result<std::vector<Ray>> read_rays(const std::filesystem::path& path);

}  // namespace cdprep::cli
