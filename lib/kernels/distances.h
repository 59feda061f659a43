// SPDX-License-Identifier: MIT
// Lower bounds of distances of boxes and of triangles. Included by kernel sources alone, after
// leaf_contacts.h.
#pragma once

#include <cassert>

#include "leaf_contacts.h"

namespace cdprep::kernels {
namespace {

/// Returns the sum of the squares of the positive components.
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

/// Returns the square of the gap between boxes along three axes.
template <class R>
R squared_gap(const Boxes<R>& a, const BoxRows& rows, RowPair at) noexcept {
    R gap[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
        gap[axis] = abs(a.centre[axis] - R::spread(rows.centre[axis], at)) -
                    (a.half[axis] + R::spread(rows.half[axis], at));
    }
    return squared_length(gap);
}

/// Axes are at right angles up to 2^-21, and squares, sums and the root round. So a length of gaps
/// is too great by less than this, in relative terms.
inline constexpr float kGapRounding = 1 - 0x1p-18F;

/// Reach::direction is shorter than 1; this allows for its rounding.
[[maybe_unused]] inline bool is_within_unit(const float* direction) noexcept {
    const float* d = direction;
    return d[0] * d[0] + d[1] * d[1] + d[2] * d[2] <= 1 + 0x1p-20F;
}

/// The extent of boxes along a direction: the middle, and the reach from it.
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

/// Stores the begins of B's boxes along the direction, plus the shift, minus the slack in all three
/// components.
template <class F>
void store_begins(const Span<F>& span, const BoxPlacement& p, const Reach& reach,
                  float* begins) noexcept {
    assert(is_within_unit(reach.direction) && is_within_unit(reach.direction_in_b));
    const float* d = reach.direction;
    const float shift = p.shift[0] * d[0] + p.shift[1] * d[1] + p.shift[2] * d[2];
    ((span.middle - span.half) + F(shift - 2 * p.slack)).store(begins);
}

/// The body of near_boxes().
template <class F, class R>
BoxPairs near_boxes_of(const BoxPlacement& p, const NodeBoxes& a, const NodeBoxes& b,
                       const BoxChoice& choice, const Reach& reach, BoxPairFloats& gaps) noexcept {
    assert(reach.limit >= 0);
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
        const R squared =
            max(squared_gap(boxes_a, along_a, at), squared_gap(turned_a, along_b, at));
        R gap = max(root(squared) * R(kGapRounding), R::spread(begins, at) - ends);
        unsigned near = wanted & ~bits(greater(gap, R(reach.limit)));
        if (oriented && near != 0) {
            const FaceGaps<R> face = oriented_gaps(oriented_a, oriented_b, at, p);
            const R length = root(max(squared_length(face.of_a), squared_length(face.of_b)));
            gap = max(gap, length * R(kGapRounding));
            near = wanted & ~bits(greater(gap, R(reach.limit)));
        }
        gap.store_rows(gaps.value[at.first], gaps.value[at.second]);
        pairs |= pairs_in_rows<R>(near, at);
    }
    return pairs;
}

template <class F>
struct Range {
    F least;
    F greatest;
};

/// Returns the extent of eight triangles along a direction.
template <class F>
Range<F> corner_range(const F corner[3][3], const float* direction) noexcept {
    const F d[3] = {F(direction[0]), F(direction[1]), F(direction[2])};
    const F first = dot(corner[0], d);
    const F second = dot(corner[1], d);
    const F third = dot(corner[2], d);
    return {min(min(first, second), third), max(max(first, second), third)};
}

/// Stores the begins of B's triangles along the direction.
template <class F>
void store_begins(const Rows& b, const float* direction, float* begins) noexcept {
    F corner[3][3];
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            corner[i][axis] = F::load(b[kCorner + 3 * i + axis]);
        }
    }
    corner_range(corner, direction).least.store(begins);
}

/// Returns the triangles of A that come within the limit of triangles of B, by their boxes and
/// along the direction. `ends` holds the ends of A's triangles, `begins` the begins of B's. Eight
/// bits a row.
template <class R>
unsigned near_rows(const ShiftedTriangles<R>& a, const Rows& b, RowPair at, const R& ends,
                   const float* begins, const LeafShift& leaf, float limit) noexcept {
    R gap[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const R above = a.lower[axis] - R::spread(b[kUpper + axis], at);
        const R below = R::spread(b[kLower + axis], at) - a.upper[axis];
        gap[axis] = max(above, below);
    }
    const R squared = squared_length(gap) * R(kGapRounding);
    // The error of a corner exceeds 3 u times any coordinate. Twelve such errors cover the corners'
    // own errors and the rounding of two dot products.
    const R along = (R::spread(begins, at) - ends) - R(12.0F * leaf.error);
    return ~bits(greater(squared, R(limit * limit)) | greater(along, R(limit)));
}

