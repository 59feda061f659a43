// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/normalize.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cdprep::mesh {
namespace {

struct UsedBox {
    Double3 lower;
    Double3 upper;
};

UsedBox box_of_used(const TriangleSoup& soup) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    UsedBox box{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
    for (const Triangle& triangle : soup.triangles) {
        for (const std::uint32_t vertex : triangle.vertex) {
            const Double3& p = soup.positions[vertex];
            box.lower = {std::min(box.lower.x, p.x), std::min(box.lower.y, p.y),
                         std::min(box.lower.z, p.z)};
            box.upper = {std::max(box.upper.x, p.x), std::max(box.upper.y, p.y),
                         std::max(box.upper.z, p.z)};
        }
    }
    return box;
}

/// Returns the diagonal by the plain formula, since the shared poses were made with it. If its
/// squares leave the range of double, uses std::hypot().
double diagonal_of(const UsedBox& box) {
    const double x = box.upper.x - box.lower.x;
    const double y = box.upper.y - box.lower.y;
    const double z = box.upper.z - box.lower.z;
    const double square = x * x + y * y + z * z;
    return std::isnormal(square) ? std::sqrt(square) : std::hypot(x, y, z);
}

}  // namespace

Normalization normalize(TriangleSoup& soup) {
    soup.metres_per_unit = 0;
    if (soup.triangles.empty()) return {};
    const UsedBox box = box_of_used(soup);
    const double length = diagonal_of(box);
    const double diagonal = length > 0 && std::isfinite(1 / length) ? length : 1;
    const Double3 offset = {0.5 * (box.lower.x + box.upper.x), 0.5 * (box.lower.y + box.upper.y),
                            0.5 * (box.lower.z + box.upper.z)};
    const auto fitted = [diagonal](double value, double middle) {
        return static_cast<double>(static_cast<float>((value - middle) / diagonal));
    };
    for (Double3& p : soup.positions) {
        p = {fitted(p.x, offset.x), fitted(p.y, offset.y), fitted(p.z, offset.z)};
    }
    soup.single_precision = true;
    return {offset, 1 / diagonal};
}

}  // namespace cdprep::mesh
