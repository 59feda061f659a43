// SPDX-License-Identifier: MIT
#include "cells/cone_reach.h"

#include <algorithm>

// A point of the triangle is the sum of its corners with weights w >= 0. It is in the cone when
// sum(w_i f_k(i)) >= 0 for the three faces k. Weights need not add up to 1: those of a cone are as
// good times any factor. v, the sum of coordinates, is divided by the sum of the weights.
//
// Rounding: let e be the largest corner's slack (cone_faces.h: 8 u of its size). f and v are off by
// less than e. Three products and their sums add 3 u of at most 2 sizes. The division by weights,
// which add up to 1 but for a few u, adds 4 u of a size. Together these are less than 1.25 e, so
// the error is less than 2.25 e.

namespace cdprep {
namespace {

using Weights = std::array<double, 3>;

constexpr double kSlacks = 3;  ///< 2.25, plus the rounding of their product

double weighted(const Weights& w, const std::array<double, 3>& values) noexcept {
    return w[0] * values[0] + w[1] * values[1] + w[2] * values[2];
}

/// A part of a triangle. Each plane that cuts it adds a corner.
struct Part {
    std::array<Weights, 6> corner;
    std::size_t count = 0;

    void add(const Weights& w) noexcept {
        if (count < corner.size()) corner[count++] = w;
    }
};

/// Returns the part on the inner side of a face.
Part cut(const Part& part, const std::array<double, 3>& f) noexcept {
    Part result;
    for (std::size_t i = 0; i < part.count; ++i) {
        const Weights& from = part.corner[i];
        const Weights& to = part.corner[(i + 1) % part.count];
        const double f_from = weighted(from, f);
        const double f_to = weighted(to, f);
        if (f_from >= 0) result.add(from);
        if ((f_from >= 0) == (f_to >= 0)) continue;
        const double way = f_from / (f_from - f_to);
        Weights w{};
        for (std::size_t k = 0; k < 3; ++k) w[k] = (1 - way) * from[k] + way * to[k];
        result.add(w);
    }
    return result;
}

Weights middle_of(const Part& part) noexcept {
    Weights sum{};
    for (std::size_t i = 0; i < part.count; ++i) {
        for (std::size_t k = 0; k < 3; ++k) sum[k] += part.corner[i][k];
    }
    for (double& w : sum) w /= static_cast<double>(part.count);
    return sum;
}

/// Moves a corner by a millionth of the way to the middle: off the planes that meet there.
Weights moved_inwards(const Weights& w, const Weights& middle) noexcept {
    constexpr double kWay = 0x1p-20;
    Weights moved{};
    for (std::size_t k = 0; k < 3; ++k) moved[k] = (1 - kWay) * w[k] + kWay * middle[k];
    return moved;
}

}  // namespace

void add_reach(const ConeFaces& faces, const SeenTriangle& t, ConeReach& reach) noexcept {
    const FaceValues f = face_values(faces, t);
    const double slack = kSlacks * std::max({f.slack[0], f.slack[1], f.slack[2]});
    const std::array<double, 3> sum = {sum_in(faces.sign, t[0]), sum_in(faces.sign, t[1]),
                                       sum_in(faces.sign, t[2])};
    const auto add = [&](const Weights& w) {
        // Also false for NaN.
        const bool is_inside = weighted(w, f.at[0]) > slack && weighted(w, f.at[1]) > slack &&
                               weighted(w, f.at[2]) > slack;
        const double v = weighted(w, sum);
        if (is_inside) reach.add({v + slack, v - slack});
    };
    Part part;
    for (const Weights& corner : {Weights{1, 0, 0}, Weights{0, 1, 0}, Weights{0, 0, 1}}) {
        add(corner);
        part.add(corner);
    }
    for (const auto& at : f.at) part = cut(part, at);
    if (part.count == 0) return;
    const Weights middle = middle_of(part);
    for (std::size_t i = 0; i < part.count; ++i) add(moved_inwards(part.corner[i], middle));
}

}  // namespace cdprep
