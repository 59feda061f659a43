// SPDX-License-Identifier: MIT
#include "cdprep/hulls.h"

#include <cassert>

#include "core/require.h"
#include "piece_parts.h"

namespace cdprep {

FeatureHull feature_hull(const Model& model, std::uint32_t piece) noexcept {
    require(model, Ask::pieces);
    assert(piece < model.pieces().pieces.size());
    FeatureHull hull;
    hull.points.corners =
        part_of_piece(model.pieces().vertices, model, piece, &format::Piece::first_vertex);
    hull.points.count = static_cast<std::uint32_t>(hull.points.corners.size());
    hull.points.floats = model.mesh().positions_f32;
    hull.points.doubles = model.mesh().positions_f64;
    if (model.pieces().adjacency.size() != model.pieces().facets.size()) return hull;
    hull.facets = part_of_piece(model.pieces().facets, model, piece, &format::Piece::first_facet);
    hull.adjacency =
        part_of_piece(model.pieces().adjacency, model, piece, &format::Piece::first_facet);
    return hull;
}

}  // namespace cdprep
