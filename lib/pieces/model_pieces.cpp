// SPDX-License-Identifier: MIT
#include "cdprep/hulls.h"

#include <cassert>

#include "core/require.h"
#include "pieces/piece_parts.h"

namespace cdprep {

ConvexPoints piece_points(const Model& model, std::uint32_t piece) noexcept {
    require(model, Ask::pieces);
    if (piece >= model.pieces().pieces.size()) {
        stop_with("The model has no convex piece with this number.");
    }
    ConvexPoints points;
    points.corners =
        part_of_piece(model.pieces().vertices, model, piece, &format::Piece::first_vertex);
    points.count = static_cast<std::uint32_t>(points.corners.size());
    points.floats = model.mesh().positions_f32;
    points.doubles = model.mesh().positions_f64;
    return points;
}

FeatureHull feature_hull(const Model& model, std::uint32_t piece) noexcept {
    require(model, Ask::contacts);
    assert(model.pieces().adjacency.size() == model.pieces().facets.size());
    FeatureHull hull;
    hull.points = piece_points(model, piece);
    hull.facets = part_of_piece(model.pieces().facets, model, piece, &format::Piece::first_facet);
    hull.adjacency =
        part_of_piece(model.pieces().adjacency, model, piece, &format::Piece::first_facet);
    return hull;
}

}  // namespace cdprep
