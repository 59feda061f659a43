// SPDX-License-Identifier: MIT
#include "cells/build/octree_steps.h"

#include <bit>
#include <cassert>
#include <memory>

#include "build/chunks.h"
#include "cdprep/advanced/parallel_for.h"
#include "cells/build/most_references.h"
#include "cells/build/octree_grid.h"
#include "cells/octree_codes.h"
#include "exact/triangle_box.h"

// Built level by level, all nodes of a level at once. Each reference of a node that is divided gets
// the set of children that its triangle touches. Then the references are moved to the children, in
// the same order. So nodes come sorted by their keys, references rise within a node, and nothing
// depends on which task did what.
//
// A closed cell is the union of its children's closed cells, whose planes are the very same
// numbers. So a triangle that touches a cell touches a child, and one that touches two children
// ends up in two leaves.

namespace cdprep::build {
namespace {

using format::Double3;
using format::kInnerNode;
using format::kOctreeBits;
using format::kSharedReference;
using format::OctreeNode;
using format::Triangle;

/// A cell that is to be divided, along each axis in doubled numbers of planes (Stand).
struct GridCell {
    CellPlace first;     ///< its first finest cell
    std::uint32_t side;  ///< finest cells
    Stand lower;
    Stand middle;
    Stand upper;

    static GridCell of(std::uint64_t key) noexcept {
        GridCell cell{octree_place(key), kOctreeSteps >> level_of(key), {}, {}, {}};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            cell.lower[axis] = static_cast<float>(2 * cell.first[axis]);
            cell.middle[axis] = static_cast<float>(2 * cell.first[axis] + cell.side);
            cell.upper[axis] = static_cast<float>(2 * cell.first[axis] + 2 * cell.side);
        }
        return cell;
    }
};

/// The children on the lower side of each axis's middle plane. The others are on the upper side.
constexpr Lanes<std::uint32_t, 4> kLowerChildren = {0x55, 0x33, 0x0f, 0xff};
constexpr Lanes<std::uint32_t, 4> kUpperChildren = {0xaa, 0xcc, 0xf0, 0xff};

/// Returns the children whose closed cells a box reaches. The box reaches the parent's cell. The
/// loop has no branch, because the side of a triangle is unpredictable.
unsigned children_between(const GridCell& cell, const Stand& least, const Stand& most) noexcept {
    Lanes<std::uint32_t, 4> children;
    for_lanes<4>([&](std::size_t i) {
        const std::uint32_t below = least[i] <= cell.middle[i] ? kLowerChildren[i] : 0;
        const std::uint32_t above = most[i] >= cell.middle[i] ? kUpperChildren[i] : 0;
        children[i] = below | above;
    });
    return children[0] & children[1] & children[2];
}

/// Returns the children whose closed cells hold a vertex; none if the parent's cell does not.
unsigned children_at(const GridCell& cell, const Stand& at) noexcept {
    Lanes<std::uint32_t, 4> children;
    for_lanes<4>([&](std::size_t i) {
        const std::uint32_t below = at[i] >= cell.lower[i] ? kLowerChildren[i] : 0;
        const std::uint32_t above = at[i] <= cell.upper[i] ? kUpperChildren[i] : 0;
        children[i] = (at[i] <= cell.middle[i] ? below : 0) | (at[i] >= cell.middle[i] ? above : 0);
    });
    return children[0] & children[1] & children[2];
}

/// Returns whether a set has one element. The set is not empty. Counting bits would be a call,
/// because processors without that instruction are supported too.
bool is_single(unsigned set) noexcept {
    assert(set != 0);
    return (set & (set - 1)) == 0;
}

/// The input of the division.
struct Input {
    const format::OctreeGrid& grid;
    std::span<const Double3> positions;
    std::span<const Triangle> triangles;
    const Stand* stands;  ///< one per position
};

/// Returns those of some children that the triangle touches, by exact tests.
unsigned touched_among(const Input& input, const Triangle& t, const GridCell& cell,
                       unsigned children) noexcept {
    const Corners corners = {input.positions[t.vertex[0]], input.positions[t.vertex[1]],
                             input.positions[t.vertex[2]]};
    const std::uint32_t half = cell.side / 2;
    assert(std::has_single_bit(half) && children <= 0xff);
    const auto level = static_cast<std::uint32_t>(std::countl_zero(half)) + kOctreeBits - 31;
    unsigned touched = 0;
    for (unsigned left = children; left != 0; left &= left - 1) {
        const auto child = static_cast<unsigned>(std::countr_zero(left));
        CellPlace first;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            first[axis] = cell.first[axis] + ((child >> axis & 1) != 0 ? half : 0);
        }
        if (triangle_touches_box(corners, octree_box(input.grid, first, level))) {
            touched |= 1U << child;
        }
    }
    return touched;
}

