// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/enclose/merge_corners.h"

#include <algorithm>
#include <vector>

#include "decompose/enclose/part_points.h"
#include "mesh/half_edges.h"
#include "mesh/vectors.h"

namespace cdprep::convex {
namespace {

constexpr double kFirstPush = 2;  ///< extents of a group: enough if the hull is pointed there
constexpr double kMorePush = 8;   ///< factor to the next push, if that was not enough
constexpr int kPushes = 6;        ///< the last is 65,536 extents; then the hull stays as it was
constexpr double kWide = 4;       ///< in distances: a wider group is left alone

/// Corners near each other.
struct Group {
    Double3 middle;
    double extent = 0;  ///< greatest distance from the middle
};

/// The groups, and the corners outside all groups.
struct Sorted {
    std::vector<Group> groups;
    std::vector<Double3> single;
};

Sorted sort_corners(const std::vector<Double3>& points, double distance) {
    const auto count = static_cast<std::uint32_t>(points.size());
    std::vector<std::uint32_t> order(count);
    for (std::uint32_t i = 0; i < count; ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return points[a].x != points[b].x ? points[a].x < points[b].x : a < b;
    });
    mesh::Groups near(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        for (std::uint32_t k = i + 1; k < count; ++k) {
            if (points[order[k]].x - points[order[i]].x > distance) break;
            if (mesh::length(mesh::minus(points[order[k]], points[order[i]])) <= distance) {
                near.join(order[i], order[k]);
            }
        }
    }
    std::vector<std::vector<Double3>> members(count);
    for (std::uint32_t i = 0; i < count; ++i) members[near.lowest(i)].push_back(points[i]);
    Sorted sorted;
    for (const auto& group : members) {
        if (group.empty()) continue;
        Group found{mesh::mean_of(group)};
        for (const Double3& p : group) {
            found.extent = std::max(found.extent, mesh::length(mesh::minus(p, found.middle)));
        }
        if (group.size() > 1 && found.extent <= kWide * distance) {
            sorted.groups.push_back(found);
        } else {
            sorted.single.insert(sorted.single.end(), group.begin(), group.end());
        }
    }
    return sorted;
}

}  // namespace

ConvexHull merge_corners(ConvexHull hull, double distance) {
    if (hull.dimension != 3) return hull;
    const Sorted sorted = sort_corners(hull.points, distance);
    if (sorted.groups.empty()) return hull;
    const Double3 middle = mesh::mean_of(hull.points);
    double push = kFirstPush;
    for (int i = 0; i < kPushes; ++i, push *= kMorePush) {
        std::vector<Double3> points = sorted.single;
        for (const Group& group : sorted.groups) {
            const Double3 away = mesh::minus(group.middle, middle);
            const double share = push * group.extent / mesh::length(away);
            points.push_back({group.middle.x + share * away.x, group.middle.y + share * away.y,
                              group.middle.z + share * away.z});
        }
        ConvexHull merged = convex_hull(points);
        if (merged.dimension != 3 || prove_points(merged, hull.points).outside > 0) continue;
        merged.numbers.clear();
        return merged;
    }
    return hull;
}

}  // namespace cdprep::convex
