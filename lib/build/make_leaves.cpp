// SPDX-License-Identifier: MIT
#include "make_leaves.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>

#include "chunks.h"

namespace cdprep::build {
namespace {

using format::BvhLeaf;
using format::Double3;
using format::kBvhWidth;
using format::Triangle;

/// Exponents of frames whose scale is an ordinary float.
constexpr std::int32_t kMaxExactExponent = 100;

using Point = std::array<double, 3>;

/// The corners of one leaf, lanes past the last triangle repeating it.
using LeafCorners = std::array<std::array<Point, 3>, kBvhWidth>;

bool is_float(const Double3& p) {
    const auto same = [](double x) { return static_cast<double>(static_cast<float>(x)) == x; };
    return same(p.x) && same(p.y) && same(p.z);
}

bool all_floats(std::span<const Double3> positions, std::span<const Triangle> triangles,
                const ParallelFor& parallel_for) {
    std::atomic<bool> all = true;
    for_chunks(triangles.size(), kItemsPerTask, parallel_for,
               [&](std::size_t first, std::size_t last) {
                   bool good = true;
                   for (std::size_t i = first; i < last; ++i) {
                       for (const std::uint32_t vertex : triangles[i].vertex) {
                           good = good && is_float(positions[vertex]);
                       }
                   }
                   if (!good) all = false;
               });
    return all;
}

float float_above(double x) {
    const auto rounded = static_cast<float>(x);
    return rounded < x ? std::nextafter(rounded, std::numeric_limits<float>::infinity()) : rounded;
}

/// Where a leaf's corners are kept: in model coordinates, or in frame coordinates.
class LeafMaker {
public:
    LeafMaker(const Frame& frame, bool exact) : frame_(frame), exact_(exact) {}

    BvhLeaf make(const LeafCorners& corners, std::uint32_t count) const {
        BvhLeaf leaf{};
        leaf.count = count;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            double lower = std::numeric_limits<double>::infinity();
            double upper = -lower;
            for (const auto& triangle : corners) {
                for (const Point& p : triangle) {
                    const double x = stored(p[axis], axis);
                    lower = std::min(lower, x);
                    upper = std::max(upper, x);
                }
            }
            const auto origin = static_cast<float>(0.5 * lower + 0.5 * upper);
            leaf.origin[axis] = origin;
            fill_axis(leaf, corners, axis);
            const double reach = std::max(upper - double{origin}, double{origin} - lower);
            // The difference of two doubles is off by half an ulp at most.
            const double enlarged = reach * (1 + 0x1p-50);
            leaf.half[axis] =
                float_above(exact_ ? std::ldexp(enlarged, frame_.exponent) : enlarged);
        }
        return leaf;
    }

private:
    double stored(double x, std::size_t axis) const {
        return exact_ ? x : std::ldexp(x - origin(axis), frame_.exponent);
    }
    double origin(std::size_t axis) const {
        return axis == 0 ? frame_.origin.x : axis == 1 ? frame_.origin.y : frame_.origin.z;
    }
    void fill_axis(BvhLeaf& leaf, const LeafCorners& corners, std::size_t axis) const {
        const double taken_off = exact_ ? 0.0 : double{leaf.origin[axis]};
        for (std::size_t lane = 0; lane < kBvhWidth; ++lane) {
            for (std::size_t i = 0; i < 3; ++i) {
                leaf.corner[i][axis][lane] =
                    static_cast<float>(stored(corners[lane][i][axis], axis) - taken_off);
            }
        }
    }

    Frame frame_;
    bool exact_;
};

}  // namespace

void make_leaves(Bvh& bvh, std::span<const Double3> positions, std::span<const Triangle> triangles,
                 const ParallelFor& parallel_for) {
    bvh.exact_leaves = std::abs(bvh.frame.exponent) <= kMaxExactExponent &&
                       all_floats(positions, triangles, parallel_for);
    const LeafMaker maker(bvh.frame, bvh.exact_leaves);
    const std::size_t count = bvh.order.size();
    bvh.leaves.resize((count + kBvhWidth - 1) / kBvhWidth);
    for_chunks(
        bvh.leaves.size(), kLeavesPerTask, parallel_for, [&](std::size_t first, std::size_t last) {
            for (std::size_t leaf = first; leaf < last; ++leaf) {
                const std::size_t begin = leaf * kBvhWidth;
                const std::size_t used = std::min<std::size_t>(kBvhWidth, count - begin);
                LeafCorners corners{};
                for (std::size_t lane = 0; lane < kBvhWidth; ++lane) {
                    const Triangle& t = triangles[bvh.order[begin + std::min(lane, used - 1)]];
                    for (std::size_t i = 0; i < 3; ++i) {
                        const Double3& p = positions[t.vertex[i]];
                        corners[lane][i] = {p.x, p.y, p.z};
                    }
                }
                bvh.leaves[leaf] = maker.make(corners, static_cast<std::uint32_t>(used));
            }
        });
}

}  // namespace cdprep::build
