// SPDX-License-Identifier: MIT
#include "cdprep/cells/build_adaptive_octree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>

#include "build/chunks.h"
#include "build/frame_map.h"
#include "cdprep/advanced/parallel_for.h"
#include "cdprep/cells/build_octree.h"
#include "cdprep/format/float_environment.h"
#include "cells/build/cell_boxes.h"
#include "cells/build/choose_split.h"
#include "cells/build/most_references.h"
#include "cells/split_box.h"
#include "core/guarded_for.h"
#include "exact/triangle_box.h"

// Built level by level. The lists of a level's cells lie one after another in one array. Each list
// is cut into batches of a fixed size. Every batch finds, for each of its triangles, the children
// that it touches. After all have counted, each knows where its part of the children's lists goes.
// So lists rise as the first one did, and nothing depends on which task did which batch.
//
// Scratch: 48 bytes per triangle for its box; 8 bytes per triangle of each median being computed. 4
// bytes per reference of a level and of the next, and one more per reference of the former. The
// cells and batches of a level, and the cells of the next. No level has more references or nodes
// than the result.

namespace cdprep::build {
namespace {

using format::Double3;
using format::kInnerNode;
using format::kSharedReference;
using format::Triangle;

constexpr std::size_t kChildren = 8;

/// A cell of the current level: its triangles are list[first, first + count).
struct Cell {
    Box3 box;
    Double3 split;
    std::size_t first;
    std::size_t count;
    std::array<std::size_t, kChildren> children;  ///< triangles of each
    std::array<bool, 3> separates;                ///< see AxisSplit
    bool divided;
};

/// A part of a cell's list that one task processes.
struct Batch {
    std::size_t cell;
    std::size_t first;
    std::size_t last;
    std::array<std::uint32_t, kChildren> children;  ///< counts, then the places where they go
};

Box3 child_box(const Cell& cell, std::size_t child) {
    return split_box(cell.box, cell.split, child);
}

bool holds(const Box3& outer, const Box3& inner) {
    return outer.lower.x <= inner.lower.x && inner.upper.x <= outer.upper.x &&
           outer.lower.y <= inner.lower.y && inner.upper.y <= outer.upper.y &&
           outer.lower.z <= inner.lower.z && inner.upper.z <= outer.upper.z;
}

/// The children, a bit each, on whose side of the cell's planes a part of a triangle's box lies.
/// Also the number of planes that cut the box.
struct Candidates {
    unsigned mask = 0xff;
    int cuts = 0;

    void look_along(double lower, double upper, double plane, double end, unsigned lower_half) {
        const bool is_below = lower <= plane;
        const bool is_above = plane <= upper && plane < end;
        mask &= (is_below ? lower_half : 0) | (is_above ? 0xff & ~lower_half : 0);
        cuts += is_below && is_above ? 1 : 0;
    }
};

Candidates candidates_of(const Cell& cell, const Box3& box) {
    Candidates found;
    const auto& [lower, upper] = box;
    const auto& end = cell.box.upper;
    found.look_along(lower.x, upper.x, cell.split.x, end.x, 0x55);
    found.look_along(lower.y, upper.y, cell.split.y, end.y, 0x33);
    found.look_along(lower.z, upper.z, cell.split.z, end.z, 0x0f);
    return found;
}

/// Leaves a cell undivided along axes whose plane would cut every triangle's box, unless that holds
/// for all axes.
void leave_whole(Cell& cell) {
    const auto& [x, y, z] = cell.separates;
    if (!x && !y && !z) return;
    const auto& end = cell.box.upper;
    if (!x) cell.split.x = end.x;
    if (!y) cell.split.y = end.y;
    if (!z) cell.split.z = end.z;
}

bool can_be_divided(const Cell& cell) {
    const auto& end = cell.box.upper;
    return cell.split.x < end.x || cell.split.y < end.y || cell.split.z < end.z;
}

class Builder {
public:
    Builder(std::span<const Double3> positions, std::span<const Triangle> triangles,
            const AdaptiveOctreeOptions& options)
        : positions_(positions), triangles_(triangles), options_(options) {
        result_.tree.level = options.level;
        result_.tree.threshold = options.threshold;
        result_.tree.rule = options.rule;
    }

    AdaptiveOctree build() {
        if (triangles_.empty()) return std::move(result_);
        begin();
        for (std::uint32_t level = 0; !cells_.empty(); ++level) {
            if (level < options_.level) {
                choose_splits();
                sort_into_children();
            }
            end_level();
        }
        return std::move(result_);
    }

private:
    void begin() {
        const Extent extent = extent_of(positions_, triangles_, options_.parallel_for);
        result_.tree.lower = {extent.lower[0], extent.lower[1], extent.lower[2]};
        result_.tree.upper = {extent.upper[0], extent.upper[1], extent.upper[2]};
        const std::size_t count = triangles_.size();
        boxes_.resize(count);
        list_.resize(count);
        for_chunks(count, kItemsPerTask, options_.parallel_for,
                   [&](std::size_t first, std::size_t last) {
                       for (std::size_t i = first; i < last; ++i) {
                           boxes_[i] = box_around(corners(static_cast<std::uint32_t>(i)));
                           list_[i] = static_cast<std::uint32_t>(i);
                       }
                   });
        cells_.push_back({{result_.tree.lower, result_.tree.upper}, {}, 0, count, {}, {}, false});
        result_.nodes.push_back({});
    }

