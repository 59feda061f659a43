// SPDX-License-Identifier: GPL-3.0-or-later
#include "convex/triangle_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "mesh/vectors.h"

namespace cdprep::convex {
namespace {

using mesh::Box;
using mesh::cross;
using mesh::dot;
using mesh::minus;

constexpr std::size_t kLeafSize = 4;       ///< triangles, at most
constexpr std::size_t kChunk = 1U << 14U;  ///< triangles handed to a thread at once
constexpr std::size_t kLeavesAtOnce = kChunk / kLeafSize;

double square_to_box(const Double3& p, const Box& box) {
    const double x = std::max({box.lower.x - p.x, 0.0, p.x - box.upper.x});
    const double y = std::max({box.lower.y - p.y, 0.0, p.y - box.upper.y});
    const double z = std::max({box.lower.z - p.z, 0.0, p.z - box.upper.z});
    return x * x + y * y + z * z;
}

double square(const Double3& a) {
    return dot(a, a);
}

double square_to_segment(const Double3& p, const Double3& a, const Double3& b) {
    const Double3 ab = minus(b, a);
    const Double3 ap = minus(p, a);
    const double length = square(ab);
    const double t = length > 0 ? std::clamp(dot(ap, ab) / length, 0.0, 1.0) : 0.0;
    return square({ap.x - t * ab.x, ap.y - t * ab.y, ap.z - t * ab.z});
}

double square_to_needle(const Double3& p, const Corners& t) {
    const Double3 ab = minus(t[1], t[0]);
    const Double3 ac = minus(t[2], t[0]);
    const Double3 ap = minus(p, t[0]);
    const Double3 n = cross(ab, ac);
    const double nn = square(n);
    if (nn > 0) {
        const double v = dot(cross(ap, ac), n);
        const double w = dot(cross(ab, ap), n);
        if (v >= 0 && w >= 0 && v + w <= nn) {
            const double d = dot(ap, n);
            return d * d / nn;
        }
    }
    return std::min({square_to_segment(p, t[0], t[1]), square_to_segment(p, t[1], t[2]),
                     square_to_segment(p, t[2], t[0])});
}

/// From the point where its foot is known to be: a + v ab + w ac.
double square_to_foot(const Double3& ap, const Double3& ab, double v, const Double3& ac, double w) {
    return square(
        {ap.x - v * ab.x - w * ac.x, ap.y - v * ab.y - w * ac.y, ap.z - v * ab.z - w * ac.z});
}

/// Rounded; what it names is bounded by point_triangle_distance() where it counts. By the
/// region that the foot is in (Ericson, Real-Time Collision Detection, 5.1.5), which takes
/// one division; needles, whose regions rounding confuses, by plane and sides.
double square_to_triangle(const Double3& p, const Corners& t) {
    constexpr double kNeedle = 0.01;  // of the square of its sine at the first corner
    const Double3 ab = minus(t[1], t[0]);
    const Double3 ac = minus(t[2], t[0]);
    const Double3 ap = minus(p, t[0]);
    const double ab_ab = square(ab), ac_ac = square(ac), ab_ac = dot(ab, ac);
    if (!(ab_ab * ac_ac - ab_ac * ab_ac > kNeedle * ab_ab * ac_ac)) return square_to_needle(p, t);
    const double ab_ap = dot(ab, ap), ac_ap = dot(ac, ap);
    if (ab_ap <= 0 && ac_ap <= 0) return square(ap);
    const double ab_bp = ab_ap - ab_ab, ac_bp = ac_ap - ab_ac;
    if (ab_bp >= 0 && ac_bp <= ab_bp) return square(minus(p, t[1]));
    const double of_c = ab_ap * ac_bp - ab_bp * ac_ap;
    if (of_c <= 0 && ab_ap >= 0 && ab_bp <= 0) {
        return square_to_foot(ap, ab, ab_ap / ab_ab, ac, 0);
    }
    const double ab_cp = ab_ap - ab_ac, ac_cp = ac_ap - ac_ac;
    if (ac_cp >= 0 && ab_cp <= ac_cp) return square(minus(p, t[2]));
    const double of_b = ab_cp * ac_ap - ab_ap * ac_cp;
    if (of_b <= 0 && ac_ap >= 0 && ac_cp <= 0) {
        return square_to_foot(ap, ab, 0, ac, ac_ap / ac_ac);
    }
    const double of_a = ab_bp * ac_cp - ab_cp * ac_bp;
    const double to_c = ac_bp - ab_bp, to_b = ab_cp - ac_cp;
    if (of_a <= 0 && to_c >= 0 && to_b >= 0) {
        const double w = to_c / (to_c + to_b);
        return square_to_foot(ap, ab, 1 - w, ac, w);
    }
    const double all = of_a + of_b + of_c;
    return square_to_foot(ap, ab, of_b / all, ac, of_c / all);
}

}  // namespace

TriangleTree::TriangleTree(std::span<const Double3> positions, std::span<const Triangle> triangles,
                           ParallelFor parallel_for)
    : order_(triangles.size()), place_(triangles.size()), corners_(triangles.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
    while (leaf_count_ * kLeafSize < triangles.size()) leaf_count_ *= 2;
    std::vector<Double3> middles(triangles.size());
    const auto corner = [&](std::size_t i, std::size_t k) -> const Double3& {
        return positions[triangles[i].vertex[k]];
    };
    const std::size_t chunks = (triangles.size() + kChunk - 1) / kChunk;
    const auto in_chunks = [&](const auto& body) {
        const auto task = [&](std::size_t chunk) {
            const std::size_t end = std::min((chunk + 1) * kChunk, triangles.size());
            for (std::size_t i = chunk * kChunk; i < end; ++i) body(i);
        };
        parallel_for(chunks, task);
    };
    in_chunks([&](std::size_t i) {
        const Double3 &a = corner(i, 0), &b = corner(i, 1), &c = corner(i, 2);
        middles[i] = {a.x / 3 + b.x / 3 + c.x / 3, a.y / 3 + b.y / 3 + c.y / 3,
                      a.z / 3 + b.z / 3 + c.z / 3};
    });
    for (std::size_t level = 1; level < leaf_count_; level *= 2) {
        split_level(level, middles, parallel_for);
    }
    sort_leaves(parallel_for);
    in_chunks([&](std::size_t i) {
        place_[order_[i]] = static_cast<std::uint32_t>(i);
        corners_[i] = {corner(order_[i], 0), corner(order_[i], 1), corner(order_[i], 2)};
    });
    fill_boxes(parallel_for);
}

void TriangleTree::split_level(std::size_t level, std::span<const Double3> middles,
                               ParallelFor parallel_for) {
    const std::size_t leaves = leaf_count_ / level;
    const auto split = [&](std::size_t node) {
        const std::size_t begin = leaf_begin(node * leaves);
        const std::size_t middle = leaf_begin(node * leaves + leaves / 2);
        const std::size_t end = leaf_begin((node + 1) * leaves);
        Box box;
        for (std::size_t i = begin; i < end; ++i) box.add(middles[order_[i]]);
        const Double3 size = minus(box.upper, box.lower);
        double Double3::*axis = &Double3::z;
        if (size.y >= size.z) axis = &Double3::y;
        if (size.x >= size.y && size.x >= size.z) axis = &Double3::x;
        const auto at = [&](std::size_t i) {
            return order_.begin() + static_cast<std::ptrdiff_t>(i);
        };
        // Ties by number: the same order with any standard library's selection, as a set.
        std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
            const double of_a = middles[a].*axis;
            const double of_b = middles[b].*axis;
            return of_a != of_b ? of_a < of_b : a < b;
        });
    };
    parallel_for(level, split);
}

