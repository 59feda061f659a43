// SPDX-License-Identifier: MIT
#include "scene/part_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cdprep/advanced/convex_distance.h"
#include "cdprep/plan.h"

namespace cdprep {
namespace {

constexpr double kUnit = 0x1p-53;
/// A pose lengthens distances by less than this share: see Pose::kRotationTolerance.
constexpr double kStretch = 2 * Pose::kRotationTolerance;

double size_of(const Double3& p) noexcept {
    return std::abs(p.x) + std::abs(p.y) + std::abs(p.z);
}

/// Returns how much rounding may change the distance of parts, relative to that of solids. A pose
/// shifts a point by at most 5 u (|R||v| + |t|) along each axis (Placement). That is less than
/// 10 u (size + |t|) in all. Points of parts and of solids are shifted, of both models.
double rounding_of(const Pair& pair, const EnclosingParts& a, const EnclosingParts& b) noexcept {
    const Placement& placement = pair.placement;
    return 20 * kUnit *
           (a.size + size_of(placement.pose_a().translation()) + b.size +
            size_of(placement.pose_b().translation()));
}

/// Calls `visit(i, j)` with each pair of parts, as hull numbers. Ends if it returns false.
template <class Visit>
void each_pair(const EnclosingParts& a, const EnclosingParts& b, const Visit& visit) noexcept {
    for (std::uint32_t i = a.first; i < a.first + a.count; ++i) {
        for (std::uint32_t j = b.first; j < b.first + b.count; ++j) {
            if (!visit(i, j)) return;
        }
    }
}

double error_of(const Model& model, std::uint32_t hull) noexcept {
    return model.hulls().hulls[hull].distance;
}

}  // namespace

std::optional<Distance> distance_of_parts(const Pair& pair, const EnclosingParts& a,
                                          const EnclosingParts& b, double max_distance) noexcept {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const double rounding = rounding_of(pair, a, b);
    double nearest = kInfinity;  // of parts
    Distance found = {kInfinity, kInfinity, {}, {}, kNoTriangleNumber, kNoTriangleNumber};
    each_pair(a, b, [&](std::uint32_t i, std::uint32_t j) {
        const auto parts =
            convex_distance(convex_points(pair.a, i), convex_points(pair.b, j), pair.placement,
                            {.max_distance = std::min(max_distance + rounding, nearest)});
        if (!parts) return true;
        const double error = error_of(pair.a, i) + error_of(pair.b, j);
        found.lower = std::min(found.lower, std::max(0.0, parts->lower - rounding));
        found.upper = std::min(found.upper, parts->upper + error * (1 + kStretch) + rounding);
        if (parts->upper < nearest) {
            nearest = parts->upper;
            found.witness_a = parts->witness_a;
            found.witness_b = parts->witness_b;
        }
        return nearest > 0;
    });
    if (!(found.lower <= max_distance)) return std::nullopt;
    return found;
}

}  // namespace cdprep
