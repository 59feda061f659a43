// SPDX-License-Identifier: MIT
// Triangle against triangle, eight pairs and more at a time. Included by kernel
// sources alone, after they have defined the lanes: F of eight floats, W of eight
// or more, each with its mask type.
//
// Rounding. Let u = 2^-24 and d the error of a pair: no corner, in the coordinates
// computed here, is further than d from where the question has it along any axis.
// A determinant of three differences U, V, W of corners is then off
//   - by the corners: each row moves by 2d per component, and the cross product of
//     two rows has components of at most 2|V||W| (largest components), six such
//     terms in all: 12 d (|V||W| + |U||W| + |U||V|), where each norm already
//     counts the other rows' motion and is therefore taken 3d too large;
//   - by rounding: six products of three, each of a difference (u), two products
//     (2u), and up to three sums of terms below 6|U||V||W| in all: 48 u |U||V||W|.
// Underflow moves a product by 2^-126 at most, even where the processor flushes
// subnormal numbers to zero; components are at most 4, so 1e-35 covers it.
#pragma once

#include "box_overlap.h"
#include "kernels.h"

namespace cdprep::kernels {
namespace {

inline constexpr float kUlp = 0x1p-24F;
inline constexpr float kUnderflow = 1e-35F;

/// Rows of a block: corners, normals, tolerance, box of the eight triangles of
/// each side, then the pair's error.
enum Row : std::size_t {
    kCorner = 0,
    kNormal = 9,
    kTolerance = 12,
    kLower = 13,
    kUpper = 16,
    kSide = 19,
    kError = 2 * kSide,
};
static_assert(LeafScratch::kRows == kError + 1);

using Block = float[LeafScratch::kRows][kLanes];

template <class F>
F largest(const F* v) noexcept {
    return max(max(abs(v[0]), abs(v[1])), abs(v[2]));
}

template <class F>
void subtract(const F* a, const F* b, F* result) noexcept {
    for (std::size_t i = 0; i < 3; ++i) result[i] = a[i] - b[i];
}

/// How far a determinant of rows with these largest components may be off.
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

/// What the row test needs of eight triangles; `reach` is the largest component
/// of any corner of the other leaf less one of theirs.
template <class F>
void describe(const F corner[3][3], float reach, float error, float (*rows)[kLanes]) noexcept {
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
    determinant_error(largest(edge1), largest(edge2), F(reach), F(error)).store(rows[kTolerance]);
}

/// B's leaf in the coordinates around the middle of A's.
struct LeafOffset {
    float offset[3];    ///< of B's middle
    float middle_a[3];  ///< to be taken off the stored corners
    float middle_b[3];
    float half_a[3];
    float reach;  ///< the largest difference of two corners along an axis, at least
    float error;
};

inline float absolute(float x) noexcept {
    return x < 0 ? -x : x;
}

inline float largest(float x, float y, float z) noexcept {
    const float xy = x > y ? x : y;
    return xy > z ? xy : z;
}

inline LeafOffset offset_of(const LeafPlacement& p, const LeafPair& pair) noexcept {
    const float* origin_a = pair.a + kLeafOrigin;
    const float* origin_b = pair.b + kLeafOrigin;
    double b[3];
    for (std::size_t i = 0; i < 3; ++i) {
        b[i] = (double{origin_b[i]} - p.b.frame_origin[i]) * p.b.scale;
    }
    LeafOffset leaf;
    for (std::size_t i = 0; i < 3; ++i) {
        const double* r = p.rotation + 3 * i;
        const double a = (double{origin_a[i]} - p.a.frame_origin[i]) * p.a.scale;
        const double at = ((r[0] * b[0] + r[1] * b[1]) + r[2] * b[2]) + p.shift[i];
        leaf.offset[i] = static_cast<float>(at - a);
        leaf.middle_a[i] = origin_a[i] * p.a.takes_origin;
        leaf.middle_b[i] = origin_b[i] * p.b.takes_origin;
        leaf.half_a[i] = pair.a[kLeafHalf + i] * p.a.box_scale;
    }
    const float far =
        largest(absolute(leaf.offset[0]), absolute(leaf.offset[1]), absolute(leaf.offset[2]));
    const float half = largest(leaf.half_a[0], leaf.half_a[1], leaf.half_a[2]);
    const float* half_b = pair.b + kLeafHalf;
    const float reach_b = largest(half_b[0], half_b[1], half_b[2]) * p.b.box_scale;
    // A corner of B: rounded when baked and when the middle is taken off (u each),
    // three rounded factors, products and sums: below 12 u sqrt 3 reach_b in all,
    // and 5 u |offset|. A's corners: 2 u half_a.
    leaf.error = p.error + kUlp * (21.0F * reach_b + 6.0F * far + 3.0F * half) + kUnderflow;
    leaf.reach = far + half + 1.75F * reach_b;
    return leaf;
}

/// Brings the triangles of both leaves into one place. Returns the triangles of B
/// whose boxes come within `margin` of the box of A's leaf; without any, the block
/// stays unfinished.
template <class F>
unsigned place_leaves(const LeafPlacement& placement, const LeafPair& pair, float margin,
                      Block& block) noexcept {
    const LeafOffset leaf = offset_of(placement, pair);
    const float* r = placement.corner_rotation;
    F b[3][3];
    for (std::size_t i = 0; i < 3; ++i) {
        F local[3];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            local[axis] = F::load(pair.b + kLanes * (3 * i + axis)) - F(leaf.middle_b[axis]);
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float* row = r + 3 * axis;
            b[i][axis] =
                fma(F(row[0]), local[0],
                    fma(F(row[1]), local[1], fma(F(row[2]), local[2], F(leaf.offset[axis]))));
        }
    }
    typename F::Mask out = F::none();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const F limit(leaf.half_a[axis] + 2 * leaf.error + margin);
        const F lower = min(min(b[0][axis], b[1][axis]), b[2][axis]);
        const F upper = max(max(b[0][axis], b[1][axis]), b[2][axis]);
        out = out | greater(lower, limit) | greater(-limit, upper);
    }
    const unsigned live = pair.used_b & ~bits(out);
    if (live == 0) return 0;
    const F scale_a(static_cast<float>(placement.a.scale));
    F a[3][3];
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            a[i][axis] =
                (F::load(pair.a + kLanes * (3 * i + axis)) - F(leaf.middle_a[axis])) * scale_a;
        }
    }
    describe(a, leaf.reach, leaf.error, block);
    describe(b, leaf.reach, leaf.error, block + kSide);
    F(leaf.error).store(block[kError]);
    return live;
}

