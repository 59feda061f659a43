// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "support/random_pose.h"

#include "cdprep/advanced/convex_distance.h"

namespace cdprep::test {

using Points = std::vector<Double3>;

/// Returns a random rotation that maps integers to integers.
inline std::array<double, 9> quarter_turns(std::mt19937& random) {
    std::array<std::size_t, 3> axis = {0, 1, 2};
    std::shuffle(axis.begin(), axis.end(), random);
    std::array<double, 3> sign{};
    for (double& s : sign) s = (random() & 1) != 0 ? 1 : -1;
    std::array<double, 9> r{};
    for (std::size_t i = 0; i < 3; ++i) r[3 * i + axis[i]] = sign[i];
    const double determinant = r[0] * (r[4] * r[8] - r[5] * r[7]) -
                               r[1] * (r[3] * r[8] - r[5] * r[6]) +
                               r[2] * (r[3] * r[7] - r[4] * r[6]);
    if (determinant < 0) {
        for (std::size_t i = 0; i < 3; ++i) r[i] = -r[i];
    }
    return r;
}

inline Pose pose_of(const std::array<double, 9>& r, const Double3& t) {
    return Pose::from_rows({r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8], t.x, t.y, t.z})
        .value();
}

/// Returns 1 to 6 points of a grid, most often 5 or 6. About every fifth set lies in a plane.
inline Points grid_points(std::mt19937& random) {
    std::uniform_int_distribution<int> coordinate(-4, 4), number(1, 16);
    Points points(static_cast<std::size_t>(std::min(number(random), 6)));
    const bool flat = random() % 5 == 0;
    for (Double3& p : points) {
        p = {double(coordinate(random)), double(coordinate(random)), double(coordinate(random))};
        if (flat) p.z = p.x;
    }
    return points;
}

inline Points moved_points(const Points& points, const Pose& pose) {
    Points result;
    for (const Double3& p : points) result.push_back(transform_point(pose, p));
    return result;
}

inline const Double3& extreme(const Points& points, const Double3& d) {
    return *std::max_element(points.begin(), points.end(), [&](const Double3& p, const Double3& q) {
        return d.x * p.x + d.y * p.y + d.z * p.z < d.x * q.x + d.y * q.y + d.z * q.z;
    });
}

/// Returns a translation of B: anywhere, or so that the two touch along a random direction.
inline Double3 grid_shift(const Points& a, const Points& b, std::mt19937& random) {
    std::uniform_int_distribution<int> coordinate(-5, 5), direction(-2, 2);
    if (random() % 3 != 0) {
        return {double(coordinate(random)), double(coordinate(random)), double(coordinate(random))};
    }
    const Double3 d = {double(direction(random)), double(direction(random)),
                       double(direction(random))};
    const Double3& p = extreme(a, d);
    const Double3& q = extreme(b, {-d.x, -d.y, -d.z});
    return {p.x - q.x, p.y - q.y, p.z - q.z};
}

/// Two sets of points, the pose of B, and the points of B in that pose.
struct HullPair {
    Points a;
    Points b;
    Pose pose;
    Points placed;
};

/// Returns a pair on a grid: apart, touching or overlapping.
inline HullPair grid_pair(std::mt19937& random) {
    const Points a = grid_points(random);
    const Points b = grid_points(random);
    const auto turn = quarter_turns(random);
    const Points turned = moved_points(b, pose_of(turn, {0, 0, 0}));
    const Pose pose = pose_of(turn, grid_shift(a, turned, random));
    return {a, b, pose, moved_points(b, pose)};
}

/// Returns a pair at any place and any angle. About every other pair almost touches: the extreme
/// points of both along a direction coincide, up to rounding.
inline HullPair fine_pair(std::mt19937& random) {
    std::uniform_real_distribution<double> coordinate(-1, 1);
    std::uniform_int_distribution<std::size_t> number(1, 6);
    const auto point = [&] {
        return Double3{coordinate(random), coordinate(random), coordinate(random)};
    };
    Points a(number(random)), b(number(random));
    for (Double3& p : a) p = point();
    for (Double3& p : b) p = point();
    const Pose turn = random_pose(random, 1);
    if (random() % 2 == 0) return {a, b, turn, moved_points(b, turn)};
    const Points turned = moved_points(b, pose_of(turn.rotation(), {0, 0, 0}));
    const Double3 d = point();
    const Double3& p = extreme(a, d);
    const Double3& q = extreme(turned, {-d.x, -d.y, -d.z});
    const Pose pose = pose_of(turn.rotation(), {p.x - q.x, p.y - q.y, p.z - q.z});
    return {a, b, pose, moved_points(b, pose)};
}

/// Returns the mean of all points.
inline Double3 middle_of(const Points& points) {
    Double3 sum{};
    for (const Double3& p : points) sum = {sum.x + p.x, sum.y + p.y, sum.z + p.z};
    const auto count = static_cast<double>(points.size());
    return {sum.x / count, sum.y / count, sum.z / count};
}

/// Returns a pair scaled along one or two axes by factors down to 2^-59. In about half of the
/// pairs the middles coincide, up to rounding. In the others the extreme points along a
/// direction are apart by at most 2^-54 to 1.
inline HullPair thin_pair(std::mt19937& random) {
    std::uniform_real_distribution<double> coordinate(-1, 1);
    HullPair pair = fine_pair(random);
    std::array<double, 3> scale = {1, 1, 1};
    const auto power = [&](unsigned most) {
        return std::ldexp(1, -static_cast<int>(random() % most));
    };
    scale[random() % 3] = power(60);
    scale[random() % 3] = power(30);
    for (Points* points : {&pair.a, &pair.b}) {
        if (random() % 4 == 0) continue;
        for (Double3& p : *points) p = {scale[0] * p.x, scale[1] * p.y, scale[2] * p.z};
    }
    const auto& turn = pair.pose.rotation();
    const Points turned = moved_points(pair.b, pose_of(turn, {0, 0, 0}));
    const Double3 d = {coordinate(random), coordinate(random), coordinate(random)};
    const bool in_middle = random() % 2 == 0;
    const Double3 p = in_middle ? middle_of(pair.a) : extreme(pair.a, d);
    const Double3 q = in_middle ? middle_of(turned) : extreme(turned, {-d.x, -d.y, -d.z});
    const double gap = in_middle ? 0 : coordinate(random) * power(55);
    pair.pose =
        pose_of(turn, {p.x - q.x + gap * d.x, p.y - q.y + gap * d.y, p.z - q.z + gap * d.z});
    pair.placed = moved_points(pair.b, pair.pose);
    return pair;
}

/// Returns points on a sphere, rounded to a coarse grid if `coarse`.
inline Points ball_points(std::mt19937& random, std::size_t count, bool coarse) {
    std::normal_distribution<double> normal;
    Points points(count);
    for (Double3& p : points) {
        p = {normal(random), normal(random), normal(random)};
        const double scale = (coarse ? 8 : 1) / std::hypot(p.x, p.y, p.z);
        p = {scale * p.x, scale * p.y, scale * p.z};
        if (coarse) p = {std::round(p.x), std::round(p.y), std::round(p.z)};
    }
    return points;
}

/// Returns a cache with random numbers, also of points that do not exist.
inline ConvexCache nonsense(std::mt19937& random) {
    ConvexCache cache;
    cache.count = static_cast<std::uint32_t>(random() % 6);
    for (std::size_t i = 0; i < 4; ++i) {
        cache.a[i] = static_cast<std::uint32_t>(random() % 7);
        cache.b[i] = static_cast<std::uint32_t>(random() % 7);
    }
    return cache;
}

}  // namespace cdprep::test
