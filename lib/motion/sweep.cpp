// SPDX-License-Identifier: MIT
#include "cdprep/sweep.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>

#include "build/frame_map.h"
#include "build/make_nodes.h"
#include "cdprep/advanced/convex_distance.h"
#include "cdprep/format/float_environment.h"
#include "core/carver.h"
#include "core/moved_model.h"
#include "core/numbers.h"
#include "core/require.h"
#include "exact/length_of.h"
#include "exact/vectors.h"
#include "motion/moving_body.h"
#include "walk/leaf_batch.h"
#include "walk/smallest_pairs.h"
#include "walk/walk_pairs.h"

// The walk takes B where it is at time 1/2. At other times its points are at most half of its
// motion away, so boxes are widened by that.
//
// Pairs of triangles are tested in B's own coordinates, where B does not move. Let y be a corner's
// place relative to the centre of B's turn. It moves evenly, so its length is greatest at an end.
// Seen from B, which turns at the rate w, the corner's acceleration is at most w^2 |y| + 2 w |y'|.
// So its path leaves the straight line between its ends by an eighth of this at most. The triangle
// stays within that distance of the convex hull of its six corners at both ends. This is done for
// parts of the step in which B turns little.

namespace cdprep {

using build::Frame;
using format::BvhNode;
using format::kBvhWidth;

/// What a sweep keeps in the caller's memory.
struct Sweep::Storage {
    std::span<Double3> start;  ///< positions at time 0
    std::span<BvhNode> nodes;  ///< the model's hierarchy, with boxes around the ways
    Frame frame;               ///< of these boxes
    bool is_empty = true;      ///< the model has no triangles
    bool has_ended = false;    ///< begin() was not called since the last end()
    std::uint64_t shape = 0;   ///< the content hash of the model at the last end()
};

namespace {

/// What Carver takes of the memory.
struct Room {
    Sweep::Storage* storage;
    Double3* start;
    BvhNode* nodes;

    Room(Carver& carver, const Model& model) noexcept
        : storage(carver.take_room<Sweep::Storage>()),
          start(carver.take<Double3>(model.vertex_count())),
          nodes(carver.take<BvhNode>(model.bvh().nodes.size())) {}
};

/// Calls use(triangle) for each triangle of a leaf.
template <class Use>
void for_triangles(const Model& model, std::uint32_t leaf, std::uint8_t used, Use&& use) noexcept {
    for (unsigned lanes = used; lanes != 0; lanes &= lanes - 1) {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
        use(model.mesh().triangles[leaf * kBvhWidth + lane]);
    }
}

struct Bounds {
    std::array<double, 3> lower = {kInfinity, kInfinity, kInfinity};
    std::array<double, 3> upper = {-kInfinity, -kInfinity, -kInfinity};

    void add(const Double3& p) noexcept {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            lower[axis] = std::min(lower[axis], build::coordinate(p, axis));
            upper[axis] = std::max(upper[axis], build::coordinate(p, axis));
        }
    }
};

/// The boxes around the ways of a model's triangles.
class SweptBoxes {
public:
    SweptBoxes(const Model& model, Sweep::Storage& to) noexcept
        : model_(model), to_(to), now_(model, nullptr), used_(model) {}

