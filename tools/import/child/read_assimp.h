// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "scene.h"

namespace cdprep::import {

/// Reads any format that assimp knows. Throws what assimp throws; a file that it
/// refuses is a std::runtime_error with its reason.
[[nodiscard]] Scene read_assimp(const std::string& path, InputFiles& files);

}  // namespace cdprep::import
