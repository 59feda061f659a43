// SPDX-License-Identifier: MIT
// Triangle against triangle, eight pairs and more at a time. Included by kernel sources alone,
// after they have defined the lanes: F of eight floats, W of eight or more, each with its mask
// type. placed_leaves.h bounds the rounding.
#pragma once

#include <cassert>

#include "placed_leaves.h"

namespace cdprep::kernels {

/// The most pairs of triangles in a batch: the room for candidates and for answers.
inline constexpr std::size_t kMostPairs = kLeafBatch * kLanes * kLanes;

namespace {

/// A's triangles at their place relative to B's leaf.
template <class R>
struct ShiftedTriangles {
    R corner[3][3];
    R normal[3];
    R lower[3];  ///< of the box, minus twice the error
    R upper[3];  ///< plus twice the error
    R tolerance;
};

template <class R>
void load_shifted(const Rows& a, const LeafShift& leaf, const ErrorFactors& factors,
                  ShiftedTriangles<R>& triangles) noexcept {
    const R twice_error(2.0F * leaf.error);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const R shift(leaf.shift[axis]);
        for (std::size_t i = 0; i < 3; ++i) {
            triangles.corner[i][axis] = R::load(a[kCorner + 3 * i + axis]) + shift;
        }
        triangles.normal[axis] = R::load(a[kNormal + axis]);
        triangles.lower[axis] = R::load(a[kLower + axis]) + shift - twice_error;
        triangles.upper[axis] = R::load(a[kUpper + axis]) + shift + twice_error;
    }
    triangles.tolerance = tolerance_of(R::load(a[kEdgeProduct]), R::load(a[kEdgeSum]), factors);
}

/// Returns the triangles of A that triangles of B may meet: tests boxes, then the sides of both
/// planes. Eight bits a row.
template <class R>
unsigned row_candidates(const ShiftedTriangles<R>& a, const Rows& b, const ErrorFactors& factors,
                        RowPair at) noexcept {
    typename R::Mask out = R::none();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        out = out | greater(a.lower[axis], R::spread(b[kUpper + axis], at)) |
              greater(R::spread(b[kLower + axis], at), a.upper[axis]);
    }
    R normal_b[3];
    R corner_b[3][3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
        normal_b[axis] = R::spread(b[kNormal + axis], at);
        for (std::size_t i = 0; i < 3; ++i) {
            corner_b[i][axis] = R::spread(b[kCorner + 3 * i + axis], at);
        }
    }
    R side_a[3];
    R side_b[3];
    for (std::size_t i = 0; i < 3; ++i) {
        R difference[3];
        subtract(corner_b[i], a.corner[0], difference);
        side_b[i] = dot(difference, a.normal);
        subtract(a.corner[i], corner_b[0], difference);
        side_a[i] = dot(difference, normal_b);
    }
    const R tolerance_b =
        tolerance_of(R::spread(b[kEdgeProduct], at), R::spread(b[kEdgeSum], at), factors);
    out = out | greater(min(min(side_b[0], side_b[1]), side_b[2]), a.tolerance) |
          greater(-a.tolerance, max(max(side_b[0], side_b[1]), side_b[2])) |
          greater(min(min(side_a[0], side_a[1]), side_a[2]), tolerance_b) |
          greater(-tolerance_b, max(max(side_a[0], side_a[1]), side_a[2]));
    return ~bits(out);
}

/// One triangle per lane.
template <class W>
struct LaneTriangle {
    W corner[3][3];  ///< [corner][axis]
};

template <class W>
LaneTriangle<W> gathered(const PlacedLeaves& leaves, typename W::Index at) noexcept {
    const float* base = leaves.leaf[0].row[0];
    LaneTriangle<W> triangle;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            triangle.corner[i][axis] = W::gather(base + kLanes * (kCorner + 3 * i + axis), at);
        }
    }
    return triangle;
}

