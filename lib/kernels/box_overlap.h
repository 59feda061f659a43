// SPDX-License-Identifier: MIT
// Box against box, eight at a time. There are two stages, of aligned and of oriented boxes. Each
// tests the six directions of faces, and leaves out the nine of edges. Included by kernel sources
// alone, after they have defined the lanes. F is a type of eight floats, and R holds the same eight
// once or twice. R::kRows rows are tested at once. Each type has a mask type.
#pragma once

#include <cassert>

#include "kernels.h"

namespace cdprep::kernels {
namespace {

/// Returns (m0 x + m1 y) + m2 z.
template <class F>
F combined(float m0, float m1, float m2, const F* v) noexcept {
    return fma(F(m2), v[2], fma(F(m1), v[1], F(m0) * v[0]));
}

template <class F>
F dot(const F* a, const F* b) noexcept {
    return fma(a[2], b[2], fma(a[1], b[1], a[0] * b[0]));
}

template <class F>
void cross(const F* a, const F* b, F* result) noexcept {
    result[0] = fms(a[1], b[2], a[2] * b[1]);
    result[1] = fms(a[2], b[0], a[0] * b[2]);
    result[2] = fms(a[0], b[1], a[1] * b[0]);
}

/// Eight axis-aligned boxes.
template <class F>
struct Boxes {
    F centre[3];
    F half[3];
};

template <class F>
Boxes<F> scaled_boxes(const float* node, float scale) noexcept {
    assert(node != nullptr && scale >= 0 && scale <= 1);
    Boxes<F> boxes;
    const F factor(0.5F * scale);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const F lower = F::load(node + kLanes * axis);
        const F upper = F::load(node + kLanes * (3 + axis));
        boxes.centre[axis] = (lower + upper) * factor;
        boxes.half[axis] = (upper - lower) * factor;
    }
    return boxes;
}

/// Returns boxes of A along the axes of B.
template <class F>
Boxes<F> turned_to_b(const Boxes<F>& boxes, const BoxPlacement& p) noexcept {
    Boxes<F> turned;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float* r = p.rotation + axis;
        const float* q = p.abs_rotation + axis;
        turned.centre[axis] = combined(r[0], r[3], r[6], boxes.centre);
        turned.half[axis] = combined(q[0], q[3], q[6], boxes.half);
    }
    return turned;
}

template <class F>
F sum_of(const F* v) noexcept {
    return v[0] + v[1] + v[2];
}

/// Returns B's boxes for the tests along A's axes: shifted, with the slack and the tolerance.
template <class F>
Boxes<F> turned_to_a(const Boxes<F>& boxes, const BoxPlacement& p) noexcept {
    assert(p.slack >= 0 && p.tolerance >= 0);
    Boxes<F> turned;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float* r = p.rotation + 3 * axis;
        const float* q = p.abs_rotation + 3 * axis;
        turned.centre[axis] = combined(r[0], r[1], r[2], boxes.centre) + F(p.shift[axis]);
        turned.half[axis] = combined(q[0], q[1], q[2], boxes.half) + F(p.slack + p.tolerance);
    }
    return turned;
}

/// Returns B's boxes for the tests along B's axes.
template <class F>
Boxes<F> shifted_in_b(const Boxes<F>& boxes, const BoxPlacement& p) noexcept {
    Boxes<F> shifted;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        shifted.centre[axis] = boxes.centre[axis] + F(p.shift_in_b[axis]);
        shifted.half[axis] = boxes.half[axis] + F(p.slack + p.tolerance);
    }
    return shifted;
}

/// Rows of eight floats, so that one box can be spread over all lanes.
struct BoxRows {
    alignas(32) float centre[3][kLanes];
    alignas(32) float half[3][kLanes];
};

template <class F>
void store(const Boxes<F>& boxes, BoxRows& rows) noexcept {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        boxes.centre[axis].store(rows.centre[axis]);
        boxes.half[axis].store(rows.half[axis]);
    }
}

