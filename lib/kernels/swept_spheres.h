// SPDX-License-Identifier: MIT
// Swept sphere against swept sphere, eight at a time: points, lines and rectangles with a radius.
// Included by kernel sources alone.
//
// Two swept spheres are apart by at least
//
//     gap(w) = (w.d - sum h_i |w.u_i| - sum g_j |w.v_j|) / |w| - r_a - r_b
//
// for any direction w. Here d leads from A's middle to B's. The axes and halves of A's are u and h,
// those of B's v and g. This is the distance of two parallel planes with the two between them. So
// it requires neither axes at right angles nor an exact w. The best w leads from the nearest point
// of A's middle to that of B's. Then gap(w) is the distance itself. For points w is d. For lines
// the nearest points have a closed form (Ericson 2005, 5.1.9). For rectangles an iteration
// alternates between the two. Each step takes the nearest point of the other. For a rectangle this
// is a clamp of two coordinates. It goes from B's centre to A, to B, to A. More steps separate one
// pair in fifty more and cost as much as that saves. The face directions are tried in addition.
//
// Rounding. Let v = 2^-24, s_a and s_b the scales, t the shift. Middles lie within sqrt 3 s of
// their origins; halves and radii are at most that. Take |w| = 1: a common factor cancels.
//
//   - Rotating, shifting and subtracting three components: d is off by 19 v s_b + 3 v s_a +
//     5 v |t|. Its product with w is off by 6 v (s_a + s_b + |t|).
//   - B's axes are rotated with 7 v each. The sum of the halves is at most sqrt 6 s: 17 v s_b.
//   - The products w.u, w.v: 8 v (s_a + s_b); the sum of five terms: 21 v (s_a + s_b) + 9 v |t|.
//   - Length, root and quotient: 7 v (s_a + s_b + |t|). A face direction's length has 14 v of the
//     same instead.
// Together they stay below 96 v (s_a + s_b + |t|): three times BoxPlacement's slack, which also
// covers all earlier rounding. A tolerance is rounded by 5 v of itself where the radii are summed
// and squared. Its caller has enlarged it.
#pragma once

#include <cassert>

#include "distances.h"

