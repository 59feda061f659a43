// SPDX-License-Identifier: MIT
#include "build/make_oriented.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "build/chunks.h"
#include "build/frame_map.h"
#include "build/oriented_axes.h"
#include "cdprep/format/portable.h"

// The axes are those of the surface below a box (oriented_axes.h). The moments of a box are the sum
// of the moments of its contents. Its extents are those of all vertices below. Eight boxes are
// fitted side by side.

namespace cdprep::build {
namespace {

using format::BvhLeaf;
using format::BvhNode;
using format::BvhShape;
using format::kBvhWidth;
using format::OrientedNode;

using Floats = Lanes<float, kBvhWidth>;

/// A leaf's corners relative to its own middle, in floats, and the place of that middle.
struct LocalLeaf {
    std::array<std::array<Floats, 3>, 3> corner;  ///< [corner][axis], times 2^-exponent frame units
    Vector middle;                                ///< frame coordinates
};

class LeafReader {
public:
    explicit LeafReader(const Bvh& bvh)
        : map_(bvh.frame),
          exact_(bvh.exact_leaves),
          scale_(bvh.exact_leaves ? std::ldexp(1.0F, bvh.frame.exponent) : 1) {}

    /// Returns the corners in frame units.
    [[nodiscard]] LocalLeaf read(const BvhLeaf& leaf) const {
        LocalLeaf local;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float origin = exact_ ? leaf.origin[axis] : 0;
            for (std::size_t corner = 0; corner < 3; ++corner) {
                const Floats& from = leaf.corner[corner][axis];
                Floats& to = local.corner[corner][axis];
                for_lanes<8>([&](std::size_t k) { to[k] = (from[k] - origin) * scale_; });
            }
            local.middle[axis] =
                exact_ ? map_.near(double{leaf.origin[axis]}, axis) : double{leaf.origin[axis]};
        }
        return local;
    }

private:
    FrameMap map_;
    bool exact_;
    float scale_;
};

/// Returns a power of two near 1 / size, so that squares of squares stay in the range of float.
float unit_of(const BvhLeaf& leaf) {
    const float size = std::max({leaf.half[0], leaf.half[1], leaf.half[2], 0x1p-100F});
    return format::bit_cast<float>((254U << 23U) -
                                   (format::bit_cast<std::uint32_t>(size) & 0x7f800000U));
}

/// Returns the moments of a leaf. For one triangle, the integral of x x^T is
/// area / 12 (9 m m^T + sum of p p^T).
Moments moments_of(const BvhLeaf& leaf, const LocalLeaf& local) {
    const float unit = unit_of(leaf);
    auto p = local.corner;
    for (auto& corner : p) {
        for (Floats& row : corner) for_lanes<8>([&](std::size_t k) { row[k] *= unit; });
    }
    Floats area;
    for_lanes<8>([&](std::size_t k) {
        const float ux = p[1][0][k] - p[0][0][k];
        const float uy = p[1][1][k] - p[0][1][k];
        const float uz = p[1][2][k] - p[0][2][k];
        const float vx = p[2][0][k] - p[0][0][k];
        const float vy = p[2][1][k] - p[0][1][k];
        const float vz = p[2][2][k] - p[0][2][k];
        const float x = uy * vz - uz * vy;
        const float y = uz * vx - ux * vz;
        const float z = ux * vy - uy * vx;
        area[k] = 0.5F * std::sqrt((x * x + y * y) + z * z);
    });
    // Lanes past the last triangle repeat it.
    for (std::size_t k = leaf.count; k < kBvhWidth; ++k) area[k] = 0;
    const float whole = sum_of(area);
    Moments moments;
    moments.middle = local.middle;
    if (!(whole > 0)) return moments;
    std::array<Floats, 3> sum;  // of the corners: three times the middle
    for (std::size_t i = 0; i < 3; ++i) {
        for_lanes<8>([&](std::size_t k) { sum[i][k] = (p[0][i][k] + p[1][i][k]) + p[2][i][k]; });
    }
    std::array<double, 3> middle;
    for (std::size_t i = 0; i < 3; ++i) {
        Floats weighed;
        for_lanes<8>([&](std::size_t k) { weighed[k] = area[k] * sum[i][k]; });
        middle[i] = double{sum_of(weighed)} / (3 * double{whole});
        moments.middle[i] += middle[i] / double{unit};
    }
    const double square = 1 / (double{unit} * double{unit});
    moments.area = double{whole} * square;
    for (std::size_t m = 0; m < 6; ++m) {
        const std::size_t i = kRow[m];
        const std::size_t j = kColumn[m];
        Floats weighed;
        for_lanes<8>([&](std::size_t k) {
            const float squares =
                (p[0][i][k] * p[0][j][k] + p[1][i][k] * p[1][j][k]) + p[2][i][k] * p[2][j][k];
            weighed[k] = area[k] * (sum[i][k] * sum[j][k] + squares);
        });
        moments.second[m] = (double{sum_of(weighed)} / 12 - double{whole} * middle[i] * middle[j]) *
                            square * square;
    }
    return moments;
}

/// Returns the middle of an axis-aligned box, as floats: near everything in it.
Vector middle_of(const BvhNode& node, std::size_t box) {
    Vector middle{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        middle[axis] = double{0.5F * (node.lower[axis][box] + node.upper[axis][box])};
    }
    return middle;
}

constexpr float kFar = std::numeric_limits<float>::infinity();

/// The extents of eight objects along three axes.
struct Range {
    std::array<Floats, 3> lower;
    std::array<Floats, 3> upper;
};

/// Extents along three axes.
struct LocalBounds {
    std::array<float, 3> lower = {kFar, kFar, kFar};
    std::array<float, 3> upper = {-kFar, -kFar, -kFar};

