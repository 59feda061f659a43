// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/degenerate.h"

#include "cdprep/advanced/mesh_arrays.h"

namespace cdprep::mesh {

std::vector<std::uint64_t> find_degenerate(const Mesh& mesh, ParallelFor parallel_for) {
    return build::find_degenerate(mesh.positions, mesh.triangles, parallel_for);
}

}  // namespace cdprep::mesh
