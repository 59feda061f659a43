// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mesh/mesh.h"

namespace cdprep::cli {

/// What pieces keep apart.
struct MeshNodes {
    std::vector<std::uint32_t> node_of;   ///< per triangle; empty: one node
    std::vector<std::string> names;       ///< per node; "" for what is under no name
    std::vector<std::uint8_t> is_convex;  ///< per node: its name says so
};

/// The nodes of the imported file; without them its groups, if they are closed by
/// themselves or their names say that they are convex: others are parts of one surface and
/// stay together. Convex is what a name that starts with UCX_ or ends in -convcol,
/// -convcolonly, -convex or _convex says. `mesh` is the welded soup.
[[nodiscard]] MeshNodes find_nodes(const mesh::TriangleSoup& soup, const mesh::Mesh& mesh);

}  // namespace cdprep::cli
