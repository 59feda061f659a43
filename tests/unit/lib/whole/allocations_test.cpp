// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <memory>
#include <new>

#include "cdprep/advanced/convex_penetration.h"
#include "cdprep/advanced/refit_bvh.h"
#include "cdprep/cells.h"
#include "cdprep/cells/overlap_through.h"
#include "cdprep/contacts.h"
#include "cdprep/pairs.h"
#include "cdprep/parallel.h"
#include "cdprep/points.h"
#include "cdprep/self.h"
#include "support/every_structure.h"
#include "support/more_sections.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"
#include "support/small_hull.h"
#include "support/tiny_pieces.h"

#include "cdprep/advanced/pair_front.h"
#include "cells/cell_storage.h"

namespace {
std::atomic<std::size_t> allocations = 0;

void* counted(std::size_t size) {
    ++allocations;
    if (void* memory = std::malloc(size)) return memory;
    throw std::bad_alloc();
}
}  // namespace

// Counts every allocation of this program.
void* operator new(std::size_t size) {
    return counted(size);
}
void* operator new[](std::size_t size) {
    return counted(size);
}
void* operator new(std::size_t size, const std::nothrow_t& /*unused*/) noexcept {
    ++allocations;
    return std::malloc(size);
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete[](void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t /*unused*/) noexcept {
    std::free(memory);
}
void operator delete[](void* memory, std::size_t /*unused*/) noexcept {
    std::free(memory);
}
void operator delete(void* memory, const std::nothrow_t& /*unused*/) noexcept {
    std::free(memory);
}

namespace cdprep::test {
namespace {

/// Every question about a shape that can be asked about any.
template <class Shape>
void ask_touching(const Model& model, const Shape& shape, Workspace& workspace,
                  std::span<std::uint32_t> triangles) {
    const auto visit = [](std::uint32_t) { return true; };
    const Pose turn = Pose::from_quaternion(5, 1, 2, 3, {0.1, 0, 0}).value();
    for (const ShapeOptions& options : {ShapeOptions{}, ShapeOptions{turn, Degenerate::skip}}) {
        static_cast<void>(touches(model, shape, workspace, options));
        static_cast<void>(touching_triangles(model, shape, workspace, triangles, options));
        static_cast<void>(touching_triangles(model, shape, workspace, triangles.first(5), options));
        visit_touching_triangles(model, shape, workspace, visit, options);
    }
}

/// With an octree, one with split points of its own, and a tetra-tree.
OpenModel with_trees(const AlignedBytes& file) {
    return open_tiny(
        with_tetra_tree(with_adaptive_octree(with_octree(file, {.level = 3}), {.level = 3}),
                        {.level = 3, .bounding = format::TetraBounding::boxes}));
}

// Through each structure, with room for next to no answers too.
TEST(Allocations, NoStructureAllocates) {
    const TestMesh sphere = icosphere(3), ring = torus(1, 0.25, 24, 12);
    const OpenModel a = with_trees(bake_tiny(sphere.positions, sphere.triangles));
    const OpenModel b = with_trees(bake_tiny(ring.positions, ring.triangles));
    Workspace workspace(cells());
    std::vector<TrianglePair> pairs(10'000);
    const Placement placement = Placement::b_moves(Pose());
    std::size_t found = 0;
    const std::size_t before = allocations;
    for (const std::size_t buckets : {TestedPairs::kBuckets, std::size_t{1}}) {
        cells_of(workspace.storage()).tested_pairs.limit(buckets);
        for (const Structure structure :
             {Structure::octree, Structure::adaptive_octree, Structure::tetra_tree}) {
            for (const LeafTest test : {LeafTest::guigue_devillers, LeafTest::feito_torres}) {
                const StructureOptions through = {structure, test};
                found += overlaps_through({a.model, b.model, placement}, through, workspace, pairs);
                found += any_overlap_through({a.model, b.model, placement}, through, workspace);
            }
        }
    }
    EXPECT_EQ(allocations, before);
    EXPECT_GT(found, 1000u);
}

// Every question, near, far, touching and nested; what they answer is for other tests.
TEST(Allocations, NoQuestionAllocates) {
    const OpenModel sphere = open_tiny(icosphere(4));
    const OpenModel ring = open_tiny(torus(1, 0.25, 40, 20), {.double_precision = true});
    const Model& a = sphere.model;
    const Model& b = ring.model;
    Workspace workspace(cells());
    PairCache cache;
    std::vector<TrianglePair> pairs(100'000);
    std::vector<std::uint32_t> triangles(a.triangle_count() + b.triangle_count());
    std::vector<RayHit> ray_hit_list(100);
    const auto visit_ray = [](const RayHit&) { return true; };
    std::vector<std::uint64_t> bits_a(a.triangle_count() / 64 + 1);
    std::vector<std::uint64_t> bits_b(b.triangle_count() / 64 + 1);
    const auto visit = [](const TrianglePair&) { return true; };
    const auto visit_segment = [](const Crossing&) { return true; };
    std::vector<Placement> placements = {Placement::b_moves(Pose())};
    std::mt19937 random(1);
    for (const double reach : {0.1, 1.0, 3.0, 100.0}) {
        const Pose p = random_pose(random, reach), q = random_pose(random, reach);
        placements.push_back(Placement::b_moves(p));
        placements.push_back(Placement::a_moves(p));
        placements.push_back(Placement::relative(p, q));
        placements.push_back(Placement::world(p, q));
    }
    std::vector<Workspace> workspaces(3);
    const auto run = [](std::size_t count, Task task) {
        for (std::size_t i = 0; i < count; ++i) task(i);
    };
    std::vector<Pair> jobs;
    for (const Placement& placement : placements) jobs.emplace_back(a, b, placement);
    jobs.front().cache = &cache;
    std::vector<Collision> collisions(jobs.size());
    std::vector<std::optional<Distance>> distances(jobs.size());
    std::vector<OverlapList> lists(jobs.size());
    std::vector<OverlapMarks> marked(jobs.size());
    std::vector<std::size_t> counts(jobs.size());
    const auto near = std::make_unique<bool[]>(jobs.size());
    lists.front().room = pairs;
    marked.front() = {bits_a, bits_b};
    std::size_t hits = 0, misses = 0;
    const std::size_t before = allocations;
    for (const Placement& placement : placements) {
        const bool hit =
            collide({a, b, placement, {.body = Body::solid}}, workspace).hit == Answer::yes;
        (hit ? hits : misses) += 1;
        static_cast<void>(overlaps({a, b, placement}, workspace, pairs));
        static_cast<void>(overlaps({a, b, placement}, workspace, std::span(pairs).first(10)));
        visit_overlaps({a, b, placement}, workspace, visit);
        visit_crossings({a, b, placement}, workspace, visit_segment);
        for (const double tolerance : {0.0, 0.05, 0.2}) {
            static_cast<void>(pairs_within({a, b, placement}, tolerance, workspace, pairs));
            static_cast<void>(pairs_within({a, b, placement}, tolerance, workspace, {}));
            visit_pairs_within({a, b, placement, {.degenerate = Degenerate::skip}}, tolerance,
                               workspace, visit);
        }
        mark_overlaps({a, b, placement}, workspace, bits_a, bits_b);
        static_cast<void>(self_overlaps(a, workspace, std::span(pairs).first(10)));
        visit_self_overlaps(b, workspace, visit);
        static_cast<void>(distance({a, b, placement}, workspace));
        static_cast<void>(
            distance({a, b, placement, {}, &cache}, workspace, {.relative_error = 0.1}));
        static_cast<void>(within({a, b, placement, {}, &cache}, 0.5, workspace));
        static_cast<void>(collide({a, b, placement, {}, &cache}, workspace));
        static_cast<void>(split_overlaps({a, b, placement}, workspaces, run, pairs));
        static_cast<void>(
            split_overlaps({a, b, placement}, workspaces, run, std::span(pairs).first(10)));
        static_cast<void>(containment({a, b, placement}, workspace));
    }
    collide_many(jobs, workspaces, run, collisions);
    distance_many(jobs, workspaces, run, distances);
    within_many(jobs, 0.5, workspaces, run, std::span(near.get(), jobs.size()));
    count_overlaps_many(jobs, workspaces, run, counts);
    overlaps_many(jobs, workspaces, run, lists);
    mark_overlaps_many(jobs, workspaces, run, marked);
    for (const double x : {0.0, 0.5, 1.0, 7.0}) {
        static_cast<void>(points_inside(a, {x, 0.1, 0.2}, workspace));
        static_cast<void>(closest_point(a, {x, 0.1, 0.2}, workspace));
        const Ray ray = {{x, 0.1, 5}, {0.1, 0, -1}};
        static_cast<void>(cast_ray(b, ray, workspace));
        static_cast<void>(ray_hits(b, ray, workspace));
        static_cast<void>(all_ray_hits(b, ray, workspace, ray_hit_list));
        static_cast<void>(all_ray_hits(b, ray, workspace, std::span(ray_hit_list).first(1)));
        visit_ray_hits(b, ray, workspace, visit_ray);
        for (const Model* model : {&a, &b}) {
            const Capsule capsule = {{x, 0, 0}, {x, 0.5, 0}, 0.25};
            const TriangleShape triangle = {{{{x, 0, 0}, {x, 0.5, 0}, {x, 0, 2}}}};
            ask_touching(*model, Box{{x, 0, -1}, {x + 1, 0.5, 1}}, workspace, triangles);
            ask_touching(*model, Sphere{{x, 0, 0}, 1}, workspace, triangles);  // tangent at 0
            ask_touching(*model, capsule, workspace, triangles);
            ask_touching(*model, triangle, workspace, triangles);
            static_cast<void>(shape_distance(*model, capsule, workspace));
            static_cast<void>(shape_distance(*model, triangle, workspace));
        }
    }
    EXPECT_EQ(allocations, before);
    EXPECT_GT(hits, 2u);
    EXPECT_GT(misses, 2u);
}

// By hand: of these points two are in the tube.
TEST(Allocations, NoStructureAllocatesToTellWhatIsInside) {
    const OpenModel ring = open_with_every_structure(torus(1, 0.25, 40, 20), {.level = 5});
    Workspace workspace(cells());
    int inside = 0;
    const std::size_t before = allocations;
    for (const Structure structure : kStructures) {
        for (const double x : {0.0, 0.5, 1.0, 1.25, 7.0}) {
            const Inclusion found = points_inside(ring.model, {x, 0, 0}, workspace, structure);
            inside += found.answer == Answer::yes ? 1 : 0;
        }
    }
    EXPECT_EQ(allocations, before);
    EXPECT_EQ(inside, 2 * std::ssize(kStructures));
}

TEST(Allocations, NoQuestionThroughAHashedOctreeAllocates) {
    const TestMesh sphere = icosphere(3), ring = torus(1, 0.25, 24, 12);
    const OpenModel a = open_tiny(with_octree(bake_tiny(sphere.positions, sphere.triangles)));
    const OpenModel b = open_tiny(with_octree(bake_tiny(ring.positions, ring.triangles)));
    Workspace workspace(cells());
    std::vector<TrianglePair> pairs(10'000);
    std::mt19937 random(2);
    std::vector<Placement> placements;
    for (const double reach : {0.5, 1.5, 3.0, 0.5, 1.5, 3.0}) {
        placements.push_back(Placement::b_moves(random_pose(random, reach)));
        placements.push_back(Placement::a_moves(random_pose(random, reach)));
    }
    std::size_t hits = 0, misses = 0;
    const std::size_t before = allocations;
    for (const Placement& placement : placements) {
        for (const LeafTest test : {LeafTest::guigue_devillers, LeafTest::feito_torres}) {
            const StructureOptions through = {.structure = Structure::hashed_octree,
                                              .leaf_test = test};
            const bool hit = any_overlap_through({a.model, b.model, placement}, through, workspace);
            (hit ? hits : misses) += 1;
            static_cast<void>(
                overlaps_through({a.model, b.model, placement}, through, workspace, pairs));
        }
    }
    EXPECT_EQ(allocations, before);
    EXPECT_GT(hits, 4U);
    EXPECT_GT(misses, 4U);
}

/// Near, far, touching and nested.
std::vector<Placement> some_placements() {
    std::vector<Placement> placements = {Placement::b_moves(Pose())};
    std::mt19937 random(4);
    for (const double reach : {0.1, 1.0, 1.5, 3.0, 100.0}) {
        const Pose p = random_pose(random, reach), q = random_pose(random, reach);
        placements.push_back(Placement::b_moves(p));
        placements.push_back(Placement::world(p, q));
    }
    return placements;
}

TEST(Allocations, NoQuestionThroughPiecesAllocates) {
    const TestMesh sphere = icosphere(3), ring = torus(1, 0.25, 24, 12);
    const OpenModel a = open_tiny(with_piece_tree(bake_tiny(sphere.positions, sphere.triangles)));
    const OpenModel b = open_tiny(
        with_piece_tree(bake_tiny(ring.positions, ring.triangles, {.double_precision = true})));
    const StructureOptions through = {.structure = Structure::pieces};
    const std::vector<Placement> placements = some_placements();
    Workspace workspace(cells());
    PieceCache cache;
    std::vector<TrianglePair> pairs(10'000);
    std::size_t hits = 0, misses = 0;
    const std::size_t before = allocations;
    for (const Placement& placement : placements) {
        for (PieceCache* from : {static_cast<PieceCache*>(nullptr), &cache}) {
            const bool hit = any_overlap_through(
                {a.model, b.model, placement, {}, from == nullptr ? nullptr : &from->pair}, through,
                workspace);
            (hit ? hits : misses) += 1;
            static_cast<void>(distance({a.model,
                                        b.model,
                                        placement,
                                        {.through = through.structure},
                                        from == nullptr ? nullptr : &from->pair,
                                        from == nullptr ? nullptr : &from->front},
                                       workspace));
            static_cast<void>(distance({a.model,
                                        b.model,
                                        placement,
                                        {.through = through.structure},
                                        from == nullptr ? nullptr : &from->pair,
                                        from == nullptr ? nullptr : &from->front},
                                       workspace, {.relative_error = 0.1}));
            static_cast<void>(within({a.model,
                                      b.model,
                                      placement,
                                      {.through = through.structure},
                                      from == nullptr ? nullptr : &from->pair,
                                      from == nullptr ? nullptr : &from->front},
                                     0.5, workspace));
        }
        static_cast<void>(
            overlaps_through({a.model, b.model, placement}, through, workspace, pairs));
        static_cast<void>(overlaps_through({a.model, b.model, placement}, through, workspace,
                                           std::span(pairs).first(10)));
    }
    EXPECT_EQ(allocations, before);
    EXPECT_GT(hits, 2U);
    EXPECT_GT(misses, 2U);
}

// More pairs of pieces than are gathered at once, single triangles and all of a ball.
TEST(Allocations, NoContactAllocates) {
    const TestMesh ball = icosphere(1), ring = torus(1, 0.25, 24, 12);
    const OpenModel a =
        open_tiny(with_contacts(with_one_piece(bake_tiny(ball.positions, ball.triangles))));
    const OpenModel b =
        open_tiny(with_contacts(with_pieces(bake_tiny(ring.positions, ring.triangles))));
    const std::vector<Placement> placements = some_placements();
    Workspace workspace(cells());
    std::vector<Contact> room(20);
    std::size_t found = 0, overlapping = 0;
    std::uint64_t most = 0;
    const auto visit = [&](const Contact& contact) {
        ++found;
        overlapping += contact.flags & contact_overlap;
        return true;
    };
    const std::size_t before = allocations;
    for (const Placement& placement : placements) {
        for (const Manifold manifold : {Manifold::none, Manifold::four}) {
            for (const OpenModel* other : {&a, &b}) {
                const Pair pair = {other->model, b.model, placement};
                const ContactOptions all = {.tolerance = 0.25, .manifold = manifold};
                most = std::max(most, contacts(pair, workspace, room, all).found);
                ContactOptions some = all;
                some.most = 12;
                some.cluster_angle = 0.25;
                EXPECT_LE(contacts(pair, workspace, room, some).count, 12U);
                visit_contacts({b.model, other->model, placement}, workspace, visit,
                               {.tolerance = 0.25, .manifold = manifold});
            }
        }
    }
    EXPECT_EQ(allocations, before);
    EXPECT_GT(most, workspace.storage().near_pieces.size());
    EXPECT_GT(overlapping, found / 20);
    EXPECT_LT(overlapping, found * 19 / 20);
}

// From a cache and without, in every state of nearness.
TEST(Allocations, NoClosestFeatureAllocates) {
    const TestMesh ball = icosphere(1);
    const OpenModel open =
        open_tiny(with_contacts(with_one_piece(bake_tiny(ball.positions, ball.triangles))));
    const Model& model = open.model;
    ConvexPoints points;
    points.count = static_cast<std::uint32_t>(model.pieces().vertices.size());
    points.corners = model.pieces().vertices;
    points.floats = model.mesh().positions_f32;
    const FeatureHull hull = {points, model.pieces().facets, model.pieces().adjacency};
    FeatureCache cache;
    int apart = 0;
    const std::size_t before = allocations;
    for (int i = 0; i < 40; ++i) {
        const Pose pose = Pose::from_quaternion(5, i % 3, 0.01 * i, 0, {0.1 * i, 0.5, 0}).value();
        const Placement placement = Placement::b_moves(pose);
        apart += closest_features(hull, hull, placement) ? 1 : 0;
        static_cast<void>(closest_features(hull, hull, placement, &cache));
    }
    EXPECT_EQ(allocations, before);
    EXPECT_GT(apart, 12);
    EXPECT_LT(apart, 28);
}

// Apart, touching and deep, climbing and not: integers and the polytope are asked too.
TEST(Allocations, NoQuestionAboutHullsAllocates) {
    const SmallHull box(box_corners(1, 1, 1)), plain(box_corners(1, 2, 1), Edges::none);
    const ConvexPoints a = box.view(), b = plain.view();
    ConvexCache cache;
    QueryCounts counts;
    const std::size_t before = allocations;
    for (int i = 0; i < 30; ++i) {
        const Pose pose = Pose::from_quaternion(5, i % 3, 0, 0, {0.1 * i, 0.5, 0}).value();
        const Placement placement = Placement::b_moves(pose);
        static_cast<void>(convex_collide(a, b, placement, &cache, &counts));
        static_cast<void>(convex_distance(a, b, placement, {}, &cache, &counts));
        static_cast<void>(convex_within(a, b, placement, 0.25, &cache, &counts));
        static_cast<void>(convex_penetration(a, b, placement, {}, &cache, &counts));
    }
    EXPECT_EQ(allocations, before);
    EXPECT_GT(counts.hulls_by_exact, 0U);
    EXPECT_GT(counts.hull_steps, 0U);
}

// Frame, leaves and boxes all move: every array is written anew, none is made.
TEST(Allocations, RefittingDoesNotAllocate) {
    const TestMesh sphere = icosphere(4);
    const TestMesh larger = moved_by(sphere, 3, {1, 2, 3});
    const build::BvhOptions options = {.bounds = build::BvhBounds::aligned};
    build::Bvh bvh = build_bvh(sphere.positions, sphere.triangles, options);
    const std::size_t before = allocations;
    refit_bvh(bvh, larger.positions, larger.triangles, options);
    EXPECT_EQ(allocations, before);
}

}  // namespace
}  // namespace cdprep::test
