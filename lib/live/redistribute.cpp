// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cassert>

#include "build/frame_map.h"
#include "build/make_nodes.h"
#include "live/live_state.h"

namespace cdprep {
namespace {

using format::BvhNode;
using format::kBvhWidth;

/// A rebuild begins when the boxes of a subtree have grown by the first factor. It goes on until
/// none has grown by the second one.
constexpr float kBegin = 1.4F;
constexpr float kEnd = 1.2F;

/// The memory of a triangle is prefetched this many triangles ahead.
constexpr std::size_t kAhead = 8;

}  // namespace

void LiveModel::State::redistribute(const LeafRange& range) {
    const build::FrameMap map(frame_);
    std::uint32_t count = 0;
    const auto end =
        static_cast<std::uint32_t>(std::min(std::size_t{range.last} * kBvhWidth, triangles.size()));
    for (std::uint32_t place = range.first * kBvhWidth; place < end; ++place) {
        if (!is_taken(place)) continue;
        const Corners c = corners(triangles[place]);
        tables.items[count] = {middle_of(map, c[0], c[1], c[2]), source_triangle[place], count};
        tables.item_triangles[count++] = triangles[place];
        take_out(place);
    }
    const std::uint32_t leaf_count = range.last - range.first;
    const Fill fill = tables.tear ? Fill::even : Fill::full;
    const std::span<SpreadItem> items = tables.items.first(count);
    spread(items, leaf_count, fill);
    for (std::uint32_t leaf = 0; leaf < leaf_count; ++leaf) {
        const std::size_t first = first_in_leaf(count, leaf, leaf_count, fill);
        const std::size_t last = first_in_leaf(count, leaf + 1, leaf_count, fill);
        assert(last - first <= kBvhWidth);
        for (std::size_t i = first; i < last; ++i) {
            if (tables.tear && i + kAhead < count) tables.tear->ids.ask(items[i + kAhead].id);
            const std::size_t place = std::size_t{range.first + leaf} * kBvhWidth + (i - first);
            put(static_cast<std::uint32_t>(place),
                {tables.item_triangles[items[i].from], items[i].id});
        }
    }
}

/// Fits leaves, and the boxes around them up to the root.
void LiveModel::State::fit_leaves(const LeafRange& range) {
    with_positions([&](const auto& positions) {
        build::make_some_leaves(leaf_room(), positions, triangles, range.first, range.last);
    });
    const format::BvhShape& shape = model.bvh().shape;
    LeafRange nodes_of = range;
    for (std::uint32_t level = 0; level + 1 < shape.levels; ++level) {
        nodes_of = {nodes_of.first / kBvhWidth, (nodes_of.last - 1) / kBvhWidth + 1};
        fit_boxes_around(level, nodes_of.first, nodes_of.last);
    }
}

// --- Rebuilds ---------------------------------------------------------------------------

std::uint32_t LiveModel::State::rebuild(std::uint32_t most) {
    const auto subtrees = static_cast<std::uint32_t>(tables.built_cost.size());
    for (std::uint32_t i = 0; i < subtrees; ++i) {
        tables.growth[i] = cost_of(i) / tables.built_cost[i];
    }
    std::uint32_t done = 0;
    while (subtrees > 0) {
        const auto worst = static_cast<std::uint32_t>(std::ranges::max_element(tables.growth) -
                                                      tables.growth.begin());
        is_rebuilding_ = tables.growth[worst] > (is_rebuilding_ ? kEnd : kBegin);
        const LeafRange range = subtree(worst);
        const std::uint32_t size = count_in(range);
        if (!is_rebuilding_ || size > most - done) break;
        redistribute(range);
        note_places(worst);
        fit_leaves(range);
        tables.built_cost[worst] = cost_of(worst);
        tables.growth[worst] = 1;
        done += size;
    }
    if (done > 0) update_header();
    return done;
}

std::uint32_t LiveModel::State::count_in(const LeafRange& range) const {
    if (!tables.tear) {
        const auto places = static_cast<std::uint32_t>(triangles.size());
        return std::min(range.last * kBvhWidth, places) - range.first * kBvhWidth;
    }
    std::uint32_t count = 0;
    for (std::uint32_t i = range.first; i < range.last; ++i) {
        count += static_cast<std::uint32_t>(std::popcount(tables.tear->lanes[i]));
    }
    return count;
}

LeafRange LiveModel::State::subtree(std::uint32_t number) const {
    const std::uint32_t first = number * kSubtreeLeaves;
    return {first, std::min(first + kSubtreeLeaves, model.bvh().shape.leaf_count)};
}

float LiveModel::State::cost_of(std::uint32_t number) const {
    const format::BvhShape& shape = model.bvh().shape;
    LeafRange below = subtree(number);
    double sum = 0;
    double whole = 0;
    for (std::uint32_t level = 0; level < shape.levels && below.last - below.first > 1; ++level) {
        below = {below.first / kBvhWidth, (below.last - 1) / kBvhWidth + 1};
        for (std::uint32_t i = below.first; i < below.last; ++i) {
            const BvhNode& node = nodes[shape.first[level] + i];
            for (const double area : build::half_areas(node)) sum += area;
            whole = build::half_area_around(node);
        }
    }
    return whole > 0 ? static_cast<float>(sum / whole) : 1;
}

void LiveModel::State::note_costs() {
    for (std::uint32_t i = 0; i < tables.built_cost.size(); ++i) tables.built_cost[i] = cost_of(i);
}

}  // namespace cdprep
