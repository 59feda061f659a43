// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/triangulate_polygon.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "cdprep/exact/predicates.h"

// Libraries serve fewer outlines: earcut decides by rounded numbers, and CGAL's constrained
// triangulation makes one corner of those with equal positions.
namespace cdprep::mesh {
namespace {

using Corners = std::array<std::uint32_t, 3>;

// The limit on edge tests per polygon. They take about a second; polygons of a few thousand
// corners stay far below.
constexpr std::uint64_t kMaxSteps = 200'000'000;

/// Returns twice the vector area of the outline, scaled to about one.
Double3 area_vector(std::span<const Double3> outline) {
    const Double3& o = outline[0];
    double extent = 0;
    for (const Double3& p : outline) {
        extent =
            std::max({extent, std::fabs(p.x - o.x), std::fabs(p.y - o.y), std::fabs(p.z - o.z)});
    }
    Double3 sum{0, 0, 0};
    if (extent == 0) return sum;
    const int exponent = -std::ilogb(extent);
    const auto scaled = [&](const Double3& p) {
        return Double3{std::scalbn(p.x - o.x, exponent), std::scalbn(p.y - o.y, exponent),
                       std::scalbn(p.z - o.z, exponent)};
    };
    for (std::size_t i = 1; i + 1 < outline.size(); ++i) {
        const Double3 a = scaled(outline[i]);
        const Double3 b = scaled(outline[i + 1]);
        sum.x += a.y * b.z - a.z * b.y;
        sum.y += a.z * b.x - a.x * b.z;
        sum.z += a.x * b.y - a.y * b.x;
    }
    return sum;
}

/// Returns the outline projected along its main axis, counter-clockwise. Drops one coordinate
/// and may swap the others, which is exact.
std::vector<Double2> project(std::span<const Double3> outline) {
    const Double3 area = area_vector(outline);
    const double x = std::fabs(area.x);
    const double y = std::fabs(area.y);
    const double z = std::fabs(area.z);
    std::vector<Double2> flat;
    flat.reserve(outline.size());
    for (const Double3& p : outline) {
        Double2 seen = {p.x, p.y};
        bool mirrored = area.z < 0;
        if (x > y && x > z) {
            seen = {p.y, p.z};
            mirrored = area.x < 0;
        } else if (y > z) {
            seen = {p.z, p.x};
            mirrored = area.y < 0;
        }
        flat.push_back(mirrored ? Double2{seen.y, seen.x} : seen);
    }
    return flat;
}

bool equal(const Double2& a, const Double2& b) {
    return a.x == b.x && a.y == b.y;
}

bool less(const Double2& a, const Double2& b) {
    return a.x < b.x || (a.x == b.x && a.y < b.y);
}

/// Returns whether every turn is strictly to the left, and the turns sum to one revolution.
bool is_strictly_convex(std::span<const Double2> flat) {
    const std::size_t n = flat.size();
    int direction_changes = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const Double2& a = flat[i];
        const Double2& b = flat[(i + 1) % n];
        const Double2& c = flat[(i + 2) % n];
        if (exact::orient2d(a, b, c) <= 0) return false;
        if (less(a, b) != less(b, c)) ++direction_changes;
    }
    return direction_changes == 2;
}

/// Returns whether b lies strictly between a and c; the points must be collinear.
bool is_between(const Double2& a, const Double2& b, const Double2& c) {
    return (less(a, b) && less(b, c)) || (less(c, b) && less(b, a));
}

struct FlatBox {
    Double2 lower;
    Double2 upper;
};

FlatBox box_of(const Double2& a, const Double2& b) {
    return {{std::min(a.x, b.x), std::min(a.y, b.y)}, {std::max(a.x, b.x), std::max(a.y, b.y)}};
}

bool overlap(const FlatBox& a, const FlatBox& b) {
    return a.lower.x <= b.upper.x && b.lower.x <= a.upper.x && a.lower.y <= b.upper.y &&
           b.lower.y <= a.upper.y;
}

/// A triangle that turns counter-clockwise.
struct Ear {
    Double2 a, b, c;
};

/// Returns whether segment pq meets the interior of the ear. Two convex sets in the plane are
/// apart exactly if a line along an edge of one of them separates them.
bool enters(const Ear& ear, const Double2& p, const Double2& q) {
    const auto outside = [&](const Double2& from, const Double2& to) {
        return exact::orient2d(from, to, p) <= 0 && exact::orient2d(from, to, q) <= 0;
    };
    if (outside(ear.a, ear.b) || outside(ear.b, ear.c) || outside(ear.c, ear.a)) return false;
    if (equal(p, q)) return true;
    const int a = exact::orient2d(p, q, ear.a);
    const int b = exact::orient2d(p, q, ear.b);
    const int c = exact::orient2d(p, q, ear.c);
    return std::min({a, b, c}) < 0 && std::max({a, b, c}) > 0;
}

/// Clips ears off a weakly simple polygon that runs counter-clockwise.
///
/// An ear is a left turn whose triangle no other edge enters. Ears whose cut passes through a
/// third corner come last: clipping them may leave collinear corners. Spikes (paths that turn
/// back on themselves) and repeated positions come first, as triangles without area: an ear
/// beside a spike might lie outside.
class EarClipper {
public:
    EarClipper(std::span<const Double2> flat, std::vector<Corners>& triangles)
        : flat_(flat), triangles_(triangles), next_(flat.size()), previous_(flat.size()) {
        const auto n = static_cast<std::uint32_t>(flat.size());
        for (std::uint32_t i = 0; i < n; ++i) {
            next_[i] = (i + 1) % n;
            previous_[i] = (i + n - 1) % n;
        }
        left_ = n;
    }