/// Returns the boxes of B that the box around all of A's reaches along A's axes.
template <class F>
unsigned boxes_within(const Boxes<F>& turned_b, const BoxPlacement& p,
                      const float* around_a) noexcept {
    typename F::Mask out = F::none();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float lower = around_a[kLanes * axis] * p.scale_a;
        const float upper = around_a[kLanes * (3 + axis)] * p.scale_a;
        const F gap = abs(turned_b.centre[axis] - F(0.5F * (lower + upper)));
        out = out | greater(gap, turned_b.half[axis] + F(0.5F * (upper - lower)));
    }
    return ~bits(out);
}

/// The rows that are tested together. The second repeats the first if only one is left.
struct RowPair {
    std::size_t first;
    std::size_t second;
};

/// Takes as many rows from a bit set as R tests at once.
template <class R>
RowPair take_rows(unsigned& rows) noexcept {
    assert(rows != 0 && rows >> kLanes == 0);
    const auto first = std::size_t{format::lowest_set_bit(rows)};
    rows &= rows - 1;
    if (R::kRows == 1 || rows == 0) return {first, first};
    const auto second = std::size_t{format::lowest_set_bit(rows)};
    rows &= rows - 1;
    return {first, second};
}

/// Returns the least overlap of boxes of `rows` with each of `a` along three axes.
template <class R>
R least_overlap(const Boxes<R>& a, const BoxRows& rows, RowPair at) noexcept {
    R least = (a.half[0] + R::spread(rows.half[0], at)) -
              abs(a.centre[0] - R::spread(rows.centre[0], at));
    for (std::size_t axis = 1; axis < 3; ++axis) {
        least = min(least, (a.half[axis] + R::spread(rows.half[axis], at)) -
                               abs(a.centre[axis] - R::spread(rows.centre[axis], at)));
    }
    return least;
}

/// Returns the lanes of `a` that one of three axes separates from boxes of `rows`.
template <class R>
typename R::Mask apart(const Boxes<R>& a, const BoxRows& rows, RowPair at) noexcept {
    typename R::Mask out = R::none();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const R gap = abs(a.centre[axis] - R::spread(rows.centre[axis], at));
        out = out | greater(gap, a.half[axis] + R::spread(rows.half[axis], at));
    }
    return out;
}

/// Returns the pairs of two rows, from eight bits of each; a row that repeats repeats its bits.
template <class R>
BoxPairs pairs_in_rows(unsigned found, RowPair at) noexcept {
    assert(at.first <= at.second && at.second < kLanes);
    assert(R::kRows == 1 || at.first != at.second || (found & 0xff) == (found >> kLanes & 0xff));
    const BoxPairs first = BoxPairs{found & 0xff} << (kLanes * at.first);
    if (R::kRows == 1) return first;
    return first | BoxPairs{(found >> kLanes) & 0xff} << (kLanes * at.second);
}

/// Returns eight bits of either row.
inline unsigned bits_of_rows(BoxPairs pairs, RowPair at) noexcept {
    const auto first = static_cast<unsigned>(pairs >> (kLanes * at.first)) & 0xff;
    const auto second = static_cast<unsigned>(pairs >> (kLanes * at.second)) & 0xff;
    return first | second << kLanes;
}

/// Eight oriented boxes with their third axes.
template <class F>
struct OrientedBoxes {
    F axis[3][3];  ///< [axis][component]
    F centre[3];
    F half[3];
};

template <class F>
void load_oriented(const float* node, float scale, OrientedBoxes<F>& boxes) noexcept {
    assert(node != nullptr && scale >= 0 && scale <= 1);
    for (std::size_t i = 0; i < 3; ++i) {
        boxes.axis[0][i] = F::load(node + kLanes * i);
        boxes.axis[1][i] = F::load(node + kLanes * (3 + i));
        boxes.centre[i] = F::load(node + kLanes * (6 + i)) * F(scale);
        boxes.half[i] = F::load(node + kLanes * (9 + i)) * F(scale);
    }
    cross(boxes.axis[0], boxes.axis[1], boxes.axis[2]);
}

/// Oriented boxes of B along A's axes, in rows, so that one can be spread over all lanes.
struct OrientedRows {
    alignas(32) float axis[3][3][kLanes];
    alignas(32) float centre[3][kLanes];
    alignas(32) float half[3][kLanes];
};

