// SPDX-License-Identifier: MIT
#include "make_oriented.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "chunks.h"

// Axes are the eigenvectors of the covariance of the surface below a box, every
// triangle counted by its area (Gottschalk, Lin and Manocha 1996, without their
// convex hull): they do not depend on how finely a part is tessellated.

namespace cdprep::build {
namespace {

using format::BvhLeaf;
using format::BvhNode;
using format::BvhShape;
using format::kBvhWidth;
using format::OrientedNode;

using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) {
    return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}

Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Area, and the integrals of x and of x x^T over a surface. Frame coordinates.
struct Moments {
    double area = 0;
    Vector first{};
    std::array<double, 6> second{};  ///< xx, yy, zz, xy, yz, zx
};

void add(Moments& sum, const Moments& other) {
    sum.area += other.area;
    for (std::size_t i = 0; i < 3; ++i) sum.first[i] += other.first[i];
    for (std::size_t i = 0; i < 6; ++i) sum.second[i] += other.second[i];
}

/// Of one triangle: the integral of x x^T is area / 12 (9 m m^T + sum of p p^T).
Moments moments_of(const std::array<Vector, 3>& corner) {
    Vector edge1{};
    Vector edge2{};
    Vector middle{};
    for (std::size_t i = 0; i < 3; ++i) {
        edge1[i] = corner[1][i] - corner[0][i];
        edge2[i] = corner[2][i] - corner[0][i];
        middle[i] = (corner[0][i] + corner[1][i] + corner[2][i]) / 3;
    }
    const Vector normal = cross(edge1, edge2);
    Moments moments;
    moments.area = 0.5 * std::sqrt(dot(normal, normal));
    constexpr std::array<std::size_t, 6> kRow = {0, 1, 2, 0, 1, 2};
    constexpr std::array<std::size_t, 6> kColumn = {0, 1, 2, 1, 2, 0};
    for (std::size_t i = 0; i < 3; ++i) moments.first[i] = moments.area * middle[i];
    for (std::size_t i = 0; i < 6; ++i) {
        double sum = 9 * middle[kRow[i]] * middle[kColumn[i]];
        for (const Vector& p : corner) sum += p[kRow[i]] * p[kColumn[i]];
        moments.second[i] = moments.area / 12 * sum;
    }
    return moments;
}

/// Columns of `vectors` become the eigenvectors of a symmetric matrix, columns of
/// least eigenvalue first. Cyclic Jacobi (Golub and Van Loan 8.5).
std::array<Vector, 3> eigenvectors(std::array<Vector, 3> m) {
    std::array<Vector, 3> v = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  // v[k]: k-th vector
    constexpr int kSweeps = 8;
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        const double off = std::fabs(m[0][1]) + std::fabs(m[0][2]) + std::fabs(m[1][2]);
        const double diagonal = std::fabs(m[0][0]) + std::fabs(m[1][1]) + std::fabs(m[2][2]);
        if (!(off > 1e-9 * diagonal)) break;
        for (const auto& [p, q] : {std::pair{0, 1}, std::pair{0, 2}, std::pair{1, 2}}) {
            const auto i = static_cast<std::size_t>(p);
            const auto j = static_cast<std::size_t>(q);
            if (m[i][j] == 0) continue;
            const double theta = (m[j][j] - m[i][i]) / (2 * m[i][j]);
            const double t =
                (theta < 0 ? -1 : 1) / (std::fabs(theta) + std::sqrt(theta * theta + 1));
            const double c = 1 / std::sqrt(t * t + 1);
            const double s = t * c;
            for (std::size_t k = 0; k < 3; ++k) {
                const double x = m[k][i];
                const double y = m[k][j];
                m[k][i] = c * x - s * y;
                m[k][j] = s * x + c * y;
            }
            for (std::size_t k = 0; k < 3; ++k) {
                const double x = m[i][k];
                const double y = m[j][k];
                m[i][k] = c * x - s * y;
                m[j][k] = s * x + c * y;
                const double vx = v[i][k];
                const double vy = v[j][k];
                v[i][k] = c * vx - s * vy;
                v[j][k] = s * vx + c * vy;
            }
        }
    }
    std::array<std::size_t, 3> order = {0, 1, 2};
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return m[a][a] != m[b][b] ? m[a][a] < m[b][b] : a < b;
    });
    return {v[order[0]], v[order[1]], v[order[2]]};
}

