// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/enclose/separated_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "hull/convex_hull.h"
#include "mesh/vectors.h"

namespace cdprep::convex {
namespace {

using mesh::cross;
using mesh::dot;
using mesh::minus;

/// Points and planes that one loop without branches tests, so that SIMD lanes are used. They change
/// no result.
constexpr std::size_t kPointsAtOnce = 16;
constexpr std::size_t kPlanesAtOnce = 64;
constexpr int kMostSteps = 40;      ///< of a search for a plane; then the point counts as inside
constexpr double kNothing = 1e-18;  ///< of squared distances: nearer counts as inside
constexpr std::uint32_t kClosed = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kManyPoints = 96;  ///< pruned above this plus twice the last pruned size

/// Up to four points around the origin. The functions reduce them to the feature of their hull that
/// is nearest to the origin, and return its nearest point.
struct Simplex {
    std::array<Double3, 4> point;
    std::size_t count = 0;
};

Double3 scaled_sum(const Double3& a, double s, const Double3& b) {
    return {a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

Double3 nearest_on_segment(Simplex& s) {
    const Double3 a = s.point[0];
    const Double3 b = s.point[1];
    const Double3 ab = minus(b, a);
    const double t = -dot(a, ab);
    const double length = dot(ab, ab);
    if (t <= 0) {
        s.count = 1;
        return a;
    }
    if (t >= length) {
        s.point[0] = b;
        s.count = 1;
        return b;
    }
    return scaled_sum(a, t / length, ab);
}

/// Returns the nearest point on the sides of a triangle.
Double3 nearest_on_sides(Simplex& s) {
    const Simplex all = s;
    Double3 best{};
    double least = -1;
    for (std::size_t k = 0; k < 3; ++k) {
        Simplex side;
        side.point = {all.point[k], all.point[(k + 1) % 3]};
        side.count = 2;
        const Double3 p = nearest_on_segment(side);
        if (least >= 0 && dot(p, p) >= least) continue;
        least = dot(p, p);
        best = p;
        s = side;
    }
    return best;
}

Double3 nearest_on_triangle(Simplex& s) {
    const Double3 &a = s.point[0], &b = s.point[1], &c = s.point[2];
    const Double3 n = cross(minus(b, a), minus(c, a));
    const double nn = dot(n, n);
    const bool within =
        nn > 0 && dot(cross(a, b), n) >= 0 && dot(cross(b, c), n) >= 0 && dot(cross(c, a), n) >= 0;
    if (!within) return nearest_on_sides(s);
    const double t = dot(a, n) / nn;
    return {t * n.x, t * n.y, t * n.z};
}

/// Returns the nearest point on the faces that the origin is beyond, or the origin if there are
/// none.
Double3 nearest_on_tetrahedron(Simplex& s) {
    constexpr std::array<std::array<std::size_t, 4>, 4> kSides = {
        {{0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 3, 1}, {1, 2, 3, 0}}};
    const Simplex all = s;
    Double3 best = {0, 0, 0};
    double least = -1;
    for (const auto& side : kSides) {
        const Double3& a = all.point[side[0]];
        const Double3 n = cross(minus(all.point[side[1]], a), minus(all.point[side[2]], a));
        const double of_origin = -dot(a, n);
        const double of_other = dot(minus(all.point[side[3]], a), n);
        if (of_origin * of_other > 0) continue;
        Simplex triangle;
        triangle.point = {a, all.point[side[1]], all.point[side[2]]};
        triangle.count = 3;
        const Double3 p = nearest_on_triangle(triangle);
        if (least >= 0 && dot(p, p) >= least) continue;
        least = dot(p, p);
        best = p;
        s = triangle;
    }
    return best;
}

Double3 nearest_to_origin(Simplex& s) {
    switch (s.count) {
        case 1:
            return s.point[0];
        case 2:
            return nearest_on_segment(s);
        case 3:
            return nearest_on_triangle(s);
        default:
            return nearest_on_tetrahedron(s);
    }
}

Double3 middle(const mesh::Box& box) {
    return {box.lower.x / 2 + box.upper.x / 2, box.lower.y / 2 + box.upper.y / 2,
            box.lower.z / 2 + box.upper.z / 2};
}

Double3 unit(const Double3& v) {
    const double length = std::sqrt(dot(v, v));
    return {v.x / length, v.y / length, v.z / length};
}

}  // namespace

std::size_t PointRows::farthest(const Double3& along) const {
    std::size_t best = 0;
    double most = -std::numeric_limits<double>::infinity();
    std::size_t i = 0;
    for (; i + kPointsAtOnce <= size(); i += kPointsAtOnce) {
        std::array<double, kPointsAtOnce> value;
        for (std::size_t k = 0; k < kPointsAtOnce; ++k) {
            value[k] = along.x * x_[i + k] + along.y * y_[i + k] + along.z * z_[i + k];
        }
        double of_block = value[0];
        for (std::size_t k = 1; k < kPointsAtOnce; ++k) of_block = std::max(of_block, value[k]);
        if (of_block <= most) continue;
        most = of_block;
        best = i;
        while (value[best - i] != of_block) ++best;
    }
    for (; i < size(); ++i) {
        const double value = along.x * x_[i] + along.y * y_[i] + along.z * z_[i];
        if (value <= most) continue;
        most = value;
        best = i;
    }
    return best;
}

void PointGroups::add(std::span<const Double3> points) {
    if (points.empty()) return;
    Group group{
        {}, static_cast<std::uint32_t>(points_.size()), static_cast<std::uint32_t>(points.size())};
    for (const Double3& p : points) group.box.add(p);
    if (groups_.size() % kBundle == 0) bundles_.emplace_back();
    bundles_.back().add(group.box.lower);
    bundles_.back().add(group.box.upper);
    groups_.push_back(group);
    points_.insert(points_.end(), points.begin(), points.end());
}

/// Sets a plane that no set lies beyond.
void SeparatedPoints::Planes::forbid(std::size_t i) {
    x[i] = y[i] = z[i] = 0;
    offset[i] = -std::numeric_limits<double>::infinity();
}

void SeparatedPoints::Planes::swap(std::size_t i, std::size_t k) {
    std::swap(x[i], x[k]);
    std::swap(y[i], y[k]);
    std::swap(z[i], z[k]);
    std::swap(offset[i], offset[k]);
}

void SeparatedPoints::Planes::resize(std::size_t count) {
    x.resize(count);
    y.resize(count);
    z.resize(count);
    offset.resize(count);
}

SeparatedPoints::SeparatedPoints(const PointGroups& kept_out)
    : kept_out_(kept_out), is_near_(kept_out.size(), 0) {}

/// Returns a plane that separates the point from the hull of the present points and `more`.
std::optional<SeparatedPoints::Touching> SeparatedPoints::find_plane(
    const Double3& kept_out, const Double3& first, std::span<const Double3> more) {
    Double3 normal = unit(first);
    Simplex simplex;
    for (int step = 0; step < kMostSteps; ++step) {
        work_ += points_.size() + more.size();
        Double3 support{};
        double most = -std::numeric_limits<double>::infinity();
        if (points_.size() > 0) {
            support = points_.at(points_.farthest(normal));
            most = dot(normal, support);
        }
        for (const Double3& p : more) {
            if (dot(normal, p) <= most) continue;
            most = dot(normal, p);
            support = p;
        }
        const Double3 relative = minus(support, kept_out);
        if (dot(normal, relative) < 0) return Touching{normal, most};
        simplex.point[simplex.count++] = relative;
        const Double3 nearest = nearest_to_origin(simplex);
        if (dot(nearest, nearest) <= kNothing * dot(relative, relative) || simplex.count == 4) {
            return std::nullopt;
        }
        normal = unit({-nearest.x, -nearest.y, -nearest.z});
    }
    return std::nullopt;
}

/// Returns true if all points of a set stay outside, beyond their plane or another one.
/// Neighbouring sets often share a plane.
bool SeparatedPoints::keep_out(Planes& planes, std::size_t i, std::span<const Double3> kept_out,
                               const Double3& centre, const Added& added) {
    const Double3 old = {planes.x[i], planes.y[i], planes.z[i]};
    if (dot(old, old) > 0) {
        work_ += added.points.size();
        const double offset = planes.offset[i];
        const auto is_before = [&](const Double3& p) { return dot(old, p) < offset; };
        if (std::all_of(added.points.begin(), added.points.end(), is_before)) return true;
    }
    const auto try_plane = [&](std::size_t k) {
        double offset = std::numeric_limits<double>::infinity();
        for (const Double3& p : kept_out) offset = std::min(offset, dot(found_[k].normal, p));
        if (offset <= found_[k].offset) return false;
        changes_.push_back({&planes, i, k, offset});
        return true;
    };
    for (std::size_t k = found_.size(); k-- > 0;) {
        if (dot(found_[k].normal, centre) > found_[k].offset && try_plane(k)) return true;
    }
    const Double3 away = minus(centre, added.centre);
    const Double3 first = dot(old, old) > 0 ? old : dot(away, away) > 0 ? away : Double3{1, 0, 0};
    const auto plane = find_plane(centre, first, added.points);
    if (!plane) return false;
    found_.push_back(*plane);
    return try_plane(found_.size() - 1);
}

/// Returns true if all points of a group stay outside, each beyond a plane of its own.
bool SeparatedPoints::keep_out_points(const Near& near, const Added& added) {
    const std::span<const Double3> points = kept_out_.points_of(near.group);
    const Double3& c = added.centre;
    work_ += points.size();
    for (std::size_t begin = 0; begin < points.size(); begin += kPlanesAtOnce) {
        const std::size_t count = std::min(kPlanesAtOnce, points.size() - begin);
        const std::size_t first = near.single + begin;
        std::array<double, kPlanesAtOnce> beyond;
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t i = first + k;
            beyond[k] = single_.x[i] * c.x + single_.y[i] * c.y + single_.z[i] * c.z +
                        added.radius - single_.offset[i];
        }
        for (std::size_t k = 0; k < count; ++k) {
            if (beyond[k] < 0) continue;
            const Double3& p = points[begin + k];
            if (!keep_out(single_, first + k, {&p, 1}, p, added)) return false;
        }
    }
    return true;
}

bool SeparatedPoints::keep_out_group(std::size_t i, const Added& added) {
    if (near_[i].single == kClosed) {
        const std::span<const Double3> all = kept_out_.points_of(near_[i].group);
        const Double3 centre = middle(kept_out_.box_of(near_[i].group));
        if (keep_out(planes_, i, all, centre, added)) return true;
        if (all.size() == 1) return false;
        opened_.push_back(i);
        near_[i].single = static_cast<std::uint32_t>(single_.size());
        single_.resize(single_.size() + all.size());
    }
    return keep_out_points(near_[i], added);
}

/// Adds the groups that the hull's box now reaches; none of them has a plane yet.
void SeparatedPoints::look_around(const mesh::Box& box) {
    work_ += kept_out_.in_box(box, [this](std::size_t i) {
        if (is_near_[i] != 0) return;
        is_near_[i] = 1;
        near_.push_back({static_cast<std::uint32_t>(i), kClosed});
    });
    planes_.resize(near_.size());
}

bool SeparatedPoints::keep_out_all(const Added& added) {
    const Double3& c = added.centre;
    work_ += near_.size();
    for (std::size_t begin = 0; begin < near_.size(); begin += kPlanesAtOnce) {
        const std::size_t count = std::min(kPlanesAtOnce, near_.size() - begin);
        std::array<double, kPlanesAtOnce> beyond;
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t i = begin + k;
            beyond[k] = planes_.x[i] * c.x + planes_.y[i] * c.y + planes_.z[i] * c.z +
                        added.radius - planes_.offset[i];
        }
        for (std::size_t k = 0; k < count; ++k) {
            if (beyond[k] < 0 || keep_out_group(begin + k, added)) continue;
            blocking_ = begin + k;
            return false;
        }
    }
    return true;
}

/// Undoes a failed add(). The group that blocked it moves forward, so that the next add() tests it
/// sooner.
void SeparatedPoints::forget(std::size_t near_count, std::size_t single_count) {
    for (const std::size_t i : opened_) near_[i].single = kClosed;
    for (std::size_t i = near_count; i < near_.size(); ++i) is_near_[near_[i].group] = 0;
    near_.resize(near_count);
    planes_.resize(near_count);
    single_.resize(single_count);
    if (blocking_ >= near_count) return;
    const std::size_t sooner = blocking_ / 2;
    std::swap(near_[blocking_], near_[sooner]);
    planes_.swap(blocking_, sooner);
}

bool SeparatedPoints::add(std::span<const Double3> points, const Double3& centre, double radius) {
    changes_.clear();
    found_.clear();
    opened_.clear();
    mesh::Box box = box_;
    for (const Double3& p : points) box.add(p);
    const std::size_t near_count = near_.size();
    const std::size_t single_count = single_.size();
    if (!box_.contains(box.lower) || !box_.contains(box.upper)) look_around(box);
    if (!keep_out_all({points, centre, radius})) {
        forget(near_count, single_count);
        return false;
    }
    for (const Change& change : changes_) {
        const Double3& n = found_[change.plane].normal;
        change.planes->x[change.of] = n.x;
        change.planes->y[change.of] = n.y;
        change.planes->z[change.of] = n.z;
        change.planes->offset[change.of] = change.offset;
    }
    for (const std::size_t i : opened_) planes_.forbid(i);
    box_ = box;
    for (const Double3& p : points) points_.add(p);
    if (points_.size() > kManyPoints + 2 * pruned_size_) prune();
    return true;
}

std::vector<Double3> SeparatedPoints::outer_points() const {
    std::vector<Double3> all;
    all.reserve(points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) all.push_back(points_.at(i));
    return all;
}

void SeparatedPoints::prune() {
    const std::vector<Double3> all = outer_points();
    points_ = {};
    for (const Double3& p : convex_hull(all).points) points_.add(p);
    pruned_size_ = points_.size();
}

}  // namespace cdprep::convex
