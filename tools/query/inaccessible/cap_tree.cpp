// SPDX-License-Identifier: GPL-3.0-or-later
#include "query/inaccessible/cap_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "mesh/vectors.h"

namespace cdprep::mesh {
namespace {

/// A bound of the rounding errors of caps, absolute and relative. The errors are far smaller.
constexpr double kCapSlack = 0x1p-40;

/// Returns `v` scaled to unit length. Works at any scale, since no square overflows or underflows.
Double3 direction(const Double3& v) {
    const double size = mesh::safe_length(v);
    return {v.x / size, v.y / size, v.z / size};
}

/// Returns the distance of the triangle's plane, minus a bound of the rounding error. No point of
/// the triangle is nearer. The error of an edge's ends is 2^-52 of their distance. The error of a
/// thin triangle's normal grows with its thinness. Returns 0 if the error exceeds the distance.
double least_distance(const Double3& a, const Double3& b, const Double3& c, double farthest) {
    const Double3 ab = minus(b, a);
    const Double3 ac = minus(c, a);
    const Double3 normal = cross(direction(ab), direction(ac));
    const double error =
        (0x1p-48 + 0x1p-48 * farthest / std::min(mesh::safe_length(ab), mesh::safe_length(ac))) /
        std::min(1.0, mesh::safe_length(normal));
    const double height = std::fabs(dot(direction(normal), a)) - farthest * error;
    return height > 0 ? height * (1 - kCapSlack) : 0;  // also 0 for NaN
}

Cap cap_of(const Double3& a, const Double3& b, const Double3& c) {
    const std::array<Double3, 3> corners = {a, b, c};
    constexpr Cap kEverything = {{0, 0, 0}, -2, 0, 2, 0, std::numeric_limits<double>::infinity()};
    Double3 sum = {0, 0, 0};
    for (const Double3& p : corners) {
        const Double3 d = direction(p);
        sum = {sum.x + d.x, sum.y + d.y, sum.z + d.z};
    }
    Cap cap{direction(sum), 1, 0, 0, 0, 0};
    for (const Double3& p : corners) {
        cap.cosine = std::min(cap.cosine, dot(cap.middle, direction(p)));
        cap.farthest = std::max(cap.farthest, mesh::safe_length(p));
    }
    // The cap is nearly half of all directions or more, or a corner is the centre or too far away.
    if (!(cap.cosine > 0.1) || !std::isfinite(cap.farthest)) return kEverything;
    cap.sine = std::sqrt(1 - cap.cosine * cap.cosine);
    cap.radius = std::sqrt(2 * (1 - cap.cosine) + kCapSlack);
    cap.nearest = least_distance(a, b, c, cap.farthest);
    return cap;
}

/// Returns whether some point of `s` may lie beyond a point of `t` in the same direction.
bool may_hide(const Cap& s, const Cap& t) {
    if (s.farthest * (1 + kCapSlack) < t.nearest) return false;
    if (s.cosine < -1 || t.cosine < -1) return true;
    return dot(s.middle, t.middle) >= s.cosine * t.cosine - s.sine * t.sine - kCapSlack;
}

/// The radii in one class differ by a factor of at most 4; kCapSlack keeps them above 2^-20.
constexpr int kClasses = 12;

std::size_t class_of(const Cap& cap) {
    const int halvings = -std::ilogb(cap.radius);
    return static_cast<std::size_t>(std::clamp(halvings / 2, 0, kClasses - 1));
}

Box around(const Double3& p, double reach) {
    return {{p.x - reach, p.y - reach, p.z - reach}, {p.x + reach, p.y + reach, p.z + reach}};
}

constexpr std::size_t kTrianglesPerTask = 4096;

}  // namespace

CapTree::CapTree(const Double3& centre, std::span<const Double3> positions,
                 std::span<const Triangle> triangles, ParallelFor parallel_for)
    : caps_(triangles.size()), classes_(kClasses) {
    const auto bound = [&](std::size_t task) {
        const std::size_t first = task * kTrianglesPerTask;
        const std::size_t last = std::min(first + kTrianglesPerTask, triangles.size());
        for (std::size_t i = first; i < last; ++i) {
            const auto& v = triangles[i].vertex;
            caps_[i] = cap_of(minus(positions[v[0]], centre), minus(positions[v[1]], centre),
                              minus(positions[v[2]], centre));
        }
    };
    parallel_for((triangles.size() + kTrianglesPerTask - 1) / kTrianglesPerTask, bound);
    for (std::uint32_t i = 0; i < caps_.size(); ++i) {
        if (caps_[i].cosine < -1) {
            everywhere_.push_back(i);
            continue;
        }
        Class& its = classes_[class_of(caps_[i])];
        its.radius = std::max(its.radius, caps_[i].radius);
        its.triangles.push_back(i);
    }
    const auto build = [&](std::size_t number) {
        Class& its = classes_[number];
        std::vector<Double3> middles;
        for (const std::uint32_t i : its.triangles) middles.push_back(caps_[i].middle);
        its.middles = PointTree(std::move(middles));
    };
    parallel_for(classes_.size(), build);
}

void CapTree::find_others(std::uint32_t triangle, std::vector<std::uint32_t>& others) const {
    others.clear();
    const Cap& own = caps_[triangle];
    const auto look_at = [&](std::uint32_t other) {
        if (other != triangle && may_hide(caps_[other], own)) others.push_back(other);
    };
    std::for_each(everywhere_.begin(), everywhere_.end(), look_at);
    for (const Class& its : classes_) {
        // If two circles of directions meet, the distance of their middles is at most the sum of
        // both radii.
        const Box reach = around(own.middle, own.radius + its.radius);
        its.middles.visit([&](const Box& box) { return box.meets(reach); },
                          [&](std::uint32_t number) { look_at(its.triangles[number]); });
    }
}

}  // namespace cdprep::mesh