/// Orthonormal axes rounded to float, the third their cross product.
struct Axes {
    std::array<std::array<float, 3>, 2> stored;
    std::array<Vector, 3> used;
};

Axes rounded(const Vector& first, const Vector& second) {
    Axes axes{};
    for (std::size_t i = 0; i < 3; ++i) {
        axes.stored[0][i] = static_cast<float>(first[i]);
        axes.stored[1][i] = static_cast<float>(second[i]);
        axes.used[0][i] = double{axes.stored[0][i]};
        axes.used[1][i] = double{axes.stored[1][i]};
    }
    axes.used[2] = cross(axes.used[0], axes.used[1]);
    return axes;
}

Axes axes_of(const Moments& moments) {
    if (!(moments.area > 0)) return rounded({1, 0, 0}, {0, 1, 0});
    Vector mean{};
    for (std::size_t i = 0; i < 3; ++i) mean[i] = moments.first[i] / moments.area;
    const auto& s = moments.second;
    const auto centred = [&](std::size_t index, std::size_t i, std::size_t j) {
        return s[index] / moments.area - mean[i] * mean[j];
    };
    const double xy = centred(3, 0, 1);
    const double yz = centred(4, 1, 2);
    const double zx = centred(5, 2, 0);
    const auto v = eigenvectors(
        {{{centred(0, 0, 0), xy, zx}, {xy, centred(1, 1, 1), yz}, {zx, yz, centred(2, 2, 2)}}});
    return rounded(v[0], v[1]);
}

/// Of an axis-aligned box: near everything in it.
Vector middle_of(const BvhNode& node, std::size_t box) {
    Vector middle{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        middle[axis] = 0.5 * (double{node.lower[axis][box]} + double{node.upper[axis][box]});
    }
    return middle;
}

struct Range {
    std::array<double, 3> lower;
    std::array<double, 3> upper;
};

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Range kNothing = {{kInfinity, kInfinity, kInfinity},
                            {-kInfinity, -kInfinity, -kInfinity}};

/// The leaves in frame coordinates, in double.
class FrameLeaves {
public:
    explicit FrameLeaves(const Bvh& bvh) : bvh_(bvh) {}

    [[nodiscard]] std::array<Vector, 3> triangle(const BvhLeaf& leaf, std::size_t lane) const {
        std::array<Vector, 3> corner{};
        const Vector origin = {bvh_.frame.origin.x, bvh_.frame.origin.y, bvh_.frame.origin.z};
        const double scale = bvh_.exact_leaves ? std::ldexp(1.0, bvh_.frame.exponent) : 1;
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const double x = double{leaf.corner[i][axis][lane]};
                corner[i][axis] =
                    bvh_.exact_leaves ? (x - origin[axis]) * scale : x + double{leaf.origin[axis]};
            }
        }
        return corner;
    }

    [[nodiscard]] Moments moments(const BvhLeaf& leaf) const {
        Moments sum;
        for (std::size_t lane = 0; lane < leaf.count; ++lane) {
            add(sum, moments_of(triangle(leaf, lane)));
        }
        return sum;
    }

    /// Coordinates along the axes, from `origin` on.
    void widen(Range& range, const BvhLeaf& leaf, const Vector& origin, const Axes& axes) const {
        for (std::size_t lane = 0; lane < leaf.count; ++lane) {
            for (const Vector& p : triangle(leaf, lane)) {
                const Vector from = {p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]};
                for (std::size_t k = 0; k < 3; ++k) {
                    const double t = dot(from, axes.used[k]);
                    range.lower[k] = std::min(range.lower[k], t);
                    range.upper[k] = std::max(range.upper[k], t);
                }
            }
        }
    }