template <class F>
void turn_oriented(const OrientedBoxes<F>& boxes, const BoxPlacement& p,
                   OrientedRows& rows) noexcept {
    for (std::size_t i = 0; i < 3; ++i) {
        const float* r = p.rotation + 3 * i;
        for (std::size_t k = 0; k < 3; ++k) {
            combined(r[0], r[1], r[2], boxes.axis[k]).store(rows.axis[k][i]);
        }
        (combined(r[0], r[1], r[2], boxes.centre) + F(p.shift[i])).store(rows.centre[i]);
        boxes.half[i].store(rows.half[i]);
    }
}

/// The gaps between boxes along the three axes of either; negative: the overlap. The slack and the
/// tolerance are subtracted.
template <class R>
struct FaceGaps {
    R of_a[3];
    R of_b[3];
};

template <class R>
R largest(const FaceGaps<R>& gaps) noexcept {
    return max(max(max(gaps.of_a[0], gaps.of_a[1]), gaps.of_a[2]),
               max(max(gaps.of_b[0], gaps.of_b[1]), gaps.of_b[2]));
}

/// The separating-axis test of two oriented boxes (Gottschalk, Lin and Manocha 1996), along six of
/// its fifteen axes. The nine cross products of edges separate a few boxes more, but double the
/// cost.
template <class R>
FaceGaps<R> oriented_gaps(const OrientedBoxes<R>& a, const OrientedRows& rows, RowPair at,
                          const BoxPlacement& p) noexcept {
    R b[3][3];
    R half_b[3];
    R t[3];
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) b[k][i] = R::spread(rows.axis[k][i], at);
        half_b[i] = R::spread(rows.half[i], at);
        t[i] = R::spread(rows.centre[i], at) - a.centre[i];
    }
    R q[3][3];
    const R wider(p.slack + p.tolerance);
    FaceGaps<R> gaps;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) q[i][k] = abs(dot(a.axis[i], b[k]));
        const R reach = fma(q[i][2], half_b[2], fma(q[i][1], half_b[1], q[i][0] * half_b[0]));
        gaps.of_a[i] = abs(dot(t, a.axis[i])) - (a.half[i] + wider + reach);
    }
    for (std::size_t k = 0; k < 3; ++k) {
        const R reach = fma(q[2][k], a.half[2], fma(q[1][k], a.half[1], q[0][k] * a.half[0]));
        gaps.of_b[k] = abs(dot(t, b[k])) - (half_b[k] + wider + reach);
    }
    return gaps;
}

/// Keeps the pairs that the oriented boxes of both nodes do not separate. Sets `depths` if kDepths
/// is true. Always inlined: a walk for the first hit waits for each step.
template <class F, class R, bool kDepths>
[[gnu::always_inline]] inline BoxPairs keep_oriented(const BoxPlacement& p, const NodeBoxes& a,
                                                     const NodeBoxes& b, BoxPairs pairs,
                                                     BoxSizes& sizes, BoxDepths* depths) noexcept {
    assert(kDepths == (depths != nullptr));
    OrientedBoxes<R> oriented_a;
    load_oriented(a.oriented, p.scale_a, oriented_a);
    OrientedBoxes<F> unturned_b;
    load_oriented(b.oriented, p.scale_b, unturned_b);
    OrientedRows oriented_b;
    turn_oriented(unturned_b, p, oriented_b);
    sum_of(oriented_a.half).store_row(sizes.a);
    sum_of(unturned_b.half).store_row(sizes.b);
    BoxPairs kept = 0;
    typename R::Deepest deepest;
    for (unsigned rows = boxes_of_b(pairs); rows != 0;) {
        const RowPair at = take_rows<R>(rows);
        const R gap = largest(oriented_gaps(oriented_a, oriented_b, at, p));
        const unsigned found = bits_of_rows(pairs, at) & ~bits(greater(gap, R(0.0F)));
        if constexpr (kDepths) {
            (-gap).store_rows(depths->value[at.first], depths->value[at.second]);
            deepest.add(-gap, found, at);
        }
        kept |= pairs_in_rows<R>(found, at);
    }
    assert((kept & ~pairs) == 0);
    if constexpr (kDepths) depths->deepest = deepest.bit();
    return kept;
}

