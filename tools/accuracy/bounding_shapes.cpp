// SPDX-License-Identifier: GPL-3.0-or-later
#include "accuracy/bounding_shapes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include "mesh/find_bounds.h"
#include "mesh/vectors.h"

namespace cdprep::study {
namespace {

constexpr int kSphereSteps = 100;

using mesh::cross;
using mesh::dot;
using mesh::minus;

Double3 turned(const Pose& pose, const Double3& v) {
    const auto& r = pose.rotation();
    return {r[0] * v.x + r[1] * v.y + r[2] * v.z, r[3] * v.x + r[4] * v.y + r[5] * v.z,
            r[6] * v.x + r[7] * v.y + r[8] * v.z};
}

/// Returns the length by which a query about these shapes enlarges lengths.
double slack_of(const Double3& centre_a, double size_a, const Double3& centre_b, double size_b,
                const Pose& pose) {
    return kSlack * (mesh::safe_length(centre_a) + size_a + mesh::safe_length(centre_b) + size_b +
                     mesh::safe_length(pose.translation()));
}

constexpr std::array<Double3, BoundingDop::kDirections> kDopDirections = {{{1, 0, 0},
                                                                           {0, 1, 0},
                                                                           {0, 0, 1},
                                                                           {1, 1, 1},
                                                                           {1, 1, -1},
                                                                           {1, -1, 1},
                                                                           {-1, 1, 1},
                                                                           {1, 1, 0},
                                                                           {1, -1, 0},
                                                                           {1, 0, 1},
                                                                           {1, 0, -1},
                                                                           {0, 1, 1},
                                                                           {0, 1, -1}}};

/// A bound of the rounding errors of planes and of the points where three of them meet, relative to
/// the polytope's size.
constexpr double kDopRounding = 1e-12;

struct Plane {
    Double3 normal;
    double at;
};

/// Returns the point where three planes meet, by Cramer's rule, or nothing if there is not exactly
/// one.
std::optional<Double3> meeting_of(const Plane& p, const Plane& q, const Plane& r) {
    const Double3 qr = cross(q.normal, r.normal);
    const double volume = dot(p.normal, qr);  // exact, since normals are small whole numbers
    if (volume == 0) return std::nullopt;
    const Double3 rp = cross(r.normal, p.normal);
    const Double3 pq = cross(p.normal, q.normal);
    const auto along = [&](double of_qr, double of_rp, double of_pq) {
        return (p.at * of_qr + q.at * of_rp + r.at * of_pq) / volume;
    };
    return Double3{along(qr.x, rp.x, pq.x), along(qr.y, rp.y, pq.y), along(qr.z, rp.z, pq.z)};
}

bool is_within(const BoundingDop& dop, const Double3& p, double slack) {
    for (std::size_t i = 0; i < BoundingDop::kDirections; ++i) {
        const double at = dot(kDopDirections[i], p);
        if (at < dop.lower[i] - slack || at > dop.upper[i] + slack) return false;
    }
    return true;
}

/// Returns the points where three planes meet and that no plane cuts off.
std::vector<Double3> dop_corners(const BoundingDop& dop, double slack) {
    std::vector<Plane> planes;
    for (std::size_t i = 0; i < BoundingDop::kDirections; ++i) {
        planes.push_back({kDopDirections[i], dop.lower[i]});
        planes.push_back({kDopDirections[i], dop.upper[i]});
    }
    std::vector<Double3> corners;
    const auto is_known = [&](const Double3& p) {
        return std::ranges::any_of(corners, [&](const Double3& known) {
            return mesh::safe_length(minus(known, p)) <= slack;
        });
    };
    for (std::size_t i = 0; i < planes.size(); ++i) {
        for (std::size_t j = i + 1; j < planes.size(); ++j) {
            for (std::size_t k = j + 1; k < planes.size(); ++k) {
                const auto p = meeting_of(planes[i], planes[j], planes[k]);
                if (p && is_within(dop, *p, slack) && !is_known(*p)) corners.push_back(*p);
            }
        }
    }
    return corners;
}

/// Returns a length of at least the diagonal.
double size_of(const BoundingDop& dop) {
    return dop.upper[0] - dop.lower[0] + dop.upper[1] - dop.lower[1] + dop.upper[2] - dop.lower[2];
}

/// The interval of points along an axis.
struct Shadow {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();
};

Shadow shadow_of(const std::vector<Double3>& points, const Double3& along) {
    Shadow shadow;
    for (const Double3& p : points) {
        const double at = dot(p, along);
        shadow.low = std::min(shadow.low, at);
        shadow.high = std::max(shadow.high, at);
    }
    return shadow;
}

/// Returns the extent of the box from its centre along an axis.
double reach(const std::array<Double3, 3>& axes, const Double3& half, const Double3& along) {
    return half.x * std::fabs(dot(axes[0], along)) + half.y * std::fabs(dot(axes[1], along)) +
           half.z * std::fabs(dot(axes[2], along));
}

}  // namespace

BoundingSphere bounding_sphere(const mesh::Mesh& mesh) {
    BoundingSphere sphere;
    if (mesh.positions.empty()) return sphere;
    const BoundingBox box = aligned_box(mesh);
    sphere.centre = box.centre;
    // Squares of very large or small distances leave the range of double. A power of two changes no
    // order.
    constexpr int kMostExponent = 1000;
    const int exponent = std::ilogb(mesh::largest_of(box.half));
    const double unit = std::ldexp(1.0, -std::clamp(exponent, -kMostExponent, kMostExponent));
    const auto farthest = [&] {
        return *std::ranges::max_element(mesh.positions, {}, [&](const Double3& p) {
            const Double3 d = mesh::scaled(minus(p, sphere.centre), unit);
            return dot(d, d);
        });
    };
    // The steps towards the farthest point shrink, so the centre converges to that of the smallest
    // sphere.
    BoundingSphere best{sphere.centre, std::numeric_limits<double>::infinity()};
    for (int step = 1; step <= kSphereSteps; ++step) {
        const Double3 d = minus(farthest(), sphere.centre);
        if (mesh::safe_length(d) < best.radius) best = {sphere.centre, mesh::safe_length(d)};
        const double share = 1.0 / (step + 1);
        sphere.centre = {sphere.centre.x + share * d.x, sphere.centre.y + share * d.y,
                         sphere.centre.z + share * d.z};
    }
    best.radius *= 1 + 1e-14;
    return best;
}

BoundingBox aligned_box(const mesh::Mesh& mesh) {
    BoundingBox box;
    if (mesh.positions.empty()) return box;
    const format::Bounds bounds = convex::find_bounds(mesh);
    const auto middle = [](double low, double high) { return low + 0.5 * (high - low); };
    box.centre = {middle(bounds.lower.x, bounds.upper.x), middle(bounds.lower.y, bounds.upper.y),
                  middle(bounds.lower.z, bounds.upper.z)};
    const Double3 up = minus(bounds.upper, box.centre);
    const Double3 down = minus(box.centre, bounds.lower);
    box.half = {std::max(up.x, down.x), std::max(up.y, down.y), std::max(up.z, down.z)};
    return box;
}

BoundingBox oriented_box(const mesh::Mesh& mesh) {
    const format::Bounds bounds = convex::find_bounds(mesh);
    return {bounds.oriented_centre, bounds.axis, bounds.half_extent};
}

BoundingDop bounding_dop(const mesh::Mesh& mesh) {
    BoundingDop dop;
    if (mesh.positions.empty()) return dop;
    const BoundingBox box = aligned_box(mesh);
    dop.centre = box.centre;
    dop.lower.fill(std::numeric_limits<double>::infinity());
    dop.upper.fill(-std::numeric_limits<double>::infinity());
    for (const Double3& p : mesh.positions) {
        const Double3 d = minus(p, dop.centre);
        for (std::size_t i = 0; i < BoundingDop::kDirections; ++i) {
            const double at = dot(kDopDirections[i], d);
            dop.lower[i] = std::min(dop.lower[i], at);
            dop.upper[i] = std::max(dop.upper[i], at);
        }
    }
    dop.corners = dop_corners(dop, kDopRounding * mesh::safe_length(box.half));
    return dop;
}

bool may_touch(const BoundingSphere& a, const BoundingSphere& b, const Pose& a_from_b) noexcept {
    const double slack = slack_of(a.centre, a.radius, b.centre, b.radius, a_from_b);
    const Double3 d = minus(transform_point(a_from_b, b.centre), a.centre);
    const double reaches = a.radius + b.radius + slack;
    return dot(d, d) <= reaches * reaches;
}

bool may_touch_aligned(const BoundingBox& a, const BoundingBox& b, const Pose& a_from_b) noexcept {
    const double slack = slack_of(a.centre, mesh::safe_length(a.half), b.centre,
                                  mesh::safe_length(b.half), a_from_b);
    const Double3 d = minus(transform_point(a_from_b, b.centre), a.centre);
    const auto& r = a_from_b.rotation();
    const auto row = [&](std::size_t i) {
        return std::fabs(r[i]) * b.half.x + std::fabs(r[i + 1]) * b.half.y +
               std::fabs(r[i + 2]) * b.half.z + slack;
    };
    return std::fabs(d.x) <= a.half.x + row(0) && std::fabs(d.y) <= a.half.y + row(3) &&
           std::fabs(d.z) <= a.half.z + row(6);
}

bool may_touch(const BoundingBox& a, const BoundingBox& b, const Pose& a_from_b) noexcept {
    const double slack = slack_of(a.centre, mesh::safe_length(a.half), b.centre,
                                  mesh::safe_length(b.half), a_from_b);
    const Double3 d = minus(transform_point(a_from_b, b.centre), a.centre);
    const std::array<Double3, 3> axes = {turned(a_from_b, b.axis[0]), turned(a_from_b, b.axis[1]),
                                         turned(a_from_b, b.axis[2])};
    // An axis of length at most 1 separates the boxes if their projections on it are disjoint.
    const auto parts = [&](const Double3& along) {
        return std::fabs(dot(d, along)) >
               reach(a.axis, a.half, along) + reach(axes, b.half, along) + slack;
    };
    for (const Double3& along : a.axis) {
        if (parts(along)) return false;
    }
    for (const Double3& along : axes) {
        if (parts(along)) return false;
    }
    for (const Double3& of_a : a.axis) {
        for (const Double3& of_b : axes) {
            if (parts(cross(of_a, of_b))) return false;
        }
    }
    return true;
}

bool may_touch(const BoundingDop& a, const BoundingDop& b, const Pose& a_from_b) noexcept {
    if (a.corners.empty() || b.corners.empty()) return false;
    // The directions have lengths up to 2.
    const double slack = 2 * slack_of(a.centre, size_of(a), b.centre, size_of(b), a_from_b);
    const Double3 d = minus(transform_point(a_from_b, b.centre), a.centre);
    const auto& r = a_from_b.rotation();
    for (std::size_t i = 0; i < BoundingDop::kDirections; ++i) {
        const Double3& along = kDopDirections[i];
        const Double3 in_b = {r[0] * along.x + r[3] * along.y + r[6] * along.z,
                              r[1] * along.x + r[4] * along.y + r[7] * along.z,
                              r[2] * along.x + r[5] * along.y + r[8] * along.z};
        const Shadow of_b = shadow_of(b.corners, in_b);
        const double at = dot(d, along);
        if (at + of_b.low > a.upper[i] + slack || at + of_b.high < a.lower[i] - slack) return false;
    }
    for (std::size_t i = 0; i < BoundingDop::kDirections; ++i) {
        const Double3 along = turned(a_from_b, kDopDirections[i]);
        const Shadow of_a = shadow_of(a.corners, along);
        const double at = dot(d, along);
        if (at + b.lower[i] > of_a.high + slack || at + b.upper[i] < of_a.low - slack) return false;
    }
    return true;
}

}  // namespace cdprep::study
