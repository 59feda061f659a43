// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/enclose/drop_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "cdprep/exact/triangles.h"
#include "decompose/enclose/part_points.h"
#include "decompose/enclose/plane.h"
#include "mesh/point_tree.h"
#include "mesh/vectors.h"

// Let P be the points of a hull. Some of them are removed, and each removed point has a new point
// in front of all planes through it. Then the hull of the others and the new points contains P.
// Otherwise some direction n would separate a removed point u from them. Let x be the point of P
// that is farthest along n; x was removed. Its planes' normals span a cone that contains n, so its
// new point lies at least as far along n as x, and that is at least as far as u. So any number of
// points can be replaced at once.
namespace cdprep::convex {
namespace {

using mesh::cross;
using mesh::dot;
using mesh::minus;
using mesh::plus;
using mesh::scaled;

// The numbers without a source or reason were chosen by trial. They trade points that stay low,
// and growth, against time. tests/engines checks how many points engines keep.

/// Of half the sum of the box's sides: the default of PhysX 5 (PxCookingParams::planeTolerance).
constexpr double kIgnored = 0.0007;
constexpr double kMargin = 1.5;             ///< factor: for the floats and partial hulls of engines
constexpr std::size_t kMostRounds = 64;     ///< of replacements: limits the time
constexpr std::uint32_t kFewestPoints = 4;  ///< a hull with a volume has no fewer
/// A hull grows by more than the height only while more than one point in so many is low. The last
/// ones would take most of the growth.
constexpr std::size_t kFewLow = 50;
/// The first distance of new points in front of planes, in units of the largest coordinate: the
/// rounding error of a coordinate. It grows until the exact test passes.
constexpr double kFirstPad = 0x1p-50;
constexpr double kPadGrowth = 16;
constexpr int kPads = 6;  ///< the last is 2^-30; then fewer points are replaced at once
constexpr std::size_t kMostNeighbours = 12;  ///< tried for each low point, the nearest first
constexpr int kSweeps = 24;                  ///< over planes; what is left is added along a way
constexpr double kLeastSlope = 0.05;         ///< sine of a way out against a plane: no shallower
constexpr double kThin = 0x1p-20;  ///< sine in a facet below which its rounded normal is no use

/// The plane of a face, through a point of it: heights are exact up to rounding near that point.
struct HullPlane {
    Double3 normal;  ///< of length 1
    Double3 at;

    [[nodiscard]] double height(const Double3& p) const {
        return dot(normal, minus(p, at));
    }
};

/// Returns the planes of the groups; empty if a normal is beyond the range of double.
std::vector<HullPlane> planes_of(const ConvexHull& hull) {
    std::vector<HullPlane> faces;
    for (std::size_t g = 0; g + 1 < hull.groups.size(); ++g) {
        HullPlane face = {};
        double most = -1;
        bool is_thin = false;
        Corners corners = {};
        for (std::uint32_t f = hull.groups[g]; f < hull.groups[g + 1]; ++f) {
            const auto& [a, b, c] = hull.facets[f];
            const Double3& at = hull.points[a];
            const Double3 u = minus(hull.points[b], at), v = minus(hull.points[c], at);
            const Double3 normal = cross(u, v);
            const double length = std::sqrt(dot(normal, normal));
            if (!(length > most) || !std::isfinite(length)) continue;
            most = length;
            face = {length > 0 ? scaled(normal, 1 / length) : Double3{}, at};
            const double longest = mesh::length(u) * mesh::length(v);
            is_thin = length < kThin * longest && std::isfinite(longest);
            corners = {at, hull.points[b], hull.points[c]};
        }
        if (is_thin) face.normal = exact_plane(corners[0], corners[1], corners[2]).normal;
        if (!(dot(face.normal, face.normal) > 0)) return {};
        faces.push_back(face);
    }
    return faces;
}

/// The faces and the points around each point of a hull.
class Stars {
public:
    explicit Stars(const ConvexHull& hull) : faces_(hull.points.size()), points_(faces_.size()) {
        for (std::uint32_t g = 0; g + 1 < hull.groups.size(); ++g) {
            for (std::uint32_t f = hull.groups[g]; f < hull.groups[g + 1]; ++f) {
                for (std::size_t i = 0; i < 3; ++i) {
                    const std::uint32_t point = hull.facets[f][i];
                    if (faces_[point].empty() || faces_[point].back() != g) {
                        faces_[point].push_back(g);
                    }
                    // Every edge is in both directions, so each neighbour comes once.
                    points_[point].push_back(hull.facets[f][(i + 1) % 3]);
                }
            }
        }
    }
    [[nodiscard]] const std::vector<std::uint32_t>& faces(std::uint32_t point) const {
        return faces_[point];
    }
    [[nodiscard]] const std::vector<std::uint32_t>& points(std::uint32_t point) const {
        return points_[point];
    }

private:
    std::vector<std::vector<std::uint32_t>> faces_;  ///< ascending
    std::vector<std::vector<std::uint32_t>> points_;
};

/// Two points and the way to the point that replaces them.
struct Merge {
    std::array<std::uint32_t, 2> points;
    Double3 base;
    Double3 way;    ///< of length 1
    double length;  ///< along the way from the base, up to all planes
    double slope;   ///< the least of the way against a plane
    double growth;  ///< of the hull, for a pad of 0

