// SPDX-License-Identifier: GPL-3.0-or-later
#include "query/inaccessible/radial_cover.h"

#include <CGAL/Interval_nt.h>
#include <gmpxx.h>

#include <algorithm>
#include <vector>

#include "cdprep/exact/predicates.h"
#include "cdprep/exact/triangles.h"
#include "mesh/vectors.h"

// A region of directions is a set of convex cones. Each cone is the intersection of half-spaces
// {d : n . d >= 0}, in the order of their boundary planes around it. Its corner between consecutive
// planes i and j is the direction n_i x n_j. The sign of det(n_i, n_j, n_k) is the side of plane k
// on which this corner lies. The mesh itself gives all planes:
//   - through the centre and an edge (a, b) of a triangle: n = a x b;
//   - around the directions in which s is farther out than t. Let N_s, N_t be normals, and
//     h_s, h_t > 0 the distances of their planes from the centre times their lengths. A ray meets
//     s at r = h_s / (N_s . d), so n = h_s N_t - h_t N_s.
// So signs have bounded degree, however often a region is cut. All corners are relative to the
// centre.

namespace cdprep::mesh {
namespace {

using Interval = CGAL::Interval_nt<false>;
using Exact = mpq_class;

template <class Number>
using Vector = std::array<Number, 3>;

/// The plane of a triangle, as its normal N and its height h: N . p = h for points p in it.
template <class Number>
struct Supporting {
    Vector<Number> normal;
    Number height;
};

constexpr std::uint32_t kNoVertex = 0xffffffffU;

/// A half-space with the centre on its boundary plane.
struct HalfSpace {
    bool is_beyond;        ///< where `first` is farther out than `second`; else of an edge
    std::uint32_t first;   ///< a triangle if is_beyond, else a vertex
    std::uint32_t second;  ///< the same
    std::array<std::uint32_t, 2> on;  ///< known vertices on the boundary plane, or kNoVertex
    Vector<Interval> normal;
};

bool is_on(const HalfSpace& plane, std::uint32_t vertex) {
    return vertex != kNoVertex && (plane.on[0] == vertex || plane.on[1] == vertex);
}

/// Returns whether both boundary planes are known to be the plane of one edge.
bool are_of_one_edge(const HalfSpace& a, const HalfSpace& b) {
    return !a.is_beyond && !b.is_beyond && is_on(b, a.on[0]) && is_on(b, a.on[1]);
}

/// One of the half-spaces whose intersection is a cone.
struct Border {
    std::uint32_t plane;   ///< number of the half-space
    Vector<Interval> ray;  ///< the corner between this border and the next
};

/// A convex cone: its borders in their order around it.
using Cone = std::vector<Border>;

bool has_inside(const std::array<int, 3>& sides) {
    return sides[0] > 0 || sides[1] > 0 || sides[2] > 0;
}

bool has_outside(const std::array<int, 3>& sides) {
    return sides[0] < 0 || sides[1] < 0 || sides[2] < 0;
}

/// The directions of a triangle in which another triangle is farther out.
enum class Over { nowhere, perhaps, everywhere };

}  // namespace

struct RadialCover::Data {
    Double3 centre;
    std::span<const Double3> positions;
    std::span<const Triangle> triangles;
    std::vector<std::int8_t> turn;  ///< by triangle: 1 outwards, -1 inwards, 0 edge-on

    template <class Number>
    [[nodiscard]] Vector<Number> corner(std::uint32_t vertex) const {
        const Double3& p = positions[vertex];
        return {Number(p.x) - Number(centre.x), Number(p.y) - Number(centre.y),
                Number(p.z) - Number(centre.z)};
    }

    /// Returns the corners in the order that turns outwards as seen from the centre.
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
        return {plus(plus(ab, cross(b, c)), cross(c, a)), dot(ab, c)};
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

    [[nodiscard]] Corners places(const std::array<std::uint32_t, 3>& v) const {
        return {positions[v[0]], positions[v[1]], positions[v[2]]};
    }

    /// Returns the side of an edge's plane for each of three vertices. 1 is the inner side of a
    /// triangle that has this edge and turns outwards.
    [[nodiscard]] std::array<int, 3> sides_of_edge(
        std::uint32_t from, std::uint32_t to, const std::array<std::uint32_t, 3>& vertices) const {
        return exact::plane_signs({centre, positions[to], positions[from]}, places(vertices));
    }

