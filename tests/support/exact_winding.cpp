// SPDX-License-Identifier: MIT
#include "support/exact_winding.h"

#include <algorithm>
#include <random>
#include <vector>

#include "support/exact_contact.h"
#include "support/exact_rational.h"

namespace cdprep::test {
namespace {

using Vector = ExactPoint<ExactNumber>;

int volume_sign(const Vector& a, const Vector& b, const Vector& c) {
    return dot(a, cross(b, c)).sign();
}

/// What the ray along `direction` adds, or nothing when it meets an edge. The
/// corners are relative to the ray's origin.
std::optional<int> crossing(const ExactTriangle<ExactNumber>& t, const Vector& direction) {
    std::array<int, 3> turn{};
    for (std::size_t i = 0; i < 3; ++i) turn[i] = volume_sign(direction, t[i], t[(i + 1) % 3]);
    const auto [least, most] = std::minmax_element(turn.begin(), turn.end());
    if (*least < 0 && *most > 0) return 0;
    if (*least == 0 || *most == 0) {
        if (!has_area(t)) return 0;
        return std::nullopt;
    }
    const int side = volume_sign(t[0], t[1], t[2]);
    return side == *least ? side : 0;
}

std::optional<int> sum_of_crossings(const std::vector<ExactTriangle<ExactNumber>>& surface,
                                    const Vector& direction) {
    int sum = 0;
    for (const auto& t : surface) {
        const std::optional<int> found = crossing(t, direction);
        if (!found) return std::nullopt;
        sum += *found;
    }
    return sum;
}

}  // namespace

std::optional<int> exact_winding(std::span<const Corners> surface, const Double3& q) {
    const Vector origin = {q.x, q.y, q.z};
    const ExactTriangle<ExactNumber> point = {origin, origin, origin};
    std::vector<ExactTriangle<ExactNumber>> around;
    for (const Corners& corners : surface) {
        const auto t = exact<ExactNumber>(corners);
        if (volume_sign(minus(t[0], origin), minus(t[1], origin), minus(t[2], origin)) == 0 &&
            contact_by_definition(point, t) != TriangleContact::disjoint) {
            return std::nullopt;
        }
        around.push_back({minus(t[0], origin), minus(t[1], origin), minus(t[2], origin)});
    }
    std::mt19937 random(1);
    std::uniform_int_distribution<int> component(-1'000'000, 1'000'000);
    for (;;) {
        const double x = component(random), y = component(random), z = component(random);
        if (const auto sum = sum_of_crossings(around, {x, y, z})) return sum;
    }
}

}  // namespace cdprep::test
