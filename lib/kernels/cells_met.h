// SPDX-License-Identifier: MIT
// Eight boxes against the eight cells around a point. Included by kernel sources alone, after they
// have defined the lanes: a type F of eight floats with its mask type. Lanes are boxes.
#pragma once

#include <cassert>

#include "box_overlap.h"

namespace cdprep::kernels {
namespace {

/// Computes the axes and centres of B's boxes along A's axes: those of the oriented boxes or,
/// without them, of the axis-aligned ones.
template <class F>
void turn_axes(const BoxPlacement& p, const NodeBoxes& b, const Boxes<F>& aligned,
               OrientedBoxes<F>& turned) noexcept {
    if (b.oriented == nullptr) {
        for (std::size_t i = 0; i < 3; ++i) {
            const float* r = p.rotation + 3 * i;
            for (std::size_t k = 0; k < 3; ++k) turned.axis[k][i] = F(r[k]);
            turned.centre[i] = combined(r[0], r[1], r[2], aligned.centre) + F(p.shift[i]);
            turned.half[i] = aligned.half[i];
        }
        return;
    }
    OrientedBoxes<F> boxes;
    load_oriented(b.oriented, p.scale_b, boxes);
    for (std::size_t i = 0; i < 3; ++i) {
        const float* r = p.rotation + 3 * i;
        for (std::size_t k = 0; k < 3; ++k) {
            turned.axis[k][i] = combined(r[0], r[1], r[2], boxes.axis[k]);
        }
        turned.centre[i] = combined(r[0], r[1], r[2], boxes.centre) + F(p.shift[i]);
        turned.half[i] = boxes.half[i];
    }
}

/// The body of place_among_cells().
template <class F>
void place_among_cells_of(const BoxPlacement& p, const NodeBoxes& b,
                          BoxesAmongCells& placed) noexcept {
    const Boxes<F> aligned = scaled_boxes<F>(b.boxes, p.scale_b);
    const Boxes<F> along_a = turned_to_a(aligned, p);
    OrientedBoxes<F> turned;
    turn_axes(p, b, aligned, turned);
    const F slack(p.slack);
    for (std::size_t i = 0; i < 3; ++i) {
        const F reach = fma(abs(turned.axis[2][i]), turned.half[2],
                            fma(abs(turned.axis[1][i]), turned.half[1],
                                fma(abs(turned.axis[0][i]), turned.half[0], slack)));
        max(along_a.centre[i] - along_a.half[i], turned.centre[i] - reach).store(placed.lower[i]);
        min(along_a.centre[i] + along_a.half[i], turned.centre[i] + reach).store(placed.upper[i]);
    }
    for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t i = 0; i < 3; ++i) turned.axis[k][i].store(placed.axis[k][i]);
        dot(turned.axis[k], turned.centre).store(placed.middle[k]);
        (turned.half[k] + slack).store(placed.half[k]);
    }
}

/// The body of cells_met().
template <class F>
void cells_met_of(const BoxesAmongCells& b, const OctantPlanes& cells, unsigned of_b,
                  std::uint8_t* met) noexcept {
    assert(of_b >> kLanes == 0 && !(cells.half < 0));
    unsigned halves[3][2];
    for (std::size_t i = 0; i < 3; ++i) {
        // Rising, unless a damaged grid is out of the range of float.
        assert(!(cells.plane[i][0] > cells.plane[i][1] || cells.plane[i][1] > cells.plane[i][2]));
        const F lower = F::load(b.lower[i]);
        const F upper = F::load(b.upper[i]);
        const F middle(cells.plane[i][1]);
        halves[i][0] = ~bits(greater(lower, middle) | greater(F(cells.plane[i][0]), upper));
        halves[i][1] = ~bits(greater(middle, upper) | greater(lower, F(cells.plane[i][2])));
    }
    F at[3];
    F step[3][3];
    F reach[3];
    for (std::size_t k = 0; k < 3; ++k) {
        at[k] = -F::load(b.middle[k]);
        reach[k] = F::load(b.half[k]);
        for (std::size_t i = 0; i < 3; ++i) {
            const F axis = F::load(b.axis[k][i]);
            at[k] = fma(axis, F(cells.plane[i][1]), at[k]);
            step[k][i] = axis * F(cells.half);
            reach[k] = reach[k] + abs(step[k][i]);
        }
    }
    for (unsigned cell = 0; cell < kLanes; ++cell) {
        const unsigned among =
            of_b & halves[0][cell & 1] & halves[1][cell >> 1 & 1] & halves[2][cell >> 2];
        met[cell] = static_cast<std::uint8_t>(among);
        if (among == 0) continue;
        typename F::Mask apart = F::none();
        for (std::size_t k = 0; k < 3; ++k) {
            F from = at[k];
            for (std::size_t i = 0; i < 3; ++i) {
                from = (cell >> i & 1) != 0 ? from + step[k][i] : from - step[k][i];
            }
            apart = apart | greater(abs(from), reach[k]);
        }
        met[cell] = static_cast<std::uint8_t>(among & ~bits(apart));
    }
}

}  // namespace
}  // namespace cdprep::kernels
