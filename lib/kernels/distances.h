// SPDX-License-Identifier: MIT
// Lower bounds of distances, of boxes and of triangles. Included by kernel sources
// alone, after leaf_contacts.h.
#pragma once

#include "leaf_contacts.h"

namespace cdprep::kernels {
namespace {

/// Squares and adds up what is positive.
template <class R>
R squared_length(const R* gap) noexcept {
    const R zero(0.0F);
    R sum = zero;
    for (std::size_t i = 0; i < 3; ++i) {
        const R positive = max(gap[i], zero);
        sum = fma(positive, positive, sum);
    }
    return sum;
}

/// Square of the gap between boxes along three axes.
template <class R>
R squared_gap(const Boxes<R>& a, const BoxRows& rows, RowPair at) noexcept {
    R gap[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
        gap[axis] = abs(a.centre[axis] - R::spread(rows.centre[axis], at)) -
                    (a.half[axis] + R::spread(rows.half[axis], at));
    }
    return squared_length(gap);
}

/// Axes are at right angles up to 2^-21, and squares, sums and the root round: a
/// length of gaps is too great by less than this, in relative terms.
inline constexpr float kGapRounding = 1 - 0x1p-18F;

/// Where boxes lie along a direction: the middle, and how far they reach from it.
template <class F>
struct Span {
    F middle;
    F half;
};

template <class F>
Span<F> span_of(const Boxes<F>& boxes, const float* direction) noexcept {
    F middle(0.0F);
    F half(0.0F);
    for (std::size_t i = 0; i < 3; ++i) {
        const F d(direction[i]);
        middle = fma(boxes.centre[i], d, middle);
        half = fma(boxes.half[i], abs(d), half);
    }
    return {middle, half};
}

template <class F>
Span<F> span_of(const OrientedBoxes<F>& boxes, const float* direction) noexcept {
    const F d[3] = {F(direction[0]), F(direction[1]), F(direction[2])};
    F half(0.0F);
    for (std::size_t k = 0; k < 3; ++k) {
        half = fma(abs(dot(boxes.axis[k], d)), boxes.half[k], half);
    }
    return {dot(boxes.centre, d), half};
}

/// Boxes of B along the direction: where each begins, less the slack in all three
/// components and the shift's place.
template <class F>
void store_begins(const Span<F>& span, const BoxPlacement& p, const Reach& reach,
                  float* begins) noexcept {
    const float* d = reach.direction;
    const float shift = p.shift[0] * d[0] + p.shift[1] * d[1] + p.shift[2] * d[2];
    ((span.middle - span.half) + F(shift - 2 * p.slack)).store(begins);
}

/// The body of near_boxes().
template <class F, class R>
BoxPairs near_boxes_of(const BoxPlacement& p, const NodeBoxes& a, const NodeBoxes& b,
                       const BoxChoice& choice, const Reach& reach, BoxPairFloats& gaps) noexcept {
    const Boxes<F> boxes_b = scaled_boxes<F>(b.boxes, p.scale_b);
    const Boxes<R> boxes_a = scaled_boxes<R>(a.boxes, p.scale_a);
    const Boxes<R> turned_a = turned_to_b(boxes_a, p);
    BoxRows along_a;
    BoxRows along_b;
    store(turned_to_a(boxes_b, p), along_a);
    store(shifted_in_b(boxes_b, p), along_b);
    const bool oriented = a.oriented != nullptr && b.oriented != nullptr;
    OrientedBoxes<R> oriented_a;
    OrientedRows oriented_b;
    Span<R> span_a = span_of(boxes_a, reach.direction);
    Span<F> span_b = span_of(boxes_b, reach.direction_in_b);
    if (oriented) {
        OrientedBoxes<F> unturned_b;
        load_oriented(a.oriented, p.scale_a, oriented_a);
        load_oriented(b.oriented, p.scale_b, unturned_b);
        turn_oriented(unturned_b, p, oriented_b);
        span_a = span_of(oriented_a, reach.direction);
        span_b = span_of(unturned_b, reach.direction_in_b);
    }
    alignas(32) float begins[kLanes];
    store_begins(span_b, p, reach, begins);
    const R ends = span_a.middle + span_a.half;
    const unsigned wanted = choice.of_a | unsigned{choice.of_a} << kLanes;
    BoxPairs pairs = 0;
    for (unsigned rest = choice.of_b; rest != 0;) {
        const RowPair at = take_rows<R>(rest);
        R squared = max(squared_gap(boxes_a, along_a, at), squared_gap(turned_a, along_b, at));
        if (oriented) {
            const FaceGaps<R> face = oriented_gaps(oriented_a, oriented_b, at, p);
            squared = max(squared, max(squared_length(face.of_a), squared_length(face.of_b)));
        }
        const R gap = max(root(squared) * R(kGapRounding), R::spread(begins, at) - ends);
        gap.store_rows(gaps.value[at.first], gaps.value[at.second]);
        pairs |= pairs_in_rows<R>(wanted & ~bits(greater(gap, R(reach.limit))), at);
    }
    return pairs;
}

template <class F>
struct Range {
    F least;
    F greatest;
};

/// Where eight triangles lie along a direction.
template <class F>
Range<F> corner_range(const float (*rows)[kLanes], const float* direction) noexcept {
    const F d[3] = {F(direction[0]), F(direction[1]), F(direction[2])};
    F least;
    F greatest;
    for (std::size_t i = 0; i < 3; ++i) {
        const F corner[3] = {F::load(rows[kCorner + 3 * i]), F::load(rows[kCorner + 3 * i + 1]),
                             F::load(rows[kCorner + 3 * i + 2])};
        const F at = dot(corner, d);
        least = i == 0 ? at : min(least, at);
        greatest = i == 0 ? at : max(greatest, at);
    }
    return {least, greatest};
}

/// Triangles of A that come within the limit of triangles of B, by their boxes and
/// along the direction: `ends` is where A's triangles end, `begins` where B's begin.
/// Eight bits a row.
template <class R>
unsigned near_rows(const Block& block, RowPair at, R ends, const float* begins,
                   float limit) noexcept {
    const float(*a)[kLanes] = block;
    const float(*b)[kLanes] = block + kSide;
    const R twice_error = R(2.0F * block[kError][0]);
    R gap[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const R above = R::load(a[kLower + axis]) - R::spread(b[kUpper + axis], at);
        const R below = R::spread(b[kLower + axis], at) - R::load(a[kUpper + axis]);
        gap[axis] = max(above, below) - twice_error;
    }
    const R squared = squared_length(gap) * R(kGapRounding);
    // The error of a corner is more than 3 u times any coordinate: 12 of them cover
    // the corners' own and the rounding of two dot products.
    const R along = (R::spread(begins, at) - ends) - R(12.0F * block[kError][0]);
    return ~bits(greater(squared, R(limit * limit)) | greater(along, R(limit)));
}

/// The nearest pair of points found so far, in each lane.
template <class W>
struct LaneNearest {
    W difference[3];  ///< from A's point to B's
    W squared;
};

template <class W>
void offer(LaneNearest<W>& nearest, const W* difference, typename W::Mask valid) noexcept {
    const W squared = dot(difference, difference);
    const auto better = valid & greater(nearest.squared, squared);
    for (std::size_t i = 0; i < 3; ++i) {
        nearest.difference[i] = select(better, difference[i], nearest.difference[i]);
    }
    nearest.squared = select(better, squared, nearest.squared);
}

template <class W>
W within_unit(W t) noexcept {
    return min(max(t, W(0.0F)), W(1.0F));
}

/// Ericson 2005, 5.1.9; `r` leads from q to p.
template <class W>
void offer_edges(const W* u, const W* v, const W* r, W uu, W vv, LaneNearest<W>& nearest) noexcept {
    const W least(1e-30F);
    const W uv = dot(u, v);
    const W ur = dot(u, r);
    const W vr = dot(v, r);
    W s = within_unit(fms(uv, vr, ur * vv) / max(fms(uu, vv, uv * uv), least));
    const W t = within_unit(fma(uv, s, vr) / max(vv, least));
    s = within_unit(fms(uv, t, ur) / max(uu, least));
    W difference[3];  // q + t v - p - s u
    for (std::size_t i = 0; i < 3; ++i) difference[i] = fms(t, v[i], fma(s, u[i], r[i]));
    offer(nearest, difference, ~W::none());
}

/// The foot of a corner on the other triangle's plane, where it lies inside; `sign`
/// is 1 when the corner is B's.
template <class W>
void offer_foot(const W* corner, const LaneTriangle<W>& t, const W edge[3][3], const W* n, W nn,
                W sign, LaneNearest<W>& nearest) noexcept {
    typename W::Mask inside = greater(nn, W(1e-30F));
    W from[3];
    for (std::size_t i = 0; i < 3; ++i) {
        subtract(corner, t.corner[i], from);
        W side[3];
        cross(edge[i], from, side);
        inside = inside & ~greater(W(0.0F), dot(n, side));
    }
    subtract(corner, t.corner[0], from);
    const W along = dot(n, from) / max(nn, W(1e-30F)) * sign;
    W difference[3];
    for (std::size_t i = 0; i < 3; ++i) difference[i] = n[i] * along;
    offer(nearest, difference, inside);
}

/// A direction across which two triangles lie far apart: between their nearest
/// points as far as float finds them (Larsen, Gottschalk, Lin and Manocha 1999).
template <class W>
LaneNearest<W> nearest_of(const LaneTriangle<W>& a, const LaneTriangle<W>& b) noexcept {
    W edge_a[3][3];
    W edge_b[3][3];
    W length_a[3];
    W length_b[3];
    for (std::size_t i = 0; i < 3; ++i) {
        subtract(a.corner[(i + 1) % 3], a.corner[i], edge_a[i]);
        subtract(b.corner[(i + 1) % 3], b.corner[i], edge_b[i]);
        length_a[i] = dot(edge_a[i], edge_a[i]);
        length_b[i] = dot(edge_b[i], edge_b[i]);
    }
    LaneNearest<W> nearest{{W(0.0F), W(0.0F), W(0.0F)}, W(3e38F)};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            W r[3];
            subtract(a.corner[i], b.corner[j], r);
            offer_edges(edge_a[i], edge_b[j], r, length_a[i], length_b[j], nearest);
        }
    }
    W n_a[3];
    W n_b[3];
    cross(edge_a[0], edge_a[1], n_a);
    cross(edge_b[0], edge_b[1], n_b);
    const W nn_a = dot(n_a, n_a);
    const W nn_b = dot(n_b, n_b);
    for (std::size_t i = 0; i < 3; ++i) {
        offer_foot(b.corner[i], a, edge_a, n_a, nn_a, W(1.0F), nearest);
        offer_foot(a.corner[i], b, edge_b, n_b, nn_b, W(-1.0F), nearest);
    }
    return nearest;
}