    [[nodiscard]] Double3 place(double pad) const {
        return plus(base, scaled(way, length + pad / slope));
    }
};

class PointDropper {
public:
    PointDropper(const ConvexHull& given, const DropOptions& options)
        : given_(given), options_(options), planes_of_given_(planes_of(given)) {
        for (const Double3& p : given.points) {
            largest_ = std::max(largest_, mesh::largest_of(p));
        }
    }

    DroppedPoints run() {
        ConvexHull hull = given_;
        double growth = 0;
        // Points that need little growth go first: later ones may then need less.
        double allowed = std::min(options_.height, options_.growth);
        for (std::size_t round = 0; round < kMostRounds && allowed > 0; ++round) {
            std::vector<Merge> merges = find_merges(hull, allowed);
            std::optional<Grown> grown;
            while (!grown && !merges.empty()) {
                grown = replace(hull, merges);
                merges.resize(merges.size() / 2);
            }
            if (grown) {
                hull = std::move(grown->hull);
                growth = std::max(growth, grown->growth);
            } else if (allowed < options_.growth && has_many_low(hull)) {
                allowed = std::min(2 * allowed, options_.growth);
            } else {
                break;
            }
        }
        DroppedPoints result{hull, growth, 0, 0};
        result.low = low_points(hull, Stars(hull)).size();
        for (const Double3& p : hull.points) result.moved += is_given(p) ? 0 : 1;
        return result;
    }

private:
    struct Low {
        double height;
        std::uint32_t point;
    };
    struct Grown {
        ConvexHull hull;
        double growth;
    };
    /// A hull in which points are replaced, and by how much it may grow.
    struct Place {
        const ConvexHull& hull;
        std::vector<HullPlane> planes;
        Stars stars;
        double allowed;
    };

    [[nodiscard]] bool is_given(const Double3& p) const {
        return std::find(given_.points.begin(), given_.points.end(), p) != given_.points.end();
    }

    /// Returns how far a point stands out of the hull of the others: its greatest height above a
    /// plane of theirs. The planes in front of which it lies are those of its neighbours.
    static double height_of(const ConvexHull& hull, const Stars& stars, std::uint32_t point) {
        std::vector<Double3> neighbours;
        for (const std::uint32_t other : stars.points(point)) {
            neighbours.push_back(hull.points[other]);
        }
        double most = 0;
        for (const HullPlane& face : planes_of(convex_hull(neighbours))) {
            most = std::max(most, face.height(hull.points[point]));
        }
        return most;
    }

