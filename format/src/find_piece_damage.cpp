// SPDX-License-Identifier: MIT
#include "section_checks.h"

#include <array>
#include <cmath>

#include "cdprep/format/pieces.h"
#include "reference_lists.h"

namespace cdprep::format {
namespace {

using Found = std::optional<Damage>;

constexpr std::array kIds = {SectionId::pieces, SectionId::piece_triangles,
                             SectionId::piece_vertices, SectionId::piece_facets};

struct Parts {
    SectionView<Piece> pieces;
    SectionView<std::uint32_t> triangles;
    SectionView<std::uint32_t> vertices;
    SectionView<PieceFacet> facets;
    std::uint64_t triangle_count;
    std::uint64_t vertex_count;

    Parts(std::span<const std::byte> file, SectionSet wanted) noexcept
        : pieces(file, SectionId::pieces, wanted),
          triangles(file, SectionId::piece_triangles, wanted),
          vertices(file, SectionId::piece_vertices, wanted),
          facets(file, SectionId::piece_facets, wanted),
          triangle_count(read_header(file).triangle_count),
          vertex_count(read_header(file).vertex_count) {}
};

/// The places where the lists of a piece begin, or where those of the last piece end.
struct Begins {
    std::uint64_t triangle;
    std::uint64_t vertex;
    std::uint64_t facet;
};

Begins begins_of(const Parts& parts, std::uint64_t piece) noexcept {
    if (piece == parts.pieces.count()) {
        return {parts.triangles.count(), parts.vertices.count(), parts.facets.count()};
    }
    const Piece at = parts.pieces[piece];
    return {at.first_triangle, at.first_vertex, at.first_facet};
}

/// Finds a number in a run that is not below `end` or does not rise. The run must lie in the
/// section.
Found find_bad_run(const SectionView<std::uint32_t>& list, std::uint64_t first, std::uint64_t last,
                   std::uint64_t end) noexcept {
    std::uint64_t least = 0;
    for (std::uint64_t i = first; i < last; ++i) {
        const std::uint64_t number = list[i];
        if (number >= end) return list.bad_index(i, number, end);
        if (number < least) return list.damage(DamageKind::bad_order, i, number, least);
        least = number + 1;
    }
    return std::nullopt;
}

Found find_bad_facet(const Parts& parts, std::uint64_t i, std::uint64_t corners,
                     bool is_first) noexcept {
    const PieceFacet facet = parts.facets[i];
    for (const std::uint32_t corner : facet.corner) {
        if (corner >= corners) {
            return parts.facets.bad_index(i, corner, corners);
        }
    }
    const auto& c = facet.corner;
    if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) {
        return parts.facets.damage(DamageKind::bad_order, i, c[1], c[2]);
    }
    constexpr std::uint32_t kKnown = facet_virtual | facet_first_of_face;
    const bool begins = (facet.flags & facet_first_of_face) != 0;
    if ((facet.flags & ~kKnown) != 0 || (is_first && !begins)) {
        return parts.facets.damage(DamageKind::bad_number, i, facet.flags, kKnown);
    }
    return std::nullopt;
}

/// Returns whether the counts match the dimension. A hull of dimension d has at least d + 1
/// corners. Its facets form a closed surface over all corners; a point or segment has none.
bool has_right_counts(std::uint32_t dimension, std::uint64_t corners,
                      std::uint64_t facets) noexcept {
    if (dimension < 2) return corners == std::uint64_t{dimension} + 1 && facets == 0;
    return corners > dimension && facets == 2 * (corners - 2);
}

Found find_bad_piece(const Parts& parts, std::uint64_t i) noexcept {
    const Piece piece = parts.pieces[i];
    const Begins begin = begins_of(parts, i), end = begins_of(parts, i + 1);
    const auto bad = [&](DamageKind kind, std::uint64_t found, std::uint64_t limit) -> Found {
        return parts.pieces.damage(kind, i, found, limit);
    };
    if (end.triangle > parts.triangles.count() || begin.triangle >= end.triangle) {
        return bad(DamageKind::bad_order, begin.triangle, end.triangle);
    }
    if (end.vertex > parts.vertices.count() || begin.vertex >= end.vertex) {
        return bad(DamageKind::bad_order, begin.vertex, end.vertex);
    }
    if (end.facet > parts.facets.count() || begin.facet > end.facet) {
        return bad(DamageKind::bad_order, begin.facet, end.facet);
    }
    if (!std::isfinite(piece.outer_error) || piece.outer_error < 0) {
        return bad(DamageKind::bad_number, i, 0);
    }
    if ((piece.flags & ~std::uint32_t{piece_contained}) != 0 || piece.reserved != 0) {
        return bad(DamageKind::bad_number, piece.flags, piece_contained);
    }
    constexpr std::uint32_t kMostDimension = 3;
    const std::uint64_t corners = end.vertex - begin.vertex;
    if (piece.dimension > kMostDimension ||
        !has_right_counts(piece.dimension, corners, end.facet - begin.facet)) {
        return bad(DamageKind::bad_count, corners, piece.dimension);
    }
    if (const Found damage =
            find_bad_run(parts.triangles, begin.triangle, end.triangle, parts.triangle_count)) {
        return damage;
    }
    if (const Found damage =
            find_bad_run(parts.vertices, begin.vertex, end.vertex, parts.vertex_count)) {
        return damage;
    }
    for (std::uint64_t f = begin.facet; f < end.facet; ++f) {
        if (const Found damage = find_bad_facet(parts, f, corners, f == begin.facet)) return damage;
    }
    return std::nullopt;
}

/// Returns whether the facet `other` has the edge from `to` to `from`, with `facet` beyond it. Both
/// are numbered within the piece whose facets begin at `first`.
bool leads_back(const Parts& parts, const SectionView<PieceAdjacency>& adjacency,
                std::uint64_t first, std::uint32_t other, std::uint64_t facet, std::uint32_t from,
                std::uint32_t to) noexcept {
    const auto& corner = parts.facets[first + other].corner;
    for (std::size_t k = 0; k < 3; ++k) {
        if (corner[k] == to && corner[(k + 1) % 3] == from) {
            return adjacency[first + other].across[k] == facet;
        }
    }
    return false;
}

/// Finds an edge of a facet that is not paired. Pairs ensure that every walk around a corner or a
/// face ends.
Found find_bad_adjacency(const Parts& parts,
                         const SectionView<PieceAdjacency>& adjacency) noexcept {
    if (adjacency.count() != parts.facets.count()) {
        return adjacency.damage(DamageKind::bad_count, 0, adjacency.count(), parts.facets.count());
    }
    for (std::uint64_t i = 0; i < parts.pieces.count(); ++i) {
        const std::uint64_t first = begins_of(parts, i).facet;
        const std::uint64_t count = begins_of(parts, i + 1).facet - first;
        for (std::uint64_t f = 0; f < count; ++f) {
            const auto& corner = parts.facets[first + f].corner;
            const auto& across = adjacency[first + f].across;
            for (std::size_t k = 0; k < 3; ++k) {
                if (across[k] >= count) {
                    return adjacency.bad_index(first + f, across[k], count);
                }
                if (!leads_back(parts, adjacency, first, across[k], f, corner[k],
                                corner[(k + 1) % 3])) {
                    return adjacency.damage(DamageKind::bad_order, first + f, across[k], f);
                }
            }
        }
    }
    return std::nullopt;
}

/// Finds a triangle whose stored piece is not the one that lists it.
Found find_bad_owner(const Parts& parts, const SectionView<std::uint32_t>& piece_of) noexcept {
    if (piece_of.count() != parts.triangle_count) {
        return piece_of.damage(DamageKind::bad_count, 0, piece_of.count(), parts.triangle_count);
    }
    for (std::uint64_t t = 0; t < piece_of.count(); ++t) {
        if (piece_of[t] < parts.pieces.count()) continue;
        return piece_of.bad_index(t, piece_of[t], parts.pieces.count());
    }
    for (std::uint64_t i = 0; i < parts.pieces.count(); ++i) {
        const std::uint64_t end = begins_of(parts, i + 1).triangle;
        for (std::uint64_t k = begins_of(parts, i).triangle; k < end; ++k) {
            const std::uint32_t t = parts.triangles[k];
            if (piece_of[t] != i) return piece_of.damage(DamageKind::bad_order, t, piece_of[t], i);
        }
    }
    return std::nullopt;
}

bool is_there(std::span<const std::byte> file, SectionSet wanted, SectionId id) noexcept {
    return wanted.contains(id) && find_section(file, id).has_value();
}

}  // namespace

