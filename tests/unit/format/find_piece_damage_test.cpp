// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "cdprep/format/content_hash.h"
#include "cdprep/format/find_damage.h"
#include "cdprep/format/pieces.h"
#include "cdprep/format/sections.h"
#include "support/changed_sections.h"
#include "support/meshes.h"
#include "support/more_sections.h"

namespace cdprep::format {
namespace {

using test::AlignedBytes;

constexpr std::array kPieceSections = {SectionId::pieces, SectionId::piece_triangles,
                                       SectionId::piece_vertices, SectionId::piece_facets};

struct Arrays {
    std::vector<Piece> pieces;
    std::vector<std::uint32_t> triangles;
    std::vector<std::uint32_t> vertices;
    std::vector<PieceFacet> facets;
    std::vector<PieceAdjacency> adjacency;
    std::vector<std::uint8_t> convexity;
    std::optional<std::vector<std::uint32_t>> piece_of;
};

/// Of two triangles side by side: each is a piece, seen from both sides.
Arrays two_pieces() {
    Arrays arrays;
    arrays.pieces = {{0, 0, 0, piece_contained, 0.5, 2, 0}, {1, 3, 2, 0, 0, 2, 0}};
    arrays.triangles = {0, 1};
    arrays.vertices = {0, 1, 2, 1, 2, 3};
    for (int i = 0; i < 2; ++i) {
        arrays.facets.push_back({{0, 1, 2}, facet_first_of_face});
        arrays.facets.push_back({{0, 2, 1}, facet_first_of_face | facet_virtual});
        arrays.adjacency.insert(arrays.adjacency.end(), {{{1, 1, 1}}, {{0, 0, 0}}});
    }
    arrays.piece_of = {0, 1};
    // Flat where they meet, from corner 1 of the first to 2 and from 0 of the second to 2.
    constexpr auto kFlat = EdgeConvexity::flat, kUnknown = EdgeConvexity::unknown;
    arrays.convexity = {edge_convexity_bits({kUnknown, kFlat, kUnknown}),
                        edge_convexity_bits({kUnknown, kUnknown, kFlat})};
    return arrays;
}

AlignedBytes file_of(const Arrays& arrays) {
    const test::TestMesh sheet = test::grid_sheet(1, 1);
    std::vector<test::TinySection> sections = {
        test::as_section(SectionId::pieces, std::span(arrays.pieces)),
        test::as_section(SectionId::piece_triangles, std::span(arrays.triangles)),
        test::as_section(SectionId::piece_vertices, std::span(arrays.vertices)),
        test::as_section(SectionId::piece_facets, std::span(arrays.facets)),
        test::as_section(SectionId::piece_adjacency, std::span(arrays.adjacency)),
        test::as_section(SectionId::edge_convexity, std::span(arrays.convexity))};
    if (arrays.piece_of) {
        sections.push_back(
            test::as_section(SectionId::triangle_piece, std::span(*arrays.piece_of)));
    }
    return test::with_sections(
        test::bake_tiny(sheet.positions, sheet.triangles, {.double_precision = true}), sections);
}

std::optional<Damage> check(const Arrays& arrays) {
    const AlignedBytes file = file_of(arrays);
    return find_damage(file.span(), SectionSet::all());
}

/// After `change`, the damage is of this kind in this section.
template <class Change>
void expect(DamageKind kind, SectionId section, Change change) {
    Arrays arrays = two_pieces();
    change(arrays);
    const auto damage = check(arrays);
    ASSERT_TRUE(damage) << section_name(section);
    EXPECT_EQ(damage->kind, kind) << section_name(damage->section);
    EXPECT_EQ(damage->section, section);
    if (kind == DamageKind::bad_index) {
        EXPECT_GT(damage->found, damage->limit);
    }
}

TEST(FindPieceDamage, AcceptsSoundPieces) {
    EXPECT_FALSE(check(two_pieces()));
    EXPECT_FALSE(find_deep_damage(file_of(two_pieces()).span()));
}

TEST(FindPieceDamage, RefusesPiecesOfWhichAPartIsMissing) {
    const AlignedBytes whole = file_of(two_pieces());
    for (const SectionId missing : kPieceSections) {
        const AlignedBytes file = test::without(whole, missing);
        const auto damage = find_damage(file.span(), SectionSet::all());
        ASSERT_TRUE(damage) << section_name(missing);
        EXPECT_EQ(damage->kind, DamageKind::missing_section);
        EXPECT_EQ(damage->section, missing);
    }
}

TEST(FindPieceDamage, RefusesListsThatDoNotFollowEachOther) {
    constexpr auto kOrder = DamageKind::bad_order;
    constexpr auto kPieces = SectionId::pieces;
    expect(kOrder, kPieces, [](Arrays& a) { a.pieces[0].first_triangle = 1; });
    expect(kOrder, kPieces, [](Arrays& a) { a.pieces[1].first_triangle = 0; });
    expect(kOrder, kPieces, [](Arrays& a) { a.pieces[1].first_triangle = 3; });
    expect(kOrder, kPieces, [](Arrays& a) { a.pieces[1].first_vertex = 0; });
    expect(kOrder, kPieces, [](Arrays& a) { a.pieces[1].first_vertex = ~0U; });
    expect(kOrder, kPieces, [](Arrays& a) { a.pieces[1].first_facet = ~0U; });
    expect(DamageKind::bad_count, kPieces, [](Arrays& a) { a.pieces[1].first_facet = 1; });
    expect(DamageKind::bad_count, kPieces, [](Arrays& a) { a.pieces[1].first_vertex = 2; });
    expect(kOrder, kPieces, [](Arrays& a) { a.pieces.clear(); });
}

TEST(FindPieceDamage, RefusesNumbersThatArePointless) {
    constexpr auto kNumber = DamageKind::bad_number;
    constexpr auto kPieces = SectionId::pieces;
    expect(kNumber, kPieces, [](Arrays& a) { a.pieces[0].outer_error = -1; });
    expect(kNumber, kPieces, [](Arrays& a) { a.pieces[1].outer_error = NAN; });
    expect(kNumber, kPieces, [](Arrays& a) { a.pieces[1].outer_error = INFINITY; });
    expect(kNumber, kPieces, [](Arrays& a) { a.pieces[1].flags = 2; });
    expect(kNumber, kPieces, [](Arrays& a) { a.pieces[1].reserved = 1; });
    expect(DamageKind::bad_count, kPieces, [](Arrays& a) { a.pieces[1].dimension = 4; });
    expect(DamageKind::bad_count, kPieces, [](Arrays& a) { a.pieces[1].dimension = 3; });
    expect(DamageKind::bad_count, kPieces, [](Arrays& a) { a.pieces[1].dimension = 1; });
}

TEST(FindPieceDamage, RefusesNumbersThatPointNowhere) {
    constexpr auto kIndex = DamageKind::bad_index;
    expect(kIndex, SectionId::piece_triangles, [](Arrays& a) { a.triangles[1] = 2; });
    expect(DamageKind::bad_count, SectionId::piece_triangles,
           [](Arrays& a) { a.triangles.push_back(1); });
    expect(kIndex, SectionId::piece_vertices, [](Arrays& a) { a.vertices[5] = 4; });
    expect(DamageKind::bad_order, SectionId::piece_vertices, [](Arrays& a) { a.vertices[5] = 2; });
    expect(kIndex, SectionId::piece_facets, [](Arrays& a) { a.facets[3].corner[1] = 3; });
    expect(DamageKind::bad_order, SectionId::piece_facets,
           [](Arrays& a) { a.facets[3].corner[1] = 0; });
    expect(DamageKind::bad_number, SectionId::piece_facets,
           [](Arrays& a) { a.facets[3].flags = 4; });
    expect(DamageKind::bad_number, SectionId::piece_facets,
           [](Arrays& a) { a.facets[2].flags = 0; });
}

TEST(FindPieceDamage, RefusesEdgesThatAreNotPaired) {
    constexpr auto kAdjacency = SectionId::piece_adjacency;
    expect(DamageKind::bad_index, kAdjacency, [](Arrays& a) { a.adjacency[2].across[2] = 2; });
    expect(DamageKind::bad_order, kAdjacency, [](Arrays& a) { a.adjacency[3].across[2] = 1; });
    expect(DamageKind::bad_count, kAdjacency, [](Arrays& a) { a.adjacency.pop_back(); });
    expect(DamageKind::bad_order, kAdjacency, [](Arrays& a) { a.facets[3].corner = {0, 1, 2}; });
}

TEST(FindPieceDamage, RefusesConvexityThatIsNone) {
    constexpr auto kConvexity = SectionId::edge_convexity;
    expect(DamageKind::bad_number, kConvexity, [](Arrays& a) { a.convexity[1] = 64; });
    expect(DamageKind::bad_count, kConvexity, [](Arrays& a) { a.convexity.push_back(0); });
}

TEST(FindPieceDamage, RefusesTrianglesOfOtherPieces) {
    constexpr auto kOwner = SectionId::triangle_piece;
    expect(DamageKind::bad_index, kOwner, [](Arrays& a) { (*a.piece_of)[1] = 2; });
    expect(DamageKind::bad_order, kOwner, [](Arrays& a) { (*a.piece_of)[1] = 0; });
    expect(DamageKind::bad_count, kOwner, [](Arrays& a) { a.piece_of->pop_back(); });
    // A wrong count is told of the first element.
    Arrays short_by_one = two_pieces(), wrong = two_pieces();
    short_by_one.piece_of->pop_back();
    (*wrong.piece_of)[0] = 2;
    const auto damage = check(short_by_one), first = check(wrong);
    ASSERT_TRUE(damage && first);
    EXPECT_EQ(damage->at, first->at);
    EXPECT_EQ(damage->found, 1u);
    EXPECT_EQ(damage->limit, 2u);
}

TEST(FindPieceDamage, DeepCheckRefusesATriangleInTwoPieces) {
    Arrays arrays = two_pieces();
    arrays.triangles = {0, 0};
    arrays.piece_of.reset();  // it would tell without the deep check
    EXPECT_FALSE(check(arrays));
    const auto damage = find_deep_damage(file_of(arrays).span());
    ASSERT_TRUE(damage);
    EXPECT_EQ(damage->kind, DamageKind::bad_fact);
    EXPECT_EQ(damage->section, SectionId::piece_triangles);
}

}  // namespace
}  // namespace cdprep::format
