// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cdprep/format/content_hash.h"
#include "cdprep/format/find_damage.h"
#include "cdprep/format/sections.h"
#include "cdprep/format/tetra_tree.h"
#include "support/changed_sections.h"
#include "support/meshes.h"
#include "support/more_sections.h"
#include "support/open_tiny.h"

namespace cdprep::format {
namespace {

using test::AlignedBytes;
using test::damage_of;
using test::element;
using test::entry_of;
using test::exchanged;
using test::with;

AlignedBytes baked(const test::TestMesh& mesh, const build::TetraTreeOptions& options) {
    return test::with_tetra_tree(
        test::bake_tiny(mesh.positions, mesh.triangles, {.double_precision = true}), options);
}

/// With leaves of several levels, and an octant that nothing touches.
AlignedBytes small_tree(TetraBounding bounding = TetraBounding::caps) {
    test::TestMesh mesh = test::icosphere(1);
    std::erase_if(mesh.triangles, [&](const Triangle& t) {
        return std::any_of(t.vertex.begin(), t.vertex.end(), [&](std::uint32_t v) {
            const Double3& p = mesh.positions[v];
            return p.x <= 0.3 && p.y <= 0.3 && p.z <= 0.3;
        });
    });
    return baked(mesh, {.level = 3, .threshold = 6, .bounding = bounding});
}

TEST(FindTetraDamage, AcceptsWhatTheBuilderMakes) {
    test::TestMesh point = test::copies_of_one_triangle(4);
    for (Double3& p : point.positions) p = {1, 2, 3};
    for (const test::TestMesh& mesh :
         {test::TestMesh{}, point, test::unit_cube(), test::icosphere(2), test::fan(70),
          test::coarse_grid_soup(3, 200, 3), test::copies_of_one_triangle(20),
          test::moved_by(test::icosphere(1), 1e-3, {1e6, 0, 1e6}),
          test::moved_by(test::icosphere(1), 0x1p-1000, {}),
          test::moved_by(test::icosphere(1), 0x1p999, {})}) {
        for (const std::uint32_t level : {0U, 3U, 5U}) {
            for (const TetraBounding bounding :
                 {TetraBounding::tetra, TetraBounding::caps, TetraBounding::boxes}) {
                const auto damage =
                    damage_of(baked(mesh, {.level = level, .threshold = 12, .bounding = bounding}));
                EXPECT_FALSE(damage) << section_name(damage->section) << " " << damage->at;
            }
        }
    }
}

TEST(FindTetraDamage, RefusesATreeOfWhichAPartIsMissing) {
    const AlignedBytes whole = small_tree(TetraBounding::boxes);
    for (const SectionId missing :
         {SectionId::tetra_tree, SectionId::tetra_nodes, SectionId::tetra_references,
          SectionId::tetra_top, SectionId::tetra_boxes, SectionId::tetra_oriented}) {
        const auto damage = damage_of(test::without(whole, missing));
        ASSERT_TRUE(damage) << section_name(missing);
        EXPECT_EQ(damage->kind, DamageKind::missing_section);
        EXPECT_EQ(damage->section, missing);
    }
}

// Nodes and table hold nothing that the rest does not fix, but radii.
TEST(FindTetraDamage, RefusesEveryOtherWordInNodesAndTable) {
    int asked = 0;
    const AlignedBytes file = small_tree();
    std::mt19937 random(5);
    for (const SectionId id : {SectionId::tetra_nodes, SectionId::tetra_top}) {
        const SectionEntry entry = entry_of(file, id);
        const std::uint64_t words = entry.count * entry.element_size / 4;
        for (std::uint64_t i = 0; i < words; ++i) {
            const std::uint64_t member = 4 * i % sizeof(TetraNode);
            const bool is_radius =
                id == SectionId::tetra_nodes && (member == offsetof(TetraNode, radius_min) ||
                                                 member == offsetof(TetraNode, radius_max));
            if (is_radius) continue;
            const auto now = element<std::uint32_t>(file, id, i);
            for (const std::uint32_t value : {0U, 1U, 0x7fffffffU, 0xffffffffU, now - 1, now + 1,
                                              now ^ (1U << random() % 32)}) {
                if (value == now) continue;
                ++asked;
                ASSERT_TRUE(damage_of(with(file, id, 4 * i, value)))
                    << section_name(id) << " word " << i << ": " << value << " for " << now;
            }
        }
    }
    EXPECT_GT(asked, 3'000);
}

TEST(FindTetraDamage, NodesTableAndReferencesHaveOneOrder) {
    const AlignedBytes file = small_tree();
    const std::uint64_t nodes = entry_of(file, SectionId::tetra_nodes).count;
    std::size_t lists = 0;
    for (std::uint64_t i = 1; i < nodes; ++i) {
        EXPECT_TRUE(damage_of(exchanged<TetraNode>(file, SectionId::tetra_nodes, i - 1, i))) << i;
        const auto node = element<TetraNode>(file, SectionId::tetra_nodes, i);
        if (node.flags != 0 || node.count < 2) continue;
        EXPECT_TRUE(damage_of(exchanged<std::uint32_t>(file, SectionId::tetra_references,
                                                       node.first, node.first + 1)))
            << i;
        ++lists;
    }
    EXPECT_GT(nodes, 30U);
    EXPECT_GT(lists, 10U);
    std::size_t places = 0;  // that differ from the one before
    for (std::uint64_t i = 1; i < entry_of(file, SectionId::tetra_top).count; ++i) {
        const auto now = element<std::uint32_t>(file, SectionId::tetra_top, i);
        if (element<std::uint32_t>(file, SectionId::tetra_top, i - 1) == now) continue;
        EXPECT_TRUE(damage_of(exchanged<std::uint32_t>(file, SectionId::tetra_top, i - 1, i))) << i;
        ++places;
    }
    EXPECT_GT(places, 10U);
}

TEST(FindTetraDamage, RadiiAreNumbersInOrder) {
    const AlignedBytes file = small_tree();
    const auto node = element<TetraNode>(file, SectionId::tetra_nodes, 0);
    const auto refused = [&](float least, float greatest) {
        TetraNode changed = node;
        changed.radius_min = least;
        changed.radius_max = greatest;
        return damage_of(with(file, SectionId::tetra_nodes, 0, changed)).has_value();
    };
    EXPECT_FALSE(refused(node.radius_min, node.radius_max));
    EXPECT_FALSE(refused(0, node.radius_max));
    EXPECT_TRUE(refused(std::nanf(""), 1));
    EXPECT_TRUE(refused(0, std::nanf("")));
    EXPECT_TRUE(refused(2, 1));
    EXPECT_TRUE(refused(-1, 1));
}

TEST(FindTetraDamage, FactsAreInTheirRanges) {
    const AlignedBytes file = small_tree();
    const auto tree = element<TetraTree>(file, SectionId::tetra_tree, 0);
    const auto refused = [&](auto change) {
        TetraTree changed = tree;
        change(changed);
        return damage_of(with(file, SectionId::tetra_tree, 0, changed)).has_value();
    };
    EXPECT_FALSE(refused([](TetraTree&) {}));
    for (const double x : {HUGE_VAL, std::nan(""), 0x1p1001}) {
        EXPECT_TRUE(refused([&](TetraTree& t) { t.centre.y = x; }));
    }
    EXPECT_TRUE(refused([](TetraTree& t) { t.level = 15; }));
    EXPECT_TRUE(refused([](TetraTree& t) { t.level = 1; }));  // there are deeper nodes
    EXPECT_TRUE(refused([](TetraTree& t) { t.top_level = t.level + 1; }));
    EXPECT_TRUE(refused([](TetraTree& t) { t.top_level = 0; }));  // the table is larger
    EXPECT_TRUE(refused([](TetraTree& t) { t.bounding = TetraBounding{3}; }));
    EXPECT_TRUE(refused([](TetraTree& t) { t.centre_count = 1; }));
    EXPECT_TRUE(refused([](TetraTree& t) { t.centre_count = 0xffffffffU; }));
    EXPECT_TRUE(refused([](TetraTree& t) { t.flags = 4; }));
}

TEST(FindTetraDamage, ReferencesAreOfTrianglesAndRise) {
    const AlignedBytes file = small_tree();
    const auto triangles = read_header(file.span()).triangle_count;
    std::uint64_t leaf = 0;  // the first of two triangles or more
    TetraNode node{};
    do {
        node = element<TetraNode>(file, SectionId::tetra_nodes, leaf++);
    } while (node.flags != 0 || node.count < 2);
    const auto refused = [&](std::uint32_t triangle) {
        const auto damage = damage_of(
            with(file, SectionId::tetra_references, 4 * std::uint64_t{node.first}, triangle));
        return damage ? damage->kind : DamageKind{0};
    };
    EXPECT_EQ(refused(triangles), DamageKind::bad_index);
    EXPECT_EQ(refused(0xffffffffU), DamageKind::bad_index);
    const auto second = element<std::uint32_t>(file, SectionId::tetra_references, node.first + 1);
    EXPECT_EQ(refused(second), DamageKind::bad_order);
}

// Beside a tree that says it has none.
TEST(FindTetraDamage, RefusesBoxesThatNothingSpeaksOf) {
    const AlignedBytes file = small_tree(TetraBounding::boxes);
    auto tree = element<TetraTree>(file, SectionId::tetra_tree, 0);
    for (const TetraBounding other : {TetraBounding::tetra, TetraBounding::caps}) {
        tree.bounding = other;
        const auto damage = damage_of(with(file, SectionId::tetra_tree, 0, tree));
        ASSERT_TRUE(damage);
        EXPECT_EQ(damage->kind, DamageKind::bad_section);
        EXPECT_EQ(damage->section, SectionId::tetra_boxes);
    }
}

// Each box is there twice, so every other number is seen; of unused ones any.
TEST(FindTetraDamage, RefusesEveryOtherNumberInBoxes) {
    int asked = 0;
    const AlignedBytes file = small_tree(TetraBounding::boxes);
    const std::uint64_t nodes = entry_of(file, SectionId::tetra_nodes).count;
    for (const SectionId id : {SectionId::tetra_boxes, SectionId::tetra_oriented}) {
        const SectionEntry entry = entry_of(file, id);
        const std::uint64_t rows = entry.element_size / 4 / kBvhWidth;
        for (std::uint64_t i = 0; i < entry.count * rows * kBvhWidth; ++i) {
            const std::uint64_t at = i / (rows * kBvhWidth);
            const std::uint64_t lane = i % kBvhWidth;
            const auto now = element<float>(file, id, i);
            const bool is_once = (at == 0 && lane < 4) || at + 1 == entry.count;
            const bool is_used = 4 * at + lane < nodes;
            for (const float value : {std::nanf(""), HUGE_VALF, now + 0.125F}) {
                const bool is_number = value == now + 0.125F;
                if (is_once && is_used && is_number) continue;
                ++asked;
                ASSERT_TRUE(damage_of(with(file, id, 4 * i, value)))
                    << section_name(id) << " number " << i << ": " << value << " for " << now;
            }
        }
    }
    EXPECT_GT(asked, 10'000);
}

TEST(FindTetraDamage, BoxesAreInTheFrameAndInOrder) {
    const AlignedBytes file = small_tree(TetraBounding::boxes);
    const auto first = element<BvhNode>(file, SectionId::tetra_boxes, 0);
    const auto refused = [&](float lower, float upper) {
        BvhNode changed = first;
        changed.lower[1][2] = lower;
        changed.upper[1][2] = upper;
        return damage_of(with(file, SectionId::tetra_boxes, 0, changed)).has_value();
    };
    EXPECT_FALSE(refused(-1, 1));
    EXPECT_FALSE(refused(0.5F, 0.5F));
    EXPECT_TRUE(refused(std::nextafter(-1.0F, -2.0F), 1));
    EXPECT_TRUE(refused(-1, std::nextafter(1.0F, 2.0F)));
    EXPECT_TRUE(refused(0.5F, std::nextafter(0.5F, 0.0F)));
    auto oriented = element<OrientedNode>(file, SectionId::tetra_oriented, 0);
    oriented.half[1][2] = -1;
    EXPECT_TRUE(damage_of(with(file, SectionId::tetra_oriented, 0, oriented)));
}

// What is not wanted is not read.
TEST(FindTetraDamage, LooksOnlyAtWhatIsWanted) {
    const AlignedBytes file = small_tree();
    const AlignedBytes bad = with(file, SectionId::tetra_nodes, 0, std::uint32_t{7});
    EXPECT_TRUE(damage_of(bad));
    EXPECT_FALSE(damage_of(bad, {SectionId::positions_f64, SectionId::triangles}));
    const AlignedBytes boxed = small_tree(TetraBounding::boxes);
    const AlignedBytes bad_box = with(boxed, SectionId::tetra_boxes, 0, std::nanf(""));
    EXPECT_TRUE(damage_of(bad_box));
    EXPECT_FALSE(damage_of(bad_box, {SectionId::tetra_tree, SectionId::tetra_nodes,
                                     SectionId::tetra_references, SectionId::tetra_top}));
}

}  // namespace
}  // namespace cdprep::format
