// SPDX-License-Identifier: MIT
#include "hull/expanding_polytope.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "cdprep/format/portable.h"
#include "core/numbers.h"
#include "exact/double_double.h"
#include "hull/difference_side.h"
#include "hull/exact_nearest.h"

// The distance of the origin from the border of a polytope that holds it is that of the nearest
// triangle. For any direction d, a triangle is at least min d . x / |d| away, over its corners x.
// So no normal has to be trusted. The farthest points of A and B bound the reach of A - B along any
// d. So both bounds hold for any search, as long as the origin is inside. Exact signs ensure that.

namespace cdprep {
namespace {

/// Scales a direction so that its largest coordinate is 1. Returns false for no direction.
bool normalise(Double3& d) {
    const double most = largest_of(d);
    if (!(most > 0 && most < kInfinity)) return false;
    d = {d.x / most, d.y / most, d.z / most};
    return true;
}

/// Returns q - p from the points of A and of B. The error is their rounding, not that of the
/// corners.
Double3 edge_between(const Difference& p, const Difference& q) {
    return (q.at_a - p.at_a) - (q.at_b - p.at_b);
}

using Accurate3 = std::array<DoubleDouble, 3>;

/// Returns the same times a power of two, in twice the precision.
Accurate3 accurate_edge(const Difference& p, const Difference& q, double scale) {
    const auto along = [&](double qa, double pa, double qb, double pb) {
        const DoubleDouble e = (DoubleDouble(qa) - pa) - (DoubleDouble(qb) - pb);
        return DoubleDouble(e.high * scale, e.low * scale);
    };
    return {along(q.at_a.x, p.at_a.x, q.at_b.x, p.at_b.x),
            along(q.at_a.y, p.at_a.y, q.at_b.y, p.at_b.y),
            along(q.at_a.z, p.at_a.z, q.at_b.z, p.at_b.z)};
}

/// Returns a power of two, between 2^-1000 and 2^1000, from the exponent of the largest coordinate.
/// Multiplied by the result, that coordinate has a size in [1, 2), unless the limits prevent it.
double scale_of(const Double3& edge) {
    constexpr int kBias = 1023;
    constexpr int kMost = 1000;
    const auto exponent = static_cast<int>(format::bit_cast<std::uint64_t>(largest_of(edge)) >> 52);
    const int wanted = std::clamp(kBias - exponent, -kMost, kMost);
    return format::bit_cast<double>(static_cast<std::uint64_t>(wanted + kBias) << 52);
}

/// Sets `normal` to the normal of p, q, r, which turn counter-clockwise as seen from its tip.
/// Returns false for no direction. The edges are scaled to length 1 first, so that no product
/// leaves the range of double. Slivers are computed in twice the precision, because the bounds of
/// thin hulls depend on their normals.
bool normal_of(const Difference& p, const Difference& q, const Difference& r, Double3& normal) {
    const Double3 first = edge_between(p, q);
    const Double3 second = edge_between(p, r);
    if (!(largest_of(first) > 0 && largest_of(second) > 0)) return false;
    const double to_first = scale_of(first);
    const double to_second = scale_of(second);
    normal = cross(to_first * first, to_second * second);
    // About the sine of the angle. Above it, at most some 10 of 53 bits cancel.
    constexpr double kSliver = 0x1p-10;
    if (largest_of(normal) < kSliver) {
        const Accurate3 e = accurate_edge(p, q, to_first);
        const Accurate3 f = accurate_edge(p, r, to_second);
        normal = {static_cast<double>(e[1] * f[2] - e[2] * f[1]),
                  static_cast<double>(e[2] * f[0] - e[0] * f[2]),
                  static_cast<double>(e[0] * f[1] - e[1] * f[0])};
    }
    return normalise(normal);
}

/// Returns two directions at right angles to d.
std::array<Double3, 2> across(const Double3& d) {
    const Double3 least =
        std::fabs(d.x) <= std::fabs(d.y) && std::fabs(d.x) <= std::fabs(d.z)
            ? Double3{1, 0, 0}
            : (std::fabs(d.y) <= std::fabs(d.z) ? Double3{0, 1, 0} : Double3{0, 0, 1});
    Double3 first = cross(d, least);
    normalise(first);
    Double3 second = cross(d, first);
    normalise(second);
    return {first, second};
}

/// Returns the threshold below which a corner's distance from the others may be rounding alone.
double noise_of(const Difference& p, const Difference& q) {
    const auto most = [](const Difference& d) {
        return std::max(largest_of(d.at_a), largest_of(d.at_b));
    };
    return 64 * kUnit * std::max(most(p), most(q));
}

}  // namespace

Difference ExpandingPolytope::difference(std::uint32_t i, std::uint32_t j) const noexcept {
    const Double3 p = a_.point(i);
    const Double3 q = b_.point(j);
    return {i, j, p, q, p - q};
}

Difference ExpandingPolytope::highest(const Double3& direction, const Difference& near) noexcept {
    ++steps_;
    return difference(a_.farthest_anew(direction, near.a), b_.farthest_anew(-direction, near.b));
}

void ExpandingPolytope::bound_along(const Double3& direction, const Difference& top,
                                    const NearestSimplex& corners) noexcept {
    const double of_a = a_.proven(direction, top.at_a, top.a).bound;
    const double of_b = b_.proven(-direction, top.at_b, top.b).bound;
    const double size = dot_size(direction, top.at) + std::fabs(of_a) + std::fabs(of_b);
    const double reach = dot(direction, top.at) + of_a + of_b + 8 * kUnit * size;
    const double unit = length(direction);
    if (!(unit > 0)) return;
    constexpr double kUnderflow = 0x1p-1050;  // more than products below the range of double lose
    const double upper = std::max(0.0, reach / unit * (1 + 8 * kUnit)) + kUnderflow;
    // All triangles with one normal prove the same bound, including those found deeper inside. The
    // last one has the witnesses.
    const double noise = 16 * kUnit * size;
    NearestSimplex nearest = corners;
    keep_nearest(nearest);
    const double foot = length(weighted_point(nearest));
    if (!(upper < best_.upper - noise || (upper <= best_.upper + noise && foot > foot_))) return;
    foot_ = foot;
    best_.upper = upper;
    best_.normal = {direction.x / unit, direction.y / unit, direction.z / unit};
    nearest_ = nearest;
    all_ = corners;
}

Penetration ExpandingPolytope::answer() noexcept {
    best_.lower = std::min(best_.lower, best_.upper);
    const Double3 off = weighted_point(nearest_) - best_.upper * best_.normal;
    double size = 0;
    for (std::size_t i = 0; i < nearest_.count; ++i) {
        size = std::max(size, largest_of(nearest_.corner[i].at));
    }
    // The weights of nearly collinear corners are rounding errors. Others leave a few
    // roundings of the size.
    constexpr double kWellPlaced = 0x1p-48;
    if (!(largest_of(off) <= kWellPlaced * size)) {
        nearest_ = exactly_weighted(all_.corner.data(), all_.count);
    }
    best_.witness_a = weighted_sum(nearest_, &Difference::at_a);
    best_.witness_b = weighted_sum(nearest_, &Difference::at_b);
    return best_;
}

bool ExpandingPolytope::add_off_point() noexcept {
    constexpr std::array<Double3, 3> kAxes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (const Double3& axis : kAxes) {
        for (const Double3& d : {axis, -axis}) {
            const Difference top = highest(d, corner_[0]);
            if (dot(d, top.at - corner_[0].at) <= noise_of(top, corner_[0])) continue;
            corner_[corners_++] = top;
            return true;
        }
    }
    return false;
}

bool ExpandingPolytope::add_off_line() noexcept {
    Double3 edge = corner_[1].at - corner_[0].at;
    normalise(edge);
    for (const Double3& axis : across(edge)) {
        for (const Double3& d : {axis, -axis}) {
            const Difference top = highest(d, corner_[0]);
            const Double3 off = cross(top.at - corner_[0].at, edge);
            if (largest_of(off) <= noise_of(top, corner_[0])) continue;
            corner_[corners_++] = top;
            return true;
        }
    }
    return false;
}

bool ExpandingPolytope::add_off_plane() noexcept {
    Double3 n{};
    if (!normal_of(corner_[0], corner_[1], corner_[2], n)) return false;
    for (const Double3& d : {n, -n}) {
        const Difference top = highest(d, corner_[0]);
        if (side_of(corner_[0], corner_[1], corner_[2], top) == 0) continue;
        corner_[corners_++] = top;
        return true;
    }
    return false;
}

bool ExpandingPolytope::span_space() noexcept {
    if (corners_ == 1 && !add_off_point()) return false;
    if (corners_ == 2 && !add_off_line()) return false;
    return corners_ > 3 || add_off_plane();
}

void ExpandingPolytope::bound_flat() noexcept {
    NearestSimplex corners;
    corners.count = corners_;
    std::copy_n(corner_.begin(), corners_, corners.corner.begin());
    Double3 d = {0, 0, 1};
    if (corners_ > 1) {
        Double3 edge = corner_[1].at - corner_[0].at;
        normalise(edge);
        d = across(edge)[0];
    }
    if (corners_ > 2) {
        Double3 n{};
        if (normal_of(corner_[0], corner_[1], corner_[2], n)) d = n;
    }
    for (const Double3& side : {d, -d}) bound_along(side, highest(side, corner_[0]), corners);
}

NearestSimplex ExpandingPolytope::simplex_of(const Face& face) const noexcept {
    NearestSimplex simplex;
    simplex.count = 3;
    for (std::size_t i = 0; i < 3; ++i) simplex.corner[i] = corner_[face.corner[i]];
    return simplex;
}

double ExpandingPolytope::lower_along(const Double3& d, const Face& face) const noexcept {
    double least = kInfinity;
    for (const std::uint8_t i : face.corner) {
        const Double3& p = corner_[i].at;
        least = std::min(least, dot(d, p) - 5 * kUnit * dot_size(d, p));
    }
    return std::max(0.0, least / length(d) * (1 - 8 * kUnit));
}

void ExpandingPolytope::add_face(std::uint8_t p, std::uint8_t q, std::uint8_t r) noexcept {
    assert(faces_ < face_.size() && p != q && q != r && r != p);
    Face& face = face_[faces_++];
    face = {{p, q, r}, 0, {}, false};
    if (normal_of(corner_[p], corner_[q], corner_[r], face.direction)) {
        face.lower = lower_along(face.direction, face);
    }
}

void ExpandingPolytope::look_closely(Face& face) const noexcept {
    face.looked_at = true;
    NearestSimplex nearest = simplex_of(face);
    keep_nearest(nearest);
    // A triangle that is nearly a line has a poor normal.
    Double3 other = nearest_direction(nearest);
    if (nearest.count < 3 && normalise(other)) {
        face.lower = std::max(face.lower, lower_along(other, face));
        if (largest_of(face.direction) == 0) face.direction = other;
    }
}

void ExpandingPolytope::first_faces() noexcept {
    assert(corners_ == 4);
    if (side_of(corner_[0], corner_[1], corner_[2], corner_[3]) < 0) {
        std::swap(corner_[0], corner_[1]);
    }
    add_face(0, 1, 2);
    add_face(1, 0, 3);
    add_face(2, 1, 3);
    add_face(0, 2, 3);
}

bool ExpandingPolytope::sees(const Difference& from, const Face& face) const noexcept {
    return side_of(corner_[face.corner[0]], corner_[face.corner[1]], corner_[face.corner[2]],
                   from) < 0;
}

bool ExpandingPolytope::has(const Difference& corner) const noexcept {
    return std::any_of(
        corner_.begin(), corner_.begin() + static_cast<std::ptrdiff_t>(corners_),
        [&](const Difference& other) { return other.a == corner.a && other.b == corner.b; });
}

bool ExpandingPolytope::grow(const Difference& corner) noexcept {
    if (corners_ == kMostCorners) return false;
    std::size_t edges = 0;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < faces_; ++i) {
        const Face face = face_[i];
        if (!sees(corner, face)) {
            face_[kept++] = face;
            continue;
        }
        for (std::size_t j = 0; j < 3; ++j) {
            const Edge edge = {face.corner[j], face.corner[(j + 1) % 3]};
            // An edge between two visible faces is met from both sides.
            const auto end = edge_.begin() + static_cast<std::ptrdiff_t>(edges);
            const auto back = std::find_if(edge_.begin(), end, [&](const Edge& other) {
                return other.from == edge.to && other.to == edge.from;
            });
            if (back == end) {
                assert(edges < edge_.size());
                edge_[edges++] = edge;
            } else {
                *back = edge_[--edges];
            }
        }
    }
    faces_ = kept;
    const auto added = static_cast<std::uint8_t>(corners_);
    corner_[corners_++] = corner;
    for (std::size_t i = 0; i < edges; ++i) add_face(edge_[i].from, edge_[i].to, added);
    assert(faces_ >= 4 && faces_ <= 2 * corners_ - 4);  // closed, by Euler
    return true;
}

