// SPDX-License-Identifier: MIT
// Asks every question in every floating-point environment that a caller may have. The expected
// bytes are those of the default environment, for which all other tests hold.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include "cdprep/advanced/build_piece_boxes.h"
#include "cdprep/advanced/closest_features.h"
#include "cdprep/advanced/convex_penetration.h"
#include "cdprep/advanced/pair_front.h"
#include "cdprep/advanced/refit_bvh.h"
#include "cdprep/advanced/self_walk.h"
#include "cdprep/bounded_distance.h"
#include "cdprep/cells.h"
#include "cdprep/cells/build_adaptive_octree.h"
#include "cdprep/cells/build_octree.h"
#include "cdprep/cells/build_tetra_tree.h"
#include "cdprep/cells/find_list_damage.h"
#include "cdprep/cells/level_of_detail.h"
#include "cdprep/cells/overlap_through.h"
#include "cdprep/cells/tetra_figures.h"
#include "cdprep/contacts.h"
#include "cdprep/format/find_damage.h"
#include "cdprep/hulls.h"
#include "cdprep/live_model.h"
#include "cdprep/pairs.h"
#include "cdprep/parallel.h"
#include "cdprep/points.h"
#include "cdprep/self.h"
#include "cdprep/sweep.h"
#include "cdprep/time_of_impact.h"
#include "cdprep/window.h"
#include "support/aligned_bytes.h"
#include "support/answer_bytes.h"
#include "support/every_structure.h"
#include "support/float_modes.h"
#include "support/hard_hulls.h"
#include "support/open_tiny.h"
#include "support/run_threads.h"
#include "support/small_hull.h"
#include "support/tiny_pieces.h"

namespace cdprep::test {
namespace {

/// One answer's bytes, and the environments that its visitors and hooks ran in.
struct Asked {
    AnswerBytes bytes;
    std::vector<std::uint64_t> seen;

