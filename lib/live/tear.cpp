// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cassert>
#include <string>

#include "build/bad_argument.h"
#include "build/frame_map.h"
#include "build/lanes.h"
#include "build/make_nodes.h"
#include "build/mesh_fault.h"
#include "core/numbers.h"
#include "live/live_state.h"

// Triangles lie in an implicit tree, of whose places some are free. A new one descends from the
// root to a leaf, each time into the box that grows least of those with room. The higher a subtree,
// the more of its places must be free; so below a node with room there is always a child with room.
// If a box without room would grow much less, the triangles of the node are distributed anew, once
// for all that came together. So does a packed-memory array (Bender, Demaine and Farach-Colton
// 2005). Here boxes decide too, and large subtrees stay as they are, so that no change takes long.

namespace cdprep {
namespace {

using build::bad_argument;
using format::BvhNode;
using format::Double3;
using format::kBvhWidth;
using format::Triangle;

/// Ids count upward to this.
constexpr std::uint32_t kIdLimit = 0x7fffffff;

/// The lanes of a leaf without a free place.
constexpr std::uint8_t kFullLeaf = 0xff;

/// What stands at a place without a triangle.
constexpr Triangle kNoTriangle = {{0, 0, 0}};

/// Returns a number that differs, almost certainly, for other triangles. The constants are odd and
/// have about as many ones as zeros.
std::uint64_t hash_of(std::uint32_t id, const Triangle& triangle) {
    std::uint64_t hash = (id + std::uint64_t{1}) * 0x9e3779b97f4a7c15;
    for (const std::uint32_t vertex : triangle.vertex) {
        hash = (hash ^ (hash >> 32) ^ vertex) * 0xd6e8feb86659fd93;
    }
    return hash ^ (hash >> 32);
}

/// A triangle is worth a redistribution if a box without room would grow less, by more than this
/// share of the extents of the box with room. With less, appending takes longer; with more, boxes
/// become larger.
constexpr float kFar = 0.25;

/// The box of a triangle in the frame, and the sum of its extents.
struct TriangleBox {
    std::array<build::Interval, 3> around;
    float size = 0;
};

using Growths = build::Lanes<float, kBvhWidth>;

/// An unused box has a lower bound above its upper one.
bool is_unused(const BvhNode& node, std::size_t box) {
    return node.lower[0][box] > node.upper[0][box];
}

/// Returns by how much the extents of each box of a node grow, in sum, with a triangle.
Growths growths_of(const BvhNode& node, const TriangleBox& box) {
    Growths sums = build::all_lanes<float, kBvhWidth>(0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const build::Interval& around = box.around[axis];
        build::for_lanes<kBvhWidth>([&](std::size_t lane) {
            const float below = node.lower[axis][lane] - around.lower;
            const float above = around.upper - node.upper[axis][lane];
            sums[lane] += (below > 0 ? below : 0) + (above > 0 ? above : 0);
        });
    }
    build::for_lanes<kBvhWidth>(
        [&](std::size_t lane) { sums[lane] = is_unused(node, lane) ? box.size : sums[lane]; });
    return sums;
}

/// Returns the sum of the extents of a box, 0 if it is unused.
float extents_of(const BvhNode& node, std::size_t box) {
    if (is_unused(node, box)) return 0;
    float sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        sum += node.upper[axis][box] - node.lower[axis][box];
    }
    return sum;
}

void grow(BvhNode& node, std::size_t box, const TriangleBox& by) {
    const bool is_first = is_unused(node, box);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        float& lower = node.lower[axis][box];
        float& upper = node.upper[axis][box];
        const auto [below, above] = by.around[axis];
        lower = is_first ? below : std::min(lower, below);
        upper = is_first ? above : std::max(upper, above);
    }
}

constexpr build::Extent kNoExtent = {
    {kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}, true};

void grow(build::Extent& extent, const Double3& p) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        extent.lower[axis] = std::min(extent.lower[axis], build::coordinate(p, axis));
        extent.upper[axis] = std::max(extent.upper[axis], build::coordinate(p, axis));
    }
}

TriangleBox box_of(const build::Frame& frame, const Corners& c) {
    const build::FrameMap map(frame);
    TriangleBox box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto [low, high] =
            std::minmax({build::coordinate(c[0], axis), build::coordinate(c[1], axis),
                         build::coordinate(c[2], axis)});
        box.around[axis] = {map.around(low, axis).lower, map.around(high, axis).upper};
        box.size += box.around[axis].upper - box.around[axis].lower;
    }
    return box;
}

}  // namespace

