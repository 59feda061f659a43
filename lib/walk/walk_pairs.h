// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>

#include "cdprep/model.h"
#include "core/prefetch.h"
#include "walk/box_placement.h"
#include "walk/workspace_storage.h"

namespace cdprep {

/// A node of the packed hierarchy, or a leaf. Height 0 is a leaf; height h > 0 is node `index` of
/// level h - 1.
struct TreePlace {
    std::uint32_t height;
    std::uint32_t index;
};

/// Two places packed in one word: heights take four bits, indices of leaves 28.
struct PendingPair {
    TreePlace a;
    TreePlace b;

    [[nodiscard]] std::uint64_t packed() const noexcept {
        assert(a.height < 16 && a.index < (1U << 28));
        assert(b.height < 16 && b.index < (1U << 28));
        const std::uint64_t half_a = std::uint64_t{a.height} << 28 | a.index;
        const std::uint64_t half_b = std::uint64_t{b.height} << 28 | b.index;
        return half_a << 32 | half_b;
    }
    [[nodiscard]] static PendingPair unpacked(std::uint64_t bits) noexcept {
        return {{static_cast<std::uint32_t>(bits >> 60),
                 static_cast<std::uint32_t>(bits >> 32) & 0xfffffff},
                {static_cast<std::uint32_t>(bits >> 28) & 0xf,
                 static_cast<std::uint32_t>(bits) & 0xfffffff}};
    }
};

/// Returns whether both places of a packed pair are at most at `height`; 0 is the height of leaves.
inline bool is_down_at(std::uint64_t pair, std::uint32_t height) noexcept {
    return static_cast<std::uint32_t>(pair >> 60) <= height &&
           (static_cast<std::uint32_t>(pair >> 28) & 0xf) <= height;
}
static_assert(format::kMaxTriangles / format::kBvhWidth < (1U << 28));
static_assert(format::kMaxBvhLevels < 16);

/// A hierarchy as a walk sees it.
struct Tree {
    const format::BvhNode* nodes;
    const format::OrientedNode* oriented;  ///< or null
    const format::SweptNode* swept;        ///< or null
    format::SweptKind swept_kind;
    format::BvhShape shape;
    std::uint32_t triangles;

    explicit Tree(const Model& model) noexcept
        : nodes(model.bvh().nodes.data()),
          oriented(model.bvh().oriented.data()),
          swept(model.bvh().swept.data()),
          swept_kind(format::swept_kind(model.header().flags)),
          shape(model.bvh().shape),
          triangles(model.triangle_count()) {}
};

/// Returns the boxes of a node that have contents: a bit set. A model that can tear has unused
/// boxes among used ones.
inline unsigned used_boxes(const format::BvhNode& node) noexcept {
    unsigned used = 0;
    for (std::size_t box = 0; box < format::kBvhWidth; ++box) {
        used |= static_cast<unsigned>(node.lower[0][box] <= node.upper[0][box]) << box;
    }
    return used;
}

/// One side of a step: the node whose boxes are tested, and which of them.
struct TestedBoxes {
    std::uint32_t node;     ///< index
    std::uint32_t first;    ///< box
    std::uint32_t last;     ///< one past
    TreePlace first_below;  ///< the place of box 0 of the node
};

/// Returns the children of a place. If it does not descend, returns its own box among its siblings.
inline TestedBoxes boxes_of(const Tree& tree, const TreePlace& place, bool descend) noexcept {
    const format::BvhShape& shape = tree.shape;
    if (descend) {
        assert(place.height > 0 && place.height <= shape.levels);
        assert(place.index < shape.count[place.height - 1]);
        const std::uint32_t level = place.height - 1;
        return {shape.first[level] + place.index,
                0,
                shape.used_boxes(level, place.index),
                {level, place.index * format::kBvhWidth}};
    }
    assert(place.height < shape.levels);  // a root has no siblings
    const std::uint32_t box = place.index % format::kBvhWidth;
    const std::uint32_t parent = place.index / format::kBvhWidth;
    return {shape.first[place.height] + parent,
            box,
            box + 1,
            {place.height, parent * format::kBvhWidth}};
}

/// Returns half the sum of the edges of a place's box, in pair units.
inline float box_size(const Tree& tree, const TreePlace& place, float scale) noexcept {
    const format::BvhShape& shape = tree.shape;
    assert(place.height <= shape.levels);
    if (place.height == shape.levels) return 3 * scale;  // the root fills the frame
    const format::BvhNode& node =
        tree.nodes[shape.first[place.height] + place.index / format::kBvhWidth];
    const std::uint32_t box = place.index % format::kBvhWidth;
    float size = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        size += node.upper[axis][box] - node.lower[axis][box];
    }
    return size * scale;
}

