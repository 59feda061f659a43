// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "cdprep/format/content_hash.h"
#include "cdprep/format/find_damage.h"
#include "cdprep/format/octree.h"
#include "cdprep/format/sections.h"
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

constexpr std::array kOctreeSections = {
    SectionId::octree_grid,          SectionId::octree_nodes,      SectionId::octree_references,
    SectionId::octree_leaf_codes,    SectionId::octree_leaf_nodes, SectionId::octree_top,
    SectionId::octree_modulus_table, SectionId::octree_mixed_table};

AlignedBytes baked(const test::TestMesh& mesh, const build::OctreeOptions& options) {
    return test::with_octree(test::bake_tiny(mesh.positions, mesh.triangles), options);
}

AlignedBytes small_octree() {
    return baked(test::icosphere(1), {.level = 3, .threshold = 9});
}

TEST(FindOctreeDamage, AcceptsWhatTheBuilderMakes) {
    for (const test::TestMesh& mesh :
         {test::TestMesh{}, test::unit_cube(), test::icosphere(2), test::fan(70),
          test::coarse_grid_soup(3, 200, 3), test::copies_of_one_triangle(20),
          test::moved_by(test::icosphere(1), 1e-3, {1e6, 0, 1e6}),
          test::moved_by(test::icosphere(1), 0x1p-1000, {}),
          test::moved_by(test::icosphere(1), 0x1p999, {})}) {
        for (const std::uint32_t level : {0U, 3U, 6U}) {
            for (const bool hashed : {false, true}) {
                const AlignedBytes plain =
                    test::bake_tiny(mesh.positions, mesh.triangles, {.double_precision = true});
                EXPECT_FALSE(damage_of(
                    test::with_octree(plain, {.level = level, .threshold = 12, .hashed = hashed})));
            }
        }
    }
}

TEST(FindOctreeDamage, RefusesATreeOfWhichAPartIsMissing) {
    const AlignedBytes whole = small_octree();
    for (const SectionId missing : kOctreeSections) {
        const auto damage = damage_of(test::without(whole, missing));
        ASSERT_TRUE(damage) << section_name(missing);
        EXPECT_EQ(damage->kind, DamageKind::missing_section);
        EXPECT_EQ(damage->section, missing);
    }
}

