// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <vector>

#include "support/answer_bytes.h"
#include "support/run_threads.h"

#include "cdprep/cdprep.hpp"
#include "cdprep/cells/level_of_detail.h"
#include "cdprep/cells/overlap_through.h"

// Every query of the C++ API in one form, for tests that run all of them.

namespace cdprep::test {

/// Two models, of which B is moved, and the workspace for a query.
struct Scene {
    const Model& a;
    const Model& b;
    double x;  ///< the distance by which B is moved along x
    Workspace& workspace;

    [[nodiscard]] Pair pair(const PairOptions& options = {}) const {
        const auto moved = Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, x, 0, 0});
        return {a, b, Placement::b_moves(*moved), options};
    }
};

/// A query, and the queries that both models must serve. The name is that of the function,
/// followed by a variant.
struct Question {
    const char* name;
    Ask needs;
    AnswerBytes (*ask)(const Scene& scene);
};

namespace in_cpp {

constexpr Ray kRay = {{-3, 0.5, 0.375}, {1, 0, 0}};
constexpr Sphere kBall = {{1.25, 0.5, 0.5}, 0.5};
constexpr std::size_t kRoom = 512;

template <class Answer>
AnswerBytes told(const Answer& answer) {
    AnswerBytes bytes;
    bytes.add(answer);
    return bytes;
}

/// Runs a query for a list; returns its count and its items.
template <class Item, class Lister>
AnswerBytes told_list(Lister&& list) {
    std::vector<Item> room(kRoom);
    const std::size_t count = list(std::span<Item>(room));
    AnswerBytes bytes;
    bytes.add(room, count);
    return bytes;
}

/// Returns the number of visited items. Their order is not part of the result.
template <class Item, class Visit>
AnswerBytes told_count(Visit&& visit) {
    std::size_t count = 0;
    const auto take = [&](const Item&) { return ++count > 0; };
    AnswerBytes bytes;
    bytes.add(visit(take));
    bytes.add(count);
    return bytes;
}

/// Runs a batch of one pair with two workers.
template <class Answer, class Batch>
AnswerBytes told_batch(const Scene& scene, Batch&& batch) {
    std::vector<Workspace> workspaces(2);
    const std::array<Pair, 1> pairs = {scene.pair()};
    std::array<Answer, 1> answer{};
    batch(std::span<const Pair>(pairs), std::span<Workspace>(workspaces),
          std::span<Answer>(answer));
    return told(answer[0]);
}

template <Body kBody, Structure kThrough>
AnswerBytes collide_by(const Scene& scene) {
    return told(collide(scene.pair({.body = kBody, .through = kThrough}), scene.workspace));
}

template <Structure kThrough>
AnswerBytes overlaps_by(const Scene& scene) {
    return told_list<TrianglePair>([&](std::span<TrianglePair> room) {
        return overlaps(scene.pair({.through = kThrough}), scene.workspace, room);
    });
}

template <Body kBody, Structure kThrough>
AnswerBytes distance_by(const Scene& scene) {
    return told(distance(scene.pair({.body = kBody, .through = kThrough}), scene.workspace));
}

/// B comes from 4 farther, and stops where it would be.
template <Body kBody>
AnswerBytes time_of_impact_of(const Scene& scene) {
    const Pose end = scene.pair().placement.pose_b();
    const auto start = Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, scene.x + 4, 0, 0});
    const Motion motion = Motion::between(*start, end).value();
    return told(time_of_impact({scene.a, scene.b, {}, motion, kBody}, scene.workspace));
}

template <Structure kThrough>
AnswerBytes inside_by(const Scene& scene) {
    return told(points_inside(scene.a, {0.5, 0.5, 0.5}, scene.workspace, kThrough));
}

}  // namespace in_cpp