    void make() noexcept {
        Bounds all;
        const auto leaves = static_cast<std::uint32_t>(model_.bvh().leaves.size());
        for (std::uint32_t leaf = 0; leaf < leaves; ++leaf) add(leaf, all);
        to_.is_empty = all.lower[0] > all.upper[0];
        if (to_.is_empty) return;
        to_.frame = build::frame_of({all.lower, all.upper, false});
        const build::FrameMap map(to_.frame);
        for (std::uint32_t leaf = 0; leaf < leaves; ++leaf) fit(leaf, map);
        build::set_unused_boxes(node_of(leaves - 1), (leaves - 1) % kBvhWidth + 1);
        build::make_nodes(to_.nodes, model_.triangle_count(), serial_for);
    }

private:
    void add(std::uint32_t leaf, Bounds& bounds) const noexcept {
        for_triangles(model_, leaf, used_(leaf), [&](const format::Triangle& triangle) {
            for (const std::uint32_t vertex : triangle.vertex) {
                bounds.add(to_.start[vertex]);
                bounds.add(now_.position(vertex));
            }
        });
    }
    [[nodiscard]] BvhNode& node_of(std::uint32_t leaf) const noexcept {
        return to_.nodes[model_.bvh().shape.first[0] + leaf / kBvhWidth];
    }
    void fit(std::uint32_t leaf, const build::FrameMap& map) const noexcept {
        BvhNode& node = node_of(leaf);
        const std::size_t box = leaf % kBvhWidth;
        Bounds bounds;
        add(leaf, bounds);
        if (bounds.lower[0] > bounds.upper[0]) return build::set_unused_box(node, box);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            node.lower[axis][box] = map.around(bounds.lower[axis], axis).lower;
            node.upper[axis][box] = map.around(bounds.upper[axis], axis).upper;
        }
    }

    const Model& model_;
    Sweep::Storage& to_;
    MovedModel now_;
    UsedLanes used_;
};

/// Points of few corners, as ConvexPoints takes them.
template <std::size_t kCount>
struct FewPoints {
    std::array<Double3, kCount> points;
    Double3 lower;
    Double3 upper;

    void bound() noexcept {
        lower = upper = points[0];
        for (const Double3& p : points) {
            lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
            upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
        }
    }
    [[nodiscard]] Box3 box() const noexcept {
        return {lower, upper};
    }
    [[nodiscard]] ConvexPoints convex() const noexcept {
        static constexpr std::array<std::uint32_t, 6> kNumbers = {0, 1, 2, 3, 4, 5};
        ConvexPoints hull;
        hull.count = kCount;
        hull.reach = {std::max(std::fabs(lower.x), std::fabs(upper.x)),
                      std::max(std::fabs(lower.y), std::fabs(upper.y)),
                      std::max(std::fabs(lower.z), std::fabs(upper.z))};
        hull.corners = std::span(kNumbers).first(kCount);
        hull.doubles = points;
        return hull;
    }
};

/// B turns by this at most in a part of the step, unless there are too many parts.
constexpr double kMostTurnOfPart = 0.25;
constexpr std::size_t kMostParts = 64;

/// The way of a triangle in a part of the step, seen from B.
struct Way {
    FewPoints<6> ends;
    double reach;  ///< the triangle stays within this of the hull of its ends
};

class SweepSearch {
public:
    SweepSearch(const Sweep& sweep, const Model& b, const Motion& motion,
                Workspace& workspace) noexcept
        : a_(sweep.model()),
          b_(b),
          from_(sweep.storage()),
          motion_(motion.parts()),
          body_(b, motion),
          parts_(static_cast<std::size_t>(
              std::clamp(std::ceil(motion_.angle / kMostTurnOfPart), 1.0, double{kMostParts}))),
          now_(a_, nullptr),
          still_(b, nullptr),
          used_a_(a_),
          used_b_(b),
          middle_(Placement::b_moves(motion.at(0.5))),
          scratch_(workspace.storage()) {
        for (std::size_t i = 0; i <= parts_; ++i) poses_[i] = motion.at(time_of(i));
    }

