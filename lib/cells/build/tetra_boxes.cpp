// SPDX-License-Identifier: MIT
#include "cells/build/tetra_steps.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "build/frame_map.h"
#include "build/oriented_axes.h"
#include "cdprep/advanced/parallel_for.h"
#include "cdprep/format/octree.h"
#include "cells/build/cone_maximum.h"
#include "core/numbers.h"

// Each node is bounded separately, from all lists below it. cone_maximum() bounds the part in the
// node's cone of a triangle that other leaves list too. An aligned box is found along x, y and z,
// an oriented one along the axes of the surface. Those are computed from whole triangles, because
// axes need not be exact.

namespace cdprep::build {
namespace {

using format::BvhNode;
using format::kBvhWidth;
using format::kSharedReference;
using format::kTetraBoxStride;
using format::OrientedNode;
using format::TetraNode;

constexpr std::array<Vector, 3> kAligned = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

/// The reach of the contents of a cone, seen from the centre, along three axes. Components of the
/// axes are at most 1 + 2^-23. Corners are off by 5 u of their sizes along one, which slack_of()
/// covers.
class ReachOf {
public:
    ReachOf(const ConeFaces& faces, const std::array<Vector, 3>& axes)
        : faces_(faces), axes_(axes) {}

    [[nodiscard]] const Reach& reach() const {
        return reach_;
    }

    /// Widens the reach by the part of a triangle that lies in the cone. The order of triangles
    /// changes nothing.
    void add(const SeenTriangle& t, bool is_within) {
        FaceValues f;
        bool has_values = is_within;
        for (std::size_t k = 0; k < 3; ++k) {
            const Along along = along_axis(t, axes_[k]);
            const bool lowers = along.lower < reach_.lower[k];
            const bool raises = along.upper > reach_.upper[k];
            // Mostly the whole triangle is within the reach of others.
            if (!lowers && !raises) continue;
            if (is_within) {
                reach_.lower[k] = std::min(reach_.lower[k], along.lower);
                reach_.upper[k] = std::max(reach_.upper[k], along.upper);
                continue;
            }
            if (!has_values) f = face_values(faces_, t);
            has_values = true;
            const auto& x = along.at;
            if (raises) reach_.upper[k] = std::max(reach_.upper[k], cone_maximum(f, x));
            if (lowers) {
                reach_.lower[k] =
                    std::min(reach_.lower[k], -cone_maximum(f, {-x[0], -x[1], -x[2]}));
            }
        }
    }

private:
    struct Along {
        std::array<double, 3> at;  ///< of each corner
        double lower;
        double upper;
    };
    static Along along_axis(const SeenTriangle& t, const Vector& axis) {
        Along along{{}, kInfinity, -kInfinity};
        for (std::size_t i = 0; i < 3; ++i) {
            const double slack = kValueSlacks * slack_of(t[i]);
            along.at[i] = dot(axis, t[i].at);
            along.lower = std::min(along.lower, along.at[i] - slack);
            along.upper = std::max(along.upper, along.at[i] + slack);
        }
        return along;
    }

    const ConeFaces& faces_;
    std::array<Vector, 3> axes_;
    Reach reach_{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
};

/// The surface below nodes, seen from the centre. Shared triangles count more than once.
struct SurfaceSum {
    double area = 0;
    Vector first{};                  ///< integral of x - middle
    std::array<double, 6> second{};  ///< of (x - middle) (x - middle)^T

    /// Adds a triangle. Its integral of x x^T is area / 12 (9 m m^T + sum of p p^T).
    void add(const SeenTriangle& t, const Vector& middle) {
        std::array<Vector, 3> p{};
        Vector sum{};
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                p[i][k] = t[i].at[k] - middle[k];
                sum[k] += p[i][k];
            }
        }
        const Vector u = {p[1][0] - p[0][0], p[1][1] - p[0][1], p[1][2] - p[0][2]};
        const Vector v = {p[2][0] - p[0][0], p[2][1] - p[0][1], p[2][2] - p[0][2]};
        const Vector n = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                          u[0] * v[1] - u[1] * v[0]};
        const double size = 0.5 * std::sqrt(dot(n, n));
        area += size;
        for (std::size_t k = 0; k < 3; ++k) first[k] += size / 3 * sum[k];
        for (std::size_t m = 0; m < 6; ++m) {
            const std::size_t i = kRow[m];
            const std::size_t j = kColumn[m];
            const double squares = p[0][i] * p[0][j] + p[1][i] * p[1][j] + p[2][i] * p[2][j];
            second[m] += size / 12 * (sum[i] * sum[j] + squares);
        }
    }
    [[nodiscard]] Moments moments(const Vector& middle) const {
        Moments moments{area, middle, {}};
        if (!(area > 0)) return moments;
        for (std::size_t k = 0; k < 3; ++k) moments.middle[k] += first[k] / area;
        for (std::size_t m = 0; m < 6; ++m) {
            moments.second[m] = second[m] - first[kRow[m]] * first[kColumn[m]] / area;
        }
        return moments;
    }
};