/// Returns the children of a cell that a triangle touches. The triangle touches the cell.
unsigned touched_children(const Input& input, const Triangle& t, const GridCell& cell) noexcept {
    const Stand& a = input.stands[t.vertex[0]];
    const Stand& b = input.stands[t.vertex[1]];
    const Stand& c = input.stands[t.vertex[2]];
    Stand least = a;
    Stand most = a;
    take_lower(least, b);
    take_lower(least, c);
    take_upper(most, b);
    take_upper(most, c);
    const unsigned reached = children_between(cell, least, most);
    if (is_single(reached)) return reached;
    const unsigned touched = children_at(cell, a) | children_at(cell, b) | children_at(cell, c);
    if (touched == reached) return touched;
    return touched | touched_among(input, t, cell, reached & ~touched);
}

/// Consecutive references of one node that is divided.
struct Segment {
    std::uint32_t node;   ///< of its level
    std::uint32_t first;  ///< of the level's references
    std::uint32_t last;
    std::array<std::uint32_t, 8> child;  ///< counts, then the places where they go
};

/// The nodes of one level, and the triangles that touch them.
struct GridLevel {
    std::vector<OctreeNode> nodes;  ///< first, count: of `references`
    std::unique_ptr<std::uint32_t[]> references;
    std::uint32_t reference_count = 0;
};

/// The division of one level's nodes and references into the next level.
class Division {
public:
    Division(const Input& input, const GridLevel& level, ParallelFor parallel_for)
        : input_(input), level_(level), parallel_for_(parallel_for) {}

    /// Returns whether any node is divided. Returns false also if the tree would get too large.
    /// `behind` is the number of references in the levels above.
    bool find_children(std::uint32_t threshold, std::uint64_t behind) {
        cut_segments(threshold);
        if (segments_.empty()) return false;
        children_ = std::make_unique_for_overwrite<std::uint8_t[]>(level_.reference_count);
        for_segments([&](Segment& segment) { count(segment); });
        return behind + references_after() <= most_references(input_.triangles.size());
    }

    /// Returns the next level. Divided nodes get the numbers of their children in it and the set of
    /// them. `nodes` are this level's.
    GridLevel next(std::span<OctreeNode> nodes) {
        GridLevel result;
        for (std::size_t i = 0; i < segments_.size();) i = place_children(i, nodes, result);
        result.references = std::make_unique_for_overwrite<std::uint32_t[]>(result.reference_count);
        for_segments([&](Segment& segment) { move(segment, result.references.get()); });
        return result;
    }

private:
    const Input& input_;
    const GridLevel& level_;
    ParallelFor parallel_for_;
    std::vector<Segment> segments_;
    std::vector<std::size_t> first_of_task_;    ///< segments
    std::unique_ptr<std::uint8_t[]> children_;  ///< one set per reference

    void cut_segments(std::uint32_t threshold) {
        assert(threshold > 0);
        std::uint64_t task_ends = 0;
        segments_.reserve(level_.nodes.size() + level_.reference_count / kItemsPerTask + 1);
        for (std::uint32_t i = 0; i < level_.nodes.size(); ++i) {
            const OctreeNode& node = level_.nodes[i];
            if (node.count < threshold) continue;
            const std::uint64_t last = std::uint64_t{node.first} + node.count;
            for (std::uint64_t at = node.first; at < last;) {
                if (at >= task_ends) {
                    task_ends = (at / kItemsPerTask + 1) * kItemsPerTask;
                    first_of_task_.push_back(segments_.size());
                }
                const std::uint64_t end = std::min(last, task_ends);
                segments_.push_back(
                    {i, static_cast<std::uint32_t>(at), static_cast<std::uint32_t>(end), {}});
                at = end;
            }
        }
        first_of_task_.push_back(segments_.size());
    }

    template <class Body>
    void for_segments(const Body& body) {
        parallel_for_(first_of_task_.size() - 1, [&](std::size_t task) {
            for (std::size_t i = first_of_task_[task]; i < first_of_task_[task + 1]; ++i) {
                body(segments_[i]);
            }
        });
    }

    void count(Segment& segment) {
        const GridCell cell = GridCell::of(level_.nodes[segment.node].key);
        std::array<std::uint32_t, 8> count{};
        for (std::uint32_t i = segment.first; i < segment.last; ++i) {
            const std::uint32_t number = level_.references[i] & ~kSharedReference;
            const unsigned touched = touched_children(input_, input_.triangles[number], cell);
            children_[i] = static_cast<std::uint8_t>(touched);
            for (unsigned left = touched; left != 0; left &= left - 1) {
                ++count[static_cast<std::size_t>(std::countr_zero(left))];
            }
        }
        segment.child = count;
    }

