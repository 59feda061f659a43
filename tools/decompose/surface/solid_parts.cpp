// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/surface/solid_parts.h"

#include "mesh/component_numbers.h"
#include "mesh/topology.h"

namespace cdprep::convex {

// Both functions number components in the order of their lowest triangle.
SolidParts::SolidParts(const mesh::Mesh& mesh)
    : mesh_(mesh), boxes_(mesh), component_of_vertex_(mesh::number_components(mesh).of_vertex) {
    for (const format::Component& component : mesh::find_topology(mesh).components) {
        const bool balanced = (component.flags & format::component_balanced) != 0;
        balanced_.push_back(balanced ? 1 : 0);
        cavity_.push_back(balanced && component.signed_volume <= 0 ? 1 : 0);
    }
}

}  // namespace cdprep::convex
