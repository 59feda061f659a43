// SPDX-License-Identifier: MIT
#include "support/exact_pairs.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "support/brute_force.h"
#include "support/exact_contact.h"
#include "support/exact_hull_pair.h"
#include "support/exact_rational.h"

namespace cdprep::test {
namespace {

/// Coordinates as multiples of a power of two, where few bits hold them all.
class Grid {
public:
    void take(const Corners& corners) {
        for (const Double3& p : corners) {
            for (const double x : {p.x, p.y, p.z}) take(x);
        }
    }
    /// Products of three differences then fit in 128 bits.
    [[nodiscard]] bool is_small() const {
        constexpr int kMostBits = 38;
        return highest_ - lowest_ <= kMostBits;
    }
    [[nodiscard]] ExactTriangle<Integer128> integers(const Corners& corners) const {
        ExactTriangle<Integer128> result;
        for (std::size_t i = 0; i < 3; ++i) {
            const Double3& p = corners[i];
            result[i] = {integer(p.x), integer(p.y), integer(p.z)};
        }
        return result;
    }

private:
    void take(double x) {
        if (x == 0) return;
        constexpr int kDigits = std::numeric_limits<double>::digits;
        int exponent = 0;
        const double fraction = std::frexp(std::fabs(x), &exponent);
        const auto bits = static_cast<std::uint64_t>(std::ldexp(fraction, kDigits));
        highest_ = std::max(highest_, exponent);
        lowest_ = std::min(lowest_, exponent - kDigits + std::countr_zero(bits));
    }
    [[nodiscard]] Integer128 integer(double x) const {
        return static_cast<Integer128>(std::ldexp(x, -lowest_));
    }

    int highest_ = -10'000;
    int lowest_ = 10'000;
};

/// Whether the plane of `a` has all of `b` on one side, with far more to spare than long
/// double rounds.
bool plane_is_clear(const Corners& a, const Corners& b) {
    using Wide = long double;
    const std::array<Wide, 3> u = {Wide(a[1].x) - a[0].x, Wide(a[1].y) - a[0].y,
                                   Wide(a[1].z) - a[0].z};
    const std::array<Wide, 3> v = {Wide(a[2].x) - a[0].x, Wide(a[2].y) - a[0].y,
                                   Wide(a[2].z) - a[0].z};
    int above = 0, below = 0;
    for (const Double3& p : b) {
        const std::array<Wide, 3> w = {Wide(p.x) - a[0].x, Wide(p.y) - a[0].y, Wide(p.z) - a[0].z};
        Wide height = 0, size = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
            height += w[i] * (u[j] * v[k] - u[k] * v[j]);
            size += std::fabs(w[i]) * (std::fabs(u[j] * v[k]) + std::fabs(u[k] * v[j]));
        }
        above += height > 0x1p-50L * size ? 1 : 0;
        below += height < -0x1p-50L * size ? 1 : 0;
    }
    return above == 3 || below == 3;
}

}  // namespace

TriangleContact exact_contact(const Corners& a, const Corners& b) {
    if (plane_is_clear(a, b) || plane_is_clear(b, a)) return TriangleContact::disjoint;
    Grid grid;
    grid.take(a);
    grid.take(b);
    if (grid.is_small()) return contact_by_definition(grid.integers(a), grid.integers(b));
    return contact_by_definition(exact<ExactNumber>(a), exact<ExactNumber>(b));
}

ExactPairs exact_pairs(const TestMesh& a, const TestMesh& b, const Placement& placement) {
    ExactPairs pairs;
    std::vector<bool> is_proper;
    pairs.closed = boxed_pairs(a, b, placement, [&](const Corners& s, const Corners& t) {
        const TriangleContact kind = exact_contact(s, t);
        if (kind == TriangleContact::disjoint) return false;
        is_proper.push_back(kind != TriangleContact::touch);
        return true;
    });
    for (std::size_t i = 0; i < is_proper.size(); ++i) {
        if (is_proper[i]) pairs.proper.push_back(pairs.closed[i]);
    }
    return pairs;
}

}  // namespace cdprep::test