/// As gathered(), if all triangles are of one leaf.
template <class W>
LaneTriangle<W> picked(const PlacedLeaf& leaf, typename W::Index at) noexcept {
    LaneTriangle<W> triangle;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            triangle.corner[i][axis] = W::pick(leaf.row[kCorner + 3 * i + axis], at);
        }
    }
    return triangle;
}

/// The sides of a plane on which three corners lie.
template <class W>
struct Sides {
    typename W::Mask plus[3];
    typename W::Mask minus[3];

    [[nodiscard]] typename W::Mask all_certain() const noexcept {
        return (plus[0] | minus[0]) & (plus[1] | minus[1]) & (plus[2] | minus[2]);
    }
    [[nodiscard]] typename W::Mask one_side() const noexcept {
        return (plus[0] & plus[1] & plus[2]) | (minus[0] & minus[1] & minus[2]);
    }
};

/// Returns the sides as orient3d() defines them: plus is behind the plane.
template <class W>
Sides<W> sides_of(const LaneTriangle<W>& plane, const LaneTriangle<W>& points, W error) noexcept {
    W edge1[3];
    W edge2[3];
    subtract(plane.corner[1], plane.corner[0], edge1);
    subtract(plane.corner[2], plane.corner[0], edge2);
    W normal[3];
    cross(edge1, edge2, normal);
    W signed_volume[3];
    W reach(0.0F);
    for (std::size_t i = 0; i < 3; ++i) {
        W difference[3];
        subtract(points.corner[i], plane.corner[0], difference);
        signed_volume[i] = dot(difference, normal);
        reach = max(reach, largest(difference));
    }
    const W limit = determinant_error(largest(edge1), largest(edge2), reach, error);
    Sides<W> sides;
    for (std::size_t i = 0; i < 3; ++i) {
        sides.plus[i] = greater(-limit, signed_volume[i]);
        sides.minus[i] = greater(signed_volume[i], limit);
    }
    return sides;
}

/// Returns the triangle rotated so that it starts with the corner that is alone on its side.
template <class W>
LaneTriangle<W> turned(const LaneTriangle<W>& t, const Sides<W>& sides,
                       typename W::Mask& lone_is_minus) noexcept {
    using Mask = typename W::Mask;
    const Mask last = ~(sides.minus[0] ^ sides.minus[1]);
    const Mask middle = ~(sides.minus[0] ^ sides.minus[2]) & ~last;
    lone_is_minus =
        (last & sides.minus[2]) | (middle & sides.minus[1]) | (~last & ~middle & sides.minus[0]);
    LaneTriangle<W> result;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const W c0 = t.corner[0][axis];
        const W c1 = t.corner[1][axis];
        const W c2 = t.corner[2][axis];
        result.corner[0][axis] = select(last, c2, select(middle, c1, c0));
        result.corner[1][axis] = select(last, c0, select(middle, c2, c1));
        result.corner[2][axis] = select(last, c1, select(middle, c0, c2));
    }
    return result;
}

template <class W>
void swap_where(typename W::Mask where, LaneTriangle<W>& t) noexcept {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const W c1 = t.corner[1][axis];
        t.corner[1][axis] = select(where, t.corner[2][axis], c1);
        t.corner[2][axis] = select(where, c1, t.corner[2][axis]);
    }
}

/// orient3d(a, b, c, d) and its largest error.
template <class W>
struct Orientation {
    W determinant;
    W error;
};

template <class W>
Orientation<W> orientation(const W* a, const W* b, const W* c, const W* d, W error) noexcept {
    W u[3];
    W v[3];
    W w[3];
    subtract(a, d, u);
    subtract(b, d, v);
    subtract(c, d, w);
    W normal[3];
    cross(v, w, normal);
    return {dot(u, normal), determinant_error(largest(u), largest(v), largest(w), error)};
}

/// The lanes that cross and those that are undecided: bit sets.
struct Verdict {
    unsigned crossing;
    unsigned unknown;
};

