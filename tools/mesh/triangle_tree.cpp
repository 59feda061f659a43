// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/triangle_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>

#include "mesh/vectors.h"
#include "mesh/with_avx2.h"

namespace cdprep::convex {
namespace {

using mesh::Box;
using mesh::cross;
using mesh::dot;
using mesh::minus;

constexpr std::size_t kLeafSize = 8;       ///< triangles at most
constexpr std::size_t kChunk = 1U << 14U;  ///< triangles per task
constexpr std::size_t kLeavesAtOnce = kChunk / kLeafSize;

// Coordinates between -1 and 1, of box sides or points, are rounded to float by at most 2^-25.
// A coordinate of a point farther out is rounded by at most 2^-24 of itself. From 2 on, the
// distance along that axis is at least half of it. Below 2, kMargin covers this rounding too.
// After kMargin, a computed square is at most 1 + 2^-21 times the true one. This includes the
// rounding of differences, squares and sums.
constexpr float kMargin = 0x1p-22F;       ///< boxes are larger by this on each side
constexpr double kFurther = 1 + 0x1p-19;  ///< factor of a square: a box beyond it is not nearer
constexpr double kMostSquare = 1e38;      ///< so that floats hold it
constexpr float kNowhere = 1e30F;         ///< sides of empty boxes, reversed
constexpr double kOutside = 4;            ///< equivalent to any coordinate farther out
constexpr double kFarthest = 1e18;        ///< coordinate: so that kMostSquare exceeds its squares
constexpr int kMostExponent = 1000;       ///< of the scale: so that it is finite

using Floats = float __attribute__((vector_size(32)));
using Mask = std::int32_t __attribute__((vector_size(32)));

// By reference: without AVX, a call has no register for such return values.
[[gnu::always_inline]] inline void load(const std::array<float, 8>& lanes, Floats& x) {
    std::memcpy(&x, lanes.data(), sizeof x);
}

/// Returns bit k from lane k, which is 0 or -1.
[[gnu::always_inline]] inline unsigned bits_of(const Mask& mask) {
    Mask lanes = mask & Mask{1, 2, 4, 8, 16, 32, 64, 128};
    lanes |= __builtin_shufflevector(lanes, lanes, 4, 5, 6, 7, 0, 1, 2, 3);
    lanes |= __builtin_shufflevector(lanes, lanes, 2, 3, 0, 1, 6, 7, 4, 5);
    lanes |= __builtin_shufflevector(lanes, lanes, 1, 0, 3, 2, 5, 4, 7, 6);
    return static_cast<unsigned>(lanes[0]);
}

/// Adds, by lane, the square of a number's distance to an interval.
[[gnu::always_inline]] inline void add_square_beyond(const Floats& lower, float at,
                                                     const Floats& upper, Floats& sum) {
    const Floats before = lower - at;
    const Floats after = at - upper;
    const Floats far = before > after ? before : after;
    const Floats gap = far > 0 ? far : Floats{};
    sum += gap * gap;
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

/// Returns the squared distance from the foot point a + v ab + w ac.
double square_to_foot(const Double3& ap, const Double3& ab, double v, const Double3& ac, double w) {
    return square(
        {ap.x - v * ab.x - w * ac.x, ap.y - v * ab.y - w * ac.y, ap.z - v * ab.z - w * ac.z});
}

/// Returns the squared distance, rounded. Callers bound the result with
/// point_triangle_distance() where it matters. Selects the region of the foot point (Ericson,
/// Real-Time Collision Detection, 5.1.5), which takes one division. Rounding blurs the regions
/// of needles, so these use plane and sides.
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
    choose_unit(positions, triangles);
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
        // Breaks ties by number, so that any standard library selects the same set.
        std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
            const double of_a = middles[a].*axis;
            const double of_b = middles[b].*axis;
            return of_a != of_b ? of_a < of_b : a < b;
        });
    };
    parallel_for(level, split);
}

/// Sorts the leaves: a selection determines only the set in a leaf, not its order.
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

/// Chooses the origin and unit of the floats, so that all corners lie between -1 and 1.
void TriangleTree::choose_unit(std::span<const Double3> positions,
                               std::span<const Triangle> triangles) {
    for (const Triangle& t : triangles) {
        for (const std::uint32_t v : t.vertex) box_.add(positions[v]);
    }
    centre_ = {box_.lower.x / 2 + box_.upper.x / 2, box_.lower.y / 2 + box_.upper.y / 2,
               box_.lower.z / 2 + box_.upper.z / 2};
    const Double3 half = minus(box_.upper, centre_);
    const double size = std::max({half.x, half.y, half.z});
    if (size > 0 && std::isfinite(size)) {
        scale_ = std::ldexp(1.0, std::min(-std::ilogb(size) - 1, kMostExponent));
    }
}

TriangleTree::FloatBox TriangleTree::to_floats(const Box& box) const {
    const auto as_float = [this](double at, double centre) {
        return static_cast<float>(std::clamp((at - centre) * scale_, -kOutside, kOutside));
    };
    return {{as_float(box.lower.x, centre_.x), as_float(box.lower.y, centre_.y),
             as_float(box.lower.z, centre_.z)},
            {as_float(box.upper.x, centre_.x), as_float(box.upper.y, centre_.y),
             as_float(box.upper.z, centre_.z)}};
}

