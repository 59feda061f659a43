// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "support/brute_force.h"
#include "support/exact_distance.h"

namespace cdprep::test {

/// Returns a lower bound of the square of the distance between two boxes, rounding included.
inline long double below_squared_gap(const Box3& a, const Box3& b) {
    const auto gap = [](double low, double high, double other_low, double other_high) {
        return std::max({0.0L, static_cast<long double>(low) - other_high,
                         static_cast<long double>(other_low) - high});
    };
    const long double x = gap(a.lower.x, a.upper.x, b.lower.x, b.upper.x);
    const long double y = gap(a.lower.y, a.upper.y, b.lower.y, b.upper.y);
    const long double z = gap(a.lower.z, a.upper.z, b.lower.z, b.upper.z);
    return (x * x + y * y + z * z) * (1 - 1e-9L);
}

/// Returns the square of the distance between two small meshes in rational numbers. Tests all
/// pairs except those whose boxes are farther apart than earlier triangles.
inline ExactRational brute_force_distance(const TestMesh& a, const TestMesh& b,
                                          const Placement& placement) {
    const Pose* pose_a = placement.a_is_moved() ? &placement.pose_a() : nullptr;
    const Pose* pose_b = placement.b_is_moved() ? &placement.pose_b() : nullptr;
    struct Pair {
        long double squared_gap;
        Corners a;
        Corners b;
    };
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < a.triangles.size(); ++i) {
        for (std::size_t j = 0; j < b.triangles.size(); ++j) {
            const Corners s = corners_of(a, i, pose_a), t = corners_of(b, j, pose_b);
            pairs.push_back({below_squared_gap(box_of(s), box_of(t)), s, t});
        }
    }
    std::sort(pairs.begin(), pairs.end(),
              [](const Pair& x, const Pair& y) { return x.squared_gap < y.squared_gap; });
    std::optional<ExactRational> best;
    for (const Pair& pair : pairs) {
        if (best && (best->sign() == 0 || pair.squared_gap > best->approximation())) break;
        const ExactRational d = exact_squared_distance(pair.a, pair.b);
        if (!best || d < *best) best = d;
    }
    return *best;
}

}  // namespace cdprep::test