    /// Returns the directions of `t` in which `s` is farther out. Neither may be edge-on. Signs at
    /// corners decide, since both triangles and the space below the plane of `s` are convex. The
    /// result is `nowhere` if all corners of one triangle are outside or on a border of the other.
    /// So two triangles in one plane give `nowhere`. The result is `everywhere` if no corner of `t`
    /// is outside any border of `s`.
    [[nodiscard]] Over over(std::uint32_t s, std::uint32_t t) const {
        const auto v = outwards(s);
        const auto w = outwards(t);
        // Corners on the centre's side of the plane of `s` are nearer than `s`.
        const std::array<int, 3> below = exact::plane_signs(places(v), places(w));
        if (!has_inside(below)) return Over::nowhere;
        bool is_everywhere = !has_outside(below);
        for (std::size_t i = 0; i < 3; ++i) {
            const std::array<int, 3> at = sides_of_edge(v[i], v[(i + 1) % 3], w);
            if (!has_inside(at)) return Over::nowhere;
            is_everywhere = is_everywhere && !has_outside(at);
        }
        if (is_everywhere) return Over::everywhere;
        for (std::size_t i = 0; i < 3; ++i) {
            if (!has_inside(sides_of_edge(w[i], w[(i + 1) % 3], v))) return Over::nowhere;
        }
        return Over::perhaps;
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

/// The directions of one triangle that remain after subtraction.
class Region {
public:
    Region(const Data& data, std::uint32_t triangle) : data_(data), triangle_(triangle) {
        Cone all;
        for (const std::uint32_t k : add_edges(triangle)) all.push_back({k, {}});
        for (std::size_t m = 0; m < all.size(); ++m) find_ray(all, m);
        cones_.push_back(std::move(all));
    }

    [[nodiscard]] bool is_empty() const {
        return cones_.empty();
    }

    /// Removes the directions in which `other` is farther out. It must not be edge-on.
    void subtract(std::uint32_t other) {
        const std::size_t known = planes_.size();
        const auto edges = add_edges(other);
        planes_.push_back(data_.beyond(other, triangle_));
        const Cutters cutters = {edges[0], edges[1], edges[2],
                                 static_cast<std::uint32_t>(planes_.size() - 1)};
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
    using Cutters = std::array<std::uint32_t, 4>;

    std::array<std::uint32_t, 3> add_edges(std::uint32_t triangle) {
        const auto v = data_.outwards(triangle);
        const auto first = static_cast<std::uint32_t>(planes_.size());
        for (std::size_t i = 0; i < 3; ++i) planes_.push_back(data_.of_edge(v[i], v[(i + 1) % 3]));
        return {first, first + 1, first + 2};
    }

    void find_ray(Cone& cone, std::size_t m) const {
        const Border& next = cone[(m + 1) % cone.size()];
        cone[m].ray = cross(planes_[cone[m].plane].normal, planes_[next.plane].normal);
    }

    /// Returns the side of plane k on which the corner of two consecutive borders lies.
    [[nodiscard]] int side(const Border& border, const Border& next, std::uint32_t k) const {
        if (border.plane == k || next.plane == k) return 0;
        const HalfSpace& a = planes_[border.plane];
        const HalfSpace& b = planes_[next.plane];
        const HalfSpace& c = planes_[k];
        // Find zeros by construction without slow exact numbers.
        if (are_of_one_edge(a, c) || are_of_one_edge(b, c)) return 0;
        for (const std::uint32_t vertex : c.on) {
            if (is_on(a, vertex) && is_on(b, vertex)) return 0;
        }
        const Interval rounded = dot(border.ray, c.normal);
        if (is_decided(rounded)) return sign_of(rounded);
        const Exact exact =
            dot(cross(data_.exact_normal(a), data_.exact_normal(b)), data_.exact_normal(c));
        return exact > 0 ? 1 : exact < 0 ? -1 : 0;
    }

    /// Finds the side of plane k for each corner. Corner m is between borders m and m + 1.
    void find_sides(const Cone& cone, std::uint32_t k) {
        at_.clear();
        for (std::size_t m = 0; m < cone.size(); ++m) {
            at_.push_back(side(cone[m], cone[(m + 1) % cone.size()], k));
        }
    }

    [[nodiscard]] bool has_corner_at(int wanted) const {
        return std::find(at_.begin(), at_.end(), wanted) != at_.end();
    }

    /// Returns whether one of the half-spaces shares no interior with the cone. False does not
    /// prove that the cone and the intersection of the half-spaces share interior.
    [[nodiscard]] bool is_apart(const Cone& cone, const Cutters& cutters) {
        return std::any_of(cutters.begin(), cutters.end(), [&](std::uint32_t k) {
            find_sides(cone, k);
            return !has_corner_at(1);
        });
    }

    /// Returns the part of the cone on one side of plane k, 1 or -1. By find_sides(), the cone must
    /// have corners on both sides.
    [[nodiscard]] Cone part(const Cone& cone, std::uint32_t k, int wanted) const {
        Cone result;
        result.reserve(cone.size() + 1);
        std::size_t cut = 0;
        const std::size_t count = cone.size();
        for (std::size_t m = 0; m < count; ++m) {
            // Border m runs from corner m - 1 to corner m.
            const int from = at_[(m + count - 1) % count];
            const int to = at_[m];
            if (from != wanted && to != wanted) continue;
            result.push_back(cone[m]);
            if (from != wanted || to == wanted) continue;
            cut = result.size();
            result.push_back({k, {}});
        }
        find_ray(result, cut - 1);
        find_ray(result, cut);
        return result;
    }

    /// Adds to `left` the parts of the cone outside the intersection of the cutters.
    void keep_outside(Cone cone, const Cutters& cutters, std::vector<Cone>& left) {
        for (const std::uint32_t k : cutters) {
            find_sides(cone, k);
            if (!has_corner_at(1)) {
                left.push_back(std::move(cone));
                return;
            }
            if (!has_corner_at(-1)) continue;
            left.push_back(part(cone, opposite(k), -1));
            cone = part(cone, k, 1);
        }
    }

    /// Adds the half-space on the other side of the same plane and returns its number.
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
    std::vector<int> at_;  ///< the result of find_sides()
};

/// Weights of the corners for sample directions: the middle, then near each corner.
constexpr std::array<std::array<double, 3>, 4> kLooks = {
    {{1, 1, 1}, {14, 1, 1}, {1, 14, 1}, {1, 1, 14}}};

/// Returns whether certainly none of `others` is farther out than the triangle in the direction
/// that the weights give.
bool is_bare_at(const Data& data, std::uint32_t triangle, std::span<const std::uint32_t> others,
                const std::array<double, 3>& weights) {
    const auto v = data.outwards(triangle);
    Vector<Interval> direction = {0, 0, 0};  // the default value of an interval is not zero
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
    return std::any_of(kLooks.begin(), kLooks.end(), [&](const auto& weights) {
        return is_bare_at(data, triangle, others, weights);
    });
}

}  // namespace

RadialCover::RadialCover(const Double3& centre, std::span<const Double3> positions,
                         std::span<const Triangle> triangles)
    : data_(std::make_unique<Data>(Data{centre, positions, triangles, {}})) {
    data_->turn.reserve(triangles.size());
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        const Corners t = data_->corners(i);
        data_->turn.push_back(static_cast<std::int8_t>(exact::orient3d(t[0], t[1], t[2], centre)));
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
    // This loop precedes the upward rounding for intervals: orient3d() rounds to nearest.
    std::vector<std::uint32_t> hiders;
    for (const std::uint32_t other : others) {
        if (other == triangle || is_edge_on(other)) continue;
        const Over over = data_->over(other, triangle);
        if (over == Over::everywhere) return true;
        if (over == Over::perhaps) hiders.push_back(other);
    }
    const Interval::Protector upwards;
    if (is_bare(*data_, triangle, hiders)) return false;
    Region left(*data_, triangle);
    for (const std::uint32_t other : hiders) {
        left.subtract(other);
        if (left.is_empty()) return true;
    }
    return false;
}

}  // namespace cdprep::mesh