    [[nodiscard]] Corners corners(std::uint32_t reference) const {
        const auto& [a, b, c] = triangles_[reference & ~kSharedReference].vertex;
        return {positions_[a], positions_[b], positions_[c]};
    }

    /// Groups `count` consecutive items so that each group has kItemsPerTask triangles or more.
    /// Runs body(repeat, first, last) for each group, `repeats` times.
    template <class Size, class Body>
    void for_groups(std::size_t count, std::size_t repeats, Size size_of, const Body& body) {
        groups_.assign(1, 0);
        std::size_t triangles = 0;
        for (std::size_t i = 0; i < count; ++i) {
            triangles += size_of(i);
            if (triangles < kItemsPerTask && i + 1 < count) continue;
            groups_.push_back(i + 1);
            triangles = 0;
        }
        options_.parallel_for((groups_.size() - 1) * repeats, [&](std::size_t task) {
            const std::size_t group = task / repeats;
            body(task % repeats, groups_[group], groups_[group + 1]);
        });
    }
    template <class Body>
    void for_batches(const Body& body) {
        const auto size_of = [&](std::size_t i) { return batches_[i].last - batches_[i].first; };
        for_groups(batches_.size(), 1, size_of,
                   [&](std::size_t, std::size_t first, std::size_t last) {
                       for (std::size_t i = first; i < last; ++i) body(batches_[i]);
                   });
    }

    void choose_splits() {
        const auto size_of = [&](std::size_t i) { return cells_[i].count; };
        for_groups(cells_.size(), 3, size_of,
                   [&](std::size_t axis, std::size_t first, std::size_t last) {
                       std::vector<double> scratch;
                       for (std::size_t i = first; i < last; ++i) {
                           if (cells_[i].count < options_.threshold) continue;
                           choose_plane(cells_[i], axis, scratch);
                       }
                   });
    }

    void choose_plane(Cell& cell, std::size_t axis, std::vector<double>& scratch) const {
        const std::span<const std::uint32_t> list(list_.data() + cell.first, cell.count);
        const AxisSplit chosen =
            choose_split({cell.box, list, boxes_}, axis, options_.rule, scratch);
        (axis == 0 ? cell.split.x : axis == 1 ? cell.split.y : cell.split.z) = chosen.plane;
        cell.separates[axis] = chosen.separates;
    }

    void sort_into_children() {
        cut_in_batches();
        masks_.resize(list_.size());
        for_batches([&](Batch& batch) { find_children(batch); });
        for (const Batch& batch : batches_) {
            for (std::size_t child = 0; child < kChildren; ++child) {
                cells_[batch.cell].children[child] += batch.children[child];
            }
        }
        decide();
    }

    void cut_in_batches() {
        batches_.clear();
        for (std::size_t i = 0; i < cells_.size(); ++i) {
            Cell& cell = cells_[i];
            if (cell.count < options_.threshold) continue;
            leave_whole(cell);
            if (!can_be_divided(cell)) continue;
            const std::size_t end = cell.first + cell.count;
            for (std::size_t at = cell.first; at < end; at += kItemsPerTask) {
                batches_.push_back({i, at, std::min(at + kItemsPerTask, end), {}});
            }
        }
    }

    void find_children(Batch& batch) {
        const Cell& cell = cells_[batch.cell];
        for (std::size_t i = batch.first; i < batch.last; ++i) {
            const unsigned mask = children_touched(cell, list_[i]);
            assert(mask <= 0xff);
            masks_[i] = static_cast<std::uint8_t>(mask);
            for (std::size_t child = 0; child < kChildren; ++child) {
                batch.children[child] += (mask >> child) & 1;
            }
        }
    }

    /// Returns the children that a triangle touches. The triangle touches the cell. Seen along one
    /// axis, it touches what its box touches; the exact test is for other cases.
    [[nodiscard]] unsigned children_touched(const Cell& cell, std::uint32_t reference) const {
        const Box3& box = boxes_[reference & ~kSharedReference];
        const Candidates found = candidates_of(cell, box);
        if (found.cuts == 0 || (found.cuts == 1 && holds(cell.box, box))) return found.mask;
        const Corners t = corners(reference);
        unsigned touched = 0;
        for (unsigned rest = found.mask; rest != 0; rest &= rest - 1) {
            const auto child = static_cast<std::size_t>(std::countr_zero(rest));
            if (triangle_touches_box(t, child_box(cell, child))) touched |= 1U << child;
        }
        return touched;
    }

