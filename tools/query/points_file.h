// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "cdprep/points.h"

namespace cdprep::cli {

/// Reads one point a line, x y z in model units. `unreadable` names the line.
[[nodiscard]] Result<std::vector<Double3>> read_points(const std::filesystem::path& path);

/// Reads one ray a line, origin then direction. A direction of zero is a
/// bad_argument, anything else that is wrong `unreadable`; both name the line.
[[nodiscard]] Result<std::vector<Ray>> read_rays(const std::filesystem::path& path);

}  // namespace cdprep::cli
