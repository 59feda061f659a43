// SPDX-License-Identifier: MIT
#include "hull/difference_side.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "exact/expansion.h"
#include "exact/predicates.h"
#include "exact/wide_vector.h"

namespace cdprep {
namespace {

/// (p - d) of points of A minus that of points of B, and the sum of the sizes of both.
struct Step {
    Double3 at;
    Double3 size;
};

Step step_between(const Difference& p, const Difference& d) {
    const Double3 of_a = p.at_a - d.at_a;
    const Double3 of_b = p.at_b - d.at_b;
    return {of_a - of_b,
            {std::fabs(of_a.x) + std::fabs(of_b.x), std::fabs(of_a.y) + std::fabs(of_b.y),
             std::fabs(of_a.z) + std::fabs(of_b.z)}};
}

bool is_exact(const Difference& p) {
    return two_sum(p.at_a.x, -p.at_b.x).tail == 0 && two_sum(p.at_a.y, -p.at_b.y).tail == 0 &&
           two_sum(p.at_a.z, -p.at_b.z).tail == 0;
}

int side_in_integers(const Difference& p, const Difference& q, const Difference& r,
                     const Difference& d) {
    const std::array<Double3, 8> ends = {p.at_a, p.at_b, q.at_a, q.at_b,
                                         r.at_a, r.at_b, d.at_a, d.at_b};
    const int lowest = lowest_bit_of(ends);
    const auto place = [&](const Difference& of) {
        return wide_place(of.at_a, lowest) - wide_place(of.at_b, lowest);
    };
    const WidePlace from = place(d);
    return dot(cross(place(p) - from, place(q) - from), place(r) - from).sign();
}

}  // namespace

// The filter: let m be the largest size per axis. Each of the nine coordinates is off by at most
// 2 u m. So each of the six products of three is off by 6 u and three roundings. Their sum adds 5 u
// of at most 6 m_x m_y m_z. In all that is less than 100 u of m_x m_y m_z.
int side_of(const Difference& p, const Difference& q, const Difference& r,
            const Difference& d) noexcept {
    const Step a = step_between(p, d), b = step_between(q, d), c = step_between(r, d);
    const double determinant = dot(cross(a.at, b.at), c.at);
    const double mx = std::max({a.size.x, b.size.x, c.size.x});
    const double my = std::max({a.size.y, b.size.y, c.size.y});
    const double mz = std::max({a.size.z, b.size.z, c.size.z});
    const double most = std::max({mx, my, mz}), least = std::min({mx, my, mz});
    if (least >= kLeastForFilter3d && most < kLargestForFilter3d) {
        constexpr double kFilter = 100 * 0x1p-53;  // derived above
        const double bound = kFilter * mx * my * mz;
        if (determinant > bound) return 1;
        if (determinant < -bound) return -1;
    }
    if (is_exact(p) && is_exact(q) && is_exact(r) && is_exact(d)) {
        return orient3d(p.at, q.at, r.at, d.at);
    }
    return side_in_integers(p, q, r, d);
}

}  // namespace cdprep
