// SPDX-License-Identifier: MIT
#include "support/exact_cone.h"

namespace cdprep::test {
namespace {

/// A plane's normal, whole numbers, inwards.
std::array<double, 3> inward_normal(const TetraCone& cone, std::size_t across) {
    const Generator& b = cone.generator[(across + 1) % 3];
    const Generator& c = cone.generator[(across + 2) % 3];
    const Generator& a = cone.generator[across];
    std::array<double, 3> n{};
    double side = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        const std::size_t k = (i + 2) % 3;
        n[i] = double(b[j]) * c[k] - double(b[k]) * c[j];
        side += n[i] * a[i];
    }
    if (side < 0) {
        for (double& x : n) x = -x;
    }
    return n;
}

ExactRational height(const ExactPoint& p, const std::array<double, 3>& n) {
    return p[0] * ExactRational(n[0]) + p[1] * ExactRational(n[1]) + p[2] * ExactRational(n[2]);
}

/// Sutherland and Hodgman 1974.
std::vector<ExactPoint> cut(const std::vector<ExactPoint>& polygon,
                            const std::array<double, 3>& n) {
    std::vector<ExactPoint> left;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const ExactPoint& from = polygon[i];
        const ExactPoint& to = polygon[(i + 1) % polygon.size()];
        const ExactRational at_from = height(from, n);
        const ExactRational at_to = height(to, n);
        if (at_from.sign() >= 0) left.push_back(from);
        if (at_from.sign() * at_to.sign() >= 0) continue;
        const ExactRational s = at_from / (at_from - at_to);
        ExactPoint between;
        for (std::size_t k = 0; k < 3; ++k) between[k] = from[k] + s * (to[k] - from[k]);
        left.push_back(between);
    }
    return left;
}

}  // namespace

std::vector<ExactPoint> cut_by_cone(const Corners& t, const Double3& centre,
                                    const TetraCone& cone) {
    std::vector<ExactPoint> polygon;
    for (const Double3& p : t) {
        polygon.push_back({ExactRational(p.x) - ExactRational(centre.x),
                           ExactRational(p.y) - ExactRational(centre.y),
                           ExactRational(p.z) - ExactRational(centre.z)});
    }
    for (std::size_t k = 0; k < 3; ++k) polygon = cut(polygon, inward_normal(cone, k));
    return polygon;
}

}  // namespace cdprep::test