/// Tests lanes of triangles (Guigue and Devillers 2003): three signs each way, then two that order
/// the intervals on the common line.
template <class W>
Verdict judge(const LaneTriangle<W>& a, const LaneTriangle<W>& b, W error) noexcept {
    using Mask = typename W::Mask;
    const Sides<W> sides_a = sides_of(b, a, error);
    const Sides<W> sides_b = sides_of(a, b, error);
    const Mask apart = sides_a.one_side() | sides_b.one_side();
    const Mask certain = sides_a.all_certain() & sides_b.all_certain();
    Mask minus_a;
    Mask minus_b;
    LaneTriangle<W> p = turned(a, sides_a, minus_a);
    LaneTriangle<W> q = turned(b, sides_b, minus_b);
    swap_where(minus_a, q);
    swap_where(minus_b, p);
    const Orientation<W> first =
        orientation(p.corner[0], p.corner[1], q.corner[0], q.corner[1], error);
    const Orientation<W> second =
        orientation(p.corner[0], p.corner[2], q.corner[2], q.corner[0], error);
    const Mask beyond =
        greater(first.determinant, first.error) | greater(second.determinant, second.error);
    const Mask within =
        greater(-first.error, first.determinant) & greater(-second.error, second.determinant);
    const unsigned crossing = bits(certain & within & ~apart);
    return {crossing, ~(crossing | bits(apart | (certain & beyond)))};
}

/// Two triangles per lane, in common coordinates, and their error.
template <class W>
struct LanePairs {
    LaneTriangle<W> a;
    LaneTriangle<W> b;
    W error;

    /// Loads candidates of any pairs of leaves.
    LanePairs(const LeafScratch& scratch, const std::uint16_t* candidate) noexcept {
        const typename W::Index at = W::load_index(candidate);
        const typename W::Index pair = shifted_right(at, 6);
        a = gathered<W>(scratch.a, low_bits(at) + W::gather_index(scratch.place[0], pair));
        b = gathered<W>(scratch.b,
                        low_bits(shifted_right(at, 3)) + W::gather_index(scratch.place[1], pair));
        error = W::gather(scratch.shift[3], pair);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const W shift = W::gather(scratch.shift[axis], pair);
            for (auto& corner : a.corner) corner[axis] = corner[axis] + shift;
        }
    }

    /// Loads candidates of one pair of leaves, number `index`. Uses permutations; gathers would
    /// take as long as all the rest. Lanes past the last candidate may hold anything.
    LanePairs(const LeafScratch& scratch, const std::uint16_t* candidate, const LeafPair& pair,
              std::size_t index) noexcept {
        assert(index < kLeafBatch);
        const typename W::Index at = W::load_index(candidate);
        a = picked<W>(scratch.a.leaf[place_of(pair.number_a)], low_bits(at));
        b = picked<W>(scratch.b.leaf[place_of(pair.number_b)], low_bits(shifted_right(at, 3)));
        error = W(scratch.shift[3][index]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const W shift(scratch.shift[axis][index]);
            for (auto& corner : a.corner) corner[axis] = corner[axis] + shift;
        }
    }
};

/// Returns the number of lanes from `first` on that hold candidates.
template <class W>
std::size_t lanes_used(std::size_t first, std::size_t end) noexcept {
    assert(first < end);
    return end - first < W::kCount ? end - first : std::size_t{W::kCount};
}

/// Repeats the last candidate in the lanes past it, because they are used to gather.
template <class W>
void fill_up(std::uint16_t* candidate, std::size_t count) noexcept {
    assert(count <= kMostPairs);
    if (count == 0) return;
    for (std::size_t i = 0; i < W::kCount; ++i) candidate[count + i] = candidate[count - 1];
}