/// The gap between the planes across a direction w through A's farthest and B's
/// nearest corner: min w.b - max w.a, over |w|. Whatever w is, the triangles are
/// that far apart, at least. Products, sums, root and quotient are off by less than
/// 16 u times the largest coordinate difference, corners by 2 sqrt 3 error.
template <class W>
W support_gap(const LaneTriangle<W>& a, const LaneTriangle<W>& b, const LaneNearest<W>& nearest,
              W error) noexcept {
    W least;
    W greatest;
    W reach(0.0F);
    for (std::size_t i = 0; i < 3; ++i) {
        // From one corner: what is far away would round more.
        W from_a[3];
        W from_b[3];
        subtract(a.corner[i], a.corner[0], from_a);
        subtract(b.corner[i], a.corner[0], from_b);
        const W at_a = dot(nearest.difference, from_a);
        const W at_b = dot(nearest.difference, from_b);
        least = i == 0 ? at_b : min(least, at_b);
        greatest = i == 0 ? at_a : max(greatest, at_a);
        reach = max(reach, max(largest(from_a), largest(from_b)));
    }
    const W length = root(dot(nearest.difference, nearest.difference));
    const W gap = (least - greatest) / max(length, W(1e-15F));
    const W rounding = fma(W(32 * kUlp), reach, W(4.0F) * error);
    // Where the direction is lost in rounding, nothing is known.
    const auto known = greater(length, W(1e-15F));
    return max(select(known, gap - rounding, W(0.0F)), W(0.0F));
}