/// What a selection leaves in a leaf is a set; its order is the standard library's.
void TriangleTree::sort_leaves(ParallelFor parallel_for) {
    const auto sort = [&](std::size_t chunk) {
        const std::size_t last = std::min((chunk + 1) * kLeavesAtOnce, leaf_count_);
        for (std::size_t leaf = chunk * kLeavesAtOnce; leaf < last; ++leaf) {
            std::sort(order_.begin() + static_cast<std::ptrdiff_t>(leaf_begin(leaf)),
                      order_.begin() + static_cast<std::ptrdiff_t>(leaf_begin(leaf + 1)));
        }
    };
    parallel_for((leaf_count_ + kLeavesAtOnce - 1) / kLeavesAtOnce, sort);
}

void TriangleTree::fill_boxes(ParallelFor parallel_for) {
    boxes_.resize(2 * leaf_count_ - 1);
    const auto fill = [&](std::size_t chunk) {
        const std::size_t last = std::min((chunk + 1) * kLeavesAtOnce, leaf_count_);
        for (std::size_t leaf = chunk * kLeavesAtOnce; leaf < last; ++leaf) {
            const std::size_t begin = leaf_begin(leaf);
            const std::size_t end = leaf_begin(leaf + 1);
            Box& box = boxes_[leaf_count_ - 1 + leaf];
            for (std::size_t i = begin; i < end; ++i) {
                for (const Double3& corner : corners_[i]) box.add(corner);
            }
        }
    };
    parallel_for((leaf_count_ + kLeavesAtOnce - 1) / kLeavesAtOnce, fill);
    for (std::size_t node = leaf_count_ - 1; node-- > 0;) {
        boxes_[node] = boxes_[2 * node + 1];
        boxes_[node].add(boxes_[2 * node + 2].lower);
        boxes_[node].add(boxes_[2 * node + 2].upper);
    }
}

TriangleTree::Nearest TriangleTree::nearest(const Double3& p, std::uint32_t hint) const {
    double least = std::numeric_limits<double>::infinity();
    std::uint32_t found = 0;
    if (hint < order_.size()) {
        least = square_to_triangle(p, corners(hint));
        found = hint;
    }
    struct Waiting {
        std::size_t node;
        double square;
    };
    std::array<Waiting, 64> stack;
    std::size_t depth = 0;
    stack[depth++] = {0, square_to_box(p, boxes_[0])};
    while (depth > 0) {
        const Waiting at = stack[--depth];
        if (at.square >= least) continue;
        if (at.node + 1 < leaf_count_) {
            Waiting near{2 * at.node + 1, square_to_box(p, boxes_[2 * at.node + 1])};
            Waiting far{2 * at.node + 2, square_to_box(p, boxes_[2 * at.node + 2])};
            if (far.square < near.square) std::swap(near, far);
            if (far.square < least) stack[depth++] = far;
            if (near.square < least) stack[depth++] = near;
            continue;
        }
        const std::size_t leaf = at.node + 1 - leaf_count_;
        for (std::size_t i = leaf_begin(leaf); i < leaf_begin(leaf + 1); ++i) {
            const double square = square_to_triangle(p, corners_[i]);
            if (square < least) {
                least = square;
                found = order_[i];
            }
        }
    }
    return {found, std::sqrt(least)};
}

}  // namespace cdprep::convex