    PolygonCut run() {
        while (left_ > 3) {
            if (clip_first([this](std::uint32_t i) { return is_spike(i); })) continue;
            if (clip_first([this](std::uint32_t i) { return is_ear(i, Cut::clear); })) continue;
            if (clip_first([this](std::uint32_t i) { return is_ear(i, Cut::any); })) continue;
            force_rest();
            return PolygonCut::forced;
        }
        triangles_.push_back({previous_[at_], at_, next_[at_]});
        const bool turns_right = turn(at_) < 0;
        return turns_right || steps_ > kMaxSteps ? PolygonCut::forced : PolygonCut::ears;
    }

private:
    enum class Cut : std::uint8_t { clear, any };

    /// Clips the first suitable corner, starting after the last clipped one.
    template <class Test>
    bool clip_first(Test&& may_go) {
        std::uint32_t corner = at_;
        for (std::uint32_t tried = 0; tried < left_; ++tried, corner = next_[corner]) {
            if (steps_ > kMaxSteps) return false;
            if (!may_go(corner)) continue;
            clip(corner);
            return true;
        }
        return false;
    }

    void clip(std::uint32_t corner) {
        const std::uint32_t before = previous_[corner];
        const std::uint32_t after = next_[corner];
        triangles_.push_back({before, corner, after});
        next_[before] = after;
        previous_[after] = before;
        at_ = after;
        --left_;
    }

    [[nodiscard]] int turn(std::uint32_t i) const {
        return exact::orient2d(flat_[previous_[i]], flat_[i], flat_[next_[i]]);
    }

    bool is_spike(std::uint32_t i) {
        ++steps_;
        const Double2& before = flat_[previous_[i]];
        const Double2& after = flat_[next_[i]];
        if (equal(before, flat_[i]) || equal(after, flat_[i])) return true;
        return turn(i) == 0 && !is_between(before, flat_[i], after);
    }

    bool is_ear(std::uint32_t i, Cut cut) {
        ++steps_;
        if (turn(i) <= 0) return false;
        const Ear ear{flat_[previous_[i]], flat_[i], flat_[next_[i]]};
        const FlatBox first = box_of(ear.a, ear.b);
        const FlatBox box{{std::min(first.lower.x, ear.c.x), std::min(first.lower.y, ear.c.y)},
                          {std::max(first.upper.x, ear.c.x), std::max(first.upper.y, ear.c.y)}};
        for (std::uint32_t p = next_[i]; p != previous_[i]; p = next_[p]) {
            ++steps_;
            const Double2& from = flat_[p];
            const Double2& to = flat_[next_[p]];
            if (!overlap(box, box_of(from, to))) continue;
            if (enters(ear, from, to)) return false;
            if (cut == Cut::clear && is_between(ear.a, from, ear.c) &&
                exact::orient2d(ear.a, from, ear.c) == 0) {
                return false;
            }
        }
        return true;
    }

    void force_rest() {
        for (std::uint32_t i = next_[at_]; next_[i] != at_; i = next_[i]) {
            triangles_.push_back({at_, i, next_[i]});
        }
    }

    std::span<const Double2> flat_;
    std::vector<Corners>& triangles_;
    std::vector<std::uint32_t> next_, previous_;
    std::uint32_t at_ = 0;
    std::uint32_t left_ = 0;
    std::uint64_t steps_ = 0;
};

}  // namespace

PolygonCut triangulate_polygon(std::span<const Double3> outline, std::vector<Corners>& triangles) {
    if (outline.size() < 3) return PolygonCut::convex;
    const std::vector<Double2> flat = project(outline);
    if (outline.size() == 3 || is_strictly_convex(flat)) {
        for (std::uint32_t i = 1; i + 1 < outline.size(); ++i) triangles.push_back({0, i, i + 1});
        return PolygonCut::convex;
    }
    return EarClipper(flat, triangles).run();
}

}  // namespace cdprep::mesh