class BoxMaker {
public:
    BoxMaker(const TetraInput& input, std::int32_t exponent, const TetraTreeOptions& options,
             TetraTree& tree)
        : input_(input),
          options_(options),
          tree_(tree),
          exponent_(options.frame_exponent - exponent),
          aligned_(tree.nodes.size()),
          moments_(tree.nodes.size()),
          axes_(tree.nodes.size()) {
        const FrameMap frame({options.frame_origin, options.frame_exponent});
        for (std::size_t k = 0; k < 3; ++k) {
            centre_[k] = frame.near(coordinate(input.centre, k), k);
        }
    }

    void run() {
        for_nodes([&](std::size_t i) {
            if (is_leaf(i)) bound_leaf(i);
        });
        for (std::size_t i = tree_.nodes.size(); i-- > 0;) {
            if (!is_leaf(i)) gather_children(i);
        }
        find_axes();
        make_room();
        for_nodes([&](std::size_t i) { write_boxes(i); });
    }

private:
    [[nodiscard]] bool is_leaf(std::size_t i) const {
        return (tree_.nodes[i].flags & format::tetra_inner) == 0;
    }
    template <class Body>
    void for_nodes(const Body& body) const {
        constexpr std::size_t kNodesPerTask = 4;
        for_chunks(tree_.nodes.size(), kNodesPerTask, options_.parallel_for,
                   [&](std::size_t first, std::size_t last) {
                       for (std::size_t i = first; i < last; ++i) body(i);
                   });
    }
    /// Calls body(triangle, is shared) for every reference of the leaves below a node.
    template <class Body>
    void for_listed(std::size_t node, const Body& body) const {
        const TetraNode& at = tree_.nodes[node];
        if (!is_leaf(node)) {
            for (std::size_t k = at.first; k < at.first + at.count; ++k) for_listed(k, body);
            return;
        }
        for (const std::uint32_t item : std::span(tree_.references).subspan(at.first, at.count)) {
            body(input_.seen(item & ~kSharedReference), (item & kSharedReference) != 0);
        }
    }
    [[nodiscard]] Reach reach_along(std::size_t node, const std::array<Vector, 3>& axes) const {
        const ConeFaces faces = cone_faces(tetra_cone(tree_.nodes[node].key));
        ReachOf reach(faces, axes);
        // Whole triangles come first: then few of the others reach farther.
        for (const bool wanted : {false, true}) {
            for_listed(node, [&](const SeenTriangle& t, bool is_shared) {
                if (is_shared == wanted) reach.add(t, !is_shared);
            });
        }
        return reach.reach();
    }

    void bound_leaf(std::size_t node) {
        assert(is_leaf(node));
        aligned_[node] = reach_along(node, kAligned);
        Vector middle{};
        for (std::size_t k = 0; k < 3; ++k) {
            middle[k] = 0.5 * (aligned_[node].lower[k] + aligned_[node].upper[k]);
        }
        SurfaceSum sum;
        for_listed(node, [&](const SeenTriangle& t, bool /*is_shared*/) { sum.add(t, middle); });
        moments_[node] = sum.moments(middle);
    }