/// Returns each query once, and through each structure.
inline const std::vector<Question>& questions() {
    using namespace in_cpp;
    constexpr Body kSurface = Body::surface, kSolid = Body::solid;
    using enum Structure;
    static const std::vector<Question> all = {
        {"collide", Ask::collide, collide_by<kSurface, bvh>},
        {"collide solid", Ask::collide | Ask::solid, collide_by<kSolid, bvh>},
        {"collide through octree", Ask::collide | Ask::octree, collide_by<kSurface, octree>},
        {"collide through adaptive octree", Ask::collide | Ask::adaptive_octree,
         collide_by<kSurface, adaptive_octree>},
        {"collide through hashed octree", Ask::collide | Ask::hashed_octree,
         collide_by<kSurface, hashed_octree>},
        {"collide solid through tetra-tree", Ask::collide | Ask::solid | Ask::tetra_tree,
         collide_by<kSolid, tetra_tree>},
        {"collide through pieces", Ask::collide | Ask::pieces, collide_by<kSurface, pieces>},
        {"containment", Ask::solid,
         [](const Scene& scene) { return told(containment(scene.pair(), scene.workspace)); }},
        {"collide_at_level", Ask::tetra_tree,
         [](const Scene& scene) {
             return told(collide_at_level(scene.pair(), 2, scene.workspace).answer);
         }},
        {"level_error", Ask::tetra_tree,
         [](const Scene& scene) { return told(level_error(scene.a, 1)); }},
        {"overlaps", Ask::overlap, overlaps_by<bvh>},
        {"overlaps through octree", Ask::overlap | Ask::octree, overlaps_by<octree>},
        {"overlaps through tetra-tree", Ask::overlap | Ask::tetra_tree, overlaps_by<tetra_tree>},
        {"overlaps through pieces", Ask::overlap | Ask::pieces, overlaps_by<pieces>},
        {"overlaps_through", Ask::overlap,
         [](const Scene& scene) {
             return told_list<TrianglePair>([&](std::span<TrianglePair> room) {
                 return overlaps_through(scene.pair(), {}, scene.workspace, room);
             });
         }},
        {"any_overlap_through", Ask::collide,
         [](const Scene& scene) {
             return told(any_overlap_through(scene.pair(), {}, scene.workspace));
         }},
        {"visit_overlaps", Ask::overlap,
         [](const Scene& scene) {
             return told_count<TrianglePair>([&](PairVisitor take) {
                 return visit_overlaps(scene.pair(), scene.workspace, take);
             });
         }},
        {"mark_overlaps", Ask::overlap,
         [](const Scene& scene) {
             std::vector<std::uint64_t> bits_a(8), bits_b(8);
             AnswerBytes bytes = told(mark_overlaps(scene.pair(), scene.workspace, bits_a, bits_b));
             bytes.add_stored(bits_a);
             bytes.add_stored(bits_b);
             return bytes;
         }},
        {"split_overlaps", Ask::overlap,
         [](const Scene& scene) {
             std::vector<Workspace> workspaces(2);
             return told_list<TrianglePair>([&](std::span<TrianglePair> room) {
                 return split_overlaps(scene.pair(), workspaces, run_threads, room);
             });
         }},
        {"crossings", Ask::overlap,
         [](const Scene& scene) {
             return told_list<Crossing>([&](std::span<Crossing> room) {
                 return crossings(scene.pair(), scene.workspace, room);
             });
         }},
        {"visit_crossings", Ask::overlap,
         [](const Scene& scene) {
             return told_count<Crossing>([&](Visitor<Crossing> take) {
                 return visit_crossings(scene.pair(), scene.workspace, take);
             });
         }},
        {"self_overlaps", Ask::overlap | Ask::corners,
         [](const Scene& scene) {
             return told_list<TrianglePair>([&](std::span<TrianglePair> room) {
                 return self_overlaps(scene.a, scene.workspace, room);
             });
         }},
        {"visit_self_overlaps", Ask::overlap | Ask::corners,
         [](const Scene& scene) {
             return told_count<TrianglePair>([&](PairVisitor take) {
                 return visit_self_overlaps(scene.a, scene.workspace, take);
             });
         }},
        {"distance", Ask::distance, distance_by<kSurface, bvh>},
        {"distance solid", Ask::distance | Ask::solid, distance_by<kSolid, bvh>},
        {"distance through pieces", Ask::distance | Ask::pieces, distance_by<kSurface, pieces>},
        {"time_of_impact", Ask::distance, time_of_impact_of<kSurface>},
        {"time_of_impact solid", Ask::distance | Ask::solid, time_of_impact_of<kSolid>},
        {"bounded_distance", Ask::distance,
         [](const Scene& scene) {
             return told(bounded_distance(scene.pair(), scene.workspace).nearest);
         }},
        {"within", Ask::within,
         [](const Scene& scene) { return told(within(scene.pair(), 0.5, scene.workspace)); }},
        {"pairs_within", Ask::within,
         [](const Scene& scene) {
             return told_list<TrianglePair>([&](std::span<TrianglePair> room) {
                 return pairs_within(scene.pair(), 0.5, scene.workspace, room);
             });
         }},
        {"visit_pairs_within", Ask::within,
         [](const Scene& scene) {
             return told_count<TrianglePair>([&](PairVisitor take) {
                 return visit_pairs_within(scene.pair(), 0.5, scene.workspace, take);
             });
         }},
        {"contacts", Ask::contacts,
         [](const Scene& scene) {
             return told_list<Contact>([&](std::span<Contact> room) {
                 return contacts(scene.pair(), scene.workspace, room,
                                 {.tolerance = 0.5, .manifold = Manifold::four})
                     .found;
             });
         }},
        {"visit_contacts", Ask::contacts,
         [](const Scene& scene) {
             return told_count<Contact>([&](ContactVisitor take) {
                 return visit_contacts(scene.pair(), scene.workspace, take);
             });
         }},
        {"collide_many", Ask::collide,
         [](const Scene& scene) {
             return told_batch<Collision>(scene, [](auto pairs, auto lanes, auto answers) {
                 collide_many(pairs, lanes, run_threads, answers);
             });
         }},
        {"distance_many", Ask::distance,
         [](const Scene& scene) {
             return told_batch<std::optional<Distance>>(
                 scene, [](auto pairs, auto lanes, auto answers) {
                     distance_many(pairs, lanes, run_threads, answers);
                 });
         }},
        {"within_many", Ask::within,
         [](const Scene& scene) {
             return told_batch<bool>(scene, [](auto pairs, auto lanes, auto answers) {
                 within_many(pairs, 0.5, lanes, run_threads, answers);
             });
         }},
        {"count_overlaps_many", Ask::overlap,
         [](const Scene& scene) {
             return told_batch<std::size_t>(scene, [](auto pairs, auto lanes, auto answers) {
                 count_overlaps_many(pairs, lanes, run_threads, answers);
             });
         }},
        {"overlaps_many", Ask::overlap,
         [](const Scene& scene) {
             return told_list<TrianglePair>([&](std::span<TrianglePair> room) {
                 std::vector<Workspace> workspaces(2);
                 const std::array<Pair, 1> pairs = {scene.pair()};
                 std::array<OverlapList, 1> answers = {{{room}}};
                 overlaps_many(pairs, workspaces, run_threads, answers);
                 return answers[0].count;
             });
         }},
        {"mark_overlaps_many", Ask::overlap,
         [](const Scene& scene) {
             std::vector<Workspace> workspaces(2);
             std::vector<std::uint64_t> bits_a(8), bits_b(8);
             const std::array<Pair, 1> pairs = {scene.pair()};
             std::array<OverlapMarks, 1> answers = {{{bits_a, bits_b}}};
             mark_overlaps_many(pairs, workspaces, run_threads, answers);
             AnswerBytes bytes = told(answers[0].count);
             bytes.add_stored(bits_a);
             bytes.add_stored(bits_b);
             return bytes;
         }},
        {"closest_point", Ask::closest,
         [](const Scene& scene) {
             return told(closest_point(scene.a, {0.5, 0.25, 2}, scene.workspace));
         }},
        {"points_inside", Ask::inside, inside_by<bvh>},
        {"points_inside through octree", Ask::inside | Ask::octree, inside_by<octree>},
        {"points_inside through adaptive octree", Ask::inside | Ask::adaptive_octree,
         inside_by<adaptive_octree>},
        {"points_inside through tetra-tree", Ask::inside | Ask::tetra_tree, inside_by<tetra_tree>},
        {"cast_ray", Ask::ray,
         [](const Scene& scene) { return told(cast_ray(scene.a, kRay, scene.workspace)); }},
        {"ray_hits", Ask::ray,
         [](const Scene& scene) { return told(ray_hits(scene.a, kRay, scene.workspace)); }},
        {"all_ray_hits", Ask::ray,
         [](const Scene& scene) {
             return told_list<RayHit>([&](std::span<RayHit> room) {
                 return all_ray_hits(scene.a, kRay, scene.workspace, room);
             });
         }},
        {"visit_ray_hits", Ask::ray,
         [](const Scene& scene) {
             return told_count<RayHit>([&](RayVisitor take) {
                 return visit_ray_hits(scene.a, kRay, scene.workspace, take);
             });
         }},
        {"touches", Ask::touch,
         [](const Scene& scene) { return told(touches(scene.a, kBall, scene.workspace)); }},
        {"touching_triangles", Ask::touch,
         [](const Scene& scene) {
             return told_list<std::uint32_t>([&](std::span<std::uint32_t> room) {
                 return touching_triangles(scene.a, kBall, scene.workspace, room);
             });
         }},
        {"visit_touching_triangles", Ask::touch,
         [](const Scene& scene) {
             return told_count<std::uint32_t>([&](TriangleVisitor take) {
                 return visit_touching_triangles(scene.a, kBall, scene.workspace, take);
             });
         }},
        {"shape_distance", Ask::touch,
         [](const Scene& scene) { return told(shape_distance(scene.a, kBall, scene.workspace)); }},
        {"find_hull", Ask::hulls,
         [](const Scene& scene) { return told(find_hull(scene.a, format::HullScope::whole)); }},
        {"convex_points", Ask::hulls,
         [](const Scene& scene) { return told(convex_points(scene.a, 0).count); }},
        {"piece_points", Ask::pieces,
         [](const Scene& scene) { return told(piece_points(scene.a, 0).count); }},
        {"feature_hull", Ask::contacts,
         [](const Scene& scene) { return told(feature_hull(scene.a, 0).facets.size()); }},
    };
    return all;
}

}  // namespace cdprep::test