/// The sides that descend one level.
struct WaysDown {
    bool a;
    bool b;
};

/// The sizes of two boxes.
struct SizePair {
    float a;
    float b;
};

/// Chooses both sides if their boxes are of similar size, otherwise the larger. A leaf never
/// descends. A root always does: it has no siblings among which it could be tested. `sizes()` is
/// called only if it matters.
template <class Sizes>
WaysDown choose_descent(const Tree& a, const Tree& b, const PendingPair& pair,
                        Sizes sizes) noexcept {
    constexpr float kSimilar = 2.5F;
    assert(pair.a.height > 0 || pair.b.height > 0);
    const bool a_can = pair.a.height > 0;
    const bool b_can = pair.b.height > 0;
    if (pair.a.height == a.shape.levels || pair.b.height == b.shape.levels) {
        return {a_can, b_can};
    }
    if (!a_can || !b_can) return {a_can, b_can};
    // Uses absolute values and negated comparisons. So absurd sizes of a damaged file (negative or
    // NaN) still take one side down; otherwise the walk would not end.
    const SizePair size = sizes();
    const float size_a = std::fabs(size.a);
    const float size_b = std::fabs(size.b);
    return {!(kSimilar * size_a < size_b), !(kSimilar * size_b < size_a)};
}

/// Adds the boxes that a step tests to the counts.
inline void count_step(const Tree& a, const Tree& b, const PendingPair& pair,
                       const WaysDown& descent, QueryCounts& counts) noexcept {
    const TestedBoxes side_a = boxes_of(a, pair.a, descent.a);
    const TestedBoxes side_b = boxes_of(b, pair.b, descent.b);
    counts.box_pairs += std::uint64_t{side_a.last - side_a.first} * (side_b.last - side_b.first);
    ++counts.node_pairs;
}

/// As above, unless the workspace is out of work. Not inlined: walks that do not count would pay.
[[gnu::noinline]] inline bool count_or_end(const Tree& a, const Tree& b, const PendingPair& pair,
                                           const WaysDown& descent,
                                           const Workspace::Storage& scratch) noexcept {
    if (scratch.is_out_of_work()) return false;
    count_step(a, b, pair, descent, *scratch.counts);
    return true;
}

/// Prefetches the parts of a node's swept spheres that the test of its kind reads.
inline void prefetch_swept(const format::SweptNode& node, format::SweptKind kind) noexcept {
    prefetch(&node.centre);
    prefetch(&node.radius);
    for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(kind); ++k) prefetch(&node.side[k]);
}

/// Prefetches the data that the walk will read for some children: nodes of `below`, one per bit.
inline void prefetch_children(const Tree& tree, const TreePlace& below, unsigned bits) noexcept {
    if (below.height == 0) return;
    const std::uint32_t first = tree.shape.first[below.height - 1] + below.index;
    for (; bits != 0; bits &= bits - 1) {
        const std::uint32_t index = first + static_cast<std::uint32_t>(std::countr_zero(bits));
        assert(index < tree.shape.node_count);
        prefetch(&tree.nodes[index]);
        if (tree.oriented != nullptr) {
            prefetch(&tree.oriented[index]);
        } else if (tree.swept != nullptr) {
            prefetch_swept(tree.swept[index], tree.swept_kind);
        }
    }
}

/// The hits that a walk searches for.
enum class Search : std::uint8_t {
    all,    ///< every pair of leaves that no test of boxes separates
    first,  ///< deepest first, so that a hit comes early
};

