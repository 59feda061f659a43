// SPDX-License-Identifier: MIT
#include "support/tiny_pieces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "cdprep/advanced/build_piece_boxes.h"
#include "support/more_sections.h"

#include "cdprep/format/pieces.h"

namespace cdprep::test {
namespace {

struct Pieces {
    std::vector<format::Piece> pieces;
    std::vector<std::uint32_t> triangles;
    std::vector<std::uint32_t> vertices;
};

/// Every eleventh of each window of triangles, over and over, cut into runs.
Pieces scattered(const std::vector<Triangle>& triangles) {
    constexpr std::uint32_t kWindow = 37;
    constexpr std::array<std::uint32_t, 5> kSizes = {1, 3, 9, 20, 4};
    Pieces made;
    const auto count = static_cast<std::uint32_t>(triangles.size());
    for (std::uint32_t first = 0; first < count; first += kWindow) {
        for (std::uint32_t i = 0; i < kWindow; ++i) {
            const std::uint32_t t = first + i * 11 % kWindow;
            if (t < count) made.triangles.push_back(t);
        }
    }
    for (std::uint32_t at = 0, i = 0; at < count; ++i) {
        const std::uint32_t size = std::min(kSizes[i % kSizes.size()], count - at);
        const auto begin = made.triangles.begin() + at;
        std::sort(begin, begin + size);
        made.pieces.push_back({at, i, 0, 0, 0, 0, 0});
        made.vertices.push_back(triangles[*begin].vertex[0]);
        at += size;
    }
    return made;
}

format::PieceNodeHull box_around(const std::vector<Double3>& points) {
    format::PieceNodeHull hull{};
    if (points.empty()) return hull;
    Double3 lower = points[0], upper = points[0];
    for (const Double3& p : points) {
        lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
        upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
    }
    for (std::size_t i = 0; i < format::kPieceHullCorners; ++i) {
        const unsigned corner = std::min<unsigned>(static_cast<unsigned>(i), 7);
        auto& at = hull.block[i / format::kHullLanes].at;
        at[0][i % format::kHullLanes] = (corner & 1) != 0 ? upper.x : lower.x;
        at[1][i % format::kHullLanes] = (corner & 2) != 0 ? upper.y : lower.y;
        at[2][i % format::kHullLanes] = (corner & 4) != 0 ? upper.z : lower.z;
    }
    hull.count = 8;
    hull.slack = std::hypot(upper.x - lower.x, upper.y - lower.y, upper.z - lower.z);
    return hull;
}

}  // namespace

std::vector<TinySection> piece_tree_sections(const Model& model,
                                             std::span<const format::Piece> pieces,
                                             std::span<const std::uint32_t> triangles) {
    const BuilderInput input = builder_input(model);
    const format::FileHeader& header = model.header();
    const build::PieceBoxes boxes =
        build::build_piece_boxes({input.positions, input.triangles, pieces, triangles},
                                 {header.frame_origin, header.frame_exponent}, serial_for);
    const std::vector<format::PieceNodeHull> hulls(
        format::piece_hull_count(
            format::piece_tree_shape(static_cast<std::uint32_t>(boxes.leaves.size()))),
        box_around(input.positions));
    return {as_section<format::BvhNode>(SectionId::piece_nodes, boxes.nodes),
            as_section<format::SweptNode>(SectionId::piece_swept, boxes.swept),
            as_section<format::PieceLeaf>(SectionId::piece_leaves, boxes.leaves),
            as_section<format::PieceNodeHull>(SectionId::piece_node_hulls, hulls)};
}

AlignedBytes with_piece_tree(const AlignedBytes& file) {
    const Model model = Model::open(file.span()).value();
    const Pieces made = scattered(builder_input(model).triangles);
    std::vector<TinySection> sections = piece_tree_sections(model, made.pieces, made.triangles);
    sections.push_back(as_section<format::Piece>(SectionId::pieces, made.pieces));
    sections.push_back(as_section<std::uint32_t>(SectionId::piece_triangles, made.triangles));
    sections.push_back(as_section<std::uint32_t>(SectionId::piece_vertices, made.vertices));
    sections.push_back(as_section<format::PieceFacet>(SectionId::piece_facets, {}));
    return with_sections(file, std::move(sections));
}

}  // namespace cdprep::test
