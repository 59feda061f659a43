// SPDX-License-Identifier: MIT
#include "cdprep/cells/find_list_damage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "cdprep/format/octree.h"
#include "cdprep/format/sections.h"
#include "support/meshes.h"
#include "support/more_sections.h"
#include "support/reseal.h"

namespace cdprep::test {
namespace {

using format::Damage;
using format::DamageKind;
using format::find_section;
using format::kInnerNode;
using format::kSharedReference;
using format::OctreeGrid;
using format::OctreeNode;

AlignedBytes baked(const TestMesh& mesh, const build::OctreeOptions& options = {}) {
    return with_octree(bake_tiny(mesh.positions, mesh.triangles, {.double_precision = true}),
                       options);
}

template <class T>
std::vector<T> elements(const AlignedBytes& file, SectionId id) {
    const auto entry = find_section(file.span(), id).value();
    std::vector<T> all(entry.count);
    std::memcpy(all.data(), file.span().data() + entry.offset, all.size() * sizeof(T));
    return all;
}

/// The file with other elements of a section, which is safe to ask still.
template <class T>
AlignedBytes with(const AlignedBytes& file, SectionId id, const std::vector<T>& all) {
    AlignedBytes changed(file.span());
    const auto entry = find_section(file.span(), id).value();
    std::memcpy(changed.span().data() + entry.offset, all.data(), all.size() * sizeof(T));
    reseal(changed.span());
    EXPECT_FALSE(format::find_damage(std::as_const(changed).span()));
    return changed;
}

std::optional<Damage> check(const AlignedBytes& file) {
    const auto opened = Model::open(file.span());
    EXPECT_TRUE(opened);
    return find_list_damage(file.span(), opened.value());
}

TEST(FindListDamage, FindsNothingInWhatTheBuilderMakes) {
    EXPECT_FALSE(check(bake_tiny(unit_cube().positions, unit_cube().triangles)));
    for (const TestMesh& mesh :
         {TestMesh{}, unit_cube(), icosphere(3), coarse_grid_soup(4, 300, 4), fan(50),
          copies_of_one_triangle(30), random_soup(8, 500, 0.3),
          moved_by(icosphere(2), 1e-3, {1e6, -1e6, 1e6}), moved_by(icosphere(1), 0x1p-1000, {}),
          moved_by(icosphere(1), 0x1p999, {})}) {
        EXPECT_FALSE(check(baked(mesh)));
        EXPECT_FALSE(check(baked(mesh, {.level = 4, .boxes_in = build::Frame{}})));
        EXPECT_FALSE(check(baked(mesh, {.level = 6, .threshold = 20, .hashed = false})));
    }
}

// The second triangle of the first leaf of two is taken for the next in number, which that
// leaf does not touch: the one is missing, the other too many.
TEST(FindListDamage, SeesAReferenceToTheWrongTriangle) {
    const AlignedBytes file = baked(icosphere(2), {.level = 2});
    auto references = elements<std::uint32_t>(file, SectionId::octree_references);
    int seen = 0;
    for (const OctreeNode& node : elements<OctreeNode>(file, SectionId::octree_nodes)) {
        if ((node.count & kInnerNode) != 0) continue;
        const std::size_t last = node.first + node.count - 1;
        const std::uint32_t before = references[last];
        if ((before & ~kSharedReference) + 1 >= 320) continue;
        ++references[last];
        const auto damage = check(with(file, SectionId::octree_references, references));
        ASSERT_TRUE(damage);
        EXPECT_EQ(damage->kind, DamageKind::bad_fact);
        references[last] = before;
        ++seen;
    }
    EXPECT_GT(seen, 10);
}

TEST(FindListDamage, SeesAWrongMark) {
    const AlignedBytes file = baked(icosphere(2), {.level = 2});
    auto references = elements<std::uint32_t>(file, SectionId::octree_references);
    for (std::size_t i = 0; i < references.size(); i += 7) {
        references[i] ^= kSharedReference;
        const auto damage = check(with(file, SectionId::octree_references, references));
        ASSERT_TRUE(damage);
        EXPECT_EQ(damage->section, SectionId::octree_references);
        references[i] ^= kSharedReference;
    }
}

TEST(FindListDamage, SeesACubeThatWasMoved) {
    const AlignedBytes file = baked(icosphere(2));
    auto grid = elements<OctreeGrid>(file, SectionId::octree_grid);
    for (const double by : {-1e-3, 1e-3, 0.5, 3.0}) {
        grid[0].origin.y += by;
        EXPECT_TRUE(check(with(file, SectionId::octree_grid, grid))) << by;
        grid[0].origin.y -= by;
    }
}

// Two nodes of a slot in a chain of three: the last is linked from both, the middle one is
// lost. Numbers rise, slots are right and there are as many links as before.
TEST(FindListDamage, SeesANodeThatNoChainHolds) {
    const AlignedBytes file = baked(icosphere(3), {.level = 5, .threshold = 4});
    const std::uint32_t bits = elements<OctreeGrid>(file, SectionId::octree_grid)[0].slot_bits;
    const std::size_t slots = std::size_t{1} << bits;
    int seen = 0;
    for (const SectionId id : {SectionId::octree_modulus_table, SectionId::octree_mixed_table}) {
        auto table = elements<std::uint32_t>(file, id);
        for (std::size_t slot = 0; slot < slots; ++slot) {
            const std::uint32_t first = table[slot];
            const std::uint32_t second = first == 0 ? 0 : table[slots + first - 1];
            const std::uint32_t third = second == 0 ? 0 : table[slots + second - 1];
            if (third == 0) continue;
            table[slots + first - 1] = third;
            const auto damage = check(with(file, id, table));
            ASSERT_TRUE(damage);
            EXPECT_EQ(damage->section, id);
            table[slots + first - 1] = second;
            if (++seen % 10 == 0) break;
        }
    }
    EXPECT_GT(seen, 5);
}

AlignedBytes baked_adaptive(const TestMesh& mesh, const build::AdaptiveOctreeOptions& options) {
    return with_adaptive_octree(
        bake_tiny(mesh.positions, mesh.triangles, {.double_precision = true}), options);
}

TEST(FindListDamage, FindsNothingInAdaptiveOctrees) {
    for (const auto rule : {format::SplitRule::median, format::SplitRule::surface_area}) {
        for (const TestMesh& mesh :
             {TestMesh{}, unit_cube(), icosphere(3), coarse_grid_soup(4, 300, 4), fan(50),
              grid_sheet(9, 9), copies_of_one_triangle(30), random_soup(8, 500, 0.3),
              moved_by(icosphere(2), 1e-3, {1e6, -1e6, 1e6}), moved_by(icosphere(1), 0x1p-1000, {}),
              moved_by(icosphere(1), 0x1p999, {})}) {
            EXPECT_FALSE(check(baked_adaptive(mesh, {.rule = rule})));
            EXPECT_FALSE(check(baked_adaptive(mesh, {.rule = rule, .boxes_in = build::Frame{}})));
            EXPECT_FALSE(check(baked_adaptive(mesh, {.level = 6, .threshold = 20, .rule = rule})));
        }
    }
}

/// As of the octree, and wrong marks: `lasts` are the last references of leaves, of 320
/// triangles.
void sees_wrong_references(const AlignedBytes& file, SectionId id,
                           const std::vector<std::size_t>& lasts) {
    auto references = elements<std::uint32_t>(file, id);
    int seen = 0;
    for (const std::size_t last : lasts) {
        const std::uint32_t before = references[last];
        if ((before & ~kSharedReference) + 1 >= 320) continue;
        ++references[last];
        const auto damage = check(with(file, id, references));
        ASSERT_TRUE(damage);
        EXPECT_EQ(damage->kind, DamageKind::bad_fact);
        references[last] = before;
        ++seen;
    }
    EXPECT_GT(seen, 10);
    for (std::size_t i = 0; i < references.size(); i += 7) {
        references[i] ^= kSharedReference;
        const auto damage = check(with(file, id, references));
        ASSERT_TRUE(damage);
        EXPECT_EQ(damage->section, id);
        references[i] ^= kSharedReference;
    }
}

TEST(FindListDamage, SeesAReferenceToTheWrongTriangleInAnAdaptiveOctree) {
    const AlignedBytes file = baked_adaptive(icosphere(2), {.level = 2});
    std::vector<std::size_t> lasts;
    for (const auto& node :
         elements<format::AdaptiveOctreeNode>(file, SectionId::adaptive_octree_nodes)) {
        if ((node.count & kInnerNode) == 0) lasts.push_back(node.first + node.count - 1);
    }
    sees_wrong_references(file, SectionId::adaptive_octree_references, lasts);
}

// A split that is moved by a bit through a vertex; and a root that lost a corner.
TEST(FindListDamage, SeesASplitThatWasMoved) {
    const AlignedBytes file = baked_adaptive(icosphere(2), {.level = 2});
    auto nodes = elements<format::AdaptiveOctreeNode>(file, SectionId::adaptive_octree_nodes);
    nodes[0].split.x += 0.05;
    EXPECT_TRUE(check(with(file, SectionId::adaptive_octree_nodes, nodes)));
    auto tree = elements<format::AdaptiveOctree>(file, SectionId::adaptive_octree);
    tree[0].upper.y = std::nextafter(tree[0].upper.y, 0.0);
    const auto damage = check(with(file, SectionId::adaptive_octree, tree));
    ASSERT_TRUE(damage);
    EXPECT_EQ(damage->section, SectionId::adaptive_octree);
}

/// Every box of an octree's cells that is drawn in by a float's step, on one side of one axis,
/// is told: leaves' hold a part of a triangle that reaches there, others' a child's box.
void sees_small_boxes(const AlignedBytes& file, SectionId id) {
    auto boxes = elements<format::CellBox>(file, id);
    int seen = 0;
    for (std::size_t i = 0; i < boxes.size(); i += 3) {
        const std::size_t axis = i % 3;
        const format::CellBox whole = boxes[i];
        float& end = i % 2 == 0 ? boxes[i].lower[axis] : boxes[i].upper[axis];
        // Two steps: the box is rounded outwards by less than one.
        const float inside = i % 2 == 0 ? whole.upper[axis] : whole.lower[axis];
        end = std::nextafter(std::nextafter(end, inside), inside);
        if (boxes[i].lower[axis] < boxes[i].upper[axis]) {
            const auto damage = check(with(file, id, boxes));
            ASSERT_TRUE(damage) << i;
            EXPECT_EQ(damage->section, id);
            ++seen;
        }
        boxes[i] = whole;
    }
    EXPECT_GT(seen, 20);
}

TEST(FindListDamage, SeesABoxThatLeavesSomethingOut) {
    sees_small_boxes(baked(icosphere(2), {.level = 2, .boxes_in = build::Frame{}}),
                     SectionId::octree_boxes);
    sees_small_boxes(baked_adaptive(icosphere(2), {.level = 2, .boxes_in = build::Frame{}}),
                     SectionId::adaptive_octree_boxes);
}

AlignedBytes baked_cones(const TestMesh& mesh, const build::TetraTreeOptions& options = {}) {
    return with_tetra_tree(bake_tiny(mesh.positions, mesh.triangles, {.double_precision = true}),
                           options);
}

TEST(FindListDamage, FindsNothingInTetraTrees) {
    for (const TestMesh& mesh :
         {TestMesh{}, unit_cube(), icosphere(3), coarse_grid_soup(4, 300, 4), fan(50),
          torus(2, 0.5, 24, 12), copies_of_one_triangle(30), random_soup(8, 500, 0.3),
          moved_by(icosphere(2), 1e-3, {1e6, -1e6, 1e6}), moved_by(icosphere(1), 0x1p-1000, {}),
          moved_by(icosphere(1), 0x1p999, {})}) {
        EXPECT_FALSE(check(baked_cones(mesh)));
        EXPECT_FALSE(check(baked_cones(mesh, {.level = 5, .threshold = 20})));
        EXPECT_FALSE(check(baked_cones(
            mesh, {.level = 4, .threshold = 10, .bounding = format::TetraBounding::boxes})));
    }
}

TEST(FindListDamage, SeesAReferenceToTheWrongTriangleInATetraTree) {
    const AlignedBytes file = baked_cones(icosphere(2), {.level = 2});
    std::vector<std::size_t> lasts;
    for (const auto& node : elements<format::TetraNode>(file, SectionId::tetra_nodes)) {
        const bool is_leaf = (node.flags & format::tetra_inner) == 0;
        if (is_leaf) lasts.push_back(node.first + node.count - 1);
    }
    sees_wrong_references(file, SectionId::tetra_references, lasts);
}

// Of every node: a box that lost a side, of which what stands twice says the same.
TEST(FindListDamage, SeesABoxThatDoesNotHoldItsTriangles) {
    const AlignedBytes file = baked_cones(
        icosphere(3), {.level = 2, .threshold = 4, .bounding = format::TetraBounding::boxes});
    const std::size_t nodes = elements<format::TetraNode>(file, SectionId::tetra_nodes).size();
    auto boxes = elements<format::BvhNode>(file, SectionId::tetra_boxes);
    auto oriented = elements<format::OrientedNode>(file, SectionId::tetra_oriented);
    const auto expect_seen = [&](const AlignedBytes& changed, SectionId id, std::size_t node) {
        const auto damage = check(changed);
        ASSERT_TRUE(damage) << node;
        EXPECT_EQ(damage->kind, DamageKind::bad_box);
        EXPECT_EQ(damage->section, id);
    };
    for (std::size_t i = 0; i < nodes; ++i) {
        const auto set = [&](auto& all, auto member, auto value) {
            member(all[i / 4], i % 4) = value;
            if (i >= 4) member(all[i / 4 - 1], i % 4 + 4) = value;
        };
        const auto upper = [&](format::BvhNode& node, std::size_t lane) -> float& {
            return node.upper[i % 3][lane];
        };
        const float before = upper(boxes[i / 4], i % 4);
        set(boxes, upper, boxes[i / 4].lower[i % 3][i % 4]);
        expect_seen(with(file, SectionId::tetra_boxes, boxes), SectionId::tetra_boxes, i);
        set(boxes, upper, before);
        const auto half = [&](format::OrientedNode& node, std::size_t lane) -> float& {
            return node.half[i % 3][lane];
        };
        const float half_before = half(oriented[i / 4], i % 4);
        set(oriented, half, 0.0F);
        expect_seen(with(file, SectionId::tetra_oriented, oriented), SectionId::tetra_oriented, i);
        set(oriented, half, half_before);
    }
}

/// Of some nodes of a tetra-tree, each by a bit of the cone's thickness and a few floats.
void sees_wrong_radii(const AlignedBytes& file) {
    constexpr float kPart = 0x1p-16F;
    auto nodes = elements<format::TetraNode>(file, SectionId::tetra_nodes);
    for (std::size_t i = 0; i < nodes.size(); i += 1 + nodes.size() / 16) {
        const format::TetraNode whole = nodes[i];
        const auto is_seen = [&] {
            const auto damage = check(with(file, SectionId::tetra_nodes, nodes));
            nodes[i] = whole;
            return damage && damage->section == SectionId::tetra_nodes &&
                   damage->kind == DamageKind::bad_box;
        };
        const float thickness = whole.radius_max - whole.radius_min;
        nodes[i].radius_max -= kPart * thickness + whole.radius_max * 0x1p-22F;
        EXPECT_TRUE(is_seen()) << i;
        nodes[i].radius_min += kPart * thickness + whole.radius_min * 0x1p-22F;
        EXPECT_TRUE(is_seen()) << i;
    }
}

TEST(FindListDamage, SeesARadiusThatLeavesSomethingOut) {
    for (const int exponent : {0, -1000, 900}) {
        const TestMesh mesh = moved_by(icosphere(2), std::ldexp(1.0, exponent), {});
        sees_wrong_radii(baked_cones(mesh, {.level = 1}));
        sees_wrong_radii(baked_cones(mesh, {.level = 3}));
    }
    const TestMesh large = moved_by(unit_cube(), 2, {-0.7, -0.8, -0.9});
    sees_wrong_radii(baked_cones(large, {.level = 3}));
    sees_wrong_radii(baked_cones(torus(2, 0.5, 24, 12), {.level = 2}));
}

// The cones of another centre are other cones; that of a fan holds its middle.
TEST(FindListDamage, SeesACentreThatWasMoved) {
    for (const TestMesh& mesh : {icosphere(2), fan(50)}) {
        const AlignedBytes file = baked_cones(mesh);
        auto tree = elements<format::TetraTree>(file, SectionId::tetra_tree);
        tree[0].centre.z += 0.125;
        EXPECT_TRUE(check(with(file, SectionId::tetra_tree, tree)));
    }
}

}  // namespace
}  // namespace cdprep::test