/// Judges the candidates, W::kCount at a time; `load(candidate)` makes LanePairs of them. Returns
/// the new number of those found.
template <class W, class Load>
std::size_t judge_all(std::size_t candidates, std::size_t found, LeafScratch& scratch,
                      Load load) noexcept {
    for (std::size_t first = 0; first < candidates; first += W::kCount) {
        const LanePairs<W> triangles = load(scratch.candidate + first);
        const Verdict verdict = judge(triangles.a, triangles.b, triangles.error);
        const unsigned used = (1U << lanes_used<W>(first, candidates)) - 1;
        for (unsigned rest = (verdict.crossing | verdict.unknown) & used; rest != 0;
             rest &= rest - 1) {
            assert(found < kMostPairs);
            const auto i = format::lowest_set_bit(rest);
            const unsigned candidate = scratch.candidate[first + i];
            scratch.found[found++] = {static_cast<std::uint8_t>(candidate >> 6),
                                      static_cast<std::uint8_t>(candidate & 7),
                                      static_cast<std::uint8_t>((candidate >> 3) & 7),
                                      ((verdict.crossing >> i) & 1) != 0};
        }
    }
    return found;
}

/// Appends the triangles of A in either row's bits, (pair << 6 | b << 3 | a) each; returns the new
/// count. Without a branch, because their number is unpredictable.
template <class R>
std::size_t append_rows(unsigned pair, RowPair at, unsigned found, unsigned used_a,
                        std::uint16_t* candidate, std::size_t count) noexcept {
    assert(pair < kLeafBatch && count <= kMostPairs && used_a >> kLanes == 0);
    const bool one_row = R::kRows == 1 || at.second == at.first;
    const unsigned kept = found & (one_row ? used_a : used_a | used_a << kLanes);
    const unsigned first = pair << 6 | static_cast<unsigned>(at.first) << 3;
    const unsigned second = pair << 6 | static_cast<unsigned>(at.second) << 3;
    R::store_lanes(kept, first, second, candidate + count);
    return count + format::count_set_bits(kept);
}

/// The leaf that claims each place, over some pairs.
class Claims {
public:
    /// Returns false if another leaf has claimed the place of either leaf.
    bool claim(const LeafPair& pair) noexcept {
        return claim(a_, number_a_, pair.number_a) && claim(b_, number_b_, pair.number_b);
    }

private:
    static bool claim(std::uint64_t& taken, std::uint32_t* numbers, std::uint32_t number) noexcept {
        const std::size_t at = place_of(number);
        if (((taken >> at) & 1) != 0) return numbers[at] == number;
        taken |= std::uint64_t{1} << at;
        numbers[at] = number;
        return true;
    }
    std::uint64_t a_ = 0;
    std::uint64_t b_ = 0;
    std::uint32_t number_a_[kLeafPlaces];
    std::uint32_t number_b_[kLeafPlaces];
};
static_assert(kLeafPlaces <= 64);

/// Returns one past the last of the pairs from `first` on whose leaves have places of their own.
inline std::size_t end_of_run(const LeafPair* pairs, std::size_t first,
                              std::size_t count) noexcept {
    Claims claims;
    while (first < count && claims.claim(pairs[first])) ++first;
    return first;
}

/// Leaves of two models: no pair of triangles is excluded.
struct NothingLeftOut {
    template <class R>
    static unsigned lanes(const LeafPair* /*pairs*/, std::size_t /*index*/,
                          RowPair /*at*/) noexcept {
        return 0;
    }
};

/// Leaves of one tree: excludes triangles with a common vertex and, for a leaf against itself,
/// duplicate pairs.
struct NeighboursLeftOut {
    const CornerNumbers* corners;  ///< of each pair of leaves

    /// Returns the triangles of A excluded with one of B. Eight bits a row.
    template <class R>
    [[nodiscard]] unsigned lanes(const LeafPair* pairs, std::size_t index,
                                 RowPair at) const noexcept {
        assert(corners != nullptr);
        const LeafPair& pair = pairs[index];
        const std::uint32_t* a = corners[index].a;
        const std::uint32_t* b = corners[index].b;
        typename R::Mask shared = R::none();
        for (std::size_t j = 0; j < 3; ++j) {
            const typename R::Index number = R::spread_number(b + kLanes * j, at);
            for (std::size_t i = 0; i < 3; ++i) {
                shared = shared | equal(R::load_numbers(a + kLanes * i), number);
            }
        }
        if (pair.number_a != pair.number_b) return bits(shared);
        const unsigned not_first = (0xffU << at.first) & 0xff;
        const unsigned not_second = (0xffU << at.second) & 0xff;
        return bits(shared) | not_first | not_second << kLanes;
    }
};