    void gather_children(std::size_t node) {
        const TetraNode& at = tree_.nodes[node];
        Reach& reach = aligned_[node];
        assert(at.first > node && at.count <= 4);
        reach = {{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
        MomentLanes below;
        for (std::size_t child = 0; child < at.count; ++child) {
            const Reach& part = aligned_[at.first + child];
            for (std::size_t k = 0; k < 3; ++k) {
                reach.lower[k] = std::min(reach.lower[k], part.lower[k]);
                reach.upper[k] = std::max(reach.upper[k], part.upper[k]);
            }
            below.set(child, moments_[at.first + child]);
        }
        moments_[node] = sum_of(below);
    }

    void find_axes() {
        for (std::size_t first = 0; first < axes_.size(); first += kBvhWidth) {
            const std::size_t count = std::min<std::size_t>(kBvhWidth, axes_.size() - first);
            MomentLanes some;
            for (std::size_t k = 0; k < count; ++k) some.set(k, moments_[first + k]);
            const NodeAxes axes = axes_of(some);
            std::copy_n(axes.begin(), count, axes_.begin() + static_cast<std::ptrdiff_t>(first));
        }
    }

    void make_room() {
        BvhNode no_boxes;
        OrientedNode no_oriented;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            no_boxes.lower[axis].fill(1);
            no_boxes.upper[axis].fill(-1);
        }
        for (std::size_t lane = 0; lane < kBvhWidth; ++lane) write_no_box(no_oriented, lane);
        const std::uint64_t count = format::tetra_box_count(tree_.nodes.size());
        tree_.boxes.assign(count, no_boxes);
        tree_.oriented.assign(count, no_oriented);
    }

    /// The rounding, in the frame, of a centre, of a distance seen from there, and of their sum:
    /// 2^-53 of less than 2 each.
    static constexpr double kRounding = 0x1p-50;

    void write_boxes(std::size_t node) {
        const std::size_t at = node / kTetraBoxStride;
        const std::size_t lane = node % kTetraBoxStride;
        BvhNode& box = tree_.boxes[at];
        Vector middle{};  // float numbers near everything in the box
        for (std::size_t k = 0; k < 3; ++k) {
            box.lower[k][lane] = float_below(frame(k, aligned_[node].lower[k]) - kRounding);
            box.upper[k][lane] = float_above(frame(k, aligned_[node].upper[k]) + kRounding);
            middle[k] = double{0.5F * (box.lower[k][lane] + box.upper[k][lane])};
        }
        write_oriented(node, middle, tree_.oriented[at], lane);
        if (at == 0) return;
        copy_lane(box, lane, tree_.boxes[at - 1]);
        copy_lane(tree_.oriented[at], lane, tree_.oriented[at - 1]);
    }
    /// Copies a lane to the place where it is stored a second time.
    static void copy_lane(const BvhNode& from, std::size_t lane, BvhNode& to) {
        for (std::size_t k = 0; k < 3; ++k) {
            to.lower[k][lane + kTetraBoxStride] = from.lower[k][lane];
            to.upper[k][lane + kTetraBoxStride] = from.upper[k][lane];
        }
    }
    static void copy_lane(const OrientedNode& from, std::size_t lane, OrientedNode& to) {
        for (std::size_t k = 0; k < 3; ++k) {
            to.axis[0][k][lane + kTetraBoxStride] = from.axis[0][k][lane];
            to.axis[1][k][lane + kTetraBoxStride] = from.axis[1][k][lane];
            to.centre[k][lane + kTetraBoxStride] = from.centre[k][lane];
            to.half[k][lane + kTetraBoxStride] = from.half[k][lane];
        }
    }
    [[nodiscard]] double frame(std::size_t axis, double seen) const {
        return centre_[axis] + std::ldexp(seen, exponent_);
    }

    /// Axes are unit and at right angles to 8 * 2^-24, and the tests treat the rest as zero. So
    /// coordinates along them are off by 48 * 2^-24 of the distance from the middle
    /// (make_oriented.cpp). The margin for this is 2^-17 of the box's reach.
    void write_oriented(std::size_t node, const Vector& middle, OrientedNode& boxes,
                        std::size_t lane) const {
        const Axes& axes = axes_[node];
        const Vector away = {centre_[0] - middle[0], centre_[1] - middle[1],
                             centre_[2] - middle[2]};
        Reach reach = reach_along(node, axes.used);
        double farthest = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const double from = dot(axes.used[k], away);
            reach.lower[k] = from + std::ldexp(reach.lower[k], exponent_);
            reach.upper[k] = from + std::ldexp(reach.upper[k], exponent_);
            farthest = std::max({farthest, -reach.lower[k], reach.upper[k]});
        }
        write_box(middle, axes, reach, 0x1p-40 + farthest * 0x1p-17, boxes, lane);
    }

    const TetraInput& input_;
    const TetraTreeOptions& options_;
    TetraTree& tree_;
    int exponent_;  ///< from seen coordinates to the frame
    Vector centre_{};
    std::vector<Reach> aligned_;  ///< seen from the centre
    std::vector<Moments> moments_;
    std::vector<Axes> axes_;
};

}  // namespace

void make_tetra_boxes(const TetraInput& input, std::int32_t exponent,
                      const TetraTreeOptions& options, TetraTree& tree) {
    BoxMaker(input, exponent, options, tree).run();
}

}  // namespace cdprep::build
