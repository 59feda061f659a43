// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/advanced/structure.h"
#include "cdprep/pairs.h"

namespace cdprep {

/// The result of the search for near triangles as to whether two touch.
enum class Touch : std::uint8_t { no, yes, unknown };

/// Two triangles within a tolerance, tree order.
struct NearTriangles {
    std::uint32_t a;
    std::uint32_t b;
    Touch touch;
};

/// As visit_pairs_within(), in tree order. Walks Structure::pieces or, for every other structure,
/// the BVHs.
bool visit_near_triangles(Structure structure, const Model& a, const Model& b,
                          const Placement& placement, double tolerance, Workspace& workspace,
                          Visitor<NearTriangles> visit, const PairOptions& options) noexcept;

}  // namespace cdprep