/// Finds the candidates of pairs [first, last); returns their number. Works in two rounds: whether
/// leaves meet is unpredictable, so the first round computes it for all.
template <class F, class R, class LeftOut>
std::size_t find_candidates(const LeafPlacement& placement, const LeafPair* pairs,
                            std::size_t first, std::size_t last, const LeftOut& left_out,
                            LeafScratch& scratch) noexcept {
    assert(first < last && last <= kLeafBatch);
    MetLeaves met[kLeafBatch];
    for (std::size_t i = first; i < last; ++i) {
        met[i] = meet<F>(placement, pairs[i], i, 0, scratch);
    }
    std::size_t candidates = 0;
    for (std::size_t i = first; i < last; ++i) {
        unsigned rows = met[i].rows;
        if (rows == 0) continue;
        const LeafShift& leaf = met[i].leaf;
        const Rows& b = scratch.b.leaf[place_of(pairs[i].number_b)].row;
        const ErrorFactors factors = error_factors(leaf.reach, leaf.error);
        ShiftedTriangles<R> a;
        load_shifted(placed_in_a<F>(placement, pairs[i], scratch), leaf, factors, a);
        while (rows != 0) {
            const RowPair at = take_rows<R>(rows);
            const unsigned near = row_candidates(a, b, factors, at);
            const unsigned wanted = near & ~left_out.template lanes<R>(pairs, i, at);
            candidates = append_rows<R>(static_cast<unsigned>(i), at, wanted, pairs[i].used_a,
                                        scratch.candidate, candidates);
        }
    }
    return candidates;
}

/// Finds the contacts of a batch except those excluded.
template <class F, class R, class W, class LeftOut>
std::size_t find_contacts_but(const LeafPlacement& placement, const LeafPair* pairs,
                              std::size_t count, const LeftOut& left_out,
                              LeafScratch& scratch) noexcept {
    assert(count <= kLeafBatch);
    std::size_t found = 0;
    for (std::size_t first = 0; first < count;) {
        const std::size_t last = end_of_run(pairs, first, count);
        assert(last > first);  // one pair always has its places
        const std::size_t candidates =
            find_candidates<F, R>(placement, pairs, first, last, left_out, scratch);
        if (last - first == 1) {
            found = judge_all<W>(candidates, found, scratch, [&](const std::uint16_t* candidate) {
                return LanePairs<W>(scratch, candidate, pairs[first], first);
            });
        } else {
            fill_up<W>(scratch.candidate, candidates);
            found = judge_all<W>(candidates, found, scratch, [&](const std::uint16_t* candidate) {
                return LanePairs<W>(scratch, candidate);
            });
        }
        first = last;
    }
    return found;
}

/// The body of find_contacts().
template <class F, class R, class W>
std::size_t find_contacts_of(const LeafPlacement& placement, const LeafPair* pairs,
                             std::size_t count, LeafScratch& scratch) noexcept {
    return find_contacts_but<F, R, W>(placement, pairs, count, NothingLeftOut{}, scratch);
}

/// The body of find_own_contacts().
template <class F, class R, class W>
std::size_t find_own_contacts_of(const LeafPlacement& placement, const LeafPair* pairs,
                                 std::size_t count, const CornerNumbers* corners,
                                 LeafScratch& scratch) noexcept {
    return find_contacts_but<F, R, W>(placement, pairs, count, NeighboursLeftOut{corners}, scratch);
}

}  // namespace
}  // namespace cdprep::kernels
