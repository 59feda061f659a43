// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>

#include "cdprep/cells.h"
#include "cdprep/cells/overlap_through.h"
#include "cdprep/format/sections.h"
#include "cdprep/pairs.h"
#include "cdprep/points.h"
#include "support/meshes.h"
#include "support/more_sections.h"
#include "support/random_pose.h"
#include "support/reseal.h"
#include "support/tiny_baker.h"

namespace cdprep::test {
namespace {

/// Overwrites every float of a section of boxes with one of a few absurd numbers.
void spoil(AlignedBytes& file, SectionId id, std::mt19937& random) {
    constexpr std::array<float, 8> kAbsurd = {3e38F, -3e38F, 0, -1, 1, 1e-38F, -1e-40F, 2};
    const auto entry = format::find_section(file.span(), id).value();
    for (std::uint64_t at = 0; at < entry.count * entry.element_size; at += sizeof(float)) {
        if (random() % 2 == 0) continue;
        const float x = kAbsurd[random() % kAbsurd.size()];
        std::memcpy(file.span().data() + entry.offset + at, &x, sizeof x);
    }
}

/// The same for what opening lets through of aligned boxes: numbers in the frame, in order. Unused
/// boxes become as large as used ones.
void spoil_boxes(AlignedBytes& file, std::mt19937& random) {
    constexpr std::array<float, 7> kAbsurd = {0, -1, 1, 1e-38F, -1e-40F, 0.5F, -0.5F};
    const auto entry = format::find_section(file.span(), SectionId::bvh_nodes).value();
    for (std::uint64_t i = 0; i < entry.count; ++i) {
        std::byte* const at = file.span().data() + entry.offset + i * sizeof(format::BvhNode);
        format::BvhNode node;
        std::memcpy(&node, at, sizeof node);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::size_t box = 0; box < format::kBvhWidth; ++box) {
                if (random() % 2 == 0) continue;
                const float x = kAbsurd[random() % kAbsurd.size()];
                const float y = kAbsurd[random() % kAbsurd.size()];
                node.lower[axis][box] = std::min(x, y);
                node.upper[axis][box] = std::max(x, y);
            }
        }
        std::memcpy(at, &node, sizeof node);
    }
}

void ask_about_shapes(const Model& m, const Pose& turn, Workspace& workspace) {
    std::array<std::uint32_t, 100> numbers{};
    std::array<RayHit, 10> hits{};
    const Capsule capsule = {{0, 0, 0.5}, {0.1, 0, -1}, 0.1};
    const TriangleShape triangle = {{{{0, 0, 0.5}, {0.1, 0, -1}, {1, 0, 0}}}};
    const auto ask = [&](const auto& shape) {
        for (const ShapeOptions& options : {ShapeOptions{}, ShapeOptions{turn, Degenerate::keep}}) {
            static_cast<void>(touches(m, shape, workspace, options));
            EXPECT_LE(touching_triangles(m, shape, workspace, numbers, options),
                      m.triangle_count());
        }
    };
    ask(Box{{-0.5, 0, 0}, {0.5, 1, 1}});
    ask(Sphere{{0, 0, 0}, 0.5});
    ask(capsule);
    ask(triangle);
    static_cast<void>(shape_distance(m, capsule, workspace));
    static_cast<void>(shape_distance(m, triangle, workspace, {turn}));
    EXPECT_LE(all_ray_hits(m, {{0, 0, 5}, {0.1, 0, -1}}, workspace, hits), m.triangle_count());
    static_cast<void>(ray_hits(m, {{0, 0, 5}, {0.1, 0, 1}}, workspace));
}

/// The same for what opening lets through of swept spheres: centres, and sizes that are
/// not negative, of sides that the kind has.
void spoil_swept(AlignedBytes& file, std::mt19937& random) {
    constexpr std::array<float, 6> kAbsurd = {3e38F, 0, 1, 1e-38F, 1e-40F, 2};
    const auto entry = format::find_section(file.span(), SectionId::swept_nodes).value();
    const auto kind =
        static_cast<std::size_t>(format::swept_kind(format::read_header(file.span()).flags));
    for (std::uint64_t at = 0; at < entry.count * entry.element_size; at += sizeof(float)) {
        const std::uint64_t row = at % entry.element_size / (sizeof(float) * format::kBvhWidth);
        const bool is_size = row == 3 || (row == 7 && kind > 0) || (row == 11 && kind > 1);
        if (random() % 2 == 0 || (row > 2 && !is_size)) continue;
        const float sign = row < 3 && random() % 2 == 0 ? -1 : 1;
        const float x = sign * kAbsurd[random() % kAbsurd.size()];
        std::memcpy(file.span().data() + entry.offset + at, &x, sizeof x);
    }
}