/// Returns the pairs of chosen boxes that the axes of either node do not separate. Sets `depths` if
/// kDepths is true. Always inlined, like keep_oriented().
template <class F, class R, bool kDepths>
[[gnu::always_inline]] inline BoxPairs keep_aligned(const BoxPlacement& p, const NodeBoxes& a,
                                                    const NodeBoxes& b, const BoxChoice& choice,
                                                    BoxSizes& sizes, BoxDepths* depths) noexcept {
    assert(kDepths == (depths != nullptr));
    const Boxes<F> boxes_b = scaled_boxes<F>(b.boxes, p.scale_b);
    const Boxes<F> turned_b = turned_to_a(boxes_b, p);
    unsigned live = choice.of_b;
    if (choice.around_a != nullptr) live &= boxes_within(turned_b, p, choice.around_a);
    if (live == 0) return 0;
    const Boxes<R> boxes_a = scaled_boxes<R>(a.boxes, p.scale_a);
    const Boxes<R> turned_a = turned_to_b(boxes_a, p);
    sum_of(boxes_a.half).store_row(sizes.a);
    sum_of(boxes_b.half).store_row(sizes.b);
    BoxRows along_a;
    BoxRows along_b;
    store(turned_b, along_a);
    store(shifted_in_b(boxes_b, p), along_b);
    const unsigned wanted = choice.of_a | unsigned{choice.of_a} << kLanes;
    BoxPairs pairs = 0;
    typename R::Deepest deepest;
    while (live != 0) {
        const RowPair at = take_rows<R>(live);
        unsigned found;
        if constexpr (kDepths) {
            const R depth =
                min(least_overlap(boxes_a, along_a, at), least_overlap(turned_a, along_b, at));
            found = wanted & ~bits(greater(R(0.0F), depth));
            depth.store_rows(depths->value[at.first], depths->value[at.second]);
            deepest.add(depth, found, at);
        } else {
            found = wanted & ~bits(apart(boxes_a, along_a, at) | apart(turned_a, along_b, at));
        }
        pairs |= pairs_in_rows<R>(found, at);
    }
    if constexpr (kDepths) depths->deepest = deepest.bit();
    return pairs;
}

/// The body of overlapping_boxes().
template <class F, class R>
BoxPairs overlapping_boxes_of(const BoxPlacement& p, const NodeBoxes& a, const NodeBoxes& b,
                              const BoxChoice& choice, BoxSizes& sizes) noexcept {
    const bool oriented = a.oriented != nullptr && b.oriented != nullptr;
    const bool one_row = (choice.of_b & (choice.of_b - 1)) == 0;
    if (oriented && one_row) {
        // Rotating the axis-aligned boxes would cost more than it saves.
        assert(choice.of_b != 0);
        const auto row = format::lowest_set_bit(std::uint32_t{choice.of_b});
        const BoxPairs pairs = BoxPairs{choice.of_a} << (kLanes * row);
        return keep_oriented<F, R, false>(p, a, b, pairs, sizes, nullptr);
    }
    const BoxPairs pairs = keep_aligned<F, R, false>(p, a, b, choice, sizes, nullptr);
    if (!oriented || pairs == 0) return pairs;
    return keep_oriented<F, R, false>(p, a, b, pairs, sizes, nullptr);
}

/// The body of overlap_depths().
template <class F, class R>
BoxPairs overlap_depths_of(const BoxPlacement& p, const NodeBoxes& a, const NodeBoxes& b,
                           const BoxChoice& choice, BoxSizes& sizes, BoxDepths& depths) noexcept {
    if (a.oriented == nullptr || b.oriented == nullptr) {
        return keep_aligned<F, R, true>(p, a, b, choice, sizes, &depths);
    }
    const BoxPairs pairs = keep_aligned<F, R, false>(p, a, b, choice, sizes, nullptr);
    return pairs == 0 ? 0 : keep_oriented<F, R, true>(p, a, b, pairs, sizes, &depths);
}

}  // namespace
}  // namespace cdprep::kernels
