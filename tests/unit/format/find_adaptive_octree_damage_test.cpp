// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "cdprep/format/find_damage.h"
#include "cdprep/format/sections.h"
#include "support/changed_sections.h"
#include "support/meshes.h"
#include "support/more_sections.h"
#include "support/open_tiny.h"
#include "support/reseal.h"

namespace cdprep::format {
namespace {

using test::AlignedBytes;
using test::entry_of;
using test::with;

constexpr std::array<SectionId, 3> kSections = {SectionId::adaptive_octree,
                                                SectionId::adaptive_octree_nodes,
                                                SectionId::adaptive_octree_references};
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

AlignedBytes file_of(const test::TestMesh& mesh, const build::AdaptiveOctreeOptions& options) {
    return test::with_adaptive_octree(test::bake_tiny(mesh.positions, mesh.triangles), options);
}

AlignedBytes soup_file() {
    return file_of(test::random_soup(11, 60, 0.5), {.level = 2, .threshold = 4});
}

DamageKind kind_of(const AlignedBytes& file, SectionSet wanted = SectionSet::all()) {
    const auto damage = test::damage_of(file, wanted);
    return damage ? damage->kind : DamageKind{0};
}

template <class T>
T at(const AlignedBytes& file, std::uint64_t place) {
    T value;
    std::memcpy(&value, file.span().data() + place, sizeof value);
    return value;
}

std::uint64_t node_place(const AlignedBytes& file, std::uint64_t index) {
    return entry_of(file, SectionId::adaptive_octree_nodes).offset +
           index * sizeof(AdaptiveOctreeNode);
}

AdaptiveOctreeNode node_of(const AlignedBytes& file, std::uint64_t index) {
    return at<AdaptiveOctreeNode>(file, node_place(file, index));
}

DamageKind kind_with(const AlignedBytes& file, std::uint64_t index,
                     const AdaptiveOctreeNode& node) {
    return kind_of(with(file, node_place(file, index), node));
}

TEST(FindAdaptiveOctreeDamage, AcceptsWhatTheBuilderMakes) {
    for (const SplitRule rule : {SplitRule::median, SplitRule::surface_area}) {
        for (const test::TestMesh& mesh :
             {test::random_soup(1, 300, 0.3), test::coarse_grid_soup(2, 300, 3),
              test::grid_sheet(8, 8), test::copies_of_one_triangle(9), test::icosphere(3),
              test::moved_by(test::random_soup(1, 300, 0.3), 1e-3, {1e6, 1e6, 1e6}),
              test::TestMesh{}}) {
            for (const std::uint32_t level : {0U, 2U, 6U}) {
                const AlignedBytes file =
                    file_of(test::in_floats(mesh), {.level = level, .threshold = 4, .rule = rule});
                EXPECT_FALSE(find_damage(file.span()));
                // The tiny baker marks no degenerate triangles, which soups may have.
                const auto deep = find_deep_damage(file.span());
                EXPECT_TRUE(!deep || deep->section == SectionId::degenerate_bits);
            }
        }
    }
}

std::vector<test::TinySection> tree_of(const AlignedBytes& file) {
    std::vector<test::TinySection> sections;
    for (const SectionId id : kSections) {
        const SectionEntry entry = entry_of(file, id);
        const auto bytes = file.span().subspan(entry.offset, entry.count * entry.element_size);
        sections.push_back({id, {bytes.begin(), bytes.end()}});
    }
    return sections;
}

TEST(FindAdaptiveOctreeDamage, ATreeWithSomeOfItsSectionsIsDamage) {
    const AlignedBytes file = soup_file();
    const auto sections = tree_of(file);
    const test::TestMesh mesh = test::random_soup(11, 60, 0.5);
    const AlignedBytes plain = test::bake_tiny(mesh.positions, mesh.triangles);
    for (std::size_t mask = 0; mask < 8; ++mask) {
        std::vector<test::TinySection> some;
        for (std::size_t i = 0; i < 3; ++i) {
            if ((mask >> i & 1) != 0) some.push_back(sections[i]);
        }
        const DamageKind kind = kind_of(test::with_sections(plain, some));
        EXPECT_EQ(kind, mask == 0 || mask == 7 ? DamageKind{0} : DamageKind::missing_section);
    }
}

TEST(FindAdaptiveOctreeDamage, ATreeNeedsItsTriangles) {
    const test::TestMesh mesh = test::random_soup(11, 60, 0.5);
    const AlignedBytes whole = file_of(mesh, {});
    const AlignedBytes file = test::assemble(read_header(whole.span()), tree_of(whole));
    EXPECT_EQ(kind_of(file), DamageKind::missing_section);
}

TEST(FindAdaptiveOctreeDamage, FactsMustBeInRange) {
    const AlignedBytes file = soup_file();
    const std::uint64_t place = entry_of(file, SectionId::adaptive_octree).offset;
    const auto good = at<AdaptiveOctree>(file, place);
    const auto kind = [&](auto change) {
        AdaptiveOctree tree = good;
        change(tree);
        return kind_of(with(file, place, tree));
    };
    EXPECT_EQ(kind([](auto& t) { t.level = kOctreeBits; }), DamageKind{0});
    EXPECT_EQ(kind([](auto& t) { t.level = kOctreeBits + 1; }), DamageKind::bad_index);
    EXPECT_EQ(kind([](auto& t) { --t.level; }), DamageKind::bad_order);
    EXPECT_EQ(kind([](auto& t) { t.rule = SplitRule{2}; }), DamageKind::bad_index);
    EXPECT_EQ(kind([](auto& t) { t.lower.y = kNan; }), DamageKind::bad_number);
    EXPECT_EQ(kind([](auto& t) { t.upper.z = 0x1p1001; }), DamageKind::bad_number);
    EXPECT_EQ(kind([](auto& t) { std::swap(t.lower.x, t.upper.x); }), DamageKind::bad_box);
    // A box that no longer holds its splits.
    EXPECT_EQ(kind([](auto& t) { t.upper.x = t.lower.x; }), DamageKind::bad_box);
    // Reserved, and of no consequence.
    EXPECT_EQ(kind([](auto& t) { t.reserved = 7; }), DamageKind{0});
    EXPECT_EQ(kind([](auto& t) { t.threshold = 0; }), DamageKind{0});
}

TEST(FindAdaptiveOctreeDamage, LinksLeadForwardAndListsFollowEachOther) {
    const AlignedBytes file = soup_file();
    const std::uint64_t nodes = entry_of(file, SectionId::adaptive_octree_nodes).count;
    std::size_t inner = 0;
    std::size_t leaves = 0;
    for (std::uint64_t i = 0; i < nodes; ++i) {
        const AdaptiveOctreeNode good = node_of(file, i);
        const bool is_inner = (good.count & kInnerNode) != 0;
        ++(is_inner ? inner : leaves);
        for (const std::uint32_t first : {0U, 0xffffffffU, good.first - 1, good.first + 1}) {
            AdaptiveOctreeNode node = good;
            node.first = first;
            EXPECT_EQ(kind_with(file, i, node),
                      first == good.first ? DamageKind{0} : DamageKind::bad_order)
                << i;
        }
        for (const std::uint32_t count : {0U, 0xffffffffU, 0x7fffffffU, good.count - 1,
                                          good.count + 1, good.count ^ kInnerNode, kInnerNode}) {
            AdaptiveOctreeNode node = good;
            node.count = count;
            EXPECT_NE(kind_with(file, i, node), DamageKind{0}) << i << " " << count;
        }
    }
    EXPECT_GT(inner, 5U);
    EXPECT_GT(leaves, 30U);
}

// The box of a node follows from the splits above it.
TEST(FindAdaptiveOctreeDamage, SplitsLieInsideTheirBoxes) {
    const AlignedBytes file = soup_file();
    const std::uint64_t root_place = entry_of(file, SectionId::adaptive_octree).offset;
    const auto tree = at<AdaptiveOctree>(file, root_place);
    const std::uint64_t nodes = entry_of(file, SectionId::adaptive_octree_nodes).count;
    for (std::uint64_t i = 0; i < nodes; ++i) {
        const AdaptiveOctreeNode good = node_of(file, i);
        for (const double wrong :
             {kNan, 1e300, -1e300, tree.lower.x, std::nextafter(tree.lower.x, -1e300),
              std::nextafter(tree.upper.x, 1e300)}) {
            AdaptiveOctreeNode node = good;
            node.split.x = wrong;
            EXPECT_EQ(kind_with(file, i, node), DamageKind::bad_box) << i << " " << wrong;
        }
        // Whole along x, though there are children above; or the split of a leaf.
        AdaptiveOctreeNode whole = good;
        whole.split.x = tree.upper.x;
        EXPECT_EQ(kind_with(file, i, whole), DamageKind::bad_box);
    }
}

TEST(FindAdaptiveOctreeDamage, ReferencesRiseAndNameTriangles) {
    const AlignedBytes file = soup_file();
    const SectionEntry entry = entry_of(file, SectionId::adaptive_octree_references);
    const std::uint32_t triangles = read_header(file.span()).triangle_count;
    for (std::uint64_t i = 0; i < entry.count; ++i) {
        for (const std::uint32_t wrong : {triangles, 0x7fffffffU, 0xffffffffU}) {
            EXPECT_EQ(kind_of(with(file, entry.offset + 4 * i, wrong)), DamageKind::bad_index);
        }
    }
    const AdaptiveOctreeNode root = node_of(file, 0);
    ASSERT_NE(root.count & kInnerNode, 0U);
    std::size_t swapped = 0;
    for (std::uint64_t i = 0; i < entry_of(file, kSections[1]).count; ++i) {
        const AdaptiveOctreeNode node = node_of(file, i);
        if ((node.count & kInnerNode) != 0 || node.count < 2) continue;
        const std::uint64_t place = entry.offset + std::uint64_t{4} * node.first;
        const auto first = at<std::uint32_t>(file, place);
        const auto second = at<std::uint32_t>(file, place + 4);
        EXPECT_EQ(kind_of(with(file, place, std::array{second, first})), DamageKind::bad_order);
        // Twice the same, told apart by the bit alone.
        EXPECT_EQ(kind_of(with(file, place + 4, first ^ kSharedReference)), DamageKind::bad_order);
        ++swapped;
    }
    EXPECT_GT(swapped, 20U);
}

// Where each node's children and list begin follows from the nodes before it.
TEST(FindAdaptiveOctreeDamage, NodesHaveOneOrder) {
    const AlignedBytes file = soup_file();
    const std::uint64_t nodes = entry_of(file, SectionId::adaptive_octree_nodes).count;
    ASSERT_GT(nodes, 30U);
    for (std::uint64_t i = 1; i < nodes; ++i) {
        const std::array pair = {node_of(file, i), node_of(file, i - 1)};
        EXPECT_NE(kind_of(with(file, node_place(file, i - 1), pair)), DamageKind{0}) << i;
    }
}

TEST(FindAdaptiveOctreeDamage, CountsMustMatch) {
    int asked = 0;
    const AlignedBytes file = soup_file();
    const FileHeader header = read_header(file.span());
    for (std::uint32_t i = 0; i < header.section_count; ++i) {
        const std::uint64_t entry_at = kSectionTableOffset + i * sizeof(SectionEntry);
        const auto entry = at<SectionEntry>(file, entry_at);
        if (entry.id < kSections[0] || entry.id > kSections[2]) continue;
        ++asked;
        SectionEntry shorter = entry;
        --shorter.count;
        if (shorter.count == 0) shorter.offset = 0;
        const DamageKind kind = kind_of(with(file, entry_at, shorter));
        EXPECT_TRUE(kind == DamageKind::bad_count || kind == DamageKind::bad_order);
        SectionEntry empty = entry;
        empty.count = 0;
        empty.offset = 0;
        const DamageKind kind_of_empty = kind_of(with(file, entry_at, empty));
        EXPECT_TRUE(kind_of_empty == DamageKind::bad_count ||
                    kind_of_empty == DamageKind::bad_order);
    }
    EXPECT_EQ(asked, 3);
}

/// Nodes that are reached from one on; each once, or this would not end.
std::uint64_t reached(const AlignedBytes& file, std::uint64_t index) {
    const AdaptiveOctreeNode node = node_of(file, index);
    std::uint64_t count = 1;
    if ((node.count & kInnerNode) == 0) return count;
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(std::popcount(node.count & 0xff));
         ++i) {
        count += reached(file, node.first + i);
    }
    return count;
}

// Every word of the three sections at its limits and off by one: what is accepted can be
// walked, and the walk meets each node once.
TEST(FindAdaptiveOctreeDamage, WhatIsAcceptedCanBeWalked) {
    const AlignedBytes file = file_of(test::random_soup(12, 20, 0.5), {.level = 3, .threshold = 4});
    std::size_t refused = 0;
    std::size_t tried = 0;
    for (const SectionId id : kSections) {
        const SectionEntry entry = entry_of(file, id);
        const std::uint64_t end = entry.offset + entry.count * entry.element_size;
        for (std::uint64_t place = entry.offset; place < end; place += 4) {
            const auto now = at<std::uint32_t>(file, place);
            for (const std::uint32_t value : {0U, 1U, 0x7ff80000U, 0xffffffffU, now - 1, now + 1}) {
                if (value == now) continue;
                ++tried;
                const AlignedBytes changed = with(file, place, value);
                if (kind_of(changed) != DamageKind{0}) {
                    ++refused;
                } else {
                    EXPECT_EQ(reached(changed, 0), entry_of(file, kSections[1]).count);
                }
            }
        }
    }
    EXPECT_GT(refused, tried * 3 / 10);
    EXPECT_LT(refused, tried * 9 / 10);
}

TEST(FindAdaptiveOctreeDamage, LooksOnlyAtTreesThatAreWantedWhole) {
    const AlignedBytes file = soup_file();
    AdaptiveOctreeNode node = node_of(file, 1);
    node.first = 0xffffffff;
    const AlignedBytes bad = with(file, node_place(file, 1), node);
    EXPECT_EQ(kind_of(bad), DamageKind::bad_order);
    EXPECT_EQ(kind_of(bad, {kSections[0], kSections[1], kSections[2]}), DamageKind::bad_order);
    EXPECT_EQ(kind_of(bad, {SectionId::triangles, kSections[1]}), DamageKind{0});
}

}  // namespace
}  // namespace cdprep::format