void LiveModel::State::start_to_tear(const LiveBase& base, const LiveLimits& limits,
                                     const LiveStart& start) {
    TearTables& tear = *tables.tear;
    tear.limit = limits.triangles;
    tear.count = static_cast<std::uint32_t>(base.triangles.size());
    tear.next_id = tear.count;
    tear.positions = static_cast<std::uint32_t>(base.number_count());
    std::ranges::copy(start.lanes(), tear.lanes.begin());
    for (std::uint32_t place = 0; place < triangles.size(); ++place) {
        if (!is_taken(place)) {
            triangles[place] = kNoTriangle;
            continue;
        }
        tables.users.add(place, triangles[place]);
        count_at(place, 1);
        tear.ids.set(source_triangle[place], place);
        tear.hash += hash_of(source_triangle[place], triangles[place]);
    }
    // What the free places of the image added.
    const auto places = static_cast<std::uint32_t>(triangles.size());
    if (!components.empty()) components[0].triangle_count -= places - tear.count;
    model.set_lanes(tear.lanes, tear.next_id);
    fit_leaves({0, model.bvh().shape.leaf_count});
    update_header();
}

// --- What is refused --------------------------------------------------------------------

std::optional<Error> LiveModel::State::find_fault(std::span<const Triangle> added) const {
    if (!tables.tear) {
        return bad_argument(
            "This live model cannot tear: make it with a limit of triangles (LiveLimits).");
    }
    const TearTables& tear = *tables.tear;
    if (is_own(std::as_bytes(added))) {
        return bad_argument(
            "The triangles point into the live model itself, which changes them: give a copy.");
    }
    if (added.size() > tear.limit - tear.count) {
        return bad_argument("The live model has " + std::to_string(tear.count) +
                            " triangles and room for " + std::to_string(tear.limit) + "; " +
                            std::to_string(added.size()) + " more do not fit.");
    }
    if (added.size() > kIdLimit - tear.next_id) {
        return bad_argument("Triangles have been numbered up to " + std::to_string(tear.next_id) +
                            ", and no number may exceed " + std::to_string(kIdLimit) +
                            ": build a new live model.");
    }
    if (auto fault = build::find_bad_triangle(tables.vertex_of.size(), added)) return fault;
    for (std::size_t i = 0; i < added.size(); ++i) {
        for (const std::uint32_t vertex : added[i].vertex) {
            if (tables.vertex_of[vertex] != kUnusedVertex) continue;
            return bad_argument("Triangle " + std::to_string(i) + " uses vertex " +
                                std::to_string(vertex) +
                                ", which has no position: give it one with refit().");
        }
    }
    return std::nullopt;
}

std::optional<Error> LiveModel::State::find_fault(std::span<const std::uint32_t> removed) const {
    if (!tables.tear) {
        return bad_argument(
            "This live model cannot tear: make it with a limit of triangles (LiveLimits).");
    }
    if (is_own(std::as_bytes(removed))) {
        return bad_argument(
            "The numbers point into the live model itself, which changes them: give a copy.");
    }
    const auto missing = std::ranges::find_if(
        removed, [&](std::uint32_t id) { return tables.tear->ids.find(id) == IdMap::kNone; });
    if (missing == removed.end()) return std::nullopt;
    return bad_argument(
        "Triangle " + std::to_string(*missing) +
        (*missing < tables.tear->next_id ? " was removed before." : " was never appended."));
}

// --- Changes ----------------------------------------------------------------------------

void LiveModel::State::append(std::span<const Triangle> added) {
    if (added.empty()) return;
    widen_frame(added);
    for (const Triangle& triangle : added) insert(triangle);
    redistribute_marked();
    note_places(tables.tear->hash);
    fit_changed(serial_for);
    note_tear();
}

void LiveModel::State::remove(std::span<const std::uint32_t> removed) {
    for (const std::uint32_t id : removed) {
        const std::uint32_t place = tables.tear->ids.find(id);
        if (place == IdMap::kNone) continue;  // listed twice
        tables.changed.mark(place / kBvhWidth);
        tables.tear->ids.erase(id);
        tables.tear->hash -= hash_of(id, triangles[place]);
        --tables.tear->count;
        take_out(place);
    }
    fit_changed(serial_for);
    if (!removed.empty()) note_tear();
}

/// Winding numbers and components are those of the triangles that were.
void LiveModel::State::note_tear() {
    model.set_torn(tables.tear->next_id);
    update_header();
}

build::Extent LiveModel::State::used_extent() const {
    build::Extent extent = kNoExtent;
    with_positions([&](const auto& positions) {
        for (std::uint32_t vertex = 0; vertex < tables.tear->positions; ++vertex) {
            if (tables.users.is_used(vertex)) grow(extent, build::as_double(positions[vertex]));
        }
    });
    return extent;
}

/// Chooses a new frame if the present one does not hold all vertices of new triangles.
void LiveModel::State::widen_frame(std::span<const Triangle> added) {
    const FrameBounds bounds = frame_bounds();
    const bool fits = std::ranges::all_of(added, [&](const Triangle& triangle) {
        const Corners c = corners(triangle);
        return bounds.hold(c[0]) && bounds.hold(c[1]) && bounds.hold(c[2]);
    });
    if (fits) return;
    build::Extent extent = used_extent();
    for (const Triangle& triangle : added) {
        for (const Double3& p : corners(triangle)) grow(extent, p);
    }
    frame_ = build::frame_of(extent);
    fit_all(serial_for);
}

