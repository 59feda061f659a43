// SPDX-License-Identifier: MIT
#include "cells/build/cone_maximum.h"

#include <algorithm>
#include <limits>

// The part of a triangle in a cone has the weights w >= 0 with sum 1. For the three faces k,
// sum(w_i f_k(i)) >= 0. A linear function v with values v_i at the corners is to be bounded there.
// For any y >= 0
//
//     v = sum(w_i v_i) <= sum(w_i (v_i + sum(y_k f_k(i)))) <= max_i (v_i + sum(y_k f_k(i))).
//
// So every y proves a bound, however y was found and rounded: only the right side must be rounded
// up. The best y makes the bound the maximum (duality of linear programs). It is one of few
// candidates. It is 0 when a corner is the maximum. One part is positive, and makes two corners
// equal, when the maximum is where an edge leaves through a face. Two parts are positive, and make
// all three corners equal, when the maximum is on a generator. All are tried, except for faces that
// no edge crosses: these cut nothing off.
//
// Rounding: let e be the corner's slack (cone_faces.h: 8 u of its size). v and f are off by less
// than e each. The products and sums add 3 u (|v| + sum(y |f|)). Both v and f are at most twice the
// size. So this is less than 6 u of it (1 + sum(y)). In all the error is less than
// 1.75 e (1 + sum(y)).

namespace cdprep::build {
namespace {

class UpperBound {
public:
    UpperBound(const FaceValues& f, const std::array<double, 3>& v) noexcept
        : f_(f), v_(v), best_(of({0, 0, 0})) {
        std::array<bool, 3> crossed{};
        for (std::size_t k = 0; k < 3; ++k) crossed[k] = try_face(k);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t m = (k + 1) % 3;
            if (crossed[k] && crossed[m]) try_generator(k, m);
        }
    }
    [[nodiscard]] double best() const noexcept {
        return best_;
    }

private:
    [[nodiscard]] double of(const std::array<double, 3>& y) const noexcept {
        double most = -std::numeric_limits<double>::infinity();
        const double share = kValueSlacks * (1 + y[0] + y[1] + y[2]);
        for (std::size_t i = 0; i < 3; ++i) {
            const double at =
                v_[i] + (y[0] * f_.at[0][i] + y[1] * f_.at[1][i] + y[2] * f_.at[2][i]);
            most = std::max(most, at + share * f_.slack[i]);
        }
        return most;
    }
    void take(const std::array<double, 3>& y) noexcept {
        constexpr double kMost = 0x1p60;  // beyond this, only slack is left
        for (const double part : y) {
            if (!(part >= 0 && part < kMost)) return;
        }
        best_ = std::min(best_, of(y));
    }
    /// Tries the points where edges cross face k. Returns whether any edge does.
    bool try_face(std::size_t k) noexcept {
        bool crossed = false;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3;
            const double fi = f_.at[k][i], fj = f_.at[k][j];
            if ((fi >= 0) == (fj >= 0)) continue;
            crossed = true;
            std::array<double, 3> y{};
            y[k] = (v_[i] - v_[j]) / (fj - fi);
            take(y);
        }
        return crossed;
    }
    /// Tries the point where the line f_k = f_m = 0 pierces the triangle.
    void try_generator(std::size_t k, std::size_t m) noexcept {
        const auto& fk = f_.at[k];
        const auto& fm = f_.at[m];
        const double k1 = fk[0] - fk[1], k2 = fk[0] - fk[2];
        const double m1 = fm[0] - fm[1], m2 = fm[0] - fm[2];
        const double v1 = v_[1] - v_[0], v2 = v_[2] - v_[0];
        const double determinant = k1 * m2 - k2 * m1;
        std::array<double, 3> y{};
        y[k] = (v1 * m2 - v2 * m1) / determinant;
        y[m] = (k1 * v2 - k2 * v1) / determinant;
        take(y);
    }

    const FaceValues& f_;
    std::array<double, 3> v_;
    double best_;
};

}  // namespace

double cone_maximum(const FaceValues& f, const std::array<double, 3>& v) noexcept {
    return UpperBound(f, v).best();
}

}  // namespace cdprep::build