    /// Returns the number of references of this level's leaves and the next level's nodes.
    [[nodiscard]] std::uint64_t references_after() const {
        std::uint64_t all = level_.reference_count;
        for (const Segment& segment : segments_) {
            all -= segment.last - segment.first;
            for (const std::uint32_t count : segment.child) all += count;
        }
        return all;
    }

    /// Places the children of the node of segment i. Returns the first segment of the next node.
    std::size_t place_children(std::size_t i, std::span<OctreeNode> nodes, GridLevel& result) {
        OctreeNode& node = nodes[segments_[i].node];
        std::size_t end = i;
        while (end < segments_.size() && segments_[end].node == segments_[i].node) ++end;
        node.first = static_cast<std::uint32_t>(result.nodes.size());
        node.count = kInnerNode;
        for (std::uint32_t child = 0; child < 8; ++child) {
            const std::uint32_t first = result.reference_count;
            for (std::size_t k = i; k < end; ++k) {
                const std::uint32_t count = segments_[k].child[child];
                segments_[k].child[child] = result.reference_count;
                result.reference_count += count;
            }
            if (result.reference_count == first) continue;
            node.count |= 1U << child;
            result.nodes.push_back({node.key << 3 | child, first, result.reference_count - first});
        }
        return end;
    }

    void move(Segment& segment, std::uint32_t* to) {
        for (std::uint32_t i = segment.first; i < segment.last; ++i) {
            const unsigned touched = children_[i];
            const bool shared = !is_single(touched);
            const std::uint32_t reference = level_.references[i] | (shared ? kSharedReference : 0);
            for (unsigned left = touched; left != 0; left &= left - 1) {
                to[segment.child[static_cast<std::size_t>(std::countr_zero(left))]++] = reference;
            }
        }
    }
};

std::unique_ptr<Stand[]> stands_of(const format::OctreeGrid& grid,
                                   std::span<const Double3> positions, ParallelFor parallel_for) {
    auto stands = std::make_unique_for_overwrite<Stand[]>(positions.size());
    for_chunks(positions.size(), kItemsPerTask, parallel_for,
               [&](std::size_t first, std::size_t last) {
                   for (std::size_t i = first; i < last; ++i) {
                       stands[i] = octree_stand(grid, positions[i]);
                   }
               });
    return stands;
}

GridLevel root_level(std::size_t triangle_count, ParallelFor parallel_for) {
    GridLevel root;
    root.reference_count = static_cast<std::uint32_t>(triangle_count);
    root.nodes = {{1, 0, root.reference_count}};
    root.references = std::make_unique_for_overwrite<std::uint32_t[]>(triangle_count);
    for_chunks(triangle_count, kItemsPerTask, parallel_for,
               [&](std::size_t first, std::size_t last) {
                   for (std::size_t i = first; i < last; ++i) {
                       root.references[i] = static_cast<std::uint32_t>(i);
                   }
               });
    return root;
}

/// Adds a level to the tree. Leaves take their references along, and children follow after all
/// nodes of this level.
void append(const GridLevel& level, std::vector<OctreeNode> nodes, Octree& octree) {
    const auto next = static_cast<std::uint32_t>(octree.nodes.size() + nodes.size());
    std::size_t listed = octree.references.size();
    for (const OctreeNode& node : nodes) listed += (node.count & kInnerNode) != 0 ? 0 : node.count;
    octree.references.reserve(listed);  // otherwise vectors take twice the memory they need
    octree.nodes.reserve(next);
    for (OctreeNode& node : nodes) {
        if ((node.count & kInnerNode) != 0) {
            node.first += next;
            continue;
        }
        const std::uint32_t* from = level.references.get() + node.first;
        node.first = static_cast<std::uint32_t>(octree.references.size());
        octree.references.insert(octree.references.end(), from, from + node.count);
    }
    octree.nodes.insert(octree.nodes.end(), nodes.begin(), nodes.end());
}

}  // namespace

void divide_octree(Octree& octree, std::span<const Double3> positions,
                   std::span<const Triangle> triangles, ParallelFor parallel_for) {
    assert(!triangles.empty() && octree.nodes.empty());
    const auto stands = stands_of(octree.grid, positions, parallel_for);
    const Input input{octree.grid, positions, triangles, stands.get()};
    GridLevel level = root_level(triangles.size(), parallel_for);
    for (std::uint32_t depth = 0; !level.nodes.empty(); ++depth) {
        GridLevel next;
        std::vector<OctreeNode> nodes = level.nodes;
        Division division(input, level, parallel_for);
        if (depth < octree.grid.level &&
            division.find_children(octree.grid.threshold, octree.references.size())) {
            next = division.next(nodes);
        }
        append(level, std::move(nodes), octree);
        level = std::move(next);
    }
}

}  // namespace cdprep::build
