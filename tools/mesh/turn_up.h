// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "cdprep/format/file_header.h"
#include "mesh/mesh.h"

namespace cdprep::mesh {

/// Turns points so that axis `from`, which points up, becomes axis `to`. Coordinates change places
/// and signs only, so nothing is rounded. Does nothing if either is unknown.
void turn_up(std::span<Double3> points, format::UpAxis from, format::UpAxis to);

}  // namespace cdprep::mesh