void LiveModel::State::insert(const Triangle& triangle) {
    TearTables& tear = *tables.tear;
    const NumberedTriangle added = {triangle, tear.next_id++};
    tear.hash += hash_of(added.number, triangle);
    ++tear.count;
    const std::uint32_t leaf = choose_leaf(triangle);
    const auto lane = static_cast<std::uint32_t>(std::countr_one(tear.lanes[leaf]));
    assert(lane < kBvhWidth);
    put(leaf * kBvhWidth + lane, added);
    tables.changed.mark(leaf);
}

std::uint32_t LiveModel::State::choose_leaf(const Triangle& triangle) {
    const TriangleBox box = box_of(frame_, corners(triangle));
    const format::BvhShape& shape = model.bvh().shape;
    std::uint32_t place = 0;
    for (std::uint32_t level = shape.levels; level-- > 0;) {
        const std::uint32_t number = shape.first[level] + place;
        const Growths growths = growths_of(nodes[number], box);
        const std::uint32_t used = shape.used_boxes(level, place);
        const auto least = *std::min_element(growths.begin(), growths.begin() + used);
        std::uint32_t best = kBvhWidth;
        for (std::uint32_t child = 0; child < used; ++child) {
            const bool is_better = best == kBvhWidth || growths[child] < growths[best];
            if (is_better && has_room(level, place * kBvhWidth + child)) best = child;
        }
        assert(best < kBvhWidth);
        const bool is_far = growths[best] - least > kFar * extents_of(nodes[number], best);
        if (is_far && level < kSubtreeLevels) tables.tear->marked.set(number);
        // The boxes are fitted when all triangles have come. Until then, only those of leaves grow:
        // a large box would attract triangles that are far away.
        if (level == 0) grow(nodes[number], best, box);
        place = place * kBvhWidth + best;
    }
    return place;
}

void LiveModel::State::redistribute_marked() {
    const format::BvhShape& shape = model.bvh().shape;
    // Nodes are in the order of their levels, the highest first.
    tables.tear->marked.take_all([&](std::uint32_t number) {
        std::uint32_t level = 0;
        while (number < shape.first[level]) ++level;
        const std::uint32_t bits = 3 * (level + 1);
        const std::uint32_t first = (number - shape.first[level]) << bits;
        const LeafRange range = {first, std::min(first + (1U << bits), shape.leaf_count)};
        redistribute(range);
        for (std::uint32_t leaf = range.first; leaf < range.last; ++leaf) tables.changed.mark(leaf);
        for (std::uint32_t below = 0; below < level; ++below) {
            const std::uint32_t start = shape.first[below];
            tables.tear->marked.clear(start + (range.first >> (3 * (below + 1))),
                                      start + ((range.last - 1) >> (3 * (below + 1))) + 1);
        }
    });
}

void LiveModel::State::put(std::uint32_t place, const NumberedTriangle& added) {
    triangles[place] = added.triangle;
    source_triangle[place] = added.number;
    tables.users.add(place, added.triangle);
    if (!tables.tear) return;
    tables.tear->lanes[place / kBvhWidth] |= static_cast<std::uint8_t>(1U << (place % kBvhWidth));
    tables.tear->ids.set(added.number, place);
    count_at(place, 1);
}

void LiveModel::State::take_out(std::uint32_t place) {
    tables.users.remove(place, triangles[place]);
    if (!tables.tear) return;
    tables.tear->lanes[place / kBvhWidth] &=
        static_cast<std::uint8_t>(~(1U << (place % kBvhWidth)));
    triangles[place] = kNoTriangle;
    count_at(place, -1);
}

void LiveModel::State::count_at(std::uint32_t place, std::int32_t by) {
    const format::BvhShape& shape = model.bvh().shape;
    // The whole tree is not counted.
    for (std::uint32_t level = 0; level + 1 < shape.levels; ++level) {
        tables.tear->taken[shape.first[level] + (place >> (3 * (level + 2)))] +=
            static_cast<std::uint32_t>(by);
    }
}

std::uint64_t LiveModel::State::to_be_free(std::uint64_t places, std::uint32_t height) const {
    return places * height / (kFreeShare * model.bvh().shape.levels);
}

bool LiveModel::State::has_room(std::uint32_t height, std::uint32_t subtree) const {
    if (height == 0) return tables.tear->lanes[subtree] != kFullLeaf;
    const format::BvhShape& shape = model.bvh().shape;
    const std::uint64_t size = std::uint64_t{kBvhWidth} << (3 * height);
    const std::uint64_t places = std::min<std::uint64_t>(size, triangles.size() - subtree * size);
    return tables.tear->taken[shape.first[height - 1] + subtree] + to_be_free(places, height) <
           places;
}

Corners LiveModel::State::corners(const Triangle& triangle) const {
    return with_positions([&](const auto& positions) {
        return Corners{build::as_double(positions[triangle.vertex[0]]),
                       build::as_double(positions[triangle.vertex[1]]),
                       build::as_double(positions[triangle.vertex[2]])};
    });
}

}  // namespace cdprep
