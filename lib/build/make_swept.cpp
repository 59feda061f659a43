// SPDX-License-Identifier: MIT
#include "build/make_swept.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "build/chunks.h"
#include "cdprep/advanced/parallel_for.h"
#include "core/numbers.h"
#include "exact/vectors.h"

// Swept spheres in the manner of Larsen, Gottschalk, Lin and Manocha 1999, along the axes of the
// oriented box. The surface is projected on the axes that are not swept; a ball around the
// projection gives the radius. Then each side is as short as that radius allows. A point far from
// the middle's plane uses more of the radius than a near one. Last, the radius becomes the largest
// distance from the middle as stored. So it covers every vertex, for any rounding in the earlier
// steps.

namespace cdprep::build {
namespace {

using format::BvhLeaf;
using format::BvhShape;
using format::kBvhWidth;
using format::OrientedNode;
using format::SweptKind;
using format::SweptNode;

using Vector = std::array<double, 3>;

/// The corners below one box, in frame coordinates.
class Corners {
public:
    Corners(const Bvh& bvh, std::size_t first_leaf, std::size_t last_leaf)
        : leaves_(bvh.leaves.data() + first_leaf, last_leaf - first_leaf),
          exact_(bvh.exact_leaves),
          origin_{bvh.frame.origin.x, bvh.frame.origin.y, bvh.frame.origin.z},
          scale_(bvh.exact_leaves ? std::ldexp(1.0, bvh.frame.exponent) : 1) {}

    template <class Visit>
    void for_each(Visit visit) const {
        for (const BvhLeaf& leaf : leaves_) {
            for (const auto& corner : leaf.corner) {
                for (std::size_t lane = 0; lane < leaf.count; ++lane) {
                    visit(Vector{place(leaf, corner, 0, lane), place(leaf, corner, 1, lane),
                                 place(leaf, corner, 2, lane)});
                }
            }
        }
    }

private:
    using Rows = std::array<std::array<float, kBvhWidth>, 3>;
    [[nodiscard]] double place(const BvhLeaf& leaf, const Rows& corner, std::size_t axis,
                               std::size_t lane) const {
        const double x = double{corner[axis][lane]};
        return exact_ ? (x - origin_[axis]) * scale_ : x + double{leaf.origin[axis]};
    }

    std::span<const BvhLeaf> leaves_;
    bool exact_;
    Vector origin_;
    double scale_;
};

/// The axes of the oriented box, as floats; the axis of the surface's greatest extent first.
struct SweptAxes {
    std::array<std::array<float, 3>, 3> stored;
    std::array<Vector, 3> used;
};

SweptAxes axes_of(const OrientedNode& node, std::size_t box) {
    SweptAxes axes{};
    for (std::size_t i = 0; i < 3; ++i) {
        axes.stored[1][i] = node.axis[1][i][box];
        axes.stored[2][i] = node.axis[0][i][box];
    }
    const auto& m = axes.stored[1];
    const auto& n = axes.stored[2];
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        const std::size_t k = (i + 2) % 3;
        axes.stored[0][i] =
            static_cast<float>(double{n[j]} * double{m[k]} - double{n[k]} * double{m[j]});
    }
    for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t i = 0; i < 3; ++i) axes.used[k][i] = double{axes.stored[k][i]};
    }
    return axes;
}

/// A swept sphere along its axes, relative to the centre of the oriented box.
struct Fit {
    Vector middle{};  ///< of the ball and of the sides, along the axes
    std::array<double, 2> half{};
    double radius = 0;
};

/// Computes the steps of a fit: first the ball, then the sides in order.
struct SweptFitter {
    const Corners& corners;
    const SweptAxes& axes;
    Vector origin;
    std::size_t sides;  ///< the number of swept axes

    [[nodiscard]] Vector along_axes(const Vector& p) const {
        const Vector from = minus(p, origin);
        return {dot(from, axes.used[0]), dot(from, axes.used[1]), dot(from, axes.used[2])};
    }
    /// Returns the square of the distance from the ball's middle across the axes that are not
    /// swept.
    [[nodiscard]] double squared_across(const Vector& at, const Vector& middle) const {
        double sum = 0;
        for (std::size_t k = sides; k < 3; ++k) sum += (at[k] - middle[k]) * (at[k] - middle[k]);
        return sum;
    }

    void fit_ball(Fit& fit) const;
    void fit_side(Fit& fit, std::size_t side) const;
};

/// Fits a ball around the projection: steps of falling length towards the farthest corner (Badoiu
/// and Clarkson 2003); keeps the best. For one axis the box's middle is the answer.
void SweptFitter::fit_ball(Fit& fit) const {
    assert(sides <= 2);
    constexpr int kSteps = 12;
    Vector middle{};
    double least = kInfinity;
    for (int step = 0; step < (sides == 2 ? 1 : kSteps); ++step) {
        double squared = 0;
        Vector farthest = middle;
        corners.for_each([&](const Vector& p) {
            const Vector at = along_axes(p);
            const double d = squared_across(at, middle);
            if (d > squared) {
                squared = d;
                farthest = at;
            }
        });
        if (squared < least) {
            least = squared;
            for (std::size_t k = sides; k < 3; ++k) fit.middle[k] = middle[k];
        }
        for (std::size_t k = sides; k < 3; ++k) {
            middle[k] += (farthest[k] - middle[k]) / (step + 2);
        }
    }
    fit.radius = std::sqrt(least);
}

