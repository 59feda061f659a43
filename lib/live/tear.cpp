// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cassert>
#include <limits>
#include <string>

#include "build/bad_argument.h"
#include "build/frame_map.h"
#include "build/make_nodes.h"
#include "build/mesh_fault.h"
#include "core/numbers.h"
#include "live/live_state.h"

// Triangles lie in an implicit tree, of whose places some are free. A new one takes a free place
// in the leaf whose box grows least. If that leaf is full, the triangles of the smallest subtree
// with enough free places are distributed anew. The higher the subtree, the more must be free, so
// the next time is far off. This is a packed-memory array (Bender, Demaine and Farach-Colton 2005).
// Triangles that come together choose their leaves first. So a subtree is distributed once for all
// of them.

namespace cdprep {
namespace {

using build::bad_argument;
using format::BvhNode;
using format::Double3;
using format::kBvhWidth;
using format::Triangle;

/// Ids count upward to this.
constexpr std::uint32_t kIdLimit = 0x7fffffff;

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

/// Returns a quarter of the sum of the edges by which a box of a node grows with a triangle's box.
float growth(const BvhNode& node, std::size_t box, const std::array<build::Interval, 3>& around) {
    const bool is_empty = node.lower[0][box] > node.upper[0][box];
    float sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (is_empty) {
            sum += around[axis].upper - around[axis].lower;
            continue;
        }
        sum += std::max(0.0F, node.lower[axis][box] - around[axis].lower) +
               std::max(0.0F, around[axis].upper - node.upper[axis][box]);
    }
    return sum;
}

constexpr build::Extent kNoExtent = {
    {kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}, true};

void grow(build::Extent& extent, const Double3& p) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        extent.lower[axis] = std::min(extent.lower[axis], build::coordinate(p, axis));
        extent.upper[axis] = std::max(extent.upper[axis], build::coordinate(p, axis));
    }
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
    choose_leaves(added);
    place(tables.tear->fresh.first(added.size()));
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

void LiveModel::State::choose_leaves(std::span<const Triangle> added) {
    TearTables& tear = *tables.tear;
    const std::span<NewTriangle> fresh = tear.fresh.first(added.size());
    for (std::size_t i = 0; i < added.size(); ++i) {
        fresh[i] = {nearest_leaf(added[i]), {added[i], tear.next_id++}};
        tear.hash += hash_of(fresh[i].added.number, added[i]);
        count_at(fresh[i].leaf * kBvhWidth, 1);  // until it has a place: others see less room
    }
    for (const NewTriangle& each : fresh) count_at(each.leaf * kBvhWidth, -1);
    tear.count += static_cast<std::uint32_t>(added.size());
    std::ranges::sort(fresh, {}, [](const NewTriangle& each) {
        return std::uint64_t{each.leaf} << 32 | each.added.number;
    });
}

void LiveModel::State::place(std::span<NewTriangle> fresh) {
    for (std::uint32_t height = 0; !fresh.empty(); ++height) {
        assert(height <= model.bvh().shape.levels);  // the whole tree has room
        const auto subtree_of = [&](std::size_t i) { return fresh[i].leaf >> (3 * height); };
        std::size_t left = 0;
        for (std::size_t first = 0, last = 0; first < fresh.size(); first = last) {
            while (last < fresh.size() && subtree_of(last) == subtree_of(first)) ++last;
            const std::span<NewTriangle> of_subtree = fresh.subspan(first, last - first);
            if (place_in(height, subtree_of(first), of_subtree)) continue;
            std::ranges::copy(of_subtree, fresh.begin() + static_cast<std::ptrdiff_t>(left));
            left += of_subtree.size();
        }
        fresh = fresh.first(left);
    }
}

bool LiveModel::State::place_in(std::uint32_t height, std::uint32_t subtree,
                                std::span<const NewTriangle> fresh) {
    const format::BvhShape& shape = model.bvh().shape;
    const std::uint32_t size = 1U << (3 * height);
    const LeafRange range = {subtree * size, std::min((subtree + 1) * size, shape.leaf_count)};
    const std::uint64_t places = std::uint64_t{range.last - range.first} * kBvhWidth;
    const std::uint64_t free = height == 0 ? 0 : to_be_free(places, height - 1);
    const bool is_root = height == shape.levels;
    if (!is_root && count_in(range) + fresh.size() + free > places) return false;
    if (height > 0) {
        redistribute(range, fresh);
    } else {
        for (const NewTriangle& each : fresh) {
            const auto lane = std::countr_one(tables.tear->lanes[range.first]);
            put(range.first * kBvhWidth + static_cast<std::uint32_t>(lane), each.added);
        }
    }
    for (std::uint32_t leaf = range.first; leaf < range.last; ++leaf) tables.changed.mark(leaf);
    return true;
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
    for (std::uint32_t level = kCountedLevel; level + 1 < shape.levels; ++level) {
        tables.tear->taken[shape.first[level] + (place >> (3 * (level + 2)))] +=
            static_cast<std::uint32_t>(by);
    }
}

std::uint64_t LiveModel::State::to_be_free(std::uint64_t places, std::uint32_t level) const {
    return places * (level + 1) / (kFreeShare * model.bvh().shape.levels);
}

bool LiveModel::State::has_room(std::uint32_t level, std::uint32_t node) const {
    if (level < kCountedLevel) return true;
    const std::uint32_t bits = 3 * (level + 2);  // of the places of a whole subtree
    const std::uint64_t first = std::uint64_t{node} << bits;
    const std::uint64_t places = std::min<std::uint64_t>(triangles.size() - first, 1ULL << bits);
    const std::uint32_t taken = tables.tear->taken[model.bvh().shape.first[level] + node];
    return taken + to_be_free(places, level) < places;
}

std::uint32_t LiveModel::State::nearest_leaf(const Triangle& triangle) const {
    const build::FrameMap map(frame_);
    const Corners c = corners(triangle);
    std::array<build::Interval, 3> around{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto [low, high] =
            std::minmax({build::coordinate(c[0], axis), build::coordinate(c[1], axis),
                         build::coordinate(c[2], axis)});
        around[axis] = {map.around(low, axis).lower, map.around(high, axis).upper};
    }
    const format::BvhShape& shape = model.bvh().shape;
    std::uint32_t place = 0;
    for (std::uint32_t level = shape.levels; level-- > 0;) {
        const BvhNode& node = nodes[shape.first[level] + place];
        const std::uint32_t used = shape.used_boxes(level, place);
        std::uint32_t best = 0;
        float least = std::numeric_limits<float>::infinity();
        for (std::uint32_t box = 0; box < used; ++box) {
            const float grown = growth(node, box, around);
            if (grown >= least) continue;
            // A large subtree without room would have to be distributed as a whole.
            if (level > 0 && !has_room(level - 1, place * kBvhWidth + box)) continue;
            least = grown;
            best = box;
        }
        place = place * kBvhWidth + best;
    }
    return place;
}

Corners LiveModel::State::corners(const Triangle& triangle) const {
    return with_positions([&](const auto& positions) {
        return Corners{build::as_double(positions[triangle.vertex[0]]),
                       build::as_double(positions[triangle.vertex[1]]),
                       build::as_double(positions[triangle.vertex[2]])};
    });
}

}  // namespace cdprep
