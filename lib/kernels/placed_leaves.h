// SPDX-License-Identifier: MIT
// Leaves transformed into common coordinates. Included by kernel sources alone, after
// box_overlap.h.
//
// Rounding. Let u = 2^-24 and d the error of a pair. No corner, in the coordinates computed here,
// is further than d along any axis from its place in the query. A determinant of three differences
// U, V, W of corners is then off
//
//   - by the corners: each row moves by 2d per component. The cross product of two rows has
//     components of at most 2|V||W| (largest components). There are six such terms in all:
//     12 d (|V||W| + |U||W| + |U||V|). Each norm includes the other rows' motion and is therefore
//     taken 3d too large;
//   - by rounding: there are six products of three, each of a difference (u). Each takes two
//     products (2u) and up to three sums. The terms are below 6|U||V||W| in all: 48 u |U||V||W|.
// Underflow moves a product by at most 2^-126, even if the processor flushes subnormal numbers to
// zero. Components are at most 4, so 1e-35 covers it.
#pragma once

#include <cassert>

#include "box_overlap.h"
#include "kernels.h"

namespace cdprep::kernels {
namespace {

inline constexpr float kUlp = 0x1p-24F;
inline constexpr float kUnderflow = 1e-35F;

/// The rows of a placed leaf: corners, normals and boxes of its triangles; the product and the sum
/// of the largest components of two edges.
enum Row : std::size_t {
    kCorner = 0,
    kNormal = 9,
    kLower = 12,
    kUpper = 15,
    kEdgeProduct = 18,
    kEdgeSum = 19,
};
static_assert(PlacedLeaf::kRows == kEdgeSum + 1);

using Rows = float[PlacedLeaf::kRows][kLanes];

template <class F>
F largest(const F* v) noexcept {
    return max(max(abs(v[0]), abs(v[1])), abs(v[2]));
}

template <class F>
void subtract(const F* a, const F* b, F* result) noexcept {
    for (std::size_t i = 0; i < 3; ++i) result[i] = a[i] - b[i];
}

/// Returns the largest error of a determinant of rows with these largest components.
template <class F>
F determinant_error(F u, F v, F w, F error) noexcept {
    const F more = F(3.0F) * error;
    u = u + more;
    v = v + more;
    w = w + more;
    const F uv = u * v;
    const F moved = fma(F(12.1F) * error, uv + w * (u + v), F(kUnderflow));
    return fma(F(64 * kUlp) * uv, w, moved);
}

/// The same error for rows of which a leaf has u v and u + v. Its factors serve the whole leaf:
/// product * by_product + sum * by_sum + rest. Expanded from determinant_error().
struct ErrorFactors {
    float by_product;
    float by_sum;
    float rest;
};

inline ErrorFactors error_factors(float w, float error) noexcept {
    const float more = 3.0F * error;
    const float moved = 12.1F * error;
    const float reach = w + more;
    const float by_product = 64 * kUlp * reach + moved;
    return {by_product, more * by_product + moved * reach,
            more * (more * by_product + 2.0F * moved * reach) + kUnderflow};
}

template <class F>
F tolerance_of(F product, F sum, const ErrorFactors& factors) noexcept {
    return fma(product, F(factors.by_product), fma(sum, F(factors.by_sum), F(factors.rest)));
}

/// Fills all rows from the corners.
template <class F>
void describe(const F corner[3][3], Rows& rows) noexcept {
    F edge1[3];
    F edge2[3];
    subtract(corner[1], corner[0], edge1);
    subtract(corner[2], corner[0], edge2);
    F normal[3];
    cross(edge1, edge2, normal);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < 3; ++i) corner[i][axis].store(rows[kCorner + 3 * i + axis]);
        normal[axis].store(rows[kNormal + axis]);
        min(min(corner[0][axis], corner[1][axis]), corner[2][axis]).store(rows[kLower + axis]);
        max(max(corner[0][axis], corner[1][axis]), corner[2][axis]).store(rows[kUpper + axis]);
    }
    const F largest1 = largest(edge1);
    const F largest2 = largest(edge2);
    (largest1 * largest2).store(rows[kEdgeProduct]);
    (largest1 + largest2).store(rows[kEdgeSum]);
}

/// Loads corner i of the stored leaf, relative to the leaf's middle, in the model's units.
template <class F>
void load_corner(const float* leaf, const LeafFrame& frame, std::size_t i, F* corner) noexcept {
    assert(i < 3 && (frame.takes_origin == 0 || frame.takes_origin == 1));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float middle = leaf[kLeafOrigin + axis] * frame.takes_origin;
        corner[axis] = F::load(leaf + kLanes * (3 * i + axis)) - F(middle);
    }
}

template <class F>
void place_in_a(const LeafPlacement& p, const float* leaf, Rows& rows) noexcept {
    const F scale(static_cast<float>(p.a.scale));
    F corner[3][3];
    for (std::size_t i = 0; i < 3; ++i) {
        load_corner(leaf, p.a, i, corner[i]);
        for (F& component : corner[i]) component = component * scale;
    }
    describe(corner, rows);
}

template <class F>
void place_in_b(const LeafPlacement& p, const float* leaf, Rows& rows) noexcept {
    F corner[3][3];
    for (std::size_t i = 0; i < 3; ++i) {
        F local[3];
        load_corner(leaf, p.b, i, local);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float* r = p.corner_rotation + 3 * axis;
            corner[i][axis] = combined(r[0], r[1], r[2], local);
        }
    }
    describe(corner, rows);
}