/// Returns the box around a place's children, stored among its siblings, or null for a root.
inline const float* box_around(const Tree& tree, const TreePlace& place) noexcept {
    if (place.height == tree.shape.levels) return nullptr;
    const std::uint32_t node = tree.shape.first[place.height] + place.index / format::kBvhWidth;
    return &tree.nodes[node].lower[0][place.index % format::kBvhWidth];
}

/// Without `reads_swept`, swept spheres of the file cost nothing.
inline kernels::NodeBoxes node_boxes(const Tree& tree, const TestedBoxes& side,
                                     bool reads_swept) noexcept {
    const float* oriented =
        tree.oriented == nullptr ? nullptr : tree.oriented[side.node].axis[0][0].data();
    const float* swept = reads_swept ? tree.swept[side.node].centre[0].data() : nullptr;
    return {tree.nodes[side.node].lower[0].data(), oriented, swept};
}

/// The bounds that a query uses where both models have both kinds.
enum class Prefer : std::uint8_t {
    oriented,  ///< separates with less work
    swept,     ///< gives bounds closer to the distance
};

/// Returns the tests for the bounds that both models have: swept spheres of one kind, otherwise the
/// table's own tests of boxes.
inline kernels::BoundTests tests_for(const Tree& a, const Tree& b, Prefer prefer) noexcept {
    const kernels::Table& kernel = kernels::active();
    const bool oriented = a.oriented != nullptr && b.oriented != nullptr;
    const bool swept = a.swept != nullptr && b.swept != nullptr && a.swept_kind == b.swept_kind;
    if (swept && (prefer == Prefer::swept || !oriented)) {
        return kernel.swept[static_cast<std::size_t>(a.swept_kind)];
    }
    return {kernel.overlapping_boxes, kernel.overlap_depths, kernel.near_boxes, false};
}

inline std::uint8_t chosen(const TestedBoxes& side) noexcept {
    assert(side.first < side.last && side.last <= format::kBvhWidth);
    return static_cast<std::uint8_t>((1U << side.last) - (1U << side.first));
}

/// Prefetches the data that the walk will read for a step's children.
inline void prefetch_step(const Tree& a, const Tree& b, const OpenStep& step) noexcept {
    const PendingPair below = PendingPair::unpacked(step.base);
    prefetch_children(a, below.a, kernels::boxes_of_a(step.pairs));
    prefetch_children(b, below.b, kernels::boxes_of_b(step.pairs));
}

/// Tests the children of a pair that is not a pair of leaves, by the separating-axis tests of
/// kernels/box_overlap.h. Sets `depths` with Search::first.
template <Search kSearch>
void open_step(const Tree& a, const Tree& b, const PlacedBoxes& placed,
               const kernels::BoundTests& tests, const PendingPair& pair, const WaysDown& descent,
               OpenStep& step, kernels::BoxDepths& depths) noexcept {
    const TestedBoxes side_a = boxes_of(a, pair.a, descent.a);
    const TestedBoxes side_b = boxes_of(b, pair.b, descent.b);
    const kernels::BoxChoice choice = {chosen(side_a), chosen(side_b),
                                       descent.a && descent.b ? box_around(a, pair.a) : nullptr};
    const kernels::NodeBoxes in_a = node_boxes(a, side_a, tests.reads_swept);
    const kernels::NodeBoxes in_b = node_boxes(b, side_b, tests.reads_swept);
    // Search::first cannot predict the deepest pair, so its oriented boxes were not prefetched. The
    // test reads them late, so a prefetch here still helps. Those of all children would be too
    // many.
    if (kSearch == Search::first && a.oriented != nullptr && b.oriented != nullptr) {
        prefetch(&a.oriented[side_a.node]);
        prefetch(&b.oriented[side_b.node]);
    }
    step.base = PendingPair{side_a.first_below, side_b.first_below}.packed();
    step.pairs = kSearch == Search::first
                     ? tests.depths(placed.placement, in_a, in_b, choice, step.sizes, depths)
                     : tests.overlapping(placed.placement, in_a, in_b, choice, step.sizes);
}