/// Triangles of A that triangles of B may meet: boxes, then the sides of both
/// planes. Eight bits a row.
template <class R>
unsigned row_candidates(const Block& block, RowPair at) noexcept {
    const float(*a)[kLanes] = block;
    const float(*b)[kLanes] = block + kSide;
    const R twice_error = R(2.0F * block[kError][0]);
    typename R::Mask out = R::none();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        out = out |
              greater(R::load(a[kLower + axis]), R::spread(b[kUpper + axis], at) + twice_error) |
              greater(R::spread(b[kLower + axis], at), R::load(a[kUpper + axis]) + twice_error);
    }
    R normal_a[3];
    R normal_b[3];
    R corner_a[3][3];
    R corner_b[3][3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
        normal_a[axis] = R::load(a[kNormal + axis]);
        normal_b[axis] = R::spread(b[kNormal + axis], at);
        for (std::size_t i = 0; i < 3; ++i) {
            corner_a[i][axis] = R::load(a[kCorner + 3 * i + axis]);
            corner_b[i][axis] = R::spread(b[kCorner + 3 * i + axis], at);
        }
    }
    R side_a[3];
    R side_b[3];
    for (std::size_t i = 0; i < 3; ++i) {
        R difference[3];
        subtract(corner_b[i], corner_a[0], difference);
        side_b[i] = dot(difference, normal_a);
        subtract(corner_a[i], corner_b[0], difference);
        side_a[i] = dot(difference, normal_b);
    }
    const R tolerance_a = R::load(a[kTolerance]);
    const R tolerance_b = R::spread(b[kTolerance], at);
    out = out | greater(min(min(side_b[0], side_b[1]), side_b[2]), tolerance_a) |
          greater(-tolerance_a, max(max(side_b[0], side_b[1]), side_b[2])) |
          greater(min(min(side_a[0], side_a[1]), side_a[2]), tolerance_b) |
          greater(-tolerance_b, max(max(side_a[0], side_a[1]), side_a[2]));
    return ~bits(out);
}

/// One triangle of each lane.
template <class W>
struct LaneTriangle {
    W corner[3][3];  ///< [corner][axis]
};

template <class W>
LaneTriangle<W> gathered(const float* base, typename W::Index at) noexcept {
    LaneTriangle<W> triangle;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            triangle.corner[i][axis] = W::gather(base + kLanes * (kCorner + 3 * i + axis), at);
        }
    }
    return triangle;
}