    void see() {
        seen.push_back(control_bits(format::float_control()));
    }
};

using Query = std::function<void(Asked&)>;

/// Asks in every mode: the bytes are those of the default environment, the caller's is what it
/// was, and visitors ran in it.
void expect_same_in_every_mode(const std::string& name, const Query& question) {
    Asked expected;
    question(expected);
    ASSERT_GT(expected.bytes.size(), 0U) << name;
    for (const FloatMode& mode : float_modes()) {
        Asked asked;
        const std::uint64_t left = run_in(mode, [&] { question(asked); });
        EXPECT_TRUE(asked.bytes == expected.bytes) << name << ", " << mode.name;
        EXPECT_EQ(left, control_bits(mode.control)) << name << ", " << mode.name;
        EXPECT_EQ(asked.seen.size(), expected.seen.size()) << name << ", " << mode.name;
        for (const std::uint64_t seen : asked.seen) {
            ASSERT_EQ(seen, control_bits(mode.control)) << name << ", " << mode.name;
        }
    }
}

/// Two models with every structure at one scale, and what is asked of them.
struct ScaledPair {
    std::string name;
    double scale;
    OpenModel a;
    OpenModel b;
    Placement placement;
    std::array<Double3, 3> point;  ///< at the scale
};

OpenModel open_scaled(TestMesh mesh, double scale) {
    for (Double3& p : mesh.positions) p = {p.x * scale, p.y * scale, p.z * scale};
    const AlignedBytes file = bake_tiny(mesh.positions, mesh.triangles, {.double_precision = true});
    return open_tiny(with_piece_tree(with_every_structure(file, {.boxes = true})));
}

ScaledPair scene(double scale, double apart) {
    const TestMesh ball = icosphere(2);
    const TestMesh ring = turned(torus(1, 0.25, 24, 12), 0.3);
    const Double3 shift = {apart * scale, 0.125 * scale, 0.0625 * scale};
    const Pose pose = Pose::from_quaternion(5, 1, 2, 3, shift).value();
    std::array<Double3, 3> points = {{{0.1, 0.2, 0.3}, {1.2, 0.05, 0.02}, {-0.9, 2.5, 0.7}}};
    for (Double3& p : points) p = {p.x * scale, p.y * scale, p.z * scale};
    return {"scale 2^" + std::to_string(std::ilogb(scale)) + ", apart " + std::to_string(apart),
            scale,
            open_scaled(ball, scale),
            open_scaled(ring, scale),
            Placement::b_moves(pose),
            points};
}

/// From all but the largest coordinates to subnormal ones; crossing, nested and apart.
std::vector<ScaledPair> scenes() {
    std::vector<ScaledPair> scenes;
    for (const double scale : {1.0, 0x1p-1000, 0x1p-1040, 0x1p990}) {
        for (const double apart : {0.2, 2.75}) scenes.push_back(scene(scale, apart));
    }
    return scenes;
}

TEST(FloatModes, ChangeNoAnswerAboutTwoModels) {
    for (const ScaledPair& s : scenes()) {
        const Model &a = s.a.model, &b = s.b.model;
        Workspace workspace(cells());
        const OpenModel crossed = open_tiny(moved_by(klein_bottle(24, 11), s.scale, {0, 0, 0}),
                                            {.double_precision = true});
        std::vector<Workspace> workspaces(3);
        std::vector<TrianglePair> pairs(20'000);
        std::vector<std::uint64_t> bits_a(a.triangle_count() / 64 + 1);
        std::vector<std::uint64_t> bits_b(b.triangle_count() / 64 + 1);
        const double near = 0.125 * s.scale, exactly = 0;
        const Double3 way = {-2 * s.scale, 0, 0};
        const auto each = [&](const char* name, const Query& question) {
            expect_same_in_every_mode(s.name + ": " + name, question);
        };
        each("collide", [&](Asked& out) {
            out.bytes.add(collide({a, b, s.placement, {.body = Body::solid}}, workspace));
            PairCache cache;
            out.bytes.add(collide({a, b, s.placement, {}, &cache}, workspace));
            out.bytes.add(collide({a, b, s.placement, {}, &cache}, workspace));
        });
        each("containment", [&](Asked& out) {
            out.bytes.add(containment({a, b, s.placement}, workspace));
        });
        each("overlaps", [&](Asked& out) {
            out.bytes.add(pairs, overlaps({a, b, s.placement}, workspace, pairs));
        });
        each("visit_overlaps", [&](Asked& out) {
            const auto visit = [&](const TrianglePair& pair) {
                out.see();
                out.bytes.add(pair);
                return true;
            };
            out.bytes.add(visit_overlaps({a, b, s.placement}, workspace, visit));
        });
        each("mark_overlaps", [&](Asked& out) {
            out.bytes.add(mark_overlaps({a, b, s.placement}, workspace, bits_a, bits_b));
            out.bytes.add_stored(bits_a);
            out.bytes.add_stored(bits_b);
        });
        each("visit_crossings", [&](Asked& out) {
            const auto visit = [&](const Crossing& crossing) {
                out.see();
                out.bytes.add(crossing);
                return true;
            };
            out.bytes.add(visit_crossings({a, b, s.placement}, workspace, visit));
        });
        each("distance", [&](Asked& out) {
            out.bytes.add(distance({a, b, s.placement}, workspace));
            out.bytes.add(distance({a, b, s.placement}, workspace, {.relative_error = 0.1}));
            out.bytes.add(distance({a, b, s.placement, {.body = Body::solid}}, workspace));
        });
        each("bounded_distance", [&](Asked& out) {
            for (const std::uint64_t work : {0U, 200U}) {
                const BoundedDistance found =
                    bounded_distance({a, b, s.placement}, workspace, {}, {.work = work});
                out.bytes.add(found.is_complete);
                out.bytes.add(found.lower);
                out.bytes.add(found.upper);
                out.bytes.add(found.nearest);
            }
        });
        each("time_of_impact", [&](Asked& out) {
            const Motion motion = Motion::by_velocity(s.placement.pose_b(), way, {0, 0, 1}).value();
            out.bytes.add(motion.at(0.25).translation());
            out.bytes.add(time_of_impact({a, b, Motion(), motion}, workspace));
        });
        each("window", [&](Asked& out) {
            AlignedBytes memory(Window::bytes({.leaves = 300}).value());
            Window window = Window::in(memory.span(), {.leaves = 300}).value();
            const WindowFill held = window.fill({a, b, s.placement}, near);
            out.bytes.add(held.radius);
            out.bytes.add(held.leaves);
            out.bytes.add(window.model().header().content_hash);
            out.bytes.add(window.margin(b, s.placement));
            out.bytes.add(window.distance({window.model(), b, s.placement}, workspace).nearest);
        });
        each("within", [&](Asked& out) {
            out.bytes.add(within({a, b, s.placement}, near, workspace));
            out.bytes.add(within({a, b, s.placement}, exactly, workspace));
        });
        each("pairs_within", [&](Asked& out) {
            out.bytes.add(pairs, pairs_within({a, b, s.placement}, near, workspace, pairs));
        });
        each("visit_pairs_within", [&](Asked& out) {
            const auto visit = [&](const TrianglePair& pair) {
                out.see();
                out.bytes.add(pair);
                return true;
            };
            out.bytes.add(visit_pairs_within({a, b, s.placement}, near, workspace, visit));
        });
        each("split_overlaps", [&](Asked& out) {
            const auto run = [&](std::size_t count, Task task) {
                out.see();
                run_threads(count, task);
                out.see();
            };
            out.bytes.add(pairs, split_overlaps({a, b, s.placement}, workspaces, run, pairs));
        });
        each("self_overlaps", [&](Asked& out) {
            out.bytes.add(pairs, self_overlaps(crossed.model, workspace, pairs));
        });
        each("visit_self_overlaps", [&](Asked& out) {
            const auto visit = [&](const TrianglePair& pair) {
                out.see();
                out.bytes.add(pair);
                return true;
            };
            out.bytes.add(visit_self_overlaps(crossed.model, workspace, visit));
        });
        each("distance_many", [&](Asked& out) {
            const Pair job = {a, b, s.placement};
            std::vector<std::optional<Distance>> answers(3);
            distance_many(std::vector<Pair>{job, job, job}, workspaces, run_threads, answers);
            for (const auto& answer : answers) out.bytes.add(answer);
        });
        each("collide_at_level", [&](Asked& out) {
            const CoarseCollision found = collide_at_level({a, b, s.placement}, 2, workspace);
            out.bytes.add(found.answer);
            out.bytes.add(found.error_a);
            out.bytes.add(level_error(b, 3));
        });
        each("overlap_through", [&](Asked& out) {
            for (const Structure structure : kStructures) {
                const StructureOptions through = {.structure = structure};
                out.bytes.add(pairs,
                              overlaps_through({a, b, s.placement}, through, workspace, pairs));
                out.bytes.add(any_overlap_through({a, b, s.placement}, through, workspace));
            }
        });
        each("questions through pieces", [&](Asked& out) {
            const StructureOptions through = {.structure = Structure::pieces};
            PieceCache cache;
            out.bytes.add(
                any_overlap_through({a, b, s.placement, {}, &cache.pair}, through, workspace));
            out.bytes.add(distance(
                {a, b, s.placement, {.through = through.structure}, &cache.pair, &cache.front},
                workspace));
            out.bytes.add(within(
                {a, b, s.placement, {.through = through.structure}, &cache.pair, &cache.front},
                near, workspace));
            out.bytes.add(pairs, pairs_within({a, b, s.placement, {.through = through.structure}},
                                              near, workspace, pairs));
        });
    }
}

/// Adds every answer about one shape.
template <class Shape>
void ask_touching(const Model& model, const Shape& shape, const ShapeOptions& options,
                  Workspace& workspace, Asked& out) {
    std::vector<std::uint32_t> triangles(model.triangle_count());
    out.bytes.add(touches(model, shape, workspace, options));
    out.bytes.add(triangles, touching_triangles(model, shape, workspace, triangles, options));
    const auto visit = [&](std::uint32_t triangle) {
        out.see();
        out.bytes.add(triangle);
        return true;
    };
    out.bytes.add(visit_touching_triangles(model, shape, workspace, visit, options));
}

TEST(FloatModes, ChangeNoAnswerAboutOneModel) {
    for (const ScaledPair& s : scenes()) {
        const Model& model = s.b.model;
        Workspace workspace(cells());
        const auto each = [&](const char* name, const Query& question) {
            expect_same_in_every_mode(s.name + ": " + name, question);
        };
        const ShapeOptions turned = {.world_from_model = s.placement.pose_b()};
        const std::array<Double3, 3>& p = s.point;
        const double radius = 0.25 * s.scale, reach = 4 * s.scale;
        const Double3 along = {p[1].x * 0.5, -p[1].x, p[1].x};
        each("includes", [&](Asked& out) {
            for (const Double3& at : p) {
                out.bytes.add(points_inside(model, at, workspace));
                for (const Structure structure : kStructures) {
                    out.bytes.add(points_inside(model, at, workspace, structure));
                }
            }
        });
        each("closest_point", [&](Asked& out) {
            for (const Double3& at : p) {
                out.bytes.add(closest_point(model, at, workspace));
                out.bytes.add(closest_point(model, at, workspace, reach));
            }
        });
        each("rays", [&](Asked& out) {
            std::vector<RayHit> hits(100);
            const auto visit = [&](const RayHit& hit) {
                out.see();
                out.bytes.add(hit);
                return true;
            };
            for (const Double3& from : p) {
                for (const Double3& way : {along, Double3{-1, 0, 0}}) {
                    const Ray ray = {from, way};
                    out.bytes.add(cast_ray(model, ray, workspace));
                    out.bytes.add(ray_hits(model, ray, workspace));
                    out.bytes.add(hits, all_ray_hits(model, ray, workspace, hits));
                    out.bytes.add(visit_ray_hits(model, ray, workspace, visit));
                }
            }
        });
        each("touching", [&](Asked& out) {
            const Box box = {p[0], p[1]};
            const Sphere sphere = {p[1], radius};
            const Capsule capsule = {p[0], p[1], radius};
            const TriangleShape triangle = {{p[0], p[1], p[2]}};
            for (const ShapeOptions& options : {ShapeOptions{}, turned}) {
                ask_touching(model, box, options, workspace, out);
                ask_touching(model, sphere, options, workspace, out);
                ask_touching(model, capsule, options, workspace, out);
                ask_touching(model, triangle, options, workspace, out);
                const ShapeOptions placed = {options.world_from_model};
                out.bytes.add(shape_distance(model, capsule, workspace, placed));
                out.bytes.add(shape_distance(model, triangle, workspace, placed));
            }
        });
        each("tetra_figures", [&](Asked& out) {
            const TetraFigures figures = tetra_figures(model);
            out.bytes.add(figures.mean_layers);
            out.bytes.add(figures.most_layers);
        });
        each("checks", [&](Asked& out) {
            out.bytes.add(format::find_damage(s.b.bytes.span()));
            out.bytes.add(format::find_header_damage(s.b.bytes.span()));
            out.bytes.add(format::find_deep_damage(s.b.bytes.span()));
            out.bytes.add(find_list_damage(s.b.bytes.span(), model));
            out.bytes.add(Model::open(s.b.bytes.span()).ok());
        });
    }
}

TEST(FloatModes, ChangeNoAnswerAboutHulls) {
    int asked = 0;
    for (const HardHulls& hard : hard_hulls(false)) {
        if (hard.is_large) continue;
        ++asked;
        for (const double scale : {1.0, 0x1p-1030}) {
            const auto scaled = [&](Points points) {
                for (Double3& p : points) p = {p.x * scale, p.y * scale, p.z * scale};
                return points;
            };
            const SmallHull hull_a(scaled(hard.a)), hull_b(scaled(hard.b));
            const ConvexPoints a = hull_a.view(), b = hull_b.view();
            const double near = 0x1p-10 * scale;
            expect_same_in_every_mode(hard.id, [&](Asked& out) {
                out.bytes.add(convex_collide(a, b, hard.placement));
                out.bytes.add(convex_distance(a, b, hard.placement));
                out.bytes.add(convex_within(a, b, hard.placement, near));
                out.bytes.add(convex_penetration(a, b, hard.placement));
                out.bytes.add(direction_cell(a.point(0)));
                out.bytes.add(a.point(0));
            });
        }
    }
    EXPECT_GT(asked, 300);
}

// By definition: a float's value as a double is the same in every mode, subnormal ones too.
TEST(FloatModes, ChangeNoPointOfAHull) {
    const std::vector<format::Float3> floats = {{0x1p-140F, -0x1p-149F, 1}};
    const std::vector<std::uint32_t> corners = {0};
    ConvexPoints points;
    points.count = 1;
    points.corners = corners;
    points.floats = floats;
    for (const FloatMode& mode : float_modes()) {
        Double3 point{};
        (void)run_in(mode, [&] { point = points.point(0); });
        EXPECT_EQ(point, (Double3{0x1p-140, -0x1p-149, 1})) << mode.name;
    }
}

TEST(FloatModes, ChangeNoContact) {
    for (const double scale : {1.0, 0x1p-1000, 0x1p-1040}) {
        const TestMesh ball = moved_by(icosphere(1), scale, {});
        const TestMesh ring = moved_by(torus(1, 0.25, 12, 8), scale, {});
        const TinyOptions doubles = {.double_precision = true};
        const OpenModel a = open_tiny(
            with_contacts(with_one_piece(bake_tiny(ball.positions, ball.triangles, doubles))));
        const OpenModel b = open_tiny(
            with_contacts(with_pieces(bake_tiny(ring.positions, ring.triangles, doubles))));
        const Double3 shift = {0.2 * scale, 0.1 * scale, 0};
        const Placement placement =
            Placement::b_moves(Pose::from_quaternion(5, 1, 2, 3, shift).value());
        const double near = 0.0625 * scale;
        Workspace workspace(cells());
        std::vector<Contact> room(20);
        const ContactOptions options = {.tolerance = near, .manifold = Manifold::four};
        const std::string at = "contacts at 2^" + std::to_string(std::ilogb(scale));
        expect_same_in_every_mode(at, [&](Asked& out) {
            const auto visit = [&](const Contact& contact) {
                out.see();
                out.bytes.add(contact);
                return true;
            };
            const Pair pair = {a.model, b.model, placement};
            out.bytes.add(room, contacts(pair, workspace, room, options).count);
            ContactOptions few = options;
            few.most = 12;
            few.cluster_angle = 0.25;
            const ContactsVerdict verdict = contacts(pair, workspace, room, few);
            out.bytes.add(verdict);
            out.bytes.add(room, verdict.count);
            out.bytes.add(visit_contacts(pair, workspace, visit, options));
        });
        const FeatureHull hull_a = feature_hull(a.model, 0), hull_b = feature_hull(b.model, 3);
        expect_same_in_every_mode(at + ", closest_features", [&](Asked& out) {
            out.bytes.add(closest_features(hull_a, hull_b, placement));
        });
    }
}

/// Builds everything over a mesh. The hook runs tasks on threads, and sees the environment.
void build_all(const TestMesh& mesh, Asked& out) {
    const auto run = [&](std::size_t count, Task task) {
        out.see();
        if (count < 8) {
            run_threads(count, task);
        } else {
            serial_for(count, task);
        }
        out.see();
    };
    build::Bvh bvh =
        build::build_bvh(mesh.positions, mesh.triangles,
                         {.parallel_for = run, .bounds = build::BvhBounds::oriented_and_swept});
    out.bytes.add(bvh.frame.origin);
    out.bytes.add(bvh.frame.exponent);
    out.bytes.add_stored(bvh.order);
    out.bytes.add_stored(bvh.nodes);
    out.bytes.add_stored(bvh.leaves);
    out.bytes.add_stored(bvh.oriented_nodes);
    out.bytes.add_stored(bvh.swept_nodes);
    out.bytes.add(build::surface_cost(bvh));
    out.bytes.add(build::refit_bvh(bvh, mesh.positions, mesh.triangles, {.parallel_for = run}));
    out.bytes.add_stored(bvh.nodes);
    const SelfWalk walk(bvh, mesh.triangles, run);
    out.bytes.add(walk.part_count());
    std::vector<format::Piece> pieces(mesh.triangles.size() / 4);
    std::vector<std::uint32_t> numbers(mesh.triangles.size());
    std::iota(numbers.begin(), numbers.end(), 0U);
    for (std::uint32_t i = 0; i < pieces.size(); ++i) pieces[i].first_triangle = 4 * i;
    const build::PieceBoxes boxes =
        build::build_piece_boxes({mesh.positions, mesh.triangles, pieces, numbers}, bvh.frame, run);
    out.bytes.add_stored(boxes.nodes);
    out.bytes.add_stored(boxes.swept);
    out.bytes.add_stored(boxes.leaves);
    const build::Octree octree = build::build_octree(mesh.positions, mesh.triangles,
                                                     {.parallel_for = run, .boxes_in = bvh.frame});
    out.bytes.add(octree.grid.origin);
    out.bytes.add(octree.grid.step);
    out.bytes.add_stored(octree.nodes);
    out.bytes.add_stored(octree.references);
    out.bytes.add_stored(octree.boxes);
    const build::AdaptiveOctree adaptive = build::build_adaptive_octree(
        mesh.positions, mesh.triangles,
        {.parallel_for = run, .rule = format::SplitRule::surface_area, .boxes_in = bvh.frame});
    out.bytes.add_stored(adaptive.nodes);
    out.bytes.add_stored(adaptive.references);
    const build::TetraTree tetra =
        build::build_tetra_tree(mesh.positions, mesh.triangles,
                                {.parallel_for = run,
                                 .bounding = format::TetraBounding::boxes,
                                 .frame_exponent = bvh.frame.exponent,
                                 .frame_origin = bvh.frame.origin});
    out.bytes.add(tetra.tree.centre);
    out.bytes.add_stored(tetra.nodes);
    out.bytes.add_stored(tetra.references);
    out.bytes.add_stored(tetra.oriented);
}

TEST(FloatModes, ChangeNothingThatIsBuilt) {
    for (const double scale : {1.0, 0x1p-1000, 0x1p-1040, 0x1p990}) {
        for (const TestMesh& mesh : {icosphere(3), random_soup(5, 5000, 0.1)}) {
            const TestMesh scaled = moved_by(mesh, scale, {});
            expect_same_in_every_mode("build at 2^" + std::to_string(std::ilogb(scale)),
                                      [&](Asked& out) { build_all(scaled, out); });
        }
    }
}

using Floats = std::vector<format::Float3>;

/// Makes a live model, and moves its vertices.
void build_live(const Floats& positions, const Floats& moved,
                const std::vector<format::Triangle>& triangles, const LiveLimits& limits,
                Asked& out) {
    const auto arrays =
        build::build_model(positions, triangles, {.bounds = build::BvhBounds::aligned}).value();
    AlignedBytes memory(LiveModel::bytes(arrays, limits).value());
    LiveModel live = LiveModel::in(memory.span(), arrays, limits).value();
    const auto add_tree = [&] {
        const auto bvh = live.model().bvh();
        out.bytes.add_stored(std::vector(bvh.nodes.begin(), bvh.nodes.end()));
        out.bytes.add_stored(std::vector(bvh.leaves.begin(), bvh.leaves.end()));
    };
    add_tree();
    out.bytes.add(live.refit(moved).ok());
    add_tree();
}

TEST(FloatModes, ChangeNoLiveModel) {
    for (const double scale : {1.0, 0x1p-90, 0x1p90}) {
        const TestMesh mesh = moved_by(random_soup(5, 500, 0.1), scale, {});
        Floats positions, moved;
        for (const Double3& p : mesh.positions) {
            positions.push_back(
                {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
            moved.push_back(positions.back());
            moved.back().x += moved.back().z / 3;
        }
        for (const std::uint32_t room : {0U, 600U}) {
            expect_same_in_every_mode(
                "live model with room for " + std::to_string(room), [&](Asked& out) {
                    build_live(positions, moved, mesh.triangles, {.triangles = room}, out);
                });
        }
    }
}

// By hand: a blade is between the two heights of a triangle, all of them below the range of normal
// floats. A mode may take them for 0.
TEST(FloatModes, ChangeNoSweep) {
    constexpr float kSide = 0x1p-100F;
    const std::vector<format::Triangle> one = {{{0, 1, 2}}};
    Floats above, below;
    for (const auto& [height, to] : {std::pair(0x1p-128F, &above), std::pair(0x1p-130F, &below)}) {
        *to = {{0, 0, height}, {kSide, 0, height}, {0, kSide, height}};
    }
    constexpr double kLow = kSide / 5, kHigh = kSide / 4, kAt = 0x1p-129;
    const OpenModel blade =
        open_tiny(TestMesh{{{kLow, kLow, kAt}, {kHigh, kLow, kAt}, {kLow, kHigh, kAt}}, one},
                  {.double_precision = true});
    const auto arrays =
        build::build_model(above, one, {.bounds = build::BvhBounds::aligned}).value();
    Workspace workspace;
    for (const FloatMode& mode : float_modes()) {
        AlignedBytes memory(LiveModel::bytes(arrays).value());
        LiveModel live = LiveModel::in(memory.span(), arrays).value();
        AlignedBytes room(Sweep::bytes(live.model()));
        Sweep sweep = Sweep::in(room.span(), live.model()).value();
        bool found = false;
        (void)run_in(mode, [&] {
            sweep.begin();
            (void)live.refit(below);
            sweep.end();
            found = may_touch(sweep, blade.model, Motion(), workspace);
        });
        EXPECT_TRUE(found) << mode.name;
    }
}

TEST(FloatModes, ChangeNoPose) {
    const double small = 0x1p-1060;
    expect_same_in_every_mode("poses", [&](Asked& out) {
        const Pose a = Pose::from_quaternion(5, 1, 2, 3, {0.1, 0.2, small}).value();
        const Pose b = Pose::from_quaternion(small, small, 0, 3 * 0x1p-1062, {small, 1, 0}).value();
        const Pose both = relative_pose(a, b);
        out.bytes.add(a);
        out.bytes.add(b);
        out.bytes.add(both);
        out.bytes.add(transform_point(both, {0.1, 0.3, 0x1p-30}));
        out.bytes.add(transform_point(Pose(), {small, -small, small}));
        std::array<double, 12> rows{};
        std::copy_n(a.rotation().begin(), 9, rows.begin());
        out.bytes.add(Pose::from_rows(rows).ok());
    });
}

// By definition of the order; in a mode that takes small numbers for 0 too.
TEST(FloatModes, ChangeNoOrderOfHits) {
    const RayHit first = {0x1p-1070, {}, 2}, second = {0x1p-1069, {}, 1};
    for (const FloatMode& mode : float_modes()) {
        bool is_less = false;
        (void)run_in(mode, [&] { is_less = first < second; });
        EXPECT_TRUE(is_less) << mode.name;
    }
}

}  // namespace
}  // namespace cdprep::test