/// Fits the shortest side with which every corner is within the radius. A corner's distance beyond
/// the earlier sides reduces its share of the radius.
void SweptFitter::fit_side(Fit& fit, std::size_t side) const {
    assert(side < sides);
    double lower = kInfinity;
    double upper = -kInfinity;
    corners.for_each([&](const Vector& p) {
        const Vector at = along_axes(p);
        double rest = fit.radius * fit.radius - squared_across(at, fit.middle);
        for (std::size_t k = 0; k < side; ++k) {
            const double beyond = std::fabs(at[k] - fit.middle[k]) - fit.half[k];
            if (beyond > 0) rest -= beyond * beyond;
        }
        const double reach = std::sqrt(std::max(rest, 0.0));
        lower = std::min(lower, at[side] + reach);
        upper = std::max(upper, at[side] - reach);
    });
    fit.middle[side] = 0.5 * (lower + upper);
    fit.half[side] = std::max(0.0, 0.5 * (upper - lower));
}

/// Writes all but the radius.
void set_middle(SweptNode& node, std::size_t box, const Vector& origin, const SweptAxes& axes,
                const Fit& fit) {
    for (std::size_t i = 0; i < 3; ++i) {
        double centre = origin[i];
        for (std::size_t k = 0; k < 3; ++k) centre += fit.middle[k] * axes.used[k][i];
        node.centre[i][box] = static_cast<float>(centre);
        for (std::size_t k = 0; k < 2; ++k) node.side[k].axis[i][box] = axes.stored[k][i];
    }
    for (std::size_t k = 0; k < 2; ++k) {
        node.side[k].half[box] = static_cast<float>(fit.half[k]);
    }
}

/// Returns the largest distance of a corner from the stored middle, rounded up. Leaves that are not
/// exact were rounded by 2^-25 a coordinate; 2^-24 covers three. 2^-40 covers the rounding of
/// double here.
float radius_of(const SweptNode& node, std::size_t box, const Corners& corners, bool exact) {
    std::array<Vector, 2> axis{};
    Vector centre{};
    for (std::size_t i = 0; i < 3; ++i) {
        centre[i] = double{node.centre[i][box]};
        for (std::size_t k = 0; k < 2; ++k) axis[k][i] = double{node.side[k].axis[i][box]};
    }
    double squared = 0;
    corners.for_each([&](const Vector& p) {
        Vector rest = minus(p, centre);
        for (std::size_t k = 0; k < 2; ++k) {
            const double half = double{node.side[k].half[box]};
            const double along = std::clamp(dot(rest, axis[k]), -half, half);
            for (std::size_t i = 0; i < 3; ++i) rest[i] -= along * axis[k][i];
        }
        squared = std::max(squared, dot(rest, rest));
    });
    const double rounding = exact ? 0 : 0x1p-24;
    return static_cast<float>((std::sqrt(squared) + rounding) * (1 + 0x1p-22) + 0x1p-40);
}

void set_unused(SweptNode& node, std::size_t box) {
    for (std::size_t k = 0; k < 2; ++k) node.side[k].axis[k][box] = 1;
}

void set_sphere(SweptNode& node, std::size_t box, const OrientedNode& oriented,
                const Corners& corners, SweptKind kind, bool exact) {
    const SweptAxes axes = axes_of(oriented, box);
    const Vector origin = {double{oriented.centre[0][box]}, double{oriented.centre[1][box]},
                           double{oriented.centre[2][box]}};
    const SweptFitter fitter{corners, axes, origin, static_cast<std::size_t>(kind)};
    Fit fit;
    fitter.fit_ball(fit);
    for (std::size_t side = 0; side < fitter.sides; ++side) fitter.fit_side(fit, side);
    set_middle(node, box, origin, axes, fit);
    node.radius[box] = radius_of(node, box, corners, exact);
}

SweptKind kind_of(BvhBounds bounds) {
    if (bounds == BvhBounds::swept_points) return SweptKind::point;
    return bounds == BvhBounds::swept_lines ? SweptKind::line : SweptKind::rectangle;
}

}  // namespace

void make_swept(Bvh& bvh, BvhBounds bounds, ParallelFor parallel_for) {
    assert(bounds != BvhBounds::aligned && bounds != BvhBounds::oriented);
    const SweptKind kind = kind_of(bounds);
    const BvhShape shape = format::bvh_shape(static_cast<std::uint32_t>(bvh.order.size()));
    bvh.swept_kind = kind;
    assert(bvh.oriented_nodes.size() == shape.node_count);
    bvh.swept_nodes.assign(shape.node_count, SweptNode{});
    std::size_t leaves_per_box = 1;
    for (std::uint32_t level = 0; level < shape.levels; ++level) {
        const auto fit = [&](std::size_t i) {
            const std::size_t index = shape.first[level] + i;
            const std::uint32_t used = shape.used_boxes(level, static_cast<std::uint32_t>(i));
            for (std::size_t box = 0; box < kBvhWidth; ++box) {
                if (box >= used) {
                    set_unused(bvh.swept_nodes[index], box);
                    continue;
                }
                const std::size_t first = (i * kBvhWidth + box) * leaves_per_box;
                const std::size_t last = std::min(bvh.leaves.size(), first + leaves_per_box);
                assert(first < last);
                set_sphere(bvh.swept_nodes[index], box, bvh.oriented_nodes[index],
                           Corners(bvh, first, last), kind, bvh.exact_leaves);
            }
        };
        const std::size_t per_task =
            std::max<std::size_t>(1, kLeavesPerTask / (kBvhWidth * leaves_per_box));
        for_chunks(shape.count[level], per_task, parallel_for,
                   [&](std::size_t first, std::size_t last) {
                       for (std::size_t i = first; i < last; ++i) fit(i);
                   });
        leaves_per_box *= kBvhWidth;
    }
    if (bounds != BvhBounds::oriented_and_swept) bvh.oriented_nodes.clear();
}

}  // namespace cdprep::build