// A file whose checksums are right may still hold boxes that make no sense: the
// answers are then worth nothing, but every question ends and stays in the file.
TEST(AbsurdBoxes, EveryQuestionEnds) {
    std::mt19937 random(1);
    for (int round = 0; round < 200; ++round) {
        const TestMesh mesh = random_soup(random(), 150, 0.3);
        const auto bounds = static_cast<build::BvhBounds>(1 + round % 5);
        AlignedBytes file = bake_tiny(mesh.positions, mesh.triangles, {.bounds = bounds});
        if (round % 3 != 0) spoil_boxes(file, random);
        const auto has = [&](SectionId id) { return format::find_section(file.span(), id); };
        if (round % 3 != 1 && has(SectionId::oriented_nodes)) {
            spoil(file, SectionId::oriented_nodes, random);
        }
        if (round % 3 != 1 && has(SectionId::swept_nodes)) spoil_swept(file, random);
        reseal(file.span());
        const auto model = Model::open(file.span());
        ASSERT_TRUE(model) << model.error().message;
        Workspace workspace(cells());
        std::vector<TrianglePair> pairs(100);
        const Model& m = model.value();
        for (const Placement& placement :
             {Placement::b_moves(Pose()), Placement::b_moves(random_pose(random, 1)),
              Placement::world(random_pose(random, 9), Pose())}) {
            const std::size_t all = m.triangle_count() * std::size_t{m.triangle_count()};
            EXPECT_LE(overlaps({m, m, placement}, workspace, pairs), all);
            static_cast<void>(collide({m, m, placement, {.body = Body::solid}}, workspace));
            static_cast<void>(distance({m, m, placement}, workspace));
            static_cast<void>(within({m, m, placement}, 0.5, workspace));
            EXPECT_LE(pairs_within({m, m, placement}, 0.125, workspace, pairs), all);
            const auto every = [](const Crossing&) { return true; };
            EXPECT_TRUE(visit_crossings({m, m, placement}, workspace, every));
        }
        static_cast<void>(cast_ray(m, {{0, 0, 5}, {0.1, 0, -1}}, workspace));
        static_cast<void>(closest_point(m, {0, 0, 5}, workspace));
        static_cast<void>(points_inside(m, {0, 0, 0}, workspace));
        ask_about_shapes(m, random_pose(random, 1), workspace);
    }
}

// The same through hashed octrees, whose boxes are the hierarchy's.
TEST(AbsurdBoxes, EveryQuestionThroughAHashedOctreeEnds) {
    std::mt19937 random(2);
    for (int round = 0; round < 100; ++round) {
        const TestMesh mesh = random_soup(random(), 300, 0.3);
        const auto bounds = static_cast<build::BvhBounds>(round % 2);
        AlignedBytes file =
            with_octree(bake_tiny(mesh.positions, mesh.triangles, {.bounds = bounds}),
                        {.level = 5, .threshold = 4});
        spoil_boxes(file, random);
        if (bounds == build::BvhBounds::oriented) spoil(file, SectionId::oriented_nodes, random);
        reseal(file.span());
        const auto model = Model::open(file.span());
        ASSERT_TRUE(model) << model.error().message;
        const Model& m = model.value();
        Workspace workspace(cells());
        for (const Placement& placement :
             {Placement::b_moves(Pose()), Placement::world(random_pose(random, 1), Pose())}) {
            for (const CellSearch search : {CellSearch::sorted, CellSearch::mixed}) {
                const StructureOptions through = {.structure = Structure::hashed_octree,
                                                  .search = search};
                EXPECT_LE(overlaps_through({m, m, placement}, through, workspace, {}),
                          m.triangle_count() * std::size_t{m.triangle_count()});
                static_cast<void>(any_overlap_through({m, m, placement}, through, workspace));
            }
        }
    }
}

}  // namespace
}  // namespace cdprep::test