inline unsigned first_of(kernels::BoxPairs pairs) noexcept {
    assert(pairs != 0);
    return static_cast<unsigned>(std::countr_zero(pairs));
}

/// Returns the bit of the pair that overlaps most, among the remaining pairs of a step.
inline unsigned deepest_of(kernels::BoxPairs pairs, const kernels::BoxPairFloats& depths) noexcept {
    unsigned deepest = first_of(pairs);
    float most = (&depths.value[0][0])[deepest];
    for (kernels::BoxPairs rest = pairs & (pairs - 1); rest != 0; rest &= rest - 1) {
        const unsigned bit = first_of(rest);
        const float depth = (&depths.value[0][0])[bit];
        if (depth > most) {
            most = depth;
            deepest = bit;
        }
    }
    return deepest;
}

/// Returns the start of a walk of everything: both roots.
inline PendingPair roots(const Tree& a, const Tree& b) noexcept {
    return {{a.shape.levels, 0}, {b.shape.levels, 0}};
}

/// Walks two hierarchies from `start` down, depth first. Calls `reach(pair)` for each pair of
/// places, both at most `floor` high, that no box test separates. Stops and returns false when
/// `reach` returns false or the workspace is out of work. Both models need nodes and triangles.
template <Search kSearch, class Reach>
bool walk_pairs_from(const PendingPair& start, std::uint32_t floor, const Tree& a, const Tree& b,
                     const PlacedBoxes& placed, Workspace::Storage& scratch,
                     Reach&& reach) noexcept {
    assert(a.triangles > 0 && b.triangles > 0);
    if (is_down_at(start.packed(), floor)) return reach(start);
    const kernels::BoundTests tests = tests_for(a, b, Prefer::oriented);
    kernels::BoxDepths depths;
    const auto best_of = [&](const OpenStep& step) {
        return kSearch == Search::first ? depths.deepest : first_of(step.pairs);
    };
    const auto pick = [&](kernels::BoxPairs pairs) {
        return kSearch == Search::first ? deepest_of(pairs, depths) : first_of(pairs);
    };
    std::size_t depth = 0;
    OpenedPair next{start.packed(), box_size(a, start.a, placed.placement.scale_a),
                    box_size(b, start.b, placed.placement.scale_b)};
    for (;;) {
        const PendingPair pair = PendingPair::unpacked(next.pair);
        const WaysDown descent = choose_descent(a, b, pair, [&] {
            return SizePair{next.size_a, next.size_b};
        });
        assert(depth < scratch.open_steps.size());
        OpenStep& step = scratch.open_steps[depth];
        if (scratch.counts != nullptr && !count_or_end(a, b, pair, descent, scratch)) return false;
        open_step<kSearch>(a, b, placed, tests, pair, descent, step, depths);
        if (is_down_at(step.base, floor)) {
            for (bool best = true; step.pairs != 0; best = false) {
                const std::uint64_t at = step.take(best ? best_of(step) : pick(step.pairs)).pair;
                if (!reach(PendingPair::unpacked(at))) return false;
            }
        } else if (step.pairs != 0) {
            if (kSearch == Search::all) prefetch_step(a, b, step);
            next = step.take(best_of(step));
            if (step.pairs != 0) ++depth;
            continue;
        }
        if (depth == 0) return true;
        OpenStep& top = scratch.open_steps[depth - 1];
        next = top.take(first_of(top.pairs));
        if (top.pairs == 0) --depth;
    }
}

/// Calls `leaf(index_a, index_b)` for each pair of leaves that no box test separates. Stops and
/// returns false when `leaf` returns false.
template <Search kSearch, class Leaf>
bool walk_pairs(const Tree& a, const Tree& b, const PlacedBoxes& placed,
                Workspace::Storage& scratch, Leaf&& leaf) noexcept {
    if (a.triangles == 0 || b.triangles == 0 || placed.apart) return true;
    return walk_pairs_from<kSearch>(
        roots(a, b), 0, a, b, placed, scratch,
        [&](const PendingPair& pair) { return leaf(pair.a.index, pair.b.index); });
}

}  // namespace cdprep