namespace cdprep::kernels {
namespace {

inline constexpr float kSweptSlack = 3;  ///< a factor of BoxPlacement::slack

/// Eight swept spheres, with kSides sides in use.
template <class F>
struct SweptSpheres {
    F centre[3];
    F radius;
    F axis[2][3];  ///< [axis][component]
    F half[2];
};

template <int kSides, class F>
void load_swept(const float* node, float scale, SweptSpheres<F>& spheres) noexcept {
    assert(node != nullptr && scale >= 0 && scale <= 1);
    for (std::size_t i = 0; i < 3; ++i) {
        spheres.centre[i] = F::load(node + kLanes * i) * F(scale);
    }
    spheres.radius = F::load(node + kLanes * 3) * F(scale);
    for (std::size_t k = 0; k < kSides; ++k) {
        const float* side = node + kLanes * 4 * (k + 1);
        for (std::size_t i = 0; i < 3; ++i) spheres.axis[k][i] = F::load(side + kLanes * i);
        spheres.half[k] = F::load(side + kLanes * 3) * F(scale);
    }
}

/// Swept spheres of B along A's axes, in rows, so that one can be spread over all lanes. The radius
/// includes the slack and the tolerance.
struct SweptRows {
    alignas(32) float centre[3][kLanes];
    alignas(32) float radius[kLanes];
    alignas(32) float axis[2][3][kLanes];
    alignas(32) float half[2][kLanes];
    alignas(32) float face[3][kLanes];
};

template <int kSides, class F>
void turn_swept(const SweptSpheres<F>& spheres, const BoxPlacement& p, SweptRows& rows) noexcept {
    F turned[2][3];
    for (std::size_t i = 0; i < 3; ++i) {
        const float* r = p.rotation + 3 * i;
        (combined(r[0], r[1], r[2], spheres.centre) + F(p.shift[i])).store(rows.centre[i]);
        for (std::size_t k = 0; k < kSides; ++k) {
            turned[k][i] = combined(r[0], r[1], r[2], spheres.axis[k]);
            turned[k][i].store(rows.axis[k][i]);
        }
    }
    (spheres.radius + F(kSweptSlack * p.slack + p.tolerance)).store(rows.radius);
    for (std::size_t k = 0; k < kSides; ++k) spheres.half[k].store(rows.half[k]);
    if (kSides < 2) return;
    F face[3];
    cross(turned[0], turned[1], face);
    for (std::size_t i = 0; i < 3; ++i) face[i].store(rows.face[i]);
}

/// One row of B against eight of A.
template <class R>
struct SweptPair {
    R d[3];  ///< from A's middle to B's
    R axis_b[2][3];
    R half_b[2];
    R radii;  ///< the sum of both, the slack and the tolerance
};

template <int kSides, class R>
SweptPair<R> swept_pair(const SweptSpheres<R>& a, const SweptRows& rows, RowPair at) noexcept {
    SweptPair<R> pair;
    for (std::size_t i = 0; i < 3; ++i) {
        pair.d[i] = R::spread(rows.centre[i], at) - a.centre[i];
        for (std::size_t k = 0; k < kSides; ++k) {
            pair.axis_b[k][i] = R::spread(rows.axis[k][i], at);
        }
    }
    for (std::size_t k = 0; k < kSides; ++k) pair.half_b[k] = R::spread(rows.half[k], at);
    pair.radii = a.radius + R::spread(rows.radius, at);
    return pair;
}

template <class R>
R within_half(R x, R half) noexcept {
    return max(min(x, half), -half);
}

/// The approximate nearest points on the two middles, along A's axes and B's.
template <class R>
struct NearestOnMiddles {
    R a[2];
    R b[2];
};

/// Lines: exact up to rounding.
template <class R>
void find_nearest_on_lines(const SweptSpheres<R>& a, const SweptPair<R>& pair,
                           NearestOnMiddles<R>& at) noexcept {
    const R p = dot(pair.d, a.axis[0]);
    const R q = dot(pair.d, pair.axis_b[0]);
    const R c = dot(a.axis[0], pair.axis_b[0]);
    const R first = (p - c * q) / max(R(1.0F) - c * c, R(1e-12F));
    at.b[0] = within_half(fms(c, within_half(first, a.half[0]), q), pair.half_b[0]);
    at.a[0] = within_half(fma(c, at.b[0], p), a.half[0]);
}

/// Rectangles: B's point is the nearest to A's point nearest to B's centre.
template <class R>
void find_nearest_on_rectangles(const SweptSpheres<R>& a, const SweptPair<R>& pair,
                                NearestOnMiddles<R>& at) noexcept {
    R p[2];
    R q[2];
    R c[2][2];
    for (std::size_t i = 0; i < 2; ++i) {
        p[i] = dot(pair.d, a.axis[i]);
        q[i] = dot(pair.d, pair.axis_b[i]);
        for (std::size_t j = 0; j < 2; ++j) c[i][j] = dot(a.axis[i], pair.axis_b[j]);
    }
    for (std::size_t i = 0; i < 2; ++i) at.a[i] = within_half(p[i], a.half[i]);
    for (std::size_t j = 0; j < 2; ++j) {
        const R along = fma(at.a[1], c[1][j], fms(at.a[0], c[0][j], q[j]));
        at.b[j] = within_half(along, pair.half_b[j]);
    }
    for (std::size_t i = 0; i < 2; ++i) {
        const R along = fma(at.b[1], c[i][1], fma(at.b[0], c[i][0], p[i]));
        at.a[i] = within_half(along, a.half[i]);
    }
}

/// A bound as a fraction: the middles are at least along / length apart.
template <class R>
struct MiddleGap {
    R along;
    R squared_length;
};

template <int kSides, class R>
MiddleGap<R> gap_between_nearest(const SweptSpheres<R>& a, const SweptPair<R>& pair) noexcept {
    if constexpr (kSides == 0) {
        const R squared = dot(pair.d, pair.d);
        return {squared, squared};
    } else {
        NearestOnMiddles<R> at;
        if constexpr (kSides == 1) {
            find_nearest_on_lines(a, pair, at);
        } else {
            find_nearest_on_rectangles(a, pair, at);
        }
        for (std::size_t k = 0; k < kSides; ++k) at.a[k] = -at.a[k];
        R w[3];
        for (std::size_t i = 0; i < 3; ++i) {
            // B's points are known before A's, so their products go first.
            w[i] = pair.d[i];
            for (std::size_t k = 0; k < kSides; ++k) w[i] = fma(at.b[k], pair.axis_b[k][i], w[i]);
            for (std::size_t k = 0; k < kSides; ++k) w[i] = fma(at.a[k], a.axis[k][i], w[i]);
        }
        R reach_a = a.half[0] * abs(dot(w, a.axis[0]));
        R reach_b = pair.half_b[0] * abs(dot(w, pair.axis_b[0]));
        if constexpr (kSides == 2) {
            reach_a = fma(a.half[1], abs(dot(w, a.axis[1])), reach_a);
            reach_b = fma(pair.half_b[1], abs(dot(w, pair.axis_b[1])), reach_b);
        }
        return {dot(w, pair.d) - (reach_a + reach_b), dot(w, w)};
    }
}

/// Returns the gap along the faces of both rectangles; `face_a` is A's.
template <class R>
R gap_along_faces(const SweptSpheres<R>& a, const R* face_a, const SweptPair<R>& pair,
                  const SweptRows& rows, RowPair row) noexcept {
    R face_b[3];
    for (std::size_t i = 0; i < 3; ++i) face_b[i] = R::spread(rows.face[i], row);
    const R reach_b = fma(pair.half_b[0], abs(dot(face_a, pair.axis_b[0])),
                          pair.half_b[1] * abs(dot(face_a, pair.axis_b[1])));
    const R reach_a =
        fma(a.half[0], abs(dot(face_b, a.axis[0])), a.half[1] * abs(dot(face_b, a.axis[1])));
    return max(abs(dot(pair.d, face_a)) - reach_b, abs(dot(pair.d, face_b)) - reach_a);
}

/// Returns a lower bound of the distance of swept spheres; negative: about the overlap.
template <int kSides, class R>
R swept_gap(const SweptSpheres<R>& a, const R* face_a, const SweptRows& rows,
            RowPair row) noexcept {
    const SweptPair<R> pair = swept_pair<kSides>(a, rows, row);
    const MiddleGap<R> nearest = gap_between_nearest<kSides>(a, pair);
    // Where the middles meet, the length is meaningless, and no gap is claimed.
    R gap = nearest.along / max(root(nearest.squared_length), R(1e-15F));
    if constexpr (kSides == 2) gap = max(gap, gap_along_faces(a, face_a, pair, rows, row));
    return gap - pair.radii;
}

/// Returns the lanes that are apart: the same bounds without a root.
template <int kSides, class R>
typename R::Mask swept_apart(const SweptSpheres<R>& a, const R* face_a, const SweptRows& rows,
                             RowPair row) noexcept {
    const SweptPair<R> pair = swept_pair<kSides>(a, rows, row);
    const MiddleGap<R> nearest = gap_between_nearest<kSides>(a, pair);
    const R reached = pair.radii * pair.radii * nearest.squared_length;
    const R zero(0.0F);
    typename R::Mask out =
        greater(nearest.along, zero) & greater(nearest.along * nearest.along, reached);
    if constexpr (kSides == 2) {
        out = out | greater(gap_along_faces(a, face_a, pair, rows, row), pair.radii);
    }
    return out;
}

/// The swept spheres of both nodes, prepared for rows.
template <class R>
struct SweptNodes {
    SweptSpheres<R> a;
    R face_a[3];
    SweptRows b;
};

template <int kSides, class F, class R>
void load_nodes(const BoxPlacement& p, const NodeBoxes& a, const NodeBoxes& b,
                SweptSpheres<F>& unturned_b, SweptNodes<R>& nodes) noexcept {
    load_swept<kSides>(a.swept, p.scale_a, nodes.a);
    if (kSides == 2) cross(nodes.a.axis[0], nodes.a.axis[1], nodes.face_a);
    load_swept<kSides>(b.swept, p.scale_b, unturned_b);
    turn_swept<kSides>(unturned_b, p, nodes.b);
}

/// Returns half the sum of the edges of the box around each, with sides along the axes.
template <int kSides, class F>
F size_of(const SweptSpheres<F>& spheres) noexcept {
    F size = spheres.radius * F(3.0F);
    for (std::size_t k = 0; k < kSides; ++k) size = size + spheres.half[k];
    return size;
}

/// Keeps the pairs that the swept spheres do not separate.
template <int kSides, class F, class R>
BoxPairs keep_swept(const BoxPlacement& p, const NodeBoxes& a, const NodeBoxes& b, BoxPairs pairs,
                    BoxSizes& sizes) noexcept {
    SweptNodes<R> nodes;
    SweptSpheres<F> unturned_b;
    load_nodes<kSides>(p, a, b, unturned_b, nodes);
    size_of<kSides>(nodes.a).store_row(sizes.a);
    size_of<kSides>(unturned_b).store_row(sizes.b);
    BoxPairs kept = 0;
    for (unsigned rows = boxes_of_b(pairs); rows != 0;) {
        const RowPair at = take_rows<R>(rows);
        const unsigned out = bits(swept_apart<kSides>(nodes.a, nodes.face_a, nodes.b, at));
        kept |= pairs_in_rows<R>(bits_of_rows(pairs, at) & ~out, at);
    }
    assert((kept & ~pairs) == 0);
    return kept;
}

/// The body of BoundTests::overlapping. The axis-aligned boxes go first, unless there is only one
/// row.
template <int kSides, class F, class R>
BoxPairs overlapping_swept_of(const BoxPlacement& p, const NodeBoxes& a, const NodeBoxes& b,
                              const BoxChoice& choice, BoxSizes& sizes) noexcept {
    if ((choice.of_b & (choice.of_b - 1)) == 0) {
        assert(choice.of_b != 0);
        const auto row = format::lowest_set_bit(std::uint32_t{choice.of_b});
        const BoxPairs pairs = BoxPairs{choice.of_a} << (kLanes * row);
        return keep_swept<kSides, F, R>(p, a, b, pairs, sizes);
    }
    const BoxPairs pairs = keep_aligned<F, R, false>(p, a, b, choice, sizes, nullptr);
    return pairs == 0 ? 0 : keep_swept<kSides, F, R>(p, a, b, pairs, sizes);
}

/// Returns the bit of the pair of `pairs` that overlaps most.
template <class R>
unsigned deepest_of(BoxPairs pairs, const BoxPairFloats& depths) noexcept {
    typename R::Deepest deepest;
    for (std::size_t row = 0; row < kLanes; row += R::kRows) {
        const RowPair at = {row, row + R::kRows - 1};
        const R depth = R::load_rows(depths.value[at.first], depths.value[at.second]);
        deepest.add(depth, bits_of_rows(pairs, at), at);
    }
    return deepest.bit();
}

/// The body of BoundTests::depths. Depths of the axis-aligned boxes lead a walk to its first hit
/// sooner than the distance of two middles does.
template <int kSides, class F, class R>
BoxPairs swept_depths_of(const BoxPlacement& p, const NodeBoxes& a, const NodeBoxes& b,
                         const BoxChoice& choice, BoxSizes& sizes, BoxDepths& depths) noexcept {
    const BoxPairs pairs = keep_aligned<F, R, true>(p, a, b, choice, sizes, &depths);
    if (pairs == 0) return 0;
    const BoxPairs kept = keep_swept<kSides, F, R>(p, a, b, pairs, sizes);
    depths.deepest = deepest_of<R>(kept, depths);
    return kept;
}

template <int kSides, class F>
Span<F> span_of_swept(const SweptSpheres<F>& spheres, const float* direction) noexcept {
    const F d[3] = {F(direction[0]), F(direction[1]), F(direction[2])};
    F half = spheres.radius;
    for (std::size_t k = 0; k < kSides; ++k) {
        half = fma(abs(dot(spheres.axis[k], d)), spheres.half[k], half);
    }
    return {dot(spheres.centre, d), half};
}

/// The body of BoundTests::near.
template <int kSides, class F, class R>
BoxPairs near_swept_of(const BoxPlacement& p, const NodeBoxes& a, const NodeBoxes& b,
                       const BoxChoice& choice, const Reach& reach, BoxPairFloats& gaps) noexcept {
    const BoxPairs pairs =
        near_boxes_of<F, R>(p, {a.boxes, nullptr}, {b.boxes, nullptr}, choice, reach, gaps);
    if (pairs == 0) return 0;
    SweptNodes<R> nodes;
    SweptSpheres<F> unturned_b;
    load_nodes<kSides>(p, a, b, unturned_b, nodes);
    const Span<R> span_a = span_of_swept<kSides>(nodes.a, reach.direction);
    alignas(32) float begins[kLanes];
    store_begins(span_of_swept<kSides>(unturned_b, reach.direction_in_b), p, reach, begins);
    const R ends = span_a.middle + span_a.half;
    BoxPairs kept = 0;
    for (unsigned rows = boxes_of_b(pairs); rows != 0;) {
        const RowPair at = take_rows<R>(rows);
        R gap = R::load_rows(gaps.value[at.first], gaps.value[at.second]);
        gap = max(gap, swept_gap<kSides>(nodes.a, nodes.face_a, nodes.b, at));
        gap = max(gap, R::spread(begins, at) - ends);
        gap.store_rows(gaps.value[at.first], gaps.value[at.second]);
        const unsigned out = bits(greater(gap, R(reach.limit)));
        kept |= pairs_in_rows<R>(bits_of_rows(pairs, at) & ~out, at);
    }
    return kept;
}

template <int kSides, class F, class R>
inline constexpr BoundTests kSweptTests = {overlapping_swept_of<kSides, F, R>,
                                           swept_depths_of<kSides, F, R>,
                                           near_swept_of<kSides, F, R>, true};

}  // namespace
}  // namespace cdprep::kernels