private:
    const Bvh& bvh_;
};

/// Writes the box of one range. The axes are unit and at right angles to 8 u (u =
/// 2^-24), the third however it is rounded; so the coordinates of a point along
/// them are off by 24 u times the largest, and the tests treat the cross terms as
/// zero, for as much again: 2^-18 in all. Leaves that are not exact were rounded
/// by u; 2^-23 of the frame's size covers that and the rounding of the centre.
void set_box(OrientedNode& node, std::size_t box, const Vector& origin, const Axes& axes,
             const Range& range, bool exact) {
    std::array<double, 3> half{};
    double largest = 0;
    Vector centre = origin;
    for (std::size_t k = 0; k < 3; ++k) {
        half[k] = 0.5 * (range.upper[k] - range.lower[k]);
        largest = std::max(largest, half[k]);
        const double middle = 0.5 * (range.upper[k] + range.lower[k]);
        for (std::size_t i = 0; i < 3; ++i) centre[i] += middle * axes.used[k][i];
    }
    double moved = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto rounded_centre = static_cast<float>(centre[i]);
        moved += std::fabs(double{rounded_centre} - centre[i]);
        node.centre[i][box] = rounded_centre;
        for (std::size_t k = 0; k < 2; ++k) node.axis[k][i][box] = axes.stored[k][i];
    }
    const double rounding = exact ? 0 : 0x1p-24;
    for (std::size_t k = 0; k < 3; ++k) {
        node.half[k][box] =
            static_cast<float>((half[k] + moved + rounding + largest * 0x1p-18) * (1 + 0x1p-22));
    }
}

void set_unused(OrientedNode& node, std::size_t box) {
    node.axis[0][0][box] = 1;
    node.axis[1][1][box] = 1;
    for (std::size_t k = 0; k < 3; ++k) node.half[k][box] = -1;
}

}  // namespace

void make_oriented(Bvh& bvh, const ParallelFor& parallel_for) {
    const auto triangles = static_cast<std::uint32_t>(bvh.order.size());
    const BvhShape shape = format::bvh_shape(triangles);
    const FrameLeaves leaves(bvh);
    bvh.oriented_nodes.assign(shape.node_count, OrientedNode{});
    std::vector<Moments> below(bvh.leaves.size());
    for_chunks(below.size(), kLeavesPerTask, parallel_for,
               [&](std::size_t first, std::size_t last) {
                   for (std::size_t i = first; i < last; ++i)
                       below[i] = leaves.moments(bvh.leaves[i]);
               });
    std::size_t leaves_per_box = 1;
    for (std::uint32_t level = 0; level < shape.levels; ++level) {
        std::vector<Moments> nodes(shape.count[level]);
        const auto fit = [&](std::size_t i) {
            const auto index = static_cast<std::uint32_t>(i);
            OrientedNode& node = bvh.oriented_nodes[shape.first[level] + i];
            const std::uint32_t used = shape.used_boxes(level, index);
            for (std::size_t box = 0; box < kBvhWidth; ++box) {
                if (box >= used) {
                    set_unused(node, box);
                    continue;
                }
                const std::size_t child = i * kBvhWidth + box;
                add(nodes[i], below[child]);
                const Axes axes = axes_of(below[child]);
                const Vector origin = middle_of(bvh.nodes[shape.first[level] + i], box);
                Range range = kNothing;
                const std::size_t end = std::min(bvh.leaves.size(), (child + 1) * leaves_per_box);
                for (std::size_t leaf = child * leaves_per_box; leaf < end; ++leaf) {
                    leaves.widen(range, bvh.leaves[leaf], origin, axes);
                }
                set_box(node, box, origin, axes, range, bvh.exact_leaves);
            }
        };
        const std::size_t per_task =
            std::max<std::size_t>(1, kLeavesPerTask / (kBvhWidth * leaves_per_box));
        for_chunks(nodes.size(), per_task, parallel_for, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) fit(i);
        });
        below = std::move(nodes);
        leaves_per_box *= kBvhWidth;
    }
}

}  // namespace cdprep::build