    /// Divides a cell if some child has fewer triangles. Divides no cell of the level if the tree
    /// would get too large.
    void decide() {
        std::uint64_t references = result_.references.size();
        std::size_t children = 0;
        for (Cell& cell : cells_) {
            std::size_t in_children = 0;
            std::size_t there = 0;
            for (const std::size_t count : cell.children) {
                in_children += count;
                there += count > 0 ? 1 : 0;
                cell.divided = cell.divided || (count > 0 && count < cell.count);
            }
            references += cell.divided ? in_children : cell.count;
            children += cell.divided ? there : 0;
        }
        next_cells_.clear();
        if (references <= most_references(triangles_.size())) return next_cells_.reserve(children);
        for (Cell& cell : cells_) cell.divided = false;
    }

    /// Writes the nodes of this level, the lists of its leaves and the cells of the next level.
    void end_level() {
        const std::size_t first_node = result_.nodes.size() - cells_.size();
        std::size_t next = 0;
        for (std::size_t i = 0; i < cells_.size(); ++i) {
            if (cells_[i].divided) {
                next = add_children(cells_[i], result_.nodes[first_node + i], next);
            } else {
                add_leaf(cells_[i], result_.nodes[first_node + i]);
            }
        }
        if (next > 0) write_lists(next);
        cells_.swap(next_cells_);
        next_cells_.clear();
        list_.swap(next_list_);
    }

    void add_leaf(const Cell& cell, format::AdaptiveOctreeNode& node) {
        node = {{0, 0, 0},
                static_cast<std::uint32_t>(result_.references.size()),
                static_cast<std::uint32_t>(cell.count)};
        const auto first = list_.begin() + static_cast<std::ptrdiff_t>(cell.first);
        result_.references.insert(result_.references.end(), first,
                                  first + static_cast<std::ptrdiff_t>(cell.count));
    }

    /// Makes the cell's children, whose lists begin at `next`. Returns the end of these lists. Sets
    /// cell.children to the start of each list.
    std::size_t add_children(Cell& cell, format::AdaptiveOctreeNode& node, std::size_t next) {
        // The nodes of this level are the last ones so far. Those of the next level follow.
        node = {cell.split, static_cast<std::uint32_t>(result_.nodes.size()), kInnerNode};
        std::uint32_t mask = 0;
        for (std::size_t child = 0; child < kChildren; ++child) {
            const std::size_t count = cell.children[child];
            cell.children[child] = next;
            if (count == 0) continue;
            mask |= 1U << child;
            next_cells_.push_back({child_box(cell, child), {}, next, count, {}, {}, false});
            next += count;
        }
        assert(mask != 0);
        node.count |= mask;
        result_.nodes.resize(result_.nodes.size() + static_cast<std::size_t>(std::popcount(mask)));
        return next;
    }

    void write_lists(std::size_t count) {
        next_list_.resize(count);
        for (Batch& batch : batches_) {
            for (std::size_t child = 0; child < kChildren; ++child) {
                std::size_t& next = cells_[batch.cell].children[child];
                const std::uint32_t own = batch.children[child];
                batch.children[child] = static_cast<std::uint32_t>(next);
                next += own;
            }
        }
        for_batches([&](Batch& batch) { write_list(batch); });
    }

    void write_list(Batch& batch) {
        if (!cells_[batch.cell].divided) return;
        for (std::size_t i = batch.first; i < batch.last; ++i) {
            const unsigned mask = masks_[i];
            assert(mask != 0);  // a triangle that touches a cell touches a child
            const std::uint32_t shared = (mask & (mask - 1)) != 0 ? kSharedReference : 0;
            for (unsigned rest = mask; rest != 0; rest &= rest - 1) {
                const auto child = static_cast<std::size_t>(std::countr_zero(rest));
                next_list_[batch.children[child]++] = list_[i] | shared;
            }
        }
    }

    std::span<const Double3> positions_;
    std::span<const Triangle> triangles_;
    const AdaptiveOctreeOptions& options_;
    AdaptiveOctree result_;
    std::vector<Box3> boxes_;  ///< around each triangle
    std::vector<Cell> cells_;
    std::vector<Cell> next_cells_;
    std::vector<std::uint32_t> list_;  ///< of all cells of the level; see Cell
    std::vector<std::uint32_t> next_list_;
    std::vector<std::uint8_t> masks_;  ///< for each entry of list_: the children that it touches
    std::vector<Batch> batches_;
    std::vector<std::size_t> groups_;
};

}  // namespace

AdaptiveOctree build_adaptive_octree(std::span<const Double3> positions,
                                     std::span<const Triangle> triangles,
                                     const AdaptiveOctreeOptions& options) {
    format::FloatEnvironment environment;
    const GuardedFor guarded(environment, options.parallel_for);
    AdaptiveOctreeOptions inside = options;
    inside.parallel_for = guarded;
    AdaptiveOctree octree = Builder(positions, triangles, inside).build();
    if (options.boxes_in) {
        bound_cells(octree, positions, triangles, *options.boxes_in, guarded);
    }
    return octree;
}

}  // namespace cdprep::build
