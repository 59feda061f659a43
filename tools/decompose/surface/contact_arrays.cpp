// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/surface/contact_arrays.h"
#include "cdprep/advanced/parallel_for.h"

#include <algorithm>
#include <array>

#include "decompose/surface/surface_edges.h"

namespace cdprep::convex {
namespace {

using format::EdgeConvexity;
using format::PieceAdjacency;
using format::PieceFacet;

/// An edge of a facet, from one corner to another.
struct FacetEdge {
    std::uint32_t from;
    std::uint32_t to;
    std::uint32_t facet;

    [[nodiscard]] std::uint64_t key() const {
        return std::uint64_t{from} << 32 | to;
    }
};

/// Writes the adjacency of one hull. Each edge occurs once in either direction.
void pair_edges(std::span<const PieceFacet> facets, std::span<PieceAdjacency> adjacency) {
    std::vector<FacetEdge> edges;
    edges.reserve(3 * facets.size());
    for (std::uint32_t f = 0; f < facets.size(); ++f) {
        const auto& corner = facets[f].corner;
        for (std::size_t k = 0; k < 3; ++k) edges.push_back({corner[k], corner[(k + 1) % 3], f});
    }
    const auto earlier = [](const FacetEdge& a, const FacetEdge& b) { return a.key() < b.key(); };
    std::sort(edges.begin(), edges.end(), earlier);
    for (std::size_t f = 0; f < facets.size(); ++f) {
        const auto& corner = facets[f].corner;
        for (std::size_t k = 0; k < 3; ++k) {
            const FacetEdge back = {corner[(k + 1) % 3], corner[k], 0};
            adjacency[f].across[k] =
                std::lower_bound(edges.begin(), edges.end(), back, earlier)->facet;
        }
    }
}

EdgeConvexity convexity_of(EdgeKind kind) {
    switch (kind) {
        case EdgeKind::convex:
            return EdgeConvexity::convex;
        case EdgeKind::flat:
            return EdgeConvexity::flat;
        case EdgeKind::reflex:
            return EdgeConvexity::reflex;
        case EdgeKind::fold:
        case EdgeKind::border:
        case EdgeKind::non_manifold:
        case EdgeKind::inconsistent:
        case EdgeKind::no_area:
            break;
    }
    return EdgeConvexity::unknown;
}

std::vector<std::uint8_t> find_convexity(const mesh::Mesh& mesh, ParallelFor parallel_for) {
    const SurfaceEdges edges = find_surface_edges(mesh, parallel_for);
    std::vector<std::uint8_t> bits(mesh.triangles.size());
    for (std::size_t t = 0; t < bits.size(); ++t) {
        std::array<EdgeConvexity, 3> edge;
        for (std::size_t k = 0; k < 3; ++k) edge[k] = convexity_of(edges.kind[3 * t + k]);
        bits[t] = format::edge_convexity_bits(edge);
    }
    return bits;
}

std::vector<PieceAdjacency> find_adjacency(const PieceArrays& pieces, ParallelFor parallel_for) {
    constexpr std::size_t kAtATime = 512;  // pieces per task: changes no result
    std::vector<PieceAdjacency> adjacency(pieces.facets.size());
    const auto begin_of = [&](std::size_t piece) -> std::size_t {
        return piece < pieces.pieces.size() ? pieces.pieces[piece].first_facet
                                            : pieces.facets.size();
    };
    for_chunks(pieces.pieces.size(), kAtATime, parallel_for,
               [&](std::size_t first, std::size_t last) {
                   for (std::size_t i = first; i < last; ++i) {
                       const std::size_t begin = begin_of(i);
                       const std::size_t count = begin_of(i + 1) - begin;
                       pair_edges(std::span(pieces.facets).subspan(begin, count),
                                  std::span(adjacency).subspan(begin, count));
                   }
               });
    return adjacency;
}

std::vector<std::uint32_t> find_owners(const PieceArrays& pieces) {
    std::vector<std::uint32_t> piece_of(pieces.triangles.size());
    std::uint32_t piece = 0;
    for (std::size_t i = 0; i < pieces.triangles.size(); ++i) {
        const std::size_t next = std::size_t{piece} + 1;
        if (next < pieces.pieces.size() && pieces.pieces[next].first_triangle == i) ++piece;
        piece_of[pieces.triangles[i]] = piece;
    }
    return piece_of;
}

mesh::Mesh mesh_of(const Model& model) {
    mesh::Mesh mesh;
    mesh.positions.assign(model.mesh().positions_f64.begin(), model.mesh().positions_f64.end());
    for (const Float3& p : model.mesh().positions_f32) mesh.positions.push_back({p.x, p.y, p.z});
    mesh.triangles.assign(model.mesh().triangles.begin(), model.mesh().triangles.end());
    return mesh;
}

}  // namespace

ContactArrays make_contact_arrays(const mesh::Mesh& mesh, const PieceArrays& pieces,
                                  ParallelFor parallel_for) {
    return {find_adjacency(pieces, parallel_for), find_convexity(mesh, parallel_for),
            find_owners(pieces)};
}

std::optional<format::Damage> find_convexity_falsehood(std::span<const std::byte> file,
                                                       const Model& model) {
    const std::span<const std::uint8_t> stored = model.mesh().edge_convexity;
    if (stored.empty()) return std::nullopt;
    const std::vector<std::uint8_t> found = find_convexity(mesh_of(model), serial_for);
    const auto [at, right] = std::mismatch(stored.begin(), stored.end(), found.begin());
    if (at == stored.end()) return std::nullopt;
    return format::wrong_fact(file, SectionId::edge_convexity,
                              static_cast<std::uint64_t>(at - stored.begin()), *at, *right);
}

}  // namespace cdprep::convex