    /// Calls `found(a, b)`, tree order. Stops and returns false when `found` returns false.
    template <class Found>
    bool run(Found&& found) noexcept {
        format::FileHeader header = a_.header();
        header.frame_origin = from_.frame.origin;
        header.frame_exponent = from_.frame.exponent;
        PlacedBoxes placed = place_boxes(header, b_.header(), middle_);
        margin_ = margin(header);
        const double way = (length_of(motion_.shift) + body_.turning_speed()) / 2 + margin_;
        placed.placement.tolerance = float_reach(std::ldexp(way, placed.exponent) * (1 + 0x1p-18));
        Tree tree_a(a_);
        tree_a.nodes = from_.nodes.data();
        tree_a.oriented = nullptr;
        tree_a.swept = nullptr;
        const Tree tree_b(b_);
        return walk_pairs_from<Search::all>(
            roots(tree_a, tree_b), 0, tree_a, tree_b, placed, scratch_,
            [&](const PendingPair& pair) { return test(pair.a.index, pair.b.index, found); });
    }

private:
    /// Returns a bound of how far a corner is off its ideal place in B's coordinates, twice.
    [[nodiscard]] double margin(const format::FileHeader& frame) const noexcept {
        const double places = largest_of(frame.frame_origin) +
                              std::ldexp(1, -frame.frame_exponent) +
                              largest_of(motion_.start.translation()) +
                              largest_of(motion_.end.translation()) + largest_of(motion_.centre);
        return 2 * body_.deviation() + 16 * Pose::kRotationTolerance * places;
    }
    template <class Found>
    bool test(std::uint32_t leaf_a, std::uint32_t leaf_b, Found&& found) noexcept;
    /// Returns when part `part` begins.
    [[nodiscard]] double time_of(std::size_t part) const noexcept {
        return static_cast<double>(part) / static_cast<double>(parts_);
    }
    [[nodiscard]] Way way_of(std::uint32_t place, std::size_t part) const noexcept;
    [[nodiscard]] FewPoints<3> triangle_of(std::uint32_t place) const noexcept {
        const Corners corners = still_.corners(place);
        FewPoints<3> points = {corners, {}, {}};
        points.bound();
        return points;
    }
    [[nodiscard]] bool is_near(const Way& way, const FewPoints<3>& triangle) const noexcept {
        if (axis_gap(way.ends.box(), triangle.box()) > way.reach) return false;
        return convex_within(way.ends.convex(), triangle.convex(), Placement::b_moves(Pose()),
                             way.reach);
    }

    const Model& a_;
    const Model& b_;
    const Sweep::Storage& from_;
    const Motion::Parts& motion_;
    MovingBody body_;
    std::size_t parts_;
    std::array<Pose, kMostParts + 1> poses_;  ///< of B where the parts begin and end
    std::array<Way, kMostParts> ways_;        ///< of one triangle
    MovedModel now_;                          ///< A at time 1
    MovedModel still_;                        ///< B in its own coordinates
    UsedLanes used_a_;
    UsedLanes used_b_;
    Placement middle_;
    Workspace::Storage& scratch_;
    double margin_ = 0;
};

Way SweepSearch::way_of(std::uint32_t place, std::size_t part) const noexcept {
    const format::Triangle& triangle = a_.mesh().triangles[place];
    const double turn = motion_.angle / static_cast<double>(parts_);
    Way way{};
    double bend = 0;
    for (std::size_t corner = 0; corner < 3; ++corner) {
        const Double3 start = from_.start[triangle.vertex[corner]];
        const Double3 shift = now_.position(triangle.vertex[corner]) - start;
        std::array<Double3, 2> arm{};
        for (std::size_t end = 0; end < 2; ++end) {
            const double time = time_of(part + end);
            const Pose& pose = poses_[part + end];
            const Double3 at = start + time * shift;
            way.ends.points[3 * end + corner] = turned_back(&pose, at - pose.translation());
            arm[end] = at - (motion_.start_of_centre + time * motion_.shift);
        }
        bend = std::max(bend, turn * turn * std::max(length_of(arm[0]), length_of(arm[1])) +
                                  2 * turn * length_of(arm[1] - arm[0]));
    }
    way.ends.bound();
    way.reach = bend / 8 * (1 + 0x1p-40) + margin_;
    return way;
}

