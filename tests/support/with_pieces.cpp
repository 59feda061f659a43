// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "exact/predicates.h"
#include "support/more_sections.h"
#include "support/open_tiny.h"
#include "support/small_hull.h"
#include "support/tiny_pieces.h"

#include "cdprep/format/pieces.h"

namespace cdprep::test {
namespace {

using format::facet_first_of_face;
using format::facet_virtual;

/// The sections of pieces, one piece after the other.
struct Sections {
    std::vector<format::Piece> pieces;
    std::vector<std::uint32_t> triangles;
    std::vector<std::uint32_t> vertices;
    std::vector<format::PieceFacet> facets;

    void begin_piece(std::uint32_t flags, std::uint32_t dimension) {
        pieces.push_back({static_cast<std::uint32_t>(triangles.size()),
                          static_cast<std::uint32_t>(vertices.size()),
                          static_cast<std::uint32_t>(facets.size()), flags, 0, dimension, 0});
    }
};

AlignedBytes with(const AlignedBytes& file, const Sections& made) {
    const auto section = [](SectionId id, const auto& elements) {
        return as_section(id, std::span(elements));
    };
    return with_sections(file, {section(SectionId::pieces, made.pieces),
                                section(SectionId::piece_triangles, made.triangles),
                                section(SectionId::piece_vertices, made.vertices),
                                section(SectionId::piece_facets, made.facets)});
}

/// The turn of a triangle along each axis is 0: it is a segment or a point.
bool is_flat(const Double3& a, const Double3& b, const Double3& c) {
    return orient2d({a.x, a.y}, {b.x, b.y}, {c.x, c.y}) == 0 &&
           orient2d({a.y, a.z}, {b.y, b.z}, {c.y, c.z}) == 0 &&
           orient2d({a.z, a.x}, {b.z, b.x}, {c.z, c.x}) == 0;
}

/// Of three points in a line the two ends, or one when all are the same.
std::vector<std::uint32_t> ends_of(const std::vector<Double3>& at, const Triangle& triangle) {
    const auto before = [&](std::uint32_t a, std::uint32_t b) {
        return std::tie(at[a].x, at[a].y, at[a].z) < std::tie(at[b].x, at[b].y, at[b].z);
    };
    const auto& v = triangle.vertex;
    const auto [low, high] = std::minmax_element(v.begin(), v.end(), before);
    if (!before(*low, *high)) return {*low};
    return {std::min(*low, *high), std::max(*low, *high)};
}

void add_triangle(Sections& made, const std::vector<Double3>& at, const Triangle& triangle) {
    const auto& v = triangle.vertex;
    if (is_flat(at[v[0]], at[v[1]], at[v[2]])) {
        const std::vector<std::uint32_t> ends = ends_of(at, triangle);
        made.begin_piece(0, static_cast<std::uint32_t>(ends.size()) - 1);
        made.vertices.insert(made.vertices.end(), ends.begin(), ends.end());
        return;
    }
    made.begin_piece(0, 2);
    std::array<std::uint32_t, 3> sorted = v;
    std::sort(sorted.begin(), sorted.end());
    std::array<std::uint32_t, 3> corner{};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto* const place = std::find(sorted.begin(), sorted.end(), v[i]);
        corner[i] = static_cast<std::uint32_t>(place - sorted.begin());
    }
    made.vertices.insert(made.vertices.end(), sorted.begin(), sorted.end());
    made.facets.push_back({corner, facet_first_of_face});
    made.facets.push_back({{corner[0], corner[2], corner[1]}, facet_first_of_face | facet_virtual});
}

/// Where the facets of a piece begin, or those of the last one end.
std::size_t first_facet(const Model& model, std::size_t i) {
    const auto pieces = model.pieces().pieces;
    return i < pieces.size() ? pieces[i].first_facet : model.pieces().facets.size();
}

/// The facets beyond the edges of one hull's facets.
void add_adjacency(std::span<const format::PieceFacet> facets,
                   std::vector<format::PieceAdjacency>& adjacency) {
    std::map<std::array<std::uint32_t, 2>, std::uint32_t> left_of;
    for (std::uint32_t f = 0; f < facets.size(); ++f) {
        const auto& c = facets[f].corner;
        for (std::size_t k = 0; k < 3; ++k) left_of[{c[k], c[(k + 1) % 3]}] = f;
    }
    for (const format::PieceFacet& facet : facets) {
        const auto& c = facet.corner;
        adjacency.push_back(
            {{left_of.at({c[1], c[0]}), left_of.at({c[2], c[1]}), left_of.at({c[0], c[2]})}});
    }
}

}  // namespace