    /// Returns the points that stand out too little, the lowest first.
    [[nodiscard]] std::vector<Low> low_points(const ConvexHull& hull, const Stars& stars) const {
        std::vector<Low> low;
        for (std::uint32_t point = 0; point < hull.points.size(); ++point) {
            const double height = height_of(hull, stars, point);
            if (height < options_.height) low.push_back({height, point});
        }
        std::sort(low.begin(), low.end(), [](const Low& a, const Low& b) {
            return a.height != b.height ? a.height < b.height : a.point < b.point;
        });
        return low;
    }

    [[nodiscard]] bool has_many_low(const ConvexHull& hull) const {
        return kFewLow * low_points(hull, Stars(hull)).size() > hull.points.size();
    }

    /// Returns a bound on the distance of a point in front of the given hull from it.
    [[nodiscard]] double distance_from_given(const Double3& p) const {
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t g = 0; g < planes_of_given_.size(); ++g) {
            if (planes_of_given_[g].height(p) < -kFirstPad * largest_) continue;
            for (std::uint32_t f = given_.groups[g]; f < given_.groups[g + 1]; ++f) {
                const auto& [a, b, c] = given_.facets[f];
                const Corners facet = {given_.points[a], given_.points[b], given_.points[c]};
                least = std::min(least, exact::point_triangle_distance(p, facet).upper);
            }
        }
        return least;
    }

    /// Returns nearly the nearest point to `base` that is in front of the planes (Hildreth 1957).
    static Double3 nearest_in_front(const Double3& base, std::span<const HullPlane> around) {
        std::vector<double> pull(around.size(), 0);
        Double3 p = base;
        for (int sweep = 0; sweep < kSweeps; ++sweep) {
            for (std::size_t i = 0; i < around.size(); ++i) {
                const double step = std::max(-pull[i], -around[i].height(p));
                pull[i] += step;
                p = plus(p, scaled(around[i].normal, step));
            }
        }
        return p;
    }

    /// Returns the way from near a base to a point in front of planes, or nothing if there is none.
    [[nodiscard]] std::optional<Merge> way_out(const Double3& near,
                                               std::span<const HullPlane> around,
                                               double allowed) const {
        const Double3 base = nearest_in_front(near, around);
        Double3 sum = {};
        for (const HullPlane& face : around) sum = plus(sum, face.normal);
        const double size = std::sqrt(dot(sum, sum));
        if (!(size > 0)) return std::nullopt;
        Merge merge = {{}, base, scaled(sum, 1 / size), 0, 1, 0};
        for (const HullPlane& face : around) {
            const double slope = dot(face.normal, merge.way);
            if (!(slope > kLeastSlope)) return std::nullopt;
            merge.slope = std::min(merge.slope, slope);
            merge.length = std::max(merge.length, -face.height(base) / slope);
        }
        merge.growth = distance_from_given(merge.place(kFirstPad * largest_));
        if (!(merge.growth < allowed)) return std::nullopt;
        return merge;
    }

    /// Returns the best point that replaces a point and a neighbour.
    [[nodiscard]] std::optional<Merge> best_of_pair(const Place& place, std::uint32_t point,
                                                    std::uint32_t other) const {
        std::vector<std::uint32_t> numbers = place.stars.faces(point);
        const std::vector<std::uint32_t>& more = place.stars.faces(other);
        numbers.insert(numbers.end(), more.begin(), more.end());
        std::sort(numbers.begin(), numbers.end());
        numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
        std::vector<HullPlane> around;
        around.reserve(numbers.size());
        for (const std::uint32_t number : numbers) around.push_back(place.planes[number]);
        std::optional<Merge> best;
        const Double3 &a = place.hull.points[point], &b = place.hull.points[other];
        for (const Double3& base : {b, mesh::middle_of(a, b), a}) {
            std::optional<Merge> merge = way_out(base, around, place.allowed);
            if (!merge || (best && best->growth <= merge->growth)) continue;
            best = merge;
            best->points = {point, other};
        }
        return best;
    }