const ExpandingPolytope::Face& ExpandingPolytope::nearest_face() noexcept {
    assert(faces_ > 0);
    for (;;) {
        Face& face =
            *std::min_element(face_.begin(), face_.begin() + static_cast<std::ptrdiff_t>(faces_),
                              [](const Face& x, const Face& y) { return x.lower < y.lower; });
        if (face.looked_at) return face;
        look_closely(face);  // after which another may be nearer
    }
}

Penetration ExpandingPolytope::expand(const Difference* corner, std::size_t count,
                                      const DistanceOptions& options) noexcept {
    assert(count >= 1 && count <= 4);
    std::copy_n(corner, count, corner_.begin());
    corners_ = count;
    best_.upper = kInfinity;
    const bool spans = span_space();
    if (!spans) {
        bound_flat();
        return answer();
    }
    first_faces();
    for (;;) {
        const Face face = nearest_face();
        best_.lower = face.lower;
        const Difference top = highest(face.direction, corner_[face.corner[0]]);
        bound_along(face.direction, top, simplex_of(face));
        const double permitted =
            std::max(options.relative_error * best_.upper, options.absolute_error);
        if (best_.upper - best_.lower <= permitted || has(top) || !sees(top, face) || !grow(top)) {
            return answer();
        }
    }
}

}  // namespace cdprep