    void grow(std::size_t axis, const Floats& low, const Floats& high) {
        lower[axis] = std::min(lower[axis], least(low));
        upper[axis] = std::max(upper[axis], greatest(high));
    }
    [[nodiscard]] bool holds(const Range& range, std::size_t lane) const {
        int inside = 1;
        for (std::size_t k = 0; k < 3; ++k) {
            inside &= int{lower[k] <= range.lower[k][lane]} & int{range.upper[k][lane] <= upper[k]};
        }
        return inside != 0;
    }
};

/// Widens the bound by the coordinates of a leaf's corners along the axes, relative to `origin`.
void widen(LocalBounds& bound, const LocalLeaf& leaf, const Vector& origin, const Axes& axes) {
    const Vector from = {leaf.middle[0] - origin[0], leaf.middle[1] - origin[1],
                         leaf.middle[2] - origin[2]};
    for (std::size_t k = 0; k < 3; ++k) {
        const auto x = static_cast<float>(axes.used[k][0]);
        const auto y = static_cast<float>(axes.used[k][1]);
        const auto z = static_cast<float>(axes.used[k][2]);
        const auto along = static_cast<float>(dot(from, axes.used[k]));
        Floats lower;
        Floats upper;
        const auto& p = leaf.corner;
        for_lanes<8>([&](std::size_t i) {
            const float a = (p[0][0][i] * x + p[0][1][i] * y) + p[0][2][i] * z;
            const float b = (p[1][0][i] * x + p[1][1][i] * y) + p[1][2][i] * z;
            const float c = (p[2][0][i] * x + p[2][1][i] * y) + p[2][2][i] * z;
            const float low = (a < b ? a : b);
            const float high = (a < b ? b : a);
            lower[i] = (c < low ? c : low) + along;
            upper[i] = (high < c ? c : high) + along;
        });
        bound.grow(k, lower, upper);
    }
}

/// Returns the reach of the boxes of a node along the axes, relative to `origin`. Of each box,
/// takes the corners that lie farthest back and farthest on.
Range reach_of(const BvhNode& node, const Vector& origin, const Axes& axes) {
    Range reach;
    for (std::size_t k = 0; k < 3; ++k) {
        reach.lower[k].fill(0);
        reach.upper[k].fill(0);
        for (std::size_t i = 0; i < 3; ++i) {
            const auto along = static_cast<float>(axes.used[k][i]);
            const auto from = static_cast<float>(origin[i]);
            const Floats& back = along < 0 ? node.upper[i] : node.lower[i];
            const Floats& on = along < 0 ? node.lower[i] : node.upper[i];
            for_lanes<8>(
                [&](std::size_t box) { reach.lower[k][box] += (back[box] - from) * along; });
            for_lanes<8>([&](std::size_t box) { reach.upper[k][box] += (on[box] - from) * along; });
        }
    }
    return reach;
}

/// Writes the box of one bound. Let u = 2^-24. The axes are unit and at right angles to 8 u, the
/// third for any rounding. So the coordinates of a point along them are off by 24 u times the
/// largest. The tests treat the cross terms as zero, which costs as much again. No corner, and no
/// leaf's middle, is farther from `origin` than 3 times the largest half extent. Boxes and middles
/// were rounded by 2^-23, which is added to that. The coordinates were found in floats relative to
/// such a middle. That costs 12 u for the products and sums and 5 u for the third axis. The middle
/// costs 3 u and adding it 6 u. A box that seemed to lie inside and was not visited costs 21 u. The
/// total is 95 u of the largest, for which 2^-17 is taken. Applied to the 2^-23 above, that is less
/// than 2^-40. Leaves that are not exact were rounded by u. 2^-23 of the frame's size covers that
/// and the rounding of the centre.
void set_box(OrientedNode& node, std::size_t box, const Vector& origin, const Axes& axes,
             const LocalBounds& bound, bool exact) {
    Reach reach{};
    for (std::size_t k = 0; k < 3; ++k) {
        reach.lower[k] = double{bound.lower[k]};
        reach.upper[k] = double{bound.upper[k]};
    }
    write_box(origin, axes, reach, exact ? 0x1p-40 : 0x1p-24, node, box);
}

/// Returns which of the first `used` lanes is the least.
std::size_t least_of(const Floats& lanes, std::size_t used) {
    assert(used > 0 && used <= lanes.size());
    std::size_t best = 0;
    for (std::size_t i = 1; i < used; ++i) best = lanes[i] < lanes[best] ? i : best;
    return best;
}

std::size_t greatest_of(const Floats& lanes, std::size_t used) {
    assert(used > 0 && used <= lanes.size());
    std::size_t best = 0;
    for (std::size_t i = 1; i < used; ++i) best = lanes[best] < lanes[i] ? i : best;
    return best;
}

class Fitter {
public:
    explicit Fitter(Bvh& bvh)
        : bvh_(bvh),
          shape_(format::bvh_shape(static_cast<std::uint32_t>(bvh.order.size()))),
          reader_(bvh) {}

