// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mesh/mesh.h"

namespace cdprep::cli {

/// The nodes that parts do not cross.
struct MeshNodes {
    std::vector<std::uint32_t> node_of;   ///< per triangle; empty: one node
    std::vector<std::string> names;       ///< per node; "" for triangles without a name
    std::vector<std::uint8_t> is_convex;  ///< per node: its name marks it as convex
};

/// Returns the nodes of the imported file. Without nodes, returns its groups that are balanced by
/// themselves or have names that mark them as colliders. Other groups belong to one surface and
/// stay together. A name marks a node as convex if it starts with UCX_ or ends in -convcol,
/// -convcolonly, -convex or _convex. Convex nodes are colliders, and so are those of is_collider().
/// `mesh` is the welded soup.
[[nodiscard]] MeshNodes find_nodes(const mesh::TriangleSoup& soup, const mesh::Mesh& mesh);

}  // namespace cdprep::cli
