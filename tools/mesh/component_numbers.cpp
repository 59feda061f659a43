// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/component_numbers.h"

namespace cdprep::mesh {

ComponentNumbers number_components(const Mesh& mesh) {
    return build::number_components(mesh.positions.size(), mesh.triangles);
}

}  // namespace cdprep::mesh