template <class Found>
bool SweepSearch::test(std::uint32_t leaf_a, std::uint32_t leaf_b, Found&& found) noexcept {
    std::array<FewPoints<3>, kBvhWidth> triangles;
    for (unsigned lanes = used_b_(leaf_b); lanes != 0; lanes &= lanes - 1) {
        const auto j = static_cast<std::uint32_t>(std::countr_zero(lanes));
        triangles[j] = triangle_of(leaf_b * kBvhWidth + j);
    }
    for (unsigned lanes_a = used_a_(leaf_a); lanes_a != 0; lanes_a &= lanes_a - 1) {
        const auto i = static_cast<std::uint32_t>(std::countr_zero(lanes_a));
        for (std::size_t part = 0; part < parts_; ++part) {
            ways_[part] = way_of(leaf_a * kBvhWidth + i, part);
        }
        for (unsigned lanes_b = used_b_(leaf_b); lanes_b != 0; lanes_b &= lanes_b - 1) {
            const auto j = static_cast<std::uint32_t>(std::countr_zero(lanes_b));
            const auto is_near_in = [&](const Way& way) { return is_near(way, triangles[j]); };
            if (std::none_of(ways_.begin(), ways_.begin() + parts_, is_near_in)) continue;
            if (!found(leaf_a * kBvhWidth + i, leaf_b * kBvhWidth + j)) return false;
        }
    }
    return true;
}

/// Calls `found(a, b)` for each pair that may touch, until it returns false.
template <class Found>
bool for_each_pair(const Sweep& sweep, const Model& b, const Motion& motion, Workspace& workspace,
                   Found&& found) noexcept {
    require(b, Ask::within);
    if (!sweep.is_current()) {
        stop_with(
            "The model of a Sweep has changed since Sweep::end(), or the step has not ended.");
    }
    if (sweep.storage().is_empty || b.triangle_count() == 0) return true;
    return SweepSearch(sweep, b, motion, workspace).run(found);
}

}  // namespace

std::size_t Sweep::bytes(const Model& model) noexcept {
    Carver carver(nullptr);
    const Room room(carver, model);
    return carver.used();
}

std::optional<Sweep> Sweep::in(std::span<std::byte> memory, const Model& model) noexcept {
    const format::FloatEnvironment environment;
    require(model, Ask::within | Ask::corners);
    const bool is_aligned =
        reinterpret_cast<std::uintptr_t>(memory.data()) % format::kSectionAlignment == 0;
    if (!is_aligned || memory.size() < bytes(model)) return std::nullopt;
    Carver carver(memory.data());
    const Room room(carver, model);
    auto* const storage = std::construct_at(room.storage);
    storage->start = {room.start, model.vertex_count()};
    storage->nodes = {room.nodes, model.bvh().nodes.size()};
    Sweep sweep(model, *storage);
    sweep.begin();
    sweep.end();
    return sweep;
}

void Sweep::begin() noexcept {
    const format::FloatEnvironment environment;
    storage_->has_ended = false;
    const MovedModel now(*model_, nullptr);
    for (std::uint32_t i = 0; i < storage_->start.size(); ++i) {
        storage_->start[i] = now.position(i);
    }
}

void Sweep::end() noexcept {
    const format::FloatEnvironment environment;
    SweptBoxes(*model_, *storage_).make();
    storage_->shape = model_->header().content_hash;
    storage_->has_ended = true;
}

bool Sweep::is_current() const noexcept {
    return storage_->has_ended && storage_->shape == model_->header().content_hash;
}

bool may_touch(const Sweep& sweep, const Model& b, const Motion& motion,
               Workspace& workspace) noexcept {
    const format::FloatEnvironment environment;
    const auto stop = [](std::uint32_t, std::uint32_t) { return false; };
    return !for_each_pair(sweep, b, motion, workspace, stop);
}

std::size_t pairs_that_may_touch(const Sweep& sweep, const Model& b, const Motion& motion,
                                 Workspace& workspace, std::span<TrianglePair> room) noexcept {
    const format::FloatEnvironment environment;
    return keep_smallest_pairs(sweep.model(), b, workspace, room, [&](auto&& found) {
        for_each_pair(sweep, b, motion, workspace, found);
    });
}

}  // namespace cdprep