    [[nodiscard]] std::optional<Merge> best_merge(const Place& place, std::uint32_t point,
                                                  const std::vector<bool>& is_used) const {
        const std::vector<Double3>& points = place.hull.points;
        std::vector<std::pair<double, std::uint32_t>> others;
        for (const std::uint32_t other : place.stars.points(point)) {
            if (is_used[other]) continue;
            others.emplace_back(mesh::squared_distance(points[point], points[other]), other);
        }
        std::sort(others.begin(), others.end());
        if (others.size() > kMostNeighbours) others.resize(kMostNeighbours);
        std::optional<Merge> best;
        for (const auto& [distance, other] : others) {
            std::optional<Merge> merge = best_of_pair(place, point, other);
            if (merge && (!best || merge->growth < best->growth)) best = merge;
        }
        return best;
    }

    /// Returns replacements of pairs that have no neighbours in common, and which grow by less than
    /// `allowed`. The lowest points are first.
    [[nodiscard]] std::vector<Merge> find_merges(const ConvexHull& hull, double allowed) const {
        const Place place = {hull, planes_of(hull), Stars(hull), allowed};
        std::vector<Merge> merges;
        if (place.planes.empty() || planes_of_given_.empty()) return merges;
        std::vector<bool> is_used(hull.points.size(), false);
        for (const Low& low : low_points(hull, place.stars)) {
            if (is_used[low.point]) continue;
            if (hull.points.size() - merges.size() <= kFewestPoints) break;
            const auto merge = best_merge(place, low.point, is_used);
            if (!merge) continue;
            merges.push_back(*merge);
            for (const std::uint32_t point : merge->points) {
                is_used[point] = true;
                for (const std::uint32_t other : place.stars.points(point)) is_used[other] = true;
            }
        }
        return merges;
    }

    /// Returns the hull with these points replaced, or nothing if no pad lets it pass the test.
    [[nodiscard]] std::optional<Grown> replace(const ConvexHull& hull,
                                               std::span<const Merge> merges) const {
        std::vector<bool> is_replaced(hull.points.size(), false);
        for (const Merge& merge : merges) {
            for (const std::uint32_t point : merge.points) is_replaced[point] = true;
        }
        double pad = kFirstPad * largest_;
        for (int i = 0; i < kPads; ++i, pad *= kPadGrowth) {
            std::vector<Double3> points;
            for (std::size_t k = 0; k < hull.points.size(); ++k) {
                if (!is_replaced[k]) points.push_back(hull.points[k]);
            }
            double growth = 0;
            for (const Merge& merge : merges) {
                points.push_back(merge.place(pad));
                growth = std::max(growth, distance_from_given(points.back()));
            }
            if (!(growth < options_.growth)) return std::nullopt;
            ConvexHull grown = convex_hull(points);
            if (grown.dimension < 3 || prove_points(grown, hull.points).outside > 0) continue;
            grown.numbers.clear();
            return Grown{std::move(grown), growth};
        }
        return std::nullopt;
    }

    const ConvexHull& given_;
    const DropOptions& options_;
    std::vector<HullPlane> planes_of_given_;
    double largest_ = 0;
};

}  // namespace

double ignored_height(std::span<const Double3> points, double least_size) {
    mesh::Box box;
    for (const Double3& p : points) box.add(p);
    const Double3 size = points.empty() ? Double3{} : minus(box.upper, box.lower);
    return kMargin * kIgnored * std::max(size.x / 2 + size.y / 2 + size.z / 2, least_size);
}

DroppedPoints drop_points(const ConvexHull& hull, const DropOptions& options) {
    if (hull.dimension != 3) return {hull, 0, 0, 0};
    return PointDropper(hull, options).run();
}

}  // namespace cdprep::convex
