// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "cdprep/format/find_damage.h"
#include "cdprep/format/octree.h"
#include "cdprep/format/sections.h"
#include "support/meshes.h"
#include "support/more_sections.h"
#include "support/reseal.h"

namespace cdprep::format {
namespace {

using test::AlignedBytes;

constexpr std::array kBoxes = {SectionId::octree_boxes, SectionId::adaptive_octree_boxes};

/// A file with the tree whose boxes `id` names, with those or without.
AlignedBytes with_tree(const AlignedBytes& file, SectionId id, bool boxes) {
    const auto boxes_in = boxes ? std::optional(build::Frame{}) : std::nullopt;
    if (id == SectionId::octree_boxes) {
        return test::with_octree(file, {.level = 2, .threshold = 4, .boxes_in = boxes_in});
    }
    return test::with_adaptive_octree(file, {.level = 2, .threshold = 4, .boxes_in = boxes_in});
}

AlignedBytes bare_file() {
    const test::TestMesh mesh = test::random_soup(11, 60, 0.5);
    return test::bake_tiny(mesh.positions, mesh.triangles);
}

void sees_boxes_that_are_none(SectionId id) {
    const AlignedBytes file = with_tree(bare_file(), id, true);
    ASSERT_FALSE(find_damage(file.span()));
    const SectionEntry entry = find_section(file.span(), id).value();
    for (const std::uint64_t box : {std::uint64_t{0}, entry.count - 1}) {
        for (std::size_t number = 0; number < 6; ++number) {
            const float wrong = number < 3 ? 1.5F : -1.5F;
            for (const float value : {wrong, -wrong, std::numeric_limits<float>::quiet_NaN()}) {
                AlignedBytes changed(file.span());
                std::memcpy(changed.span().data() + entry.offset + 24 * box + 4 * number, &value,
                            4);
                test::reseal(changed.span());
                const auto damage = find_damage(std::as_const(changed).span());
                ASSERT_TRUE(damage);
                EXPECT_EQ(damage->kind, DamageKind::bad_box);
                EXPECT_EQ(damage->section, id);
            }
        }
    }
}

TEST(FindBadCellBox, SeesBoxesThatAreNone) {
    for (const SectionId id : kBoxes) sees_boxes_that_are_none(id);
}

// Boxes of another tree, and boxes without any.
TEST(FindBadCellBox, SeesBoxesThatBelongToNoTree) {
    const std::vector<CellBox> boxes(3, CellBox{{-1, -1, -1}, {1, 1, 1}});
    for (const SectionId id : kBoxes) {
        const auto section = test::as_section(id, std::span(boxes));
        const auto lost = find_damage(test::with_sections(bare_file(), {section}).span());
        ASSERT_TRUE(lost);
        EXPECT_EQ(lost->kind, DamageKind::missing_section);
        const AlignedBytes tree = with_tree(bare_file(), id, false);
        const auto few = find_damage(test::with_sections(tree, {section}).span());
        ASSERT_TRUE(few);
        EXPECT_EQ(few->kind, DamageKind::bad_count);
    }
}

}  // namespace
}  // namespace cdprep::format
