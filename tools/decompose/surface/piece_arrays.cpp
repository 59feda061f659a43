// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/surface/piece_arrays.h"
#include "cdprep/advanced/parallel_for.h"

#include <algorithm>
#include <array>
#include <utility>

#include "cdprep/exact/predicates.h"
#include "decompose/surface/flat_turn.h"
#include "hull/convex_hull.h"

namespace cdprep::convex {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// One piece of a mesh and its hull.
class PieceHull {
public:
    PieceHull(const mesh::Mesh& mesh, std::span<const std::uint32_t> triangles)
        : mesh_(mesh), triangles_(triangles) {
        for (const std::uint32_t t : triangles) {
            const auto& v = mesh.triangles[t].vertex;
            vertices_.insert(vertices_.end(), v.begin(), v.end());
        }
        std::sort(vertices_.begin(), vertices_.end());
        vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
        std::vector<Double3> points;
        points.reserve(vertices_.size());
        for (const std::uint32_t v : vertices_) points.push_back(mesh.positions[v]);
        hull_ = convex_hull(points);
    }

    /// Appends the hull's corners, by number, and its facets.
    void append_to(PieceArrays& arrays) const {
        for (const std::uint32_t number : hull_.numbers) {
            arrays.vertices.push_back(vertices_[number]);
        }
        for (std::size_t face = 0; face + 1 < hull_.groups.size(); ++face) {
            const std::uint32_t uncovered = is_covered(face) ? 0U : +format::facet_virtual;
            for (std::uint32_t f = hull_.groups[face]; f < hull_.groups[face + 1]; ++f) {
                const bool first = f == hull_.groups[face];
                arrays.facets.push_back(
                    {hull_.facets[f], uncovered | (first ? +format::facet_first_of_face : 0U)});
            }
        }
    }
    [[nodiscard]] int dimension() const {
        return hull_.dimension;
    }

private:
    // Returns true if triangles cover a face. They lie in its plane and are wound like it. Some
    // sides of theirs are not shared by two of them. They cover the face if each such side lies on
    // its outline, with the whole face to its left.
    [[nodiscard]] bool is_covered(std::size_t face) const {
        const auto& some = hull_.facets[hull_.groups[face]];
        const std::array<Double3, 3> plane = {hull_.points[some[0]], hull_.points[some[1]],
                                              hull_.points[some[2]]};
        const int axis = axis_of_turn(plane[0], plane[1], plane[2]);
        const int turn = flat_turn(axis, plane[0], plane[1], plane[2]);
        std::vector<Edge> sides;
        for (const std::uint32_t t : triangles_) {
            const auto& v = mesh_.triangles[t].vertex;
            if (!lies_in(plane, axis, turn, v)) continue;
            for (std::size_t k = 0; k < 3; ++k) sides.emplace_back(v[k], v[(k + 1) % 3]);
        }
        if (sides.empty()) return false;
        std::sort(sides.begin(), sides.end());
        return std::all_of(sides.begin(), sides.end(), [&](const Edge& side) {
            const Edge back = {side.second, side.first};
            return std::binary_search(sides.begin(), sides.end(), back) ||
                   has_left(face, axis, turn, side);
        });
    }
    [[nodiscard]] bool lies_in(const std::array<Double3, 3>& plane, int axis, int turn,
                               const std::array<std::uint32_t, 3>& v) const {
        const auto& at = mesh_.positions;
        return std::all_of(v.begin(), v.end(),
                           [&](std::uint32_t corner) {
                               return exact::orient3d(plane[0], plane[1], plane[2], at[corner]) ==
                                      0;
                           }) &&
               flat_turn(axis, at[v[0]], at[v[1]], at[v[2]]) == turn;
    }
    [[nodiscard]] bool has_left(std::size_t face, int axis, int turn, const Edge& side) const {
        const Double3 &from = mesh_.positions[side.first], &to = mesh_.positions[side.second];
        for (std::uint32_t f = hull_.groups[face]; f < hull_.groups[face + 1]; ++f) {
            for (const std::uint32_t corner : hull_.facets[f]) {
                if (flat_turn(axis, from, to, hull_.points[corner]) == -turn) return false;
            }
        }
        return true;
    }

    const mesh::Mesh& mesh_;
    std::span<const std::uint32_t> triangles_;
    std::vector<std::uint32_t> vertices_;
    ConvexHull hull_;
};

}  // namespace

PieceArrays make_piece_arrays(const mesh::Mesh& mesh, SurfacePieces pieces,
                              ParallelFor parallel_for) {
    constexpr std::size_t kAtATime = 512;  // pieces per task: changes no result
    const std::size_t count = pieces.pieces.size();
    std::vector<PieceArrays> parts((count + kAtATime - 1) / kAtATime);
    for_chunks(count, kAtATime, parallel_for, [&](std::size_t first, std::size_t last) {
        PieceArrays& part = parts[first / kAtATime];
        for (std::size_t i = first; i < last; ++i) {
            const PieceHull hull(mesh, pieces.of(i));
            const SurfacePiece& piece = pieces.pieces[i];
            part.pieces.push_back(
                {pieces.first[i], static_cast<std::uint32_t>(part.vertices.size()),
                 static_cast<std::uint32_t>(part.facets.size()),
                 piece.contained ? +format::piece_contained : 0U, piece.outer_error,
                 static_cast<std::uint32_t>(hull.dimension()), 0});
            hull.append_to(part);
        }
    });
    PieceArrays all;
    all.triangles = std::move(pieces.triangles);
    for (const PieceArrays& part : parts) {
        for (format::Piece piece : part.pieces) {
            piece.first_vertex += static_cast<std::uint32_t>(all.vertices.size());
            piece.first_facet += static_cast<std::uint32_t>(all.facets.size());
            all.pieces.push_back(piece);
        }
        all.vertices.insert(all.vertices.end(), part.vertices.begin(), part.vertices.end());
        all.facets.insert(all.facets.end(), part.facets.begin(), part.facets.end());
    }
    return all;
}

}  // namespace cdprep::convex
