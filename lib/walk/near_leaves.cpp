// SPDX-License-Identifier: MIT
#include "walk/near_leaves.h"

#include <array>
#include <bit>
#include <cassert>
#include <cmath>

#include "walk/walk_pairs.h"

// A's hierarchy is walked depth first in tree order, so each leaf is met at most once. For each
// node of A, B's hierarchy is walked. This walk ends as soon as each box of the node is near a
// leaf's box of B. Most boxes of A far up are near the first leaf of B.

namespace cdprep {
namespace {

/// The most places that a depth-first walk holds: seven siblings a level, and one node's children.
constexpr std::size_t kMostPlaces = std::size_t{format::kMaxBvhLevels + 1} * format::kBvhWidth;

/// Places that wait in a depth-first walk.
class Places {
public:
    explicit Places(const Tree& tree) noexcept {
        push({tree.shape.levels, 0});
    }
    [[nodiscard]] bool empty() const noexcept {
        return count_ == 0;
    }
    void push(const TreePlace& place) noexcept {
        assert(count_ < places_.size());
        places_[count_++] = place;
    }
    /// Pushes some children of a node, the first on top.
    void push_children(const TreePlace& first, unsigned bits) noexcept {
        for (std::uint32_t box = format::kBvhWidth; box-- > 0;) {
            if ((bits >> box & 1) != 0) push({first.height, first.index + box});
        }
    }
    TreePlace pop() noexcept {
        assert(count_ > 0);
        return places_[--count_];
    }

private:
    std::array<TreePlace, kMostPlaces> places_;
    std::size_t count_ = 0;
};

class NearLeaves {
public:
    NearLeaves(const Model& a, const Model& b, const Placement& placement, double reach) noexcept
        : a_(a),
          b_(b),
          a_has_gaps_(!a.bvh().lanes.empty()),
          b_has_gaps_(!b.bvh().lanes.empty()),
          placed_(place_boxes(a, b, placement)),
          tests_(tests_for(a_, b_, Prefer::swept)) {
        reach_.limit = float_reach(std::ldexp(reach, placed_.exponent));
    }

    std::size_t find(std::span<std::uint32_t> room) const noexcept {
        std::size_t count = 0;
        for (Places open(a_); !open.empty();) {
            const TestedBoxes boxes = boxes_of(a_, open.pop(), true);
            const unsigned near = near_boxes(boxes);
            if (boxes.first_below.height > 0) {
                open.push_children(boxes.first_below, near);
                continue;
            }
            for (unsigned bits = near; bits != 0; bits &= bits - 1) {
                if (count == room.size()) return count + 1;
                room[count++] =
                    boxes.first_below.index + static_cast<std::uint32_t>(std::countr_zero(bits));
            }
        }
        return count;
    }

private:
    static unsigned used(const Tree& tree, const TestedBoxes& boxes, bool has_gaps) noexcept {
        const unsigned all = chosen(boxes);
        return has_gaps ? all & used_boxes(tree.nodes[boxes.node]) : all;
    }

    /// Returns the boxes of a node of A that are near a leaf of B: a bit set.
    [[nodiscard]] unsigned near_boxes(const TestedBoxes& side_a) const noexcept {
        const kernels::NodeBoxes in_a = node_boxes(a_, side_a, tests_.reads_swept);
        unsigned open = used(a_, side_a, a_has_gaps_);
        unsigned near = 0;
        for (Places places(b_); open != 0 && !places.empty();) {
            const TestedBoxes side_b = boxes_of(b_, places.pop(), true);
            const unsigned of_b = used(b_, side_b, b_has_gaps_);
            if (of_b == 0) continue;
            kernels::BoxPairFloats gaps;
            const kernels::BoxPairs pairs = tests_.near(
                placed_.placement, in_a, node_boxes(b_, side_b, tests_.reads_swept),
                {static_cast<std::uint8_t>(open), static_cast<std::uint8_t>(of_b), nullptr}, reach_,
                gaps);
            if (side_b.first_below.height > 0) {
                places.push_children(side_b.first_below, kernels::boxes_of_b(pairs));
            } else {
                near |= kernels::boxes_of_a(pairs);
                open &= ~near;
            }
        }
        return near;
    }

    Tree a_;
    Tree b_;
    bool a_has_gaps_;
    bool b_has_gaps_;
    PlacedBoxes placed_;
    kernels::BoundTests tests_;
    kernels::Reach reach_{};
};

}  // namespace

std::size_t find_near_leaves(const Model& a, const Model& b, const Placement& placement,
                             double reach, std::span<std::uint32_t> room) noexcept {
    assert(reach >= 0 && a.triangle_count() > 0 && b.triangle_count() > 0);
    return NearLeaves(a, b, placement, reach).find(room);
}

}  // namespace cdprep
