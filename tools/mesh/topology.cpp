// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/topology.h"

namespace cdprep::mesh {

Topology find_topology(const Mesh& mesh) {
    return build::find_topology(mesh.positions, mesh.triangles);
}

}  // namespace cdprep::mesh