/// The body of near_triangles().
template <class F, class R, class W>
std::size_t near_triangles_of(const LeafPlacement& placement, const LeafPair& pair,
                              const Reach& reach, LeafScratch& scratch) noexcept {
    Block& block = scratch.block[0];
    const float limit = reach.limit;
    unsigned rows = place_leaves<F>(placement, pair, limit, block);
    if (rows == 0) return 0;
    alignas(32) float begins[kLanes];
    corner_range<F>(block + kSide, reach.direction).least.store(begins);
    const R ends = corner_range<R>(block, reach.direction).greatest;
    std::size_t candidates = 0;
    while (rows != 0) {
        const RowPair at = take_rows<R>(rows);
        const unsigned found = near_rows<R>(block, at, ends, begins, limit);
        candidates = append(0, at.first, found & pair.used_a, scratch.candidate, candidates);
        if (R::kRows == 2 && at.second != at.first) {
            candidates = append(0, at.second, (found >> kLanes) & pair.used_a, scratch.candidate,
                                candidates);
        }
    }
    const float* base = block[0];
    std::size_t kept = 0;
    for (std::size_t first = 0; first < candidates; first += W::kCount) {
        const LaneIndices<W> lanes(scratch.candidate, first, candidates);
        const LaneTriangle<W> a = gathered<W>(base, lanes.of_a());
        const LaneTriangle<W> b = gathered<W>(base, lanes.of_b());
        const W gap = support_gap(a, b, nearest_of(a, b), W(block[kError][0]));
        alignas(64) float lower[W::kCount];
        gap.store_all(lower);
        for (std::size_t i = 0; i < lanes.count(); ++i) {
            if (lower[i] > limit) continue;
            const unsigned candidate = scratch.candidate[first + i];
            scratch.gap[kept++] = {lower[i], static_cast<std::uint8_t>(candidate & 7),
                                   static_cast<std::uint8_t>((candidate >> 3) & 7)};
        }
    }
    return kept;
}

}  // namespace
}  // namespace cdprep::kernels