AlignedBytes with_pieces(const AlignedBytes& file) {
    const OpenModel open = open_tiny(AlignedBytes(file.span()));
    const BuilderInput input = builder_input(open.model);
    Sections made;
    for (std::uint32_t t = 0; t < input.triangles.size(); ++t) {
        add_triangle(made, input.positions, input.triangles[t]);
        made.triangles.push_back(t);
    }
    return with(file, made);
}

AlignedBytes with_one_piece(const AlignedBytes& file) {
    const OpenModel open = open_tiny(AlignedBytes(file.span()));
    const BuilderInput input = builder_input(open.model);
    const SmallHull hull(input.positions);
    Sections made;
    made.begin_piece(format::piece_contained, 3);
    made.triangles.resize(input.triangles.size());
    std::iota(made.triangles.begin(), made.triangles.end(), 0U);
    std::vector<std::uint32_t> vertex_of;
    for (const Double3& p : hull.points()) {
        const auto at = std::find(input.positions.begin(), input.positions.end(), p);
        vertex_of.push_back(static_cast<std::uint32_t>(at - input.positions.begin()));
    }
    made.vertices = vertex_of;
    std::sort(made.vertices.begin(), made.vertices.end());
    for (const auto& triangle : hull.triangles()) {
        format::PieceFacet facet{{}, facet_first_of_face};
        for (std::size_t i = 0; i < 3; ++i) {
            const auto at = std::lower_bound(made.vertices.begin(), made.vertices.end(),
                                             vertex_of[triangle[i]]);
            facet.corner[i] = static_cast<std::uint32_t>(at - made.vertices.begin());
        }
        made.facets.push_back(facet);
    }
    return with(file, made);
}

AlignedBytes with_contacts(const AlignedBytes& file) {
    const Model model = Model::open(file.span()).value();
    std::vector<format::PieceAdjacency> adjacency;
    for (std::size_t i = 0; i < model.pieces().pieces.size(); ++i) {
        const std::size_t begin = first_facet(model, i);
        add_adjacency(model.pieces().facets.subspan(begin, first_facet(model, i + 1) - begin),
                      adjacency);
    }
    std::vector<std::uint8_t> convexity(model.triangle_count());
    for (std::size_t t = 0; t < convexity.size(); ++t) {
        convexity[t] = static_cast<std::uint8_t>(t * 37 % 64);
    }
    std::vector<std::uint32_t> piece_of(model.triangle_count());
    for (std::uint32_t i = 0; i < model.pieces().pieces.size(); ++i) {
        const bool is_last = i + 1 == model.pieces().pieces.size();
        const std::size_t end =
            is_last ? piece_of.size() : model.pieces().pieces[i + 1].first_triangle;
        for (std::size_t t = model.pieces().pieces[i].first_triangle; t < end; ++t) {
            piece_of[model.pieces().triangles[t]] = i;
        }
    }
    std::vector<TinySection> sections;
    if (!model.sections().contains(SectionId::piece_nodes)) {
        sections = piece_tree_sections(model, model.pieces().pieces, model.pieces().triangles);
    }
    sections.push_back(as_section<format::PieceAdjacency>(SectionId::piece_adjacency, adjacency));
    sections.push_back(as_section<std::uint8_t>(SectionId::edge_convexity, convexity));
    sections.push_back(as_section<std::uint32_t>(SectionId::triangle_piece, piece_of));
    return with_sections(file, std::move(sections));
}

}  // namespace cdprep::test