    /// Fits all boxes of a node and of everything below it.
    Moments fit_subtree(std::uint32_t level, std::size_t index) const {
        assert(level < shape_.levels && index < shape_.count[level]);
        if (level == 0) return fit_leaves(index);
        MomentLanes below;
        for (std::size_t box = 0; box < used_boxes(level, index); ++box) {
            below.set(box, fit_subtree(level - 1, index * kBvhWidth + box));
        }
        return fit_node(level, index, below);
    }

    /// Fits the boxes of a node above level 0 from the moments of their contents; returns the sum
    /// of these.
    Moments fit_node(std::uint32_t level, std::size_t index, const MomentLanes& below) const {
        set_boxes(level, index, below,
                  [&](LocalBounds& bound, std::size_t box, const Vector& origin, const Axes& axes) {
                      widen_by(bound, level, index * kBvhWidth + box, origin, axes);
                  });
        return sum_of(below);
    }

    [[nodiscard]] const BvhShape& shape() const {
        return shape_;
    }
    [[nodiscard]] std::size_t used_boxes(std::uint32_t level, std::size_t index) const {
        return shape_.used_boxes(level, static_cast<std::uint32_t>(index));
    }

private:
    Moments fit_leaves(std::size_t index) const {
        MomentLanes below;
        std::array<LocalLeaf, kBvhWidth> local;
        for (std::size_t box = 0; box < used_boxes(0, index); ++box) {
            const BvhLeaf& leaf = bvh_.leaves[index * kBvhWidth + box];
            local[box] = reader_.read(leaf);
            below.set(box, moments_of(leaf, local[box]));
        }
        set_boxes(0, index, below,
                  [&](LocalBounds& bound, std::size_t box, const Vector& origin, const Axes& axes) {
                      widen(bound, local[box], origin, axes);
                  });
        return sum_of(below);
    }