/// The nearest pair of points found so far, in each lane.
template <class W>
struct LaneNearest {
    W difference[3];  ///< from A's point to B's
    W squared;
    W between_edges;  ///< the least for points on edges, which certainly lie on the triangles
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

/// An edge, its squared length and the reciprocal of that. Each is used three times, and a quotient
/// takes as long as ten products.
template <class W>
struct LaneEdge {
    W along[3];
    W squared;
    W inverse;
};

template <class W>
W inverse_of(W squared) noexcept {
    return W(1.0F) / max(squared, W(1e-30F));
}

template <class W>
void edges_of(const LaneTriangle<W>& t, LaneEdge<W> edge[3]) noexcept {
    for (std::size_t i = 0; i < 3; ++i) {
        subtract(t.corner[(i + 1) % 3], t.corner[i], edge[i].along);
        edge[i].squared = dot(edge[i].along, edge[i].along);
        edge[i].inverse = inverse_of(edge[i].squared);
    }
}

/// Offers the nearest points of two edges (Ericson 2005, 5.1.9). `r` leads from q to p.
template <class W>
void offer_edges(const LaneEdge<W>& of_a, const LaneEdge<W>& of_b, const W* r,
                 LaneNearest<W>& nearest) noexcept {
    const W* u = of_a.along;
    const W* v = of_b.along;
    const W uv = dot(u, v);
    const W ur = dot(u, r);
    const W vr = dot(v, r);
    const W parallel = fms(of_a.squared, of_b.squared, uv * uv);
    W s = within_unit(fms(uv, vr, ur * of_b.squared) / max(parallel, W(1e-30F)));
    const W t = within_unit(fma(uv, s, vr) * of_b.inverse);
    s = within_unit(fms(uv, t, ur) * of_a.inverse);
    W difference[3];  // q + t v - p - s u
    for (std::size_t i = 0; i < 3; ++i) difference[i] = fms(t, v[i], fma(s, u[i], r[i]));
    offer(nearest, difference, ~W::none());
}

/// A triangle's plane: a normal, its squared length and the reciprocal of that.
template <class W>
struct LanePlane {
    W normal[3];
    W squared;
    W inverse;

    explicit LanePlane(const LaneEdge<W> edge[3]) noexcept {
        cross(edge[0].along, edge[1].along, normal);
        squared = dot(normal, normal);
        inverse = inverse_of(squared);
    }
};

/// Offers the foot of a corner on the other triangle's plane, if it lies inside. `sign` is 1 if the
/// corner is B's.
template <class W>
void offer_foot(const W* corner, const LaneTriangle<W>& t, const LaneEdge<W> edge[3],
                const LanePlane<W>& plane, W sign, LaneNearest<W>& nearest) noexcept {
    const W* n = plane.normal;
    typename W::Mask inside = greater(plane.squared, W(1e-30F));
    W from[3];
    for (std::size_t i = 0; i < 3; ++i) {
        subtract(corner, t.corner[i], from);
        W side[3];
        cross(edge[i].along, from, side);
        inside = inside & ~greater(W(0.0F), dot(n, side));
    }
    subtract(corner, t.corner[0], from);
    const W along = dot(n, from) * plane.inverse * sign;
    W difference[3];
    for (std::size_t i = 0; i < 3; ++i) difference[i] = n[i] * along;
    offer(nearest, difference, inside);
}

/// Returns a direction along which two triangles lie far apart. It leads between their nearest
/// points, as far as float finds them (Larsen, Gottschalk, Lin and Manocha 1999).
template <bool kUpper, class W>
LaneNearest<W> nearest_of(const LaneTriangle<W>& a, const LaneTriangle<W>& b) noexcept {
    LaneEdge<W> edge_a[3];
    LaneEdge<W> edge_b[3];
    edges_of(a, edge_a);
    edges_of(b, edge_b);
    LaneNearest<W> nearest{{W(0.0F), W(0.0F), W(0.0F)}, W(3e38F), W(3e38F)};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            W r[3];
            subtract(a.corner[i], b.corner[j], r);
            offer_edges(edge_a[i], edge_b[j], r, nearest);
        }
    }
    if constexpr (kUpper) nearest.between_edges = nearest.squared;
    const LanePlane<W> plane_a(edge_a);
    const LanePlane<W> plane_b(edge_b);
    for (std::size_t i = 0; i < 3; ++i) {
        offer_foot(b.corner[i], a, edge_a, plane_a, W(1.0F), nearest);
        offer_foot(a.corner[i], b, edge_b, plane_b, W(-1.0F), nearest);
    }
    return nearest;
}

/// A lower and an upper bound of the distance of two triangles.
template <class W>
struct LaneGap {
    W lower;
    W upper;
};

