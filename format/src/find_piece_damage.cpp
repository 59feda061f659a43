// SPDX-License-Identifier: MIT
#include "find_piece_damage.h"

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

/// Where the lists of a piece begin, or those of the last one end.
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

/// Numbers below `limit`, rising. The run lies in the section.
Found find_bad_run(const SectionView<std::uint32_t>& list, std::uint64_t first, std::uint64_t last,
                   std::uint64_t limit) noexcept {
    std::uint64_t least = 0;
    for (std::uint64_t i = first; i < last; ++i) {
        const std::uint64_t number = list[i];
        if (number >= limit) return list.damage(DamageKind::bad_index, i, number, limit);
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
            return parts.facets.damage(DamageKind::bad_index, i, corner, corners);
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

/// A hull of dimension d has d + 1 corners at least; facets are those of a closed surface
/// over all of them, a point or segment has none.
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

}  // namespace

std::optional<Damage> find_missing_pieces(std::span<const std::byte> file) noexcept {
    if (const Found damage = find_gap(file, kIds)) return damage;
    if (!find_section(file, kIds[0]) || find_section(file, SectionId::triangles)) {
        return std::nullopt;
    }
    return missing_section(SectionId::triangles);
}

std::optional<Damage> find_piece_damage(std::span<const std::byte> file,
                                        SectionSet wanted) noexcept {
    for (const SectionId id : kIds) {
        if (!wanted.contains(id) || !find_section(file, id)) return std::nullopt;
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
    return std::nullopt;
}

}  // namespace cdprep::format