inline void middle_in_a(const LeafPlacement& p, const float* leaf, double* middle) noexcept {
    for (std::size_t i = 0; i < 3; ++i) {
        middle[i] = (double{leaf[kLeafOrigin + i]} - p.a.frame_origin[i]) * p.a.scale;
    }
}

inline void middle_in_b(const LeafPlacement& p, const float* leaf, double* middle) noexcept {
    double b[3];
    for (std::size_t i = 0; i < 3; ++i) {
        b[i] = (double{leaf[kLeafOrigin + i]} - p.b.frame_origin[i]) * p.b.scale;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const double* r = p.rotation + 3 * i;
        middle[i] = ((r[0] * b[0] + r[1] * b[1]) + r[2] * b[2]) + p.shift[i];
    }
}

inline std::size_t place_of(std::uint32_t number) noexcept {
    return number % kLeafPlaces;
}

/// Returns whether a leaf is placed for this query; records that it will be.
inline bool is_placed(PlacedLeaves& leaves, std::uint32_t number, std::uint64_t question) noexcept {
    assert(question > 0 && question >> 32 == 0);  // LeafScratch::begin() was called
    std::uint64_t& holds = leaves.holds[place_of(number)];
    const std::uint64_t wanted = question << 32 | number;
    const bool placed = holds == wanted;
    holds = wanted;
    return placed;
}

inline float absolute(float x) noexcept {
    return x < 0 ? -x : x;
}

inline float largest(float x, float y, float z) noexcept {
    const float xy = x > y ? x : y;
    return xy > z ? xy : z;
}

/// The relative position of two placed leaves.
struct LeafShift {
    float shift[3];   ///< A's middle minus B's: added to A's corners
    float half_a[3];  ///< of the box around A's leaf
    float reach;      ///< at least the largest difference of two corners along an axis
    float error;
};

inline LeafShift shift_of(const LeafPlacement& p, const LeafPair& pair,
                          const double* middle_b) noexcept {
    assert(p.error >= 0 && p.a.box_scale >= 0 && p.b.box_scale >= 0);
    double middle_a[3];
    middle_in_a(p, pair.a, middle_a);
    LeafShift leaf;
    for (std::size_t i = 0; i < 3; ++i) {
        leaf.shift[i] = static_cast<float>(middle_a[i] - middle_b[i]);
        leaf.half_a[i] = pair.a[kLeafHalf + i] * p.a.box_scale;
    }
    const float far =
        largest(absolute(leaf.shift[0]), absolute(leaf.shift[1]), absolute(leaf.shift[2]));
    const float half = largest(leaf.half_a[0], leaf.half_a[1], leaf.half_a[2]);
    const float* half_b = pair.b + kLeafHalf;
    const float reach_b = largest(half_b[0], half_b[1], half_b[2]) * p.b.box_scale;
    // A corner of B is rounded when baked and when the middle is subtracted (u each). Three rounded
    // factors, products and sums follow: below 12 u sqrt 3 reach_b in all. A corner of A:
    // 2 u half_a, the shift u |shift|, and their sum u (half_a + |shift|).
    leaf.error = p.error + kUlp * (21.0F * reach_b + 4.0F * far + 4.0F * half) + kUnderflow;
    leaf.reach = far + half + 1.75F * reach_b;
    return leaf;
}

/// Returns the triangles of B whose boxes come within `margin` of the box around A's leaf.
template <class F>
unsigned rows_near(const Rows& b, const LeafShift& leaf, unsigned used_b, float margin) noexcept {
    typename F::Mask out = F::none();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float reach = leaf.half_a[axis] + 2 * leaf.error + margin;
        out = out | greater(F::load(b[kLower + axis]), F(leaf.shift[axis] + reach)) |
              greater(F(leaf.shift[axis] - reach), F::load(b[kUpper + axis]));
    }
    return used_b & ~bits(out);
}

/// The result of the box tests for one pair of leaves.
struct MetLeaves {
    LeafShift leaf;
    unsigned rows;  ///< triangles of B near A's leaf
};

/// Places B's leaf, unless it is placed. Stores the relative position of the leaves of pair `index`
/// in the scratch.
template <class F>
MetLeaves meet(const LeafPlacement& p, const LeafPair& pair, std::size_t index, float margin,
               LeafScratch& scratch) noexcept {
    assert(index < kLeafBatch && margin >= 0);
    const std::size_t at = place_of(pair.number_b);
    Rows& b = scratch.b.leaf[at].row;
    if (!is_placed(scratch.b, pair.number_b, scratch.question)) {
        place_in_b<F>(p, pair.b, b);
        middle_in_b(p, pair.b, scratch.b.middle[at]);
    }
    constexpr auto kStride = static_cast<std::int32_t>(sizeof(PlacedLeaf) / sizeof(float));
    const LeafShift leaf = shift_of(p, pair, scratch.b.middle[at]);
    for (std::size_t i = 0; i < 3; ++i) scratch.shift[i][index] = leaf.shift[i];
    scratch.shift[3][index] = leaf.error;
    scratch.place[0][index] = kStride * static_cast<std::int32_t>(place_of(pair.number_a));
    scratch.place[1][index] = kStride * static_cast<std::int32_t>(at);
    return {leaf, rows_near<F>(b, leaf, pair.used_b, margin)};
}

/// Returns A's leaf; places it unless it is placed.
template <class F>
const Rows& placed_in_a(const LeafPlacement& p, const LeafPair& pair,
                        LeafScratch& scratch) noexcept {
    Rows& rows = scratch.a.leaf[place_of(pair.number_a)].row;
    if (!is_placed(scratch.a, pair.number_a, scratch.question)) place_in_a<F>(p, pair.a, rows);
    return rows;
}

}  // namespace
}  // namespace cdprep::kernels
