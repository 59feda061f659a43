// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "cdprep/format/pieces.h"
#include "core/numbers.h"
#include "exact/vectors.h"
#include "walk/leaf_batch.h"
#include "walk/walk_pairs.h"

namespace cdprep {

/// The reach of something along a direction, and the point where it is attained. Pair units, along
/// its model's axes.
struct Reached {
    double far = -std::numeric_limits<double>::infinity();      ///< nothing is farther
    double reached = -std::numeric_limits<double>::infinity();  ///< the height of `at`
    Double3 at{};
};

/// One model's hierarchy over pieces, as used in a search for its farthest points.
struct TreeSide {
    const Tree& tree;
    const kernels::LeafFrame& leaf;
    double scale;                                  ///< of boxes
    std::span<const format::PieceNodeHull> hulls;  ///< of the first nodes
    const format::FileHeader& head;
};

using Direction = std::array<float, 3>;

/// Computes the reach of each box of a node along a direction, or that of its swept sphere if that
/// is less. Frame units.
inline void find_reaches(const Tree& tree, std::uint32_t number, const Direction& along,
                         float* reach) noexcept {
    const format::BvhNode& node = tree.nodes[number];
    const auto far_side = [&](std::size_t axis) {
        return (along[axis] > 0 ? node.upper : node.lower)[axis].data();
    };
    const float* x = far_side(0);
    const float* y = far_side(1);
    const float* z = far_side(2);
    const format::SweptNode& swept = tree.swept[number];
    for (std::size_t i = 0; i < format::kBvhWidth; ++i) {
        const auto part = [&](const auto& rows) {
            return along[0] * rows[0][i] + along[1] * rows[1][i] + along[2] * rows[2][i];
        };
        const float of_swept = part(swept.centre) + swept.radius[i] +
                               std::fabs(part(swept.side[0].axis)) * swept.side[0].half[i] +
                               std::fabs(part(swept.side[1].axis)) * swept.side[1].half[i];
        const float of_box = along[0] * x[i] + along[1] * y[i] + along[2] * z[i];
        reach[i] = std::min(of_box, of_swept);
    }
}

/// Updates `best` with the farthest corner of a leaf's triangles, if it is farther.
inline void offer_leaf(const LeafView& view, const kernels::LeafFrame& frame,
                       const Direction& along, Reached& best) noexcept {
    std::array<float, 3> middle{};
    std::array<double, 3> at{};
    double far = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float origin = view.leaf[kernels::kLeafOrigin + axis];
        middle[axis] = origin * frame.takes_origin;
        at[axis] = (double{origin} - frame.frame_origin[axis]) * frame.scale;
        far += double{along[axis]} * at[axis];
    }
    constexpr std::size_t kLanes = kernels::kLanes;
    alignas(32) std::array<std::array<float, kLanes>, 3> beyond;
    for (std::size_t corner = 0; corner < 3; ++corner) {
        const float* rows = view.leaf + 3 * kLanes * corner;
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            beyond[corner][lane] = along[0] * (rows[lane] - middle[0]) +
                                   along[1] * (rows[kLanes + lane] - middle[1]) +
                                   along[2] * (rows[2 * kLanes + lane] - middle[2]);
        }
    }
    alignas(32) std::array<float, kLanes> highest;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const float two = std::max(beyond[0][lane], beyond[1][lane]);
        highest[lane] = std::max(two, beyond[2][lane]);
    }
    auto lane = static_cast<std::size_t>(std::countr_zero(view.used));
    for (unsigned rest = view.used & (view.used - 1U); rest != 0; rest &= rest - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(rest));
        lane = highest[i] > highest[lane] ? i : lane;
    }
    const float most = highest[lane];
    far += frame.scale * double{most};
    if (!(far > best.reached)) return;
    std::size_t corner = beyond[1][lane] > beyond[0][lane] ? 1 : 0;
    if (beyond[2][lane] > beyond[corner][lane]) corner = 2;
    const float* rows = view.leaf + 3 * kLanes * corner + lane;
    const auto coordinate = [&](std::size_t axis) {
        return at[axis] + frame.scale * double{rows[kLanes * axis] - middle[axis]};
    };
    best.reached = far;
    best.at = {coordinate(0), coordinate(1), coordinate(2)};
}

/// Updates `best` with the farthest corner of a hull around everything below a node, if it is
/// farther.
inline void offer_hull(const TreeSide& side, const format::PieceNodeHull& hull,
                       const Direction& along, Reached& best) noexcept {
    const std::array<double, 3> d = {along[0], along[1], along[2]};
    const std::size_t blocks = (hull.count + format::kHullLanes - 1) / format::kHullLanes;
    const std::uint32_t number = std::min(
        kernels::active().farthest(hull.block[0].at[0].data(), blocks, d.data()), hull.count - 1);
    const auto& block = hull.block[number / format::kHullLanes].at;
    const std::size_t lane = number % format::kHullLanes;
    const double unit = scaled(side.scale, side.head.frame_exponent);
    const Double3& o = side.head.frame_origin;
    const Double3 at = {(block[0][lane] - o.x) * unit, (block[1][lane] - o.y) * unit,
                        (block[2][lane] - o.z) * unit};
    const double reached = d[0] * at.x + d[1] * at.y + d[2] * at.z;
    if (!(reached > best.reached)) return;
    best.reached = reached;
    best.at = at;
}

/// Descends into boxes that reach beyond the best by more than the tolerance.
template <class EachView>
void offer_below(const TreeSide& side, const TreePlace& place, const Direction& along,
                 const EachView& each_view, double tolerance, Reached& best) noexcept {
    if (place.height == 0) {
        each_view(place.index, [&](const LeafView& view) {
            offer_leaf(view, side.leaf, along, best);
            return true;
        });
        return;
    }
    const TestedBoxes boxes = boxes_of(side.tree, place, true);
    if (boxes.node < side.hulls.size()) {
        offer_hull(side, side.hulls[boxes.node], along, best);
        return;
    }
    alignas(32) std::array<float, format::kBvhWidth> reach;
    find_reaches(side.tree, boxes.node, along, reach.data());
    for (unsigned rest = chosen(boxes); rest != 0;) {
        auto farthest = static_cast<std::uint32_t>(std::countr_zero(rest));
        for (unsigned other = rest & (rest - 1); other != 0; other &= other - 1) {
            const auto i = static_cast<std::uint32_t>(std::countr_zero(other));
            farthest = reach[i] > reach[farthest] ? i : farthest;
        }
        const double bound = side.scale * double{reach[farthest]};
        if (!(bound > best.reached + tolerance)) {
            best.far = std::max(best.far, bound);
            return;
        }
        rest &= ~(1U << farthest);
        const TreePlace below = {boxes.first_below.height, boxes.first_below.index + farthest};
        offer_below(side, below, along, each_view, tolerance, best);
    }
}

/// Returns the reach along a direction of what is below a place, or of the hull around it, at most
/// `tolerance` too large. `each_view(leaf, test)` calls test(view) for a leaf's triangles.
template <class EachView>
Reached farthest_below(const TreeSide& side, const TreePlace& place, const Direction& along,
                       const EachView& each_view, double tolerance) noexcept {
    Reached best;
    offer_below(side, place, along, each_view, tolerance, best);
    // Coordinates that overflow reach nowhere. They must prove nothing.
    best.far = best.reached > -kInfinity ? std::max(best.far, best.reached) : kInfinity;
    return best;
}

}  // namespace cdprep
