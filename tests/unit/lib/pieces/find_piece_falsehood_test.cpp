// SPDX-License-Identifier: MIT
#include "cdprep/advanced/find_falsehood.h"

#include <gtest/gtest.h>

#include <cstring>

#include "cdprep/format/sections.h"
#include "support/open_tiny.h"
#include "support/reseal.h"
#include "support/tiny_pieces.h"

namespace cdprep::test {
namespace {

AlignedBytes baked() {
    const TestMesh ball = icosphere(3);
    return with_piece_tree(bake_tiny(ball.positions, ball.triangles, {.double_precision = true}));
}

/// What is found after a change of the last hull, whose corners are those of a box around all.
template <class Change>
std::optional<format::Damage> falsehood_after(Change change) {
    AlignedBytes file = baked();
    const auto entry =
        format::find_section(std::as_const(file).span(), SectionId::piece_node_hulls);
    std::byte* at = file.span().data() + entry->offset + (entry->count - 1) * entry->element_size;
    format::PieceNodeHull hull;
    std::memcpy(&hull, at, sizeof hull);
    change(hull);
    std::memcpy(at, &hull, sizeof hull);
    reseal(file.span());
    const OpenModel open = open_tiny(std::move(file));
    return find_piece_falsehood(std::as_const(open.bytes).span(), open.model);
}

TEST(FindPieceFalsehood, AcceptsHullsAroundWhatIsBelow) {
    EXPECT_FALSE(falsehood_after([](format::PieceNodeHull&) {}));
    const OpenModel plain = open_tiny(unit_cube());
    EXPECT_FALSE(find_piece_falsehood(std::as_const(plain.bytes).span(), plain.model));
}

// By hand: one step inwards leaves a point of a ball outside.
TEST(FindPieceFalsehood, RefusesAHullThatLeavesAVertexOut) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto damage = falsehood_after([&](format::PieceNodeHull& hull) {
            for (format::HullBlock& block : hull.block) {
                for (double& x : block.at[axis]) x = x > 0 ? 0.25 * x : x;
            }
        });
        ASSERT_TRUE(damage);
        EXPECT_EQ(damage->section, SectionId::piece_node_hulls);
        EXPECT_EQ(damage->kind, format::DamageKind::bad_fact);
    }
}

TEST(FindPieceFalsehood, RefusesASlackThatIsTooSmall) {
    EXPECT_TRUE(falsehood_after([](format::PieceNodeHull& hull) { hull.slack = 0x1p-10; }));
}

}  // namespace
}  // namespace cdprep::test
