// SPDX-License-Identifier: MIT
#include <algorithm>
#include <numeric>
#include <tuple>

#include "predicates.h"
#include "support/more_sections.h"
#include "support/open_tiny.h"
#include "support/small_hull.h"

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

}  // namespace cdprep::test
