// SPDX-License-Identifier: GPL-3.0-or-later
#include "accuracy/ladders.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <ctime>
#include <deque>
#include <iterator>
#include <utility>

#include "accuracy/bounding_shapes.h"
#include "accuracy/bytes_read.h"
#include "accuracy/octree_level.h"
#include "accuracy/part_set.h"
#include "cdprep/advanced/convex_distance.h"
#include "cdprep/advanced/float_contacts.h"
#include "cdprep/cells.h"
#include "cdprep/cells/level_of_detail.h"
#include "cdprep/hulls.h"
#include "cdprep/pairs.h"
#include "decompose/enclose/hull_error.h"
#include "decompose/enclose/search_scale.h"
#include "decompose/enclose/solid.h"
#include "hull/convex_hull.h"

namespace cdprep::study {
namespace {

using Clock = std::chrono::steady_clock;
using format::SectionId;

// The processor time of all threads for parts. A search does not begin if twice the time of the
// search for half as many parts would exceed it.
constexpr double kPartShare_s = 60;
constexpr double kQuickPartShare_s = 6;
// The work of one search (convex::ApproximateOptions): about 4 s and 0.5 s of one core. Solids of
// few plane faces use all of it.
constexpr std::size_t kPartWork = 400'000'000;
constexpr std::size_t kQuickPartWork = 50'000'000;
constexpr std::uint32_t kTetraThreshold = 4;

constexpr format::SectionSet kTreeSections = {SectionId::bvh_nodes, SectionId::bvh_leaves,
                                              SectionId::oriented_nodes};

struct ShapeContender {
    Rung rung;
    std::function<Answer(std::size_t pose)> ask;
};

/// Returns the processor time of all threads.
double processor_seconds() {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

Answer hit_or_no(bool may_touch) {
    return may_touch ? Answer::yes : Answer::no;
}

template <class Work>
auto timed(double& seconds, Work work) {
    const Clock::time_point begun = Clock::now();
    auto made = work();
    seconds += std::chrono::duration<double>(Clock::now() - begun).count();
    return made;
}

/// Computes how far shapes stick out of the two solids, as a share of the diagonal.
class Outside {
public:
    explicit Outside(const Climb& climb)
        : climb_(climb),
          solid_a_(climb.mesh_a, climb.parallel_for),
          solid_b_(climb.mesh_b, climb.parallel_for) {}

    /// Returns how far the hulls of these points stick out, the larger of both models.
    [[nodiscard]] double of_points(const std::vector<Double3>& around_a,
                                   const std::vector<Double3>& around_b) const {
        return std::max(error_of(around_a, solid_a_), error_of(around_b, solid_b_)) /
               climb_.set.diagonal;
    }

private:
    /// A solid and the map to its coordinates.
    struct Scaled {
        Scaled(const mesh::Mesh& mesh, ParallelFor parallel_for)
            : scale(mesh.positions),
              solid(scale.inwards(mesh), convex::Reference::solid, parallel_for) {}

        convex::SearchScale scale;
        convex::Solid solid;
    };

    [[nodiscard]] double error_of(const std::vector<Double3>& points, const Scaled& of) const {
        convex::HullErrorOptions options;
        options.relative = climb_.is_quick ? 0.1 : 0.02;
        options.most_cells = climb_.is_quick ? 4'000 : 50'000;
        const convex::ConvexHull hull = of.scale.inwards(convex::convex_hull(points));
        return of.scale.outwards(convex::find_hull_error(hull, of.solid, options)).upper;
    }

    const Climb& climb_;
    Scaled solid_a_;
    Scaled solid_b_;
};

std::vector<Double3> corners_of(const BoundingBox& box) {
    std::vector<Double3> corners;
    for (int i = 0; i < 8; ++i) {
        const double x = (i & 1) != 0 ? box.half.x : -box.half.x;
        const double y = (i & 2) != 0 ? box.half.y : -box.half.y;
        const double z = (i & 4) != 0 ? box.half.z : -box.half.z;
        const auto& [u, v, w] = box.axis;
        corners.push_back({box.centre.x + x * u.x + y * v.x + z * w.x,
                           box.centre.y + x * u.y + y * v.y + z * w.y,
                           box.centre.z + x * u.z + y * v.z + z * w.z});
    }
    return corners;
}

std::vector<Double3> corners_of(const BoundingDop& dop) {
    std::vector<Double3> corners;
    for (const Double3& p : dop.corners) {
        corners.push_back({dop.centre.x + p.x, dop.centre.y + p.y, dop.centre.z + p.z});
    }
    return corners;
}

/// Returns points whose hull contains the sphere and little more: a grid of directions at a radius
/// that covers the widest gap between neighbours.
std::vector<Double3> corners_around(const BoundingSphere& sphere) {
    constexpr int kRings = 24;
    constexpr int kSides = 48;
    constexpr double kPi = 3.14159265358979323846;
    // The angle from any direction to a corner is at most half the diagonal of a grid cell.
    const double widest = 0.5 * std::hypot(kPi / kRings, 2 * kPi / kSides);
    const double out = sphere.radius / std::cos(widest);
    std::vector<Double3> corners;
    for (int ring = 0; ring <= kRings; ++ring) {
        const double down = kPi * ring / kRings;
        for (int side = 0; side < kSides; ++side) {
            const double around = 2 * kPi * side / kSides;
            corners.push_back({sphere.centre.x + out * std::sin(down) * std::cos(around),
                               sphere.centre.y + out * std::sin(down) * std::sin(around),
                               sphere.centre.z + out * std::cos(down)});
        }
    }
    return corners;
}

/// The rungs and the structures behind them, at stable addresses.
class ShapeContenders {
public:
    ShapeContenders(const Climb& climb, Ladder& ladder)
        : climb_(climb), ladder_(ladder), outside_(climb) {}

    void add_all() {
        add_simple_shapes();
        add_hulls();
        add_parts();
        add_tetra_levels();
        add_octree_levels();
        add_hierarchies();
    }

    [[nodiscard]] std::deque<ShapeContender>& all() {
        return contenders_;
    }

private:
    [[nodiscard]] const Pose& pose(std::size_t number) const {
        return climb_.set.poses[number].a_from_b;
    }
    [[nodiscard]] Placement placement(std::size_t number) const {
        return Placement::b_moves(pose(number));
    }

    Rung& add(const std::string& name, const std::string& how, Promise promise,
              std::function<Answer(std::size_t)> ask) {
        ShapeContender contender;
        contender.rung.name = name;
        contender.rung.how = how;
        contender.rung.promise = promise;
        contender.ask = std::move(ask);
        // Shapes enclose the model. The boxes of a BVH are not a single shape.
        const bool is_shape = promise == Promise::no_misses || promise == Promise::both_sides;
        if (is_shape && !name.starts_with("float")) contender.rung.inner = 0;
        contenders_.push_back(std::move(contender));
        return contenders_.back().rung;
    }

    void add_simple_shapes() {
        climb_.begins("shapes");
        double sphere_s = 0;
        sphere_a_ = timed(sphere_s, [&] { return bounding_sphere(climb_.mesh_a); });
        sphere_b_ = timed(sphere_s, [&] { return bounding_sphere(climb_.mesh_b); });
        double box_s = 0;
        aligned_a_ = timed(box_s, [&] { return aligned_box(climb_.mesh_a); });
        aligned_b_ = timed(box_s, [&] { return aligned_box(climb_.mesh_b); });
        double oriented_s = 0;
        oriented_a_ = timed(oriented_s, [&] { return oriented_box(climb_.mesh_a); });
        oriented_b_ = timed(oriented_s, [&] { return oriented_box(climb_.mesh_b); });

        Rung& sphere = add(
            "sphere", "bounding spheres of the models", Promise::no_misses,
            [this](std::size_t i) { return hit_or_no(may_touch(sphere_a_, sphere_b_, pose(i))); });
        keep_all_read(sphere, sphere_s, 2 * sizeof(BoundingSphere));
        sphere.outer = outside_.of_points(corners_around(sphere_a_), corners_around(sphere_b_));
        Rung& box = add("box", "axis-aligned boxes: A's, and one around B's transformed box",
                        Promise::no_misses, [this](std::size_t i) {
                            return hit_or_no(may_touch_aligned(aligned_a_, aligned_b_, pose(i)));
                        });
        keep_all_read(box, box_s, 2 * sizeof(std::array<double, 6>));
        box.outer = outside_.of_points(corners_of(aligned_a_), corners_of(aligned_b_));
        Rung& oriented = add("oriented box", "oriented boxes, by the 15-axis test",
                             Promise::no_misses, [this](std::size_t i) {
                                 return hit_or_no(may_touch(oriented_a_, oriented_b_, pose(i)));
                             });
        keep_all_read(oriented, oriented_s, 2 * sizeof(BoundingBox));
        oriented.outer = outside_.of_points(corners_of(oriented_a_), corners_of(oriented_b_));
        add_polytopes();
    }

    void add_polytopes() {
        double seconds = 0;
        dop_a_ = timed(seconds, [&] { return bounding_dop(climb_.mesh_a); });
        dop_b_ = timed(seconds, [&] { return bounding_dop(climb_.mesh_b); });
        Rung& dop = add(
            "26-DOP", "polytopes of 26 faces, by the face directions of both", Promise::no_misses,
            [this](std::size_t i) { return hit_or_no(may_touch(dop_a_, dop_b_, pose(i))); });
        keep_all_read(dop, seconds, bytes_of_dop(dop_a_) + bytes_of_dop(dop_b_));
        dop.outer = outside_.of_points(corners_of(dop_a_), corners_of(dop_b_));
    }

    /// Returns the mean bytes that a query about two shapes reads; ask(pose, sum) adds them to sum.
    template <class Ask>
    [[nodiscard]] double mean_read(Ask ask) const {
        std::uint64_t read = 0;
        for (std::size_t i = 0; i < climb_.set.poses.size(); ++i) ask(i, read);
        return static_cast<double>(read) / static_cast<double>(climb_.set.poses.size());
    }

    void add_hulls() {
        if (!climb_.a.model.serves(Ask::hulls) || !climb_.b.model.serves(Ask::hulls)) return;
        const auto number_a = find_hull(climb_.a.model, format::HullScope::whole);
        const auto number_b = find_hull(climb_.b.model, format::HullScope::whole);
        if (!number_a || !number_b) return;
        hull_a_ = convex_points(climb_.a.model, *number_a);
        hull_b_ = convex_points(climb_.b.model, *number_b);
        Rung& hull =
            add("hull", "the convex hulls, by GJK", Promise::no_misses, [this](std::size_t i) {
                return hit_or_no(convex_collide(hull_a_, hull_b_, placement(i)));
            });
        hull.build_s = climb_.a.seconds.hulls + climb_.b.seconds.hulls;
        hull.bytes = bytes_of_hull(hull_a_) + bytes_of_hull(hull_b_);
        hull.outer = outside_.of_points(points_of(hull_a_), points_of(hull_b_));
    }

    void add_parts() {
        const std::vector<std::size_t> counts =
            climb_.is_quick ? std::vector<std::size_t>{2, 8}
                            : std::vector<std::size_t>{2, 4, 8, 16, 32, 64, 128, 256};
        const double share = climb_.is_quick ? kQuickPartShare_s : kPartShare_s;
        double spent = 0;
        double last = 0;
        for (const std::size_t count : counts) {
            climb_.begins(std::to_string(count) + " parts");
            if (spent + 2 * last > share) {
                ladder_.left_out.push_back(
                    std::to_string(count) +
                    " parts: building the sets of fewer parts took too long.");
                continue;
            }
            const double begun = processor_seconds();
            const std::size_t work = climb_.is_quick ? kQuickPartWork : kPartWork;
            auto a = make_part_set(climb_.mesh_a, count, work, climb_.parallel_for, climb_.stop);
            auto b = make_part_set(climb_.mesh_b, count, work, climb_.parallel_for, climb_.stop);
            if (!a || !b) return;
            last = processor_seconds() - begun;
            spent += last;
            add_part_rung(count, std::move(*a), std::move(*b));
        }
    }

    void add_part_rung(std::size_t count, PartSet a, PartSet b) {
        const auto& pair = parts_.emplace_back(std::move(a), std::move(b));
        const PartSet& in_a = pair.first;
        const PartSet& in_b = pair.second;
        Rung& rung = add(std::to_string(count) + " parts",
                         "enclosing parts, at most this number for each model", Promise::no_misses,
                         [this, &in_a, &in_b](std::size_t i) {
                             return hit_or_no(parts_touch(in_a, in_b, pose(i), centres_));
                         });
        rung.build_s = in_a.seconds + in_b.seconds;
        rung.bytes = in_a.bytes() + in_b.bytes();
        rung.touched = mean_read([&](std::size_t i, std::uint64_t& read) {
            static_cast<void>(parts_touch(in_a, in_b, pose(i), centres_, &read));
        });
        rung.outer = std::max(in_a.outer_error, in_b.outer_error) / climb_.set.diagonal;
    }

    void add_tetra_levels() {
        const std::vector<std::uint32_t> levels =
            climb_.is_quick ? std::vector<std::uint32_t>{0, 2, 4}
                            : std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 6};
        for (const std::uint32_t level : levels) {
            if (climb_.must_stop()) return;
            climb_.begins("tetra-tree level " + std::to_string(level));
            const MemoryParts parts = {.bounds = build::BvhBounds::aligned,
                                       .tetra_tree = build::TetraTreeOptions{
                                           .level = level, .threshold = kTetraThreshold}};
            auto a = make_memory_model(climb_.mesh_a, parts, climb_.parallel_for);
            auto b = make_memory_model(climb_.mesh_b, parts, climb_.parallel_for);
            if (!a || !b) return;
            const auto& pair = levels_.emplace_back(std::move(a).value(), std::move(b).value());
            const MemoryModel& in_a = pair.first;
            const MemoryModel& in_b = pair.second;
            Rung& rung = add("tetra-tree " + std::to_string(level),
                             "the facets of this level of both tetra-trees: yes, no or unknown",
                             Promise::both_sides, [this, &in_a, &in_b, level](std::size_t i) {
                                 return collide_at_level({in_a.model, in_b.model, placement(i)},
                                                         level, workspace_)
                                     .answer;
                             });
            constexpr format::SectionSet kNodes = {SectionId::tetra_tree, SectionId::tetra_nodes};
            // The error of a level comes from all nodes.
            keep_all_read(rung, in_a.seconds.tetra_tree + in_b.seconds.tetra_tree,
                          bytes_of(in_a, kNodes) + bytes_of(in_b, kNodes));
            rung.outer = std::max(level_error(in_a.model, level), level_error(in_b.model, level)) /
                         climb_.set.diagonal;
        }
    }

    void add_octree_levels() {
        const std::vector<std::uint32_t> levels =
            climb_.is_quick ? std::vector<std::uint32_t>{3, 5}
                            : std::vector<std::uint32_t>{2, 3, 4, 5, 6, 7, 8, 9};
        for (const std::uint32_t level : levels) {
            if (climb_.must_stop()) return;
            climb_.begins("octree level " + std::to_string(level));
            double seconds = 0;
            const auto build = [&](const MemoryModel& model) {
                return timed(seconds, [&] {
                    return CellModel{build::build_octree(model.ordered.positions,
                                                         model.ordered.triangles,
                                                         {.parallel_for = climb_.parallel_for,
                                                          .level = level,
                                                          .threshold = 1,
                                                          .hashed = false})};
                });
            };
            const auto& pair = cells_.emplace_back(build(climb_.a), build(climb_.b));
            const CellModel& in_a = pair.first;
            const CellModel& in_b = pair.second;
            Rung& rung = add("octree " + std::to_string(level),
                             "the cells of this level that contain part of the surface",
                             Promise::no_misses, [this, &in_a, &in_b](std::size_t i) {
                                 return hit_or_no(cells_may_meet(in_a, in_b, pose(i), pending_));
                             });
            keep(rung, seconds, in_a.bytes() + in_b.bytes());
            rung.touched = mean_read([&](std::size_t i, std::uint64_t& read) {
                std::uint64_t pairs = 0;
                static_cast<void>(cells_may_meet(in_a, in_b, pose(i), pending_, &pairs));
                read += 2 * sizeof(format::OctreeNode) * pairs;
            });
            rung.outer = std::sqrt(3.0) * std::max(in_a.edge(), in_b.edge()) / climb_.set.diagonal;
        }
    }

    void add_hierarchies() {
        const double tree_s = climb_.a.seconds.tree + climb_.b.seconds.tree;
        const std::uint64_t bytes =
            bytes_of(climb_.a, kTreeSections) + bytes_of(climb_.b, kTreeSections);
        const auto add_float = [&](const char* name, const char* how, Promise promise,
                                   bool doubt_hits) {
            Rung& rung = add(name, how, promise, [this, doubt_hits](std::size_t i) {
                return hit_or_no(float_hit(i, doubt_hits));
            });
            keep(rung, tree_s, bytes);
            rung.touched = tree_read([&](std::size_t i) { float_hit(i, doubt_hits); });
            count_float_pairs(doubt_hits, rung);
        };
        add_float("float, doubt hits", "the BVH in float; undecided pairs count as hits",
                  Promise::no_misses, true);
        add_float("float, doubt misses", "the BVH in float; undecided pairs count as apart",
                  Promise::no_false_hits, false);
        Rung& exact =
            add("exact", "the BVH in float, then double, then exact", Promise::exact,
                [this](std::size_t i) {
                    return hit_or_no(
                        collide({climb_.a.model, climb_.b.model, placement(i)}, workspace_).hit ==
                        Answer::yes);
                });
        keep(exact, tree_s, bytes);
        exact.touched = tree_read([&](std::size_t i) {
            static_cast<void>(collide({climb_.a.model, climb_.b.model, placement(i)}, workspace_));
        });
        exact.outer = 0;
        exact.inner = 0;
        for (const PairCounts& counts : contenders_[contenders_.size() - 2].rung.pair_counts) {
            exact.pair_counts.push_back({counts.wanted, counts.wanted, counts.wanted});
        }
        exact.pairs = pair_errors(exact.pair_counts);
    }

    [[nodiscard]] double tree_read(const std::function<void(std::size_t)>& ask) {
        return mean_bytes_read(climb_.a.model, climb_.b.model, workspace_, climb_.set.poses.size(),
                               ask);
    }

    bool float_hit(std::size_t number, bool doubt_hits) {
        bool hit = false;
        const auto visit = [&](const FloatContact& contact) {
            hit = contact.certain || doubt_hits;
            return !hit;
        };
        visit_float_contacts({climb_.a.model, climb_.b.model, placement(number)}, workspace_,
                             FloatSearch::first, visit);
        return hit;
    }

    void count_float_pairs(bool doubt_counts, Rung& rung) {
        std::vector<TrianglePair> wanted;
        std::vector<TrianglePair> found;
        std::vector<TrianglePair> both;
        for (std::size_t i = 0; i < climb_.set.poses.size(); ++i) {
            wanted.clear();
            found.clear();
            both.clear();
            const auto want = [&](const TrianglePair& pair) {
                wanted.push_back(pair);
                return true;
            };
            visit_overlaps({climb_.a.model, climb_.b.model, placement(i)}, workspace_, want);
            const auto find = [&](const FloatContact& contact) {
                if (contact.certain || doubt_counts) found.push_back({contact.a, contact.b});
                return true;
            };
            visit_float_contacts({climb_.a.model, climb_.b.model, placement(i)}, workspace_,
                                 FloatSearch::all, find);
            std::ranges::sort(wanted);
            std::ranges::sort(found);
            std::ranges::set_intersection(wanted, found, std::back_inserter(both));
            rung.pair_counts.push_back({wanted.size(), found.size(), both.size()});
        }
        rung.pairs = pair_errors(rung.pair_counts);
    }

    static void keep(Rung& rung, double build_s, std::uint64_t bytes) {
        rung.build_s = build_s;
        rung.bytes = bytes;
    }

    /// Sets the build time and bytes of structures that every query reads completely.
    static void keep_all_read(Rung& rung, double build_s, std::uint64_t bytes) {
        keep(rung, build_s, bytes);
        rung.touched = static_cast<double>(bytes);
    }

    static std::uint64_t bytes_of_dop(const BoundingDop& dop) {
        return sizeof(Double3) * (1 + dop.corners.size()) + sizeof dop.lower + sizeof dop.upper;
    }

    static std::vector<Double3> points_of(const ConvexPoints& hull) {
        std::vector<Double3> points;
        for (std::uint32_t i = 0; i < hull.count; ++i) points.push_back(hull.point(i));
        return points;
    }

    static std::uint64_t bytes_of_hull(const ConvexPoints& hull) {
        return hull.blocks.size_bytes() + hull.neighbour_begins.size_bytes() +
               hull.neighbours.size_bytes() + hull.starts.size_bytes();
    }

    const Climb& climb_;
    Ladder& ladder_;
    Outside outside_;
    std::deque<ShapeContender> contenders_;
    Workspace workspace_{cells()};
    BoundingSphere sphere_a_;
    BoundingSphere sphere_b_;
    BoundingBox aligned_a_;
    BoundingBox aligned_b_;
    BoundingBox oriented_a_;
    BoundingBox oriented_b_;
    BoundingDop dop_a_;
    BoundingDop dop_b_;
    ConvexPoints hull_a_;
    ConvexPoints hull_b_;
    std::deque<std::pair<PartSet, PartSet>> parts_;
    std::deque<std::pair<MemoryModel, MemoryModel>> levels_;
    std::deque<std::pair<CellModel, CellModel>> cells_;
    std::vector<Double3> centres_;
    std::vector<std::uint64_t> pending_;
};

}  // namespace

Ladder climb_geometry(const Climb& climb, Broken& broken) {
    Ladder ladder;
    ladder.name = "geometry";
    ladder.question = "do the surfaces touch, by enclosing shapes";
    ladder.error =
        "false hits, as a share of the poses that are apart; for rungs that may miss or are exact, "
        "wrong answers, as a share of all poses";
    ladder.cases = "pose";
    ladder.left_out.emplace_back(
        "Bytes read by the hull's rung are missing: the vertices that its search visits are not "
        "counted.");
    ladder.left_out.emplace_back(
        "Level E3 is not a rung: queries answer at E1; columns count the poses at which the answer "
        "is proved at E3.");
    ShapeContenders contenders(climb, ladder);
    contenders.add_all();
    if (climb.must_stop()) return ladder;

    climb.begins("geometry: queries");
    const std::size_t poses = climb.set.poses.size();
    std::vector<Question> questions;
    for (ShapeContender& contender : contenders.all()) {
        for (std::size_t i = 0; i < poses && !climb.must_stop(); ++i) {
            contender.rung.answers.push_back(contender.ask(i));
        }
        questions.push_back(question_of(
            [&contender](std::size_t i) { return static_cast<std::uint64_t>(contender.ask(i)); }));
    }
    const std::vector<Timings> timings = time_questions(poses, questions, climb.timing);
    if (climb.must_stop()) return ladder;
    std::size_t number = 0;
    for (ShapeContender& contender : contenders.all()) {
        keep_time(climb.set, timings[number++], contender.rung);
        judge_answers(ladder.name, climb.set, contender.rung, broken);
        judge_pairs(ladder.name, contender.rung, broken);
        ladder.rungs.push_back(std::move(contender.rung));
    }
    return ladder;
}

}  // namespace cdprep::study