/// On which side of a plane three corners lie.
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

/// Sides as orient3d() gives them: plus is behind the plane.
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

/// A triangle turned so that it starts with the corner that is alone on its side.
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

/// orient3d(a, b, c, d) and how far it may be off.
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

/// Bit sets of lanes.
struct Verdict {
    unsigned crossing;
    unsigned unknown;
};

/// Guigue and Devillers 2003: three signs each way, then two that order the
/// intervals on the common line.
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

/// Where the blocks keep some of the candidates, (pair << 6 | b << 3 | a) each;
/// lanes past the last repeat the first.
template <class W>
class LaneIndices {
public:
    LaneIndices(const std::uint16_t* candidate, std::size_t first, std::size_t end) noexcept
        : count_(end - first < W::kCount ? end - first : std::size_t{W::kCount}) {
        for (std::size_t i = 0; i < W::kCount; ++i) {
            const unsigned at = candidate[first + (i < count_ ? i : 0)];
            const auto block = static_cast<std::int32_t>((at >> 6) * LeafScratch::kRows * kLanes);
            a_[i] = block + static_cast<std::int32_t>(at & 7);
            b_[i] = block + static_cast<std::int32_t>(kSide * kLanes + ((at >> 3) & 7));
        }
    }
    [[nodiscard]] std::size_t count() const noexcept {
        return count_;
    }
    [[nodiscard]] typename W::Index of_a() const noexcept {
        return W::load_index(a_);
    }
    [[nodiscard]] typename W::Index of_b() const noexcept {
        return W::load_index(b_);
    }

private:
    alignas(64) std::int32_t a_[W::kCount];
    alignas(64) std::int32_t b_[W::kCount];
    std::size_t count_;
};

/// Judges the candidates, W::kCount at a time.
template <class W>
std::size_t judge_all(std::size_t candidates, LeafScratch& scratch) noexcept {
    const float* base = scratch.block[0][0];
    std::size_t found = 0;
    for (std::size_t first = 0; first < candidates; first += W::kCount) {
        const LaneIndices<W> lanes(scratch.candidate, first, candidates);
        const W error = W::gather(base + kError * kLanes, lanes.of_a());
        const Verdict verdict =
            judge(gathered<W>(base, lanes.of_a()), gathered<W>(base, lanes.of_b()), error);
        const unsigned used = (1U << lanes.count()) - 1;
        for (unsigned rest = (verdict.crossing | verdict.unknown) & used; rest != 0;
             rest &= rest - 1) {
            const auto i = static_cast<unsigned>(__builtin_ctz(rest));
            const unsigned candidate = scratch.candidate[first + i];
            scratch.found[found++] = {static_cast<std::uint8_t>(candidate >> 6),
                                      static_cast<std::uint8_t>(candidate & 7),
                                      static_cast<std::uint8_t>((candidate >> 3) & 7),
                                      ((verdict.crossing >> i) & 1) != 0};
        }
    }
    return found;
}

/// Appends the triangles of A in a bit set, each with triangle b of B.
inline std::size_t append(unsigned pair, std::size_t b, unsigned mask, std::uint16_t* candidate,
                          std::size_t count) noexcept {
    const unsigned base = pair << 6 | static_cast<unsigned>(b) << 3;
    for (; mask != 0; mask &= mask - 1) {
        candidate[count++] =
            static_cast<std::uint16_t>(base | static_cast<unsigned>(__builtin_ctz(mask)));
    }
    return count;
}

/// The body of find_contacts().
template <class F, class R, class W>
std::size_t find_contacts_of(const LeafPlacement& placement, const LeafPair* pairs,
                             std::size_t count, LeafScratch& scratch) noexcept {
    std::size_t candidates = 0;
    for (unsigned i = 0; i < count; ++i) {
        unsigned rows = place_leaves<F>(placement, pairs[i], 0, scratch.block[i]);
        while (rows != 0) {
            const RowPair at = take_rows<R>(rows);
            const unsigned found = row_candidates<R>(scratch.block[i], at);
            candidates =
                append(i, at.first, found & pairs[i].used_a, scratch.candidate, candidates);
            if (R::kRows == 2 && at.second != at.first) {
                candidates = append(i, at.second, (found >> kLanes) & pairs[i].used_a,
                                    scratch.candidate, candidates);
            }
        }
    }
    return judge_all<W>(candidates, scratch);
}

}  // namespace
}  // namespace cdprep::kernels