// The nodes and the tables hold nothing that the rest does not fix: any other word is
// damage. A reference may be to another triangle between its neighbours, and be marked or
// not, without any danger; and the grid's threshold is only reported.
TEST(FindOctreeDamage, RefusesEveryOtherWordInNodesAndTables) {
    int asked = 0;
    const AlignedBytes file = small_octree();
    std::mt19937 random(5);
    for (const SectionId id : kOctreeSections) {
        if (id == SectionId::octree_grid || id == SectionId::octree_references) continue;
        const SectionEntry entry = entry_of(file, id);
        const std::uint64_t words = entry.count * entry.element_size / 4;
        for (std::uint64_t i = 0; i < words; ++i) {
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
    EXPECT_GT(asked, 10'000);
}

// Each code still belongs to its node: only their order is wrong, or one leaf is there twice.
TEST(FindOctreeDamage, CodesOfLeavesRiseStrictly) {
    const AlignedBytes file = small_octree();
    const std::uint64_t leaves = entry_of(file, SectionId::octree_leaf_codes).count;
    ASSERT_GT(leaves, 30U);
    const auto expect_refused = [](const AlignedBytes& changed, std::uint64_t i) {
        const auto damage = damage_of(changed);
        ASSERT_TRUE(damage) << i;
        EXPECT_EQ(damage->kind, DamageKind::bad_order) << i;
        EXPECT_EQ(damage->section, SectionId::octree_leaf_codes) << i;
    };
    for (std::uint64_t i = 1; i < leaves; ++i) {
        const auto codes = exchanged<std::uint64_t>(file, SectionId::octree_leaf_codes, i - 1, i);
        expect_refused(exchanged<std::uint32_t>(codes, SectionId::octree_leaf_nodes, i - 1, i), i);
        const auto code = element<std::uint64_t>(file, SectionId::octree_leaf_codes, i - 1);
        const auto node = element<std::uint32_t>(file, SectionId::octree_leaf_nodes, i - 1);
        expect_refused(with(with(file, SectionId::octree_leaf_codes, 8 * i, code),
                            SectionId::octree_leaf_nodes, 4 * i, node),
                       i);
    }
}

TEST(FindOctreeDamage, NodesAndReferencesHaveOneOrder) {
    const AlignedBytes file = small_octree();
    const std::uint64_t nodes = entry_of(file, SectionId::octree_nodes).count;
    ASSERT_GT(nodes, 30U);
    std::size_t lists = 0;
    for (std::uint64_t i = 1; i < nodes; ++i) {
        EXPECT_TRUE(damage_of(exchanged<OctreeNode>(file, SectionId::octree_nodes, i - 1, i))) << i;
        const auto node = element<OctreeNode>(file, SectionId::octree_nodes, i);
        if ((node.count & kInnerNode) != 0 || node.count < 2) continue;
        EXPECT_TRUE(damage_of(exchanged<std::uint32_t>(file, SectionId::octree_references,
                                                       node.first, node.first + 1)))
            << i;
        ++lists;
    }
    EXPECT_GT(lists, 20U);
}

TEST(FindOctreeDamage, ReferencesAreOfTrianglesAndRise) {
    const AlignedBytes file = small_octree();
    std::uint64_t leaf = 0;  // the first of two triangles or more
    OctreeNode node{};
    do {
        node = element<OctreeNode>(file, SectionId::octree_nodes, leaf++);
    } while ((node.count & kInnerNode) != 0 || node.count < 2);
    const auto refused = [&](std::uint32_t triangle) {
        const auto damage = damage_of(
            with(file, SectionId::octree_references, 4 * std::uint64_t{node.first}, triangle));
        return damage ? damage->kind : DamageKind{0};
    };
    EXPECT_EQ(refused(80), DamageKind::bad_index);
    EXPECT_EQ(refused(kSharedReference | 80), DamageKind::bad_index);
    EXPECT_EQ(refused(0xffffffffU), DamageKind::bad_index);
    const auto second = element<std::uint32_t>(file, SectionId::octree_references, node.first + 1);
    EXPECT_EQ(refused(second), DamageKind::bad_order);
}

TEST(FindOctreeDamage, PlanesOfTheGridRiseStrictlyAndAreFinite) {
    const AlignedBytes file = small_octree();
    const auto grid = element<OctreeGrid>(file, SectionId::octree_grid, 0);
    const auto refused = [&](auto change) {
        OctreeGrid changed = grid;
        change(changed);
        return damage_of(with(file, SectionId::octree_grid, 0, changed)).has_value();
    };
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(refused([](OctreeGrid&) {}));
    for (const double x : {kInfinity, -kInfinity, std::nan(""), 0x1p1010}) {
        EXPECT_TRUE(refused([&](OctreeGrid& g) { g.origin.y = x; }));
        EXPECT_TRUE(refused([&](OctreeGrid& g) { g.step = x; }));
    }
    EXPECT_TRUE(refused([](OctreeGrid& g) { g.step = 0; }));
    EXPECT_TRUE(refused([](OctreeGrid& g) { g.step = -g.step; }));
    EXPECT_TRUE(refused([](OctreeGrid& g) { g.step *= 0x1p-40; }));
    EXPECT_TRUE(refused([](OctreeGrid& g) { g.step *= 1 + 0x1p-40; }));  // 32 bits
    EXPECT_TRUE(refused([](OctreeGrid& g) { g.level = 22; }));
    EXPECT_TRUE(refused([](OctreeGrid& g) { g.level = 1; }));  // there are deeper nodes
    EXPECT_TRUE(refused([](OctreeGrid& g) { g.top_level = g.level + 1; }));
    EXPECT_TRUE(refused([](OctreeGrid& g) { g.top_level = 0; }));  // the table is larger
    for (const std::uint32_t bits : {0U, 1U, 40U, 41U, 64U, 0xffffffffU}) {
        EXPECT_TRUE(refused([&](OctreeGrid& g) { g.slot_bits = bits; }));
    }
}

// What is not wanted is not read, and a tree without its grid is no tree.
TEST(FindOctreeDamage, LooksOnlyAtWhatIsWanted) {
    const AlignedBytes file = small_octree();
    const AlignedBytes bad_top = with(file, SectionId::octree_top, 0, 7U);
    const SectionSet tree = {SectionId::octree_grid, SectionId::octree_nodes,
                             SectionId::octree_references};
    EXPECT_FALSE(damage_of(bad_top, tree));
    EXPECT_TRUE(damage_of(bad_top));
    const AlignedBytes bad_node = with(file, SectionId::octree_nodes, 0, std::uint64_t{2});
    EXPECT_TRUE(damage_of(bad_node, tree));
    EXPECT_FALSE(damage_of(bad_node, {SectionId::positions_f32}));
}

}  // namespace
}  // namespace cdprep::format