void TriangleTree::fill_boxes(ParallelFor parallel_for) {
    first_of_level_ = {0};
    std::size_t count = leaf_count_;
    for (std::size_t all = 0;; count = (count + kWidth - 1) / kWidth) {
        first_of_level_.push_back(all += count);
        if (count == 1) break;
    }
    Lanes empty;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        empty.lower[axis].fill(kNowhere);
        empty.upper[axis].fill(-kNowhere);
    }
    nodes_.assign(first_of_level_.back(), empty);
    const auto fill = [&](std::size_t chunk) {
        const std::size_t last = std::min((chunk + 1) * kLeavesAtOnce, leaf_count_);
        for (std::size_t leaf = chunk * kLeavesAtOnce; leaf < last; ++leaf) {
            const std::size_t begin = leaf_begin(leaf);
            for (std::size_t i = begin; i < leaf_begin(leaf + 1); ++i) {
                Box box;
                for (const Double3& corner : corners_[i]) box.add(corner);
                const FloatBox around = to_floats(box);
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    nodes_[leaf].lower[axis][i - begin] = around.lower[axis] - kMargin;
                    nodes_[leaf].upper[axis][i - begin] = around.upper[axis] + kMargin;
                }
            }
        }
    };
    parallel_for((leaf_count_ + kLeavesAtOnce - 1) / kLeavesAtOnce, fill);
    for (std::size_t level = 1; level + 1 < first_of_level_.size(); ++level) {
        const std::size_t first = first_of_level_[level - 1];
        for (std::size_t i = first; i < first_of_level_[level]; ++i) {
            Lanes& above = nodes_[first_of_level_[level] + (i - first) / kWidth];
            const std::size_t k = (i - first) % kWidth;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const auto& lower = nodes_[i].lower[axis];
                const auto& upper = nodes_[i].upper[axis];
                above.lower[axis][k] = *std::min_element(lower.begin(), lower.end());
                above.upper[axis][k] = *std::max_element(upper.begin(), upper.end());
            }
        }
    }
}

CDPREP_WITH_AVX2
unsigned TriangleTree::which_meet(const Lanes& lanes, const FloatBox& box) {
    Mask apart{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Floats lower, upper;
        load(lanes.lower[axis], lower);
        load(lanes.upper[axis], upper);
        apart |= lower > box.upper[axis];
        apart |= upper < box.lower[axis];
    }
    return bits_of(~apart);
}

CDPREP_WITH_AVX2
TriangleTree::Nearest TriangleTree::nearest(const Double3& p, std::uint32_t hint) const {
    double least = std::numeric_limits<double>::infinity();
    float limit = std::numeric_limits<float>::max();  // boxes farther away are skipped
    std::uint32_t found = 0;
    std::uint32_t looks = 0;
    const auto look_at = [&](std::size_t place) {
        ++looks;
        const double square = square_to_triangle(p, corners_[place]);
        if (!(square < least)) return;
        least = square;
        limit = static_cast<float>(std::min(square * scale_ * scale_ * kFurther, kMostSquare));
        found = order_[place];
    };
    if (hint < order_.size()) look_at(place_[hint]);
    // A point farther out is moved nearer to all boxes, so none is skipped.
    const auto as_float = [this](double x, double centre) {
        return static_cast<float>(std::clamp((x - centre) * scale_, -kFarthest, kFarthest));
    };
    const std::array<float, 3> at = {as_float(p.x, centre_.x), as_float(p.y, centre_.y),
                                     as_float(p.z, centre_.z)};
    struct Waiting {
        Place place;
        float square;
    };
    std::array<Waiting, kMostWaiting> stack;
    std::size_t depth = 0;
    stack[depth++] = {{top_level(), 0}, 0};
    while (depth > 0) {
        const Waiting next = stack[--depth];
        if (next.square > limit) continue;
        ++looks;
        const Lanes& lanes = node(next.place);
        Floats squares{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            Floats lower, upper;
            load(lanes.lower[axis], lower);
            load(lanes.upper[axis], upper);
            add_square_beyond(lower, at[axis], upper, squares);
        }
        std::array<float, kWidth> square;
        std::memcpy(square.data(), &squares, sizeof square);
        // The nearest last, so that it is on top of the stack.
        std::array<std::uint8_t, kWidth> order;
        std::size_t count = 0;
        for (unsigned near = bits_of(squares <= limit); near != 0; near &= near - 1) {
            const auto k = static_cast<std::uint8_t>(std::countr_zero(near));
            std::size_t i = count++;
            for (; i > 0 && square[order[i - 1]] < square[k]; --i) order[i] = order[i - 1];
            order[i] = k;
        }
        if (next.place.level > 0) {
            for (std::size_t i = 0; i < count; ++i) {
                stack[depth++] = {below(next.place, order[i]), square[order[i]]};
            }
            continue;
        }
        while (count > 0 && square[order[count - 1]] <= limit) {
            look_at(leaf_begin(next.place.index) + order[--count]);
        }
    }
    return {found, std::sqrt(least), looks};
}

}  // namespace cdprep::convex
