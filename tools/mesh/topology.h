// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "mesh/mesh.h"

namespace cdprep::mesh {

struct Topology {
    /// As format::Component says, in the order of their lowest source triangle.
    std::vector<format::Component> components;
    /// The oriented uses of every edge cancel: winding numbers are defined.
    bool closed = false;
};

/// Finds the connected components (triangles that share a vertex) and whether
/// each is closed: every edge used as often in one direction as in the other.
/// Corners that repeat add nothing. A mesh without triangles is closed. Volumes
/// beyond the largest double are cut to it. O(n).
[[nodiscard]] Topology find_topology(const Mesh& mesh);

}  // namespace cdprep::mesh
