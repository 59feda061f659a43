// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/radial_cover.h"

#include <CGAL/Exact_rational.h>
#include <CGAL/Interval_nt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "mesh/vectors.h"
#include "predicates.h"
#include "triangle_contact.h"

// A region of directions is a set of convex cones, each the common part of half-spaces
// {d : n . d >= 0} whose border planes go round it. Its corner between planes i and j
// that follow each other is the direction n_i x n_j, so on which side of plane k it lies
// is the sign of det(n_i, n_j, n_k). All planes are given by the mesh itself:
//   - through the centre and an edge (a, b) of a triangle: n = a x b;
//   - between the directions in which s is farther out than t: with N_s, N_t normals and
//     h_s, h_t > 0 their distances from the centre times their lengths, s is met at
//     r = h_s / (N_s . d), so n = h_s N_t - h_t N_s.
// So signs are of bounded degree however often a region is cut. (Corners relative to the
// centre throughout.)

namespace cdprep::mesh {
namespace {

using Interval = CGAL::Interval_nt<false>;
using Exact = CGAL::Exact_rational;

using mesh::cross;
using mesh::dot;

template <class Number>
using Vector = std::array<Number, 3>;

template <class Number>
Vector<Number> cross(const Vector<Number>& a, const Vector<Number>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template <class Number>
Number dot(const Vector<Number>& a, const Vector<Number>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class Number>
Vector<Number> sum(const Vector<Number>& a, const Vector<Number>& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

/// Where n = h N is kept as the two: a normal and the volume that goes with it.
template <class Number>
struct Supporting {
    Vector<Number> normal;
    Number height;
};

constexpr std::uint32_t kNoVertex = 0xffffffffU;

/// A half-space with the centre on its border.
struct HalfSpace {
    bool is_beyond;        ///< where `first` is farther out than `second`; else of an edge
    std::uint32_t first;   ///< vertex, or triangle
    std::uint32_t second;  ///< the same
    std::array<std::uint32_t, 2> on;  ///< vertices that the border holds, or kNoVertex
    Vector<Interval> normal;
};

bool is_on(const HalfSpace& plane, std::uint32_t vertex) {
    return vertex != kNoVertex && (plane.on[0] == vertex || plane.on[1] == vertex);
}

/// Both borders are the plane of one edge.
bool are_of_one_edge(const HalfSpace& a, const HalfSpace& b) {
    return !a.is_beyond && !b.is_beyond && is_on(b, a.on[0]) && is_on(b, a.on[1]);
}

/// What bounds a triangle as seen from the centre: a circle of directions, and distances.
/// Rounded: off by far less than kCapSlack, of one or of themselves.
struct Cap {
    Double3 middle;  ///< unit length
    double cosine;   ///< of the circle's radius; below -1: all directions
    double sine;
    double nearest;
    double farthest;
};

constexpr double kCapSlack = 0x1p-40;

double length(const Double3& v) {
    return std::hypot(v.x, v.y, v.z);
}

/// Scaled to unit length; whatever the scale, no square leaves the range.
Double3 direction(const Double3& v) {
    const double size = length(v);
    return {v.x / size, v.y / size, v.z / size};
}

/// Of the triangle's plane, which no point of it is nearer than, less what rounding may
/// do: the edges' ends are off by 2^-52 of how far they are, and a thin triangle's normal
/// by as much more as it is thin. 0 where that is all there is.
double least_distance(const Double3& a, const Double3& b, const Double3& c, double farthest) {
    const Double3 ab = minus(b, a);
    const Double3 ac = minus(c, a);
    const Double3 normal = cross(direction(ab), direction(ac));
    const double error = (0x1p-48 + 0x1p-48 * farthest / std::min(length(ab), length(ac))) /
                         std::min(1.0, length(normal));
    const double height = std::fabs(dot(direction(normal), a)) - farthest * error;
    return height > 0 ? height * (1 - kCapSlack) : 0;  // 0 too for what is no number
}

Cap cap_of(const Double3& a, const Double3& b, const Double3& c) {
    const std::array<Double3, 3> corners = {a, b, c};
    constexpr Cap kEverything = {{0, 0, 0}, -2, 0, 0, std::numeric_limits<double>::infinity()};
    Double3 sum = {0, 0, 0};
    for (const Double3& p : corners) {
        const Double3 d = direction(p);
        sum = {sum.x + d.x, sum.y + d.y, sum.z + d.z};
    }
    Cap cap{direction(sum), 1, 0, 0, 0};
    for (const Double3& p : corners) {
        cap.cosine = std::min(cap.cosine, dot(cap.middle, direction(p)));
        cap.farthest = std::max(cap.farthest, length(p));
    }
    // Half a turn and more, or corners at the centre, or too large to tell.
    if (!(cap.cosine > 0.1) || !std::isfinite(cap.farthest)) return kEverything;
    cap.sine = std::sqrt(1 - cap.cosine * cap.cosine);
    cap.nearest = least_distance(a, b, c, cap.farthest);
    return cap;
}

/// Whether some point of `s` may lie beyond one of `t` in a direction of both.
bool may_hide(const Cap& s, const Cap& t) {
    if (s.farthest * (1 + kCapSlack) < t.nearest) return false;
    if (s.cosine < -1 || t.cosine < -1) return true;
    return dot(s.middle, t.middle) >= s.cosine * t.cosine - s.sine * t.sine - kCapSlack;
}

/// A convex cone: numbers of half-spaces, in the order in which their borders go round it.
using Cone = std::vector<std::uint32_t>;

}  // namespace

struct RadialCover::Data {
    Double3 centre;
    std::span<const Double3> positions;
    std::span<const Triangle> triangles;
    std::vector<std::int8_t> turn;  ///< by triangle: 1 outwards, -1 inwards, 0 edge-on
    std::vector<Cap> cap;           ///< by triangle

    template <class Number>
    [[nodiscard]] Vector<Number> corner(std::uint32_t vertex) const {
        const Double3& p = positions[vertex];
        return {Number(p.x) - Number(centre.x), Number(p.y) - Number(centre.y),
                Number(p.z) - Number(centre.z)};
    }

    /// Corners so that they turn outwards as seen from the centre.
    [[nodiscard]] std::array<std::uint32_t, 3> outwards(std::uint32_t triangle) const {
        std::array<std::uint32_t, 3> v = triangles[triangle].vertex;
        if (turn[triangle] < 0) std::swap(v[1], v[2]);
        return v;
    }

    template <class Number>
    [[nodiscard]] Supporting<Number> supporting(std::uint32_t triangle) const {
        const auto v = outwards(triangle);
        const auto a = corner<Number>(v[0]);
        const auto b = corner<Number>(v[1]);
        const auto c = corner<Number>(v[2]);
        const Vector<Number> ab = cross(a, b);
        return {sum(sum(ab, cross(b, c)), cross(c, a)), dot(ab, c)};
    }

    template <class Number>
    [[nodiscard]] Vector<Number> edge_normal(std::uint32_t from, std::uint32_t to) const {
        return cross(corner<Number>(from), corner<Number>(to));
    }

    template <class Number>
    [[nodiscard]] Vector<Number> beyond_normal(std::uint32_t s, std::uint32_t t) const {
        const Supporting<Number> of_s = supporting<Number>(s);
        const Supporting<Number> of_t = supporting<Number>(t);
        Vector<Number> normal;
        for (std::size_t i = 0; i < 3; ++i) {
            normal[i] = of_s.height * of_t.normal[i] - of_t.height * of_s.normal[i];
        }
        return normal;
    }

    [[nodiscard]] Vector<Exact> exact_normal(const HalfSpace& plane) const {
        return plane.is_beyond ? beyond_normal<Exact>(plane.first, plane.second)
                               : edge_normal<Exact>(plane.first, plane.second);
    }

    [[nodiscard]] HalfSpace of_edge(std::uint32_t from, std::uint32_t to) const {
        return {false, from, to, {from, to}, edge_normal<Interval>(from, to)};
    }

    [[nodiscard]] HalfSpace beyond(std::uint32_t s, std::uint32_t t) const {
        HalfSpace plane{true, s, t, {kNoVertex, kNoVertex}, beyond_normal<Interval>(s, t)};
        std::size_t count = 0;
        for (const std::uint32_t vertex : triangles[s].vertex) {
            const auto& other = triangles[t].vertex;
            const bool is_common = std::find(other.begin(), other.end(), vertex) != other.end();
            if (is_common && count < plane.on.size()) plane.on[count++] = vertex;
        }
        return plane;
    }

    [[nodiscard]] Corners corners(std::uint32_t triangle) const {
        const auto& v = triangles[triangle].vertex;
        return {positions[v[0]], positions[v[1]], positions[v[2]]};
    }

    /// Those of `others` that cover directions, by what bounds them perhaps its own.
    [[nodiscard]] std::vector<std::uint32_t> neighbours(
        std::uint32_t triangle, std::span<const std::uint32_t> others) const {
        std::vector<std::uint32_t> result;
        for (const std::uint32_t other : others) {
            const bool is_one =
                other != triangle && turn[other] != 0 && may_hide(cap[other], cap[triangle]);
            if (is_one) result.push_back(other);
        }
        return result;
    }

    /// One plane holds both, which then are nowhere farther out than one another.
    [[nodiscard]] bool are_coplanar(std::uint32_t s, std::uint32_t t) const {
        const Corners of_t = corners(t);
        const Corners of_s = corners(s);
        return std::all_of(of_s.begin(), of_s.end(), [&](const Double3& p) {
            return orient3d(of_t[0], of_t[1], of_t[2], p) == 0;
        });
    }
};

namespace {

using Data = RadialCover::Data;

int sign_of(const Interval& x) {
    return x.inf() > 0 ? 1 : x.sup() < 0 ? -1 : 0;
}

bool is_decided(const Interval& x) {
    return x.inf() > 0 || x.sup() < 0 || (x.inf() == 0 && x.sup() == 0);
}

/// What is left of one triangle's directions.
class Region {
public:
    Region(const Data& data, std::uint32_t triangle) : data_(data), triangle_(triangle) {
        Cone all;
        add_edges(triangle, all);
        cones_.push_back(std::move(all));
    }

    [[nodiscard]] bool is_empty() const {
        return cones_.empty();
    }

    /// Takes away the directions in which `other`, not edge-on, is farther out.
    void subtract(std::uint32_t other) {
        const std::size_t known = planes_.size();
        Cone cutters;
        add_edges(other, cutters);
        planes_.push_back(data_.beyond(other, triangle_));
        cutters.push_back(static_cast<std::uint32_t>(planes_.size() - 1));
        std::vector<Cone> left;
        bool cuts = false;
        for (Cone& cone : cones_) {
            if (is_apart(cone, cutters)) {
                left.push_back(std::move(cone));
            } else {
                cuts = true;
                keep_outside(std::move(cone), cutters, left);
            }
        }
        cones_ = std::move(left);
        if (!cuts) planes_.resize(known);
    }

private:
    void add_edges(std::uint32_t triangle, Cone& cone) {
        const auto v = data_.outwards(triangle);
        for (std::size_t i = 0; i < 3; ++i) {
            cone.push_back(static_cast<std::uint32_t>(planes_.size()));
            planes_.push_back(data_.of_edge(v[i], v[(i + 1) % 3]));
        }
    }

    /// On which side of plane k the corner between planes i and j lies.
    [[nodiscard]] int side(std::uint32_t i, std::uint32_t j, std::uint32_t k) const {
        const HalfSpace& a = planes_[i];
        const HalfSpace& b = planes_[j];
        const HalfSpace& c = planes_[k];
        // What is zero by construction need not be found so by big numbers.
        if (i == k || j == k || are_of_one_edge(a, c) || are_of_one_edge(b, c)) return 0;
        for (const std::uint32_t vertex : c.on) {
            if (is_on(a, vertex) && is_on(b, vertex)) return 0;
        }
        const Interval rounded = dot(cross(a.normal, b.normal), c.normal);
        if (is_decided(rounded)) return sign_of(rounded);
        const Exact exact =
            dot(cross(data_.exact_normal(a), data_.exact_normal(b)), data_.exact_normal(c));
        return exact > 0 ? 1 : exact < 0 ? -1 : 0;
    }

    /// Sides of plane k on which the corners lie; corner m is between borders m and m + 1.
    [[nodiscard]] std::vector<int> sides(const Cone& cone, std::uint32_t k) const {
        std::vector<int> result;
        for (std::size_t m = 0; m < cone.size(); ++m) {
            result.push_back(side(cone[m], cone[(m + 1) % cone.size()], k));
        }
        return result;
    }

    /// No inside in common with the half-spaces together, as far as one of them tells.
    [[nodiscard]] bool is_apart(const Cone& cone, const Cone& cutters) const {
        return std::any_of(cutters.begin(), cutters.end(), [&](std::uint32_t k) {
            const std::vector<int> at = sides(cone, k);
            return std::none_of(at.begin(), at.end(), [](int s) { return s > 0; });
        });
    }

    /// The part of the cone on one side of plane k, 1 or -1, where it has corners.
    [[nodiscard]] static Cone part(const Cone& cone, const std::vector<int>& at, std::uint32_t k,
                                   int wanted) {
        Cone result;
        const std::size_t count = cone.size();
        for (std::size_t m = 0; m < count; ++m) {
            // Border m runs from corner m - 1 to corner m.
            const int from = at[(m + count - 1) % count];
            const int to = at[m];
            if (from != wanted && to != wanted) continue;
            result.push_back(cone[m]);
            if (from == wanted && to != wanted) result.push_back(k);
        }
        return result;
    }

    /// Adds to `left` what of the cone lies outside the cutters' common part.
    void keep_outside(Cone cone, const Cone& cutters, std::vector<Cone>& left) {
        for (const std::uint32_t k : cutters) {
            const std::vector<int> at = sides(cone, k);
            const bool inside = std::any_of(at.begin(), at.end(), [](int s) { return s > 0; });
            const bool outside = std::any_of(at.begin(), at.end(), [](int s) { return s < 0; });
            if (!inside) {
                left.push_back(std::move(cone));
                return;
            }
            if (!outside) continue;
            left.push_back(part(cone, at, opposite(k), -1));
            cone = part(cone, at, k, 1);
        }
    }

    /// The half-space on the other side of the same border.
    std::uint32_t opposite(std::uint32_t k) {
        HalfSpace plane = planes_[k];
        std::swap(plane.first, plane.second);
        for (Interval& x : plane.normal) x = -x;
        planes_.push_back(plane);
        return static_cast<std::uint32_t>(planes_.size() - 1);
    }

    const Data& data_;
    std::uint32_t triangle_;
    std::vector<HalfSpace> planes_;
    std::vector<Cone> cones_;
};

/// Directions for a first look: the middle, then near the corners.
constexpr std::array<std::array<double, 3>, 4> kLooks = {
    {{1, 1, 1}, {14, 1, 1}, {1, 14, 1}, {1, 1, 14}}};

/// Whether none of `others` lies farther out than the triangle in a direction inside it,
/// for certain.
bool is_bare_at(const Data& data, std::uint32_t triangle, std::span<const std::uint32_t> others,
                const std::array<double, 3>& weights) {
    const auto v = data.outwards(triangle);
    Vector<Interval> direction = {0, 0, 0};  // an interval is not zero by itself
    for (std::size_t i = 0; i < 3; ++i) {
        const auto corner = data.corner<Interval>(v[i]);
        for (std::size_t axis = 0; axis < 3; ++axis) direction[axis] += weights[i] * corner[axis];
    }
    return std::all_of(others.begin(), others.end(), [&](std::uint32_t s) {
        const auto w = data.outwards(s);
        for (std::size_t i = 0; i < 3; ++i) {
            const auto normal = data.edge_normal<Interval>(w[i], w[(i + 1) % 3]);
            if (sign_of(dot(normal, direction)) < 0) return true;
        }
        return sign_of(dot(data.beyond_normal<Interval>(s, triangle), direction)) < 0;
    });
}

bool is_bare(const Data& data, std::uint32_t triangle, std::span<const std::uint32_t> others) {
    const Interval::Protector upwards;
    return std::any_of(kLooks.begin(), kLooks.end(), [&](const auto& weights) {
        return is_bare_at(data, triangle, others, weights);
    });
}

}  // namespace

RadialCover::RadialCover(const Double3& centre, std::span<const Double3> positions,
                         std::span<const Triangle> triangles)
    : data_(std::make_unique<Data>(Data{centre, positions, triangles, {}, {}})) {
    data_->turn.reserve(triangles.size());
    data_->cap.reserve(triangles.size());
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        const Corners t = data_->corners(i);
        data_->turn.push_back(static_cast<std::int8_t>(orient3d(t[0], t[1], t[2], centre)));
        data_->cap.push_back(cap_of(minus(t[0], centre), minus(t[1], centre), minus(t[2], centre)));
    }
}

RadialCover::RadialCover(RadialCover&&) noexcept = default;
RadialCover& RadialCover::operator=(RadialCover&&) noexcept = default;
RadialCover::~RadialCover() = default;

bool RadialCover::is_edge_on(std::uint32_t triangle) const {
    return data_->turn[triangle] == 0;
}

bool RadialCover::is_hidden(std::uint32_t triangle, std::span<const std::uint32_t> others) const {
    if (is_edge_on(triangle)) return false;
    std::vector<std::uint32_t> hiders = data_->neighbours(triangle, others);
    if (is_bare(*data_, triangle, hiders)) return false;
    // Before intervals round upwards: orient3d() wants to round to the nearest.
    std::erase_if(hiders, [&](std::uint32_t s) { return data_->are_coplanar(s, triangle); });
    const Interval::Protector upwards;
    Region left(*data_, triangle);
    for (const std::uint32_t other : hiders) {
        left.subtract(other);
        if (left.is_empty()) return true;
    }
    return false;
}

}  // namespace cdprep::mesh