std::optional<Damage> find_missing_pieces(std::span<const std::byte> file) noexcept {
    if (const Found damage = find_gap(file, kIds)) return damage;
    const bool has_pieces = find_section(file, kIds[0]).has_value();
    if (!has_pieces && (find_section(file, SectionId::piece_adjacency) ||
                        find_section(file, SectionId::triangle_piece))) {
        return missing_section(kIds[0]);
    }
    const bool needs_triangles = has_pieces || find_section(file, SectionId::edge_convexity);
    if (!needs_triangles || find_section(file, SectionId::triangles)) return std::nullopt;
    return missing_section(SectionId::triangles);
}

std::optional<Damage> find_piece_damage(std::span<const std::byte> file,
                                        SectionSet wanted) noexcept {
    for (const SectionId id : kIds) {
        if (!is_there(file, wanted, id)) return std::nullopt;
    }
    const Parts parts(file, wanted);
    if (parts.triangles.count() != parts.triangle_count) {
        return parts.triangles.damage(DamageKind::bad_count, 0, parts.triangles.count(),
                                      parts.triangle_count);
    }
    const Begins first = begins_of(parts, 0);
    if (first.triangle != 0 || first.vertex != 0 || first.facet != 0) {
        return parts.pieces.damage(DamageKind::bad_order, 0, first.triangle, 0);
    }
    for (std::uint64_t i = 0; i < parts.pieces.count(); ++i) {
        if (const Found damage = find_bad_piece(parts, i)) return damage;
    }
    const SectionView<PieceAdjacency> adjacency(file, SectionId::piece_adjacency, wanted);
    if (is_there(file, wanted, SectionId::piece_adjacency)) {
        if (const Found damage = find_bad_adjacency(parts, adjacency)) return damage;
    }
    const SectionView<std::uint32_t> piece_of(file, SectionId::triangle_piece, wanted);
    if (is_there(file, wanted, SectionId::triangle_piece)) return find_bad_owner(parts, piece_of);
    return std::nullopt;
}

}  // namespace cdprep::format