/// Lower bound: the gap between the planes across a direction w through A's farthest and B's
/// nearest corner, (min w.b - max w.a) / |w|. For any w, the triangles are at least that far apart.
/// Products, sums, root and quotient are off by less than 16 u times the largest coordinate
/// difference, corners by 2 sqrt 3 error.
///
/// Upper bound: the distance of points of two edges, for any weights in [0, 1]. Let coordinates be
/// at most M from A's first corner. Differences of corners are off by 2 u M. The two weighted ones
/// and the sums are off by 14 u M a component in all, 25 u M in length. Square, sums and root are
/// off by 14 u M. Together this is less than 64 u M.
template <bool kUpper, class W>
LaneGap<W> support_gap(const LaneTriangle<W>& a, const LaneTriangle<W>& b,
                       const LaneNearest<W>& nearest, W error) noexcept {
    W least;
    W greatest;
    W reach(0.0F);
    for (std::size_t i = 0; i < 3; ++i) {
        // Relative to one corner: larger coordinates would round more.
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
    // If the direction is lost in rounding, nothing is known.
    const auto known = greater(length, W(1e-15F));
    LaneGap<W> bounds;
    bounds.lower = max(select(known, gap - rounding, W(0.0F)), W(0.0F));
    if constexpr (kUpper) bounds.upper = fma(W(2.0F), rounding, root(nearest.between_edges));
    return bounds;
}

/// Bounds the gaps of the candidates, W::kCount at a time; `load(candidate)` makes LanePairs of
/// them. Returns the new number of those kept. Without kUpper nothing is certain, at less cost.
template <bool kUpper, class W, class Load>
std::size_t keep_near(std::size_t candidates, std::size_t kept, const Reach& reach,
                      LeafScratch& scratch, Load load) noexcept {
    for (std::size_t first = 0; first < candidates; first += W::kCount) {
        const LanePairs<W> triangles = load(scratch.candidate + first);
        const LaneNearest<W> nearest = nearest_of<kUpper>(triangles.a, triangles.b);
        const LaneGap<W> gap =
            support_gap<kUpper>(triangles.a, triangles.b, nearest, triangles.error);
        unsigned certain = 0;
        if constexpr (kUpper) certain = bits(greater(W(reach.certain), gap.upper));
        alignas(64) float lower[W::kCount];
        gap.lower.store_all(lower);
        for (std::size_t i = 0; i < lanes_used<W>(first, candidates); ++i) {
            if (lower[i] > reach.limit) continue;
            assert(kept < kMostPairs);
            const unsigned candidate = scratch.candidate[first + i];
            scratch.gap[kept++] = {lower[i], static_cast<std::uint8_t>(candidate >> 6),
                                   static_cast<std::uint8_t>(candidate & 7),
                                   static_cast<std::uint8_t>((candidate >> 3) & 7),
                                   ((certain >> i) & 1) != 0};
        }
    }
    return kept;
}

/// Appends the candidates of pair `index`; returns their new number. Always inlined: with two
/// callers GCC would not inline it, and a search for the nearest takes 2 % longer.
template <class F, class R>
[[gnu::always_inline]] inline std::size_t near_candidates(const LeafPlacement& placement,
                                                          const LeafPair& pair, std::size_t index,
                                                          const Reach& reach,
                                                          std::size_t candidates,
                                                          LeafScratch& scratch) noexcept {
    assert(is_within_unit(reach.direction));
    MetLeaves met = meet<F>(placement, pair, index, reach.limit, scratch);
    if (met.rows == 0) return candidates;
    const LeafShift& leaf = met.leaf;
    const Rows& b = scratch.b.leaf[place_of(pair.number_b)].row;
    ShiftedTriangles<R> a;
    load_shifted(placed_in_a<F>(placement, pair, scratch), leaf,
                 error_factors(leaf.reach, leaf.error), a);
    alignas(32) float begins[kLanes];
    store_begins<F>(b, reach.direction, begins);
    const R ends = corner_range(a.corner, reach.direction).greatest;
    while (met.rows != 0) {
        const RowPair at = take_rows<R>(met.rows);
        const unsigned found = near_rows(a, b, at, ends, begins, leaf, reach.limit);
        candidates = append_rows<R>(static_cast<unsigned>(index), at, found, pair.used_a,
                                    scratch.candidate, candidates);
    }
    return candidates;
}

/// The body of near_triangles().
template <class F, class R, class W>
std::size_t near_triangles_of(const LeafPlacement& placement, const LeafPair& pair,
                              const Reach& reach, LeafScratch& scratch) noexcept {
    const std::size_t candidates = near_candidates<F, R>(placement, pair, 0, reach, 0, scratch);
    return keep_near<false, W>(candidates, 0, reach, scratch, [&](const std::uint16_t* candidate) {
        return LanePairs<W>(scratch, candidate, pair, 0);
    });
}

/// The body of triangles_within().
template <class F, class R, class W>
std::size_t triangles_within_of(const LeafPlacement& placement, const LeafPair* pairs,
                                std::size_t count, const Reach& reach,
                                LeafScratch& scratch) noexcept {
    assert(count <= kLeafBatch);
    std::size_t kept = 0;
    for (std::size_t first = 0; first < count;) {
        const std::size_t last = end_of_run(pairs, first, count);
        assert(last > first);  // one pair always has its places
        std::size_t candidates = 0;
        for (; first < last; ++first) {
            candidates =
                near_candidates<F, R>(placement, pairs[first], first, reach, candidates, scratch);
        }
        fill_up<W>(scratch.candidate, candidates);
        kept = keep_near<true, W>(
            candidates, kept, reach, scratch,
            [&](const std::uint16_t* candidate) { return LanePairs<W>(scratch, candidate); });
    }
    return kept;
}

}  // namespace
}  // namespace cdprep::kernels