    /// widen_box(bound, box, origin, axes) computes the extents of one box.
    template <class WidenBox>
    void set_boxes(std::uint32_t level, std::size_t index, const MomentLanes& below,
                   const WidenBox& widen_box) const {
        const std::size_t number = shape_.first[level] + index;
        const NodeAxes axes = axes_of(below);
        OrientedNode& node = bvh_.oriented_nodes[number];
        for (std::size_t box = 0; box < kBvhWidth; ++box) {
            if (box >= used_boxes(level, index)) {
                write_no_box(node, box);
                continue;
            }
            const Vector origin = middle_of(bvh_.nodes[number], box);
            LocalBounds bound;
            widen_box(bound, box, origin, axes[box]);
            set_box(node, box, origin, axes[box], bound, bvh_.exact_leaves);
        }
    }

    /// Widens a bound by the corners below a place: leaf `index` at height 0, node `index` of level
    /// h - 1 at height h. Skips places that cannot widen it.
    void widen_by(LocalBounds& bound, std::uint32_t height, std::size_t index, const Vector& origin,
                  const Axes& axes) const {
        if (height == 0) return widen(bound, reader_.read(bvh_.leaves[index]), origin, axes);
        const std::size_t used = used_boxes(height - 1, index);
        const Range reach = reach_of(bvh_.nodes[shape_.first[height - 1] + index], origin, axes);
        // The boxes that reach farthest, either way along each axis, come first. The others are
        // then likely to lie inside.
        unsigned left = (1U << used) - 1;
        const auto visit = [&](std::size_t box) {
            if ((left >> box & 1U) == 0) return;
            left &= ~(1U << box);
            if (bound.holds(reach, box)) return;
            widen_by(bound, height - 1, index * kBvhWidth + box, origin, axes);
        };
        for (std::size_t k = 0; k < 3; ++k) {
            visit(least_of(reach.lower[k], used));
            visit(greatest_of(reach.upper[k], used));
        }
        for (std::size_t box = 0; box < used; ++box) visit(box);
    }

    Bvh& bvh_;
    BvhShape shape_;
    LeafReader reader_;
};

/// The level of the nodes that are tasks: 4096 triangles each.
constexpr std::uint32_t kTaskLevel = 2;

/// Fits one level above the tasks.
std::vector<Moments> fit_level(const Fitter& fitter, std::uint32_t level,
                               const std::vector<Moments>& below, ParallelFor parallel_for) {
    std::vector<Moments> sums(fitter.shape().count[level]);
    parallel_for(sums.size(), [&](std::size_t i) {
        MomentLanes lanes;
        for (std::size_t box = 0; box < fitter.used_boxes(level, i); ++box) {
            lanes.set(box, below[i * kBvhWidth + box]);
        }
        sums[i] = fitter.fit_node(level, i, lanes);
    });
    return sums;
}

}  // namespace

void make_oriented(Bvh& bvh, ParallelFor parallel_for) {
    assert(!bvh.order.empty());
    bvh.oriented_nodes.resize(bvh.nodes.size());
    const Fitter fitter(bvh);
    const std::uint32_t lowest = std::min(kTaskLevel, fitter.shape().levels - 1);
    std::vector<Moments> sums(fitter.shape().count[lowest]);
    parallel_for(sums.size(), [&](std::size_t i) { sums[i] = fitter.fit_subtree(lowest, i); });
    for (std::uint32_t level = lowest + 1; level < fitter.shape().levels; ++level) {
        sums = fit_level(fitter, level, sums, parallel_for);
    }
}

}  // namespace cdprep::build
