// SPDX-License-Identifier: MIT
#include "cdprep/advanced/closest_features.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "cdprep/format/float_environment.h"
#include "core/numbers.h"
#include "exact/length_of.h"
#include "exact/point_triangle_distance.h"
#include "hull/hull_edges.h"
#include "hull/hull_nearest.h"

// Each feature is a vertex, an edge or a face of a hull. At least one of the two is a vertex or an
// edge. Two features hold the nearest points when no neighbouring feature comes nearer. That is so
// when each nearest point lies in the Voronoi region of the other feature (Lin and Canny 1991). A
// step goes to a feature in which the distance falls, or to the end of an edge that holds the
// nearest point. A face against an edge or a face is left at once for a corner or an edge of the
// border. The result of the march is not trusted: it is proved by bounds, as in GJK. Where the
// bounds are not tight, GJK answers.

namespace cdprep {
namespace {

/// Steps of a march: limits its time. GJK answers if the march has not ended by then.
constexpr int kMostStations = 64;
/// The threshold, as the sine of the angle, below which directions count as parallel or
/// perpendicular.
constexpr double kParallel = 1e-9;

/// A feature on the march: the vertex where an edge begins, the edge itself, or the face of its
/// facet.
struct Station {
    FeatureKind kind;
    FacetPlace place;
};

/// One of the two hulls on the march.
class Ground {
public:
    Ground(const FeatureHull& hull, const MovedHull& moved) noexcept
        : edges_(hull.facets, hull.adjacency), moved_(&moved) {}

    [[nodiscard]] const HullEdges& edges() const noexcept {
        return edges_;
    }
    [[nodiscard]] Double3 start(const FacetPlace& p) const noexcept {
        return moved_->point(edges_.start(p));
    }
    [[nodiscard]] Double3 end(const FacetPlace& p) const noexcept {
        return moved_->point(edges_.end(p));
    }
    [[nodiscard]] Corners corners(std::uint32_t facet) const noexcept {
        const auto& c = edges_.facets()[facet].corner;
        return {moved_->point(c[0]), moved_->point(c[1]), moved_->point(c[2])};
    }
    [[nodiscard]] Double3 normal(std::uint32_t facet) const noexcept {
        const Corners t = corners(facet);
        return cross(t[1] - t[0], t[2] - t[0]);
    }

    /// Returns the edge at a vertex along which the distance to a point falls most, if one exists.
    [[nodiscard]] std::optional<FacetPlace> uphill(const FacetPlace& vertex,
                                                   const Double3& towards) const noexcept {
        const Double3 at = start(vertex), way = towards - at;
        std::optional<FacetPlace> best;
        double most = 0;
        edges_.each_from(vertex, [&](const FacetPlace& p) {
            const Double3 along = end(p) - at;
            const double gain = dot(way, along);
            if (gain > 0 && gain * gain > most * dot(along, along)) {
                most = gain * gain / dot(along, along);
                best = p;
            }
        });
        return best;
    }

    /// Returns the facet beside an edge into which the distance falls from a point of the edge, if
    /// one exists.
    [[nodiscard]] std::optional<std::uint32_t> beside(const FacetPlace& edge,
                                                      const Double3& gap) const noexcept {
        for (const FacetPlace& p : {edge, edges_.twin(edge)}) {
            const Double3 inward = cross(normal(p.facet), end(p) - start(p));
            if (dot(gap, inward) > kParallel * std::sqrt(dot(gap, gap) * dot(inward, inward))) {
                return p.facet;
            }
        }
        return std::nullopt;
    }

    /// Returns the edge around a face that a point lies farthest beyond, seen along the normal.
    /// Returns nothing if the point is not beyond any edge.
    [[nodiscard]] std::optional<FacetPlace> beyond(std::uint32_t first, const Double3& normal,
                                                   const Double3& point) const noexcept {
        std::optional<FacetPlace> worst;
        double most = 0;
        edges_.each_around_face(first, [&](const FacetPlace& p) {
            const Double3 from = start(p), outward = cross(end(p) - from, normal);
            const double by = dot(point - from, outward);
            if (by > 0 && by * by > most * dot(outward, outward)) {
                most = by * by / dot(outward, outward);
                worst = p;
            }
        });
        return worst;
    }

private:
    HullEdges edges_;
    const MovedHull* moved_;
};

/// The march from one pair of features to the nearest.
class March {
public:
    March(const Ground& a, const Ground& b) noexcept : ground_{&a, &b} {}

    Station at[2];         ///< of A and B
    Double3 witness[2]{};  ///< the nearest points of the two
    Double3 gap{};         ///< from A to B, any length; perpendicular to edges and faces it joins
    double upper = 0;      ///< an upper bound of the distance of the witnesses
    double size = 0;       ///< of the differences between corners that it is computed from

    /// Returns false when the march does not end at nearest features.
    [[nodiscard]] bool run() noexcept {
        for (int i = 0; i < kMostStations; ++i) {
            const Outcome outcome = step();
            if (outcome != Outcome::moved) return outcome == Outcome::arrived;
        }
        return false;
    }

private:
    enum class Outcome : std::uint8_t { moved, arrived, lost };
    using enum FeatureKind;

    [[nodiscard]] Outcome step() noexcept {
        const FeatureKind a = at[0].kind, b = at[1].kind;
        if (a == vertex && b == vertex) return from_vertices();
        if (a == edge && b == edge) return from_edges();
        if (a == vertex && b == edge) return from_edge(0, 1);
        if (a == edge && b == vertex) return from_edge(1, 0);
        if (a == vertex && b == face) return from_face(0, 1);
        if (a == face && b == vertex) return from_face(1, 0);
        return Outcome::lost;
    }

    [[nodiscard]] Outcome from_vertices() noexcept {
        for (std::size_t i = 0; i < 2; ++i) witness[i] = ground_[i]->start(at[i].place);
        gap = witness[1] - witness[0];
        measure(gap, largest_of(gap));
        return climb(0) || climb(1) ? Outcome::moved : Outcome::arrived;
    }

    /// Sets the upper bound from `apart`, a computed difference of witnesses. `of` is the size of
    /// the few terms in its sum.
    void measure(const Double3& apart, double of) noexcept {
        size = of;
        upper = length_of(apart.x, apart.y, apart.z) * (1 + 4 * kUnit) + 20 * kUnit * of;
    }

    /// Moves from a vertex to the edge along which it comes nearest to the other witness. Returns
    /// false if there is none.
    [[nodiscard]] bool climb(std::size_t side) noexcept {
        const auto edge_there = ground_[side]->uphill(at[side].place, witness[1 - side]);
        if (!edge_there) return false;
        at[side] = {edge, *edge_there};
        return true;
    }

    /// Moves to one end of an edge.
    void stop_at(std::size_t side, bool is_end) noexcept {
        const FacetPlace p = at[side].place;
        at[side] = {vertex, is_end ? HullEdges::next(p) : p};
    }

    [[nodiscard]] Outcome from_edge(std::size_t corner_side, std::size_t edge_side) noexcept {
        const Double3 point = ground_[corner_side]->start(at[corner_side].place);
        const Double3 from = ground_[edge_side]->start(at[edge_side].place);
        const Double3 along = ground_[edge_side]->end(at[edge_side].place) - from;
        const Double3 way = point - from;
        const double place = dot(way, along) / dot(along, along);
        if (!(place > 0 && place < 1)) {
            stop_at(edge_side, place >= 1);
            return Outcome::moved;
        }
        witness[corner_side] = point;
        witness[edge_side] = from + place * along;
        gap = way - place * along;  // from the edge to the corner
        if (edge_side == 1) gap = -gap;
        measure(gap, std::max(largest_of(way), largest_of(along)));
        if (climb(corner_side)) return Outcome::moved;
        return widen(edge_side) ? Outcome::moved : Outcome::arrived;
    }

    /// Moves from an edge, against a vertex, to a face beside it. Returns false if there is none.
    [[nodiscard]] bool widen(std::size_t side) noexcept {
        const Double3 towards = side == 0 ? gap : -gap;
        const auto facet = ground_[side]->beside(at[side].place, towards);
        if (!facet) return false;
        at[side] = {face, {*facet, 0}};
        return true;
    }

    [[nodiscard]] Outcome from_edges() noexcept {
        std::array<Double3, 2> from, along;
        for (std::size_t i = 0; i < 2; ++i) {
            from[i] = ground_[i]->start(at[i].place);
            along[i] = ground_[i]->end(at[i].place) - from[i];
        }
        const Double3 across = cross(along[0], along[1]);
        const double both = dot(along[0], along[0]) * dot(along[1], along[1]);
        if (!(dot(across, across) > kParallel * kParallel * both)) return Outcome::lost;
        const std::array<double, 2> place = nearest_places(from, along);
        bool stopped = false;
        for (std::size_t i = 0; i < 2; ++i) {
            if (place[i] > 0 && place[i] < 1) continue;
            stop_at(i, place[i] >= 1);
            stopped = true;
        }
        if (stopped) return Outcome::moved;
        for (std::size_t i = 0; i < 2; ++i) witness[i] = from[i] + place[i] * along[i];
        const Double3 between = from[1] - from[0];
        const Double3 apart = between + place[1] * along[1] - place[0] * along[0];
        gap = dot(across, apart) < 0 ? -across : across;
        measure(apart, std::max({largest_of(between), largest_of(along[0]), largest_of(along[1])}));
        for (std::size_t i = 0; i < 2; ++i) {
            const auto facet = ground_[i]->beside(at[i].place, i == 0 ? gap : -gap);
            if (facet) return slide_over(i, *facet, along[1 - i], place[1 - i]);
        }
        return Outcome::arrived;
    }

    /// Returns the nearest points of two segments, as fractions of their lengths. The segments are
    /// not parallel.
    static std::array<double, 2> nearest_places(const std::array<Double3, 2>& from,
                                                const std::array<Double3, 2>& along) noexcept {
        const Double3 between = from[0] - from[1];
        const double aa = dot(along[0], along[0]), bb = dot(along[1], along[1]);
        const double ab = dot(along[0], along[1]);
        const double a = dot(along[0], between), b = dot(along[1], between);
        double s = std::clamp((ab * b - a * bb) / (aa * bb - ab * ab), 0.0, 1.0);
        double t = (ab * s + b) / bb;
        if (t < 0 || t > 1) {
            t = std::clamp(t, 0.0, 1.0);
            s = std::clamp((ab * t - a) / aa, 0.0, 1.0);
        }
        return {s, t};
    }

    /// Slides an edge of the other hull over a face. It begins at the fraction `place` of the edge
    /// and goes down, as far as the edge is over the face.
    [[nodiscard]] Outcome slide_over(std::size_t face_side, std::uint32_t facet,
                                     const Double3& along, double place) noexcept {
        const std::size_t side = 1 - face_side;
        const bool falls = dot(ground_[face_side]->normal(facet), along) < 0;
        const FacetPlace lower =
            falls ? at[side].place : ground_[side]->edges().twin(at[side].place);
        return slide(face_side, facet, lower, falls ? place : 1 - place);
    }
    [[nodiscard]] Outcome slide(std::size_t face_side, std::uint32_t facet,
                                const FacetPlace& edge_there, double place) noexcept {
        const Ground& base = *ground_[face_side];
        const Ground& other = *ground_[1 - face_side];
        const std::uint32_t first = base.edges().first_of_face(facet);
        const Double3 normal = base.normal(first), on = base.corners(first)[0];
        const Double3 from = other.start(edge_there), along = other.end(edge_there) - from;
        double leaves = 1;
        std::optional<FacetPlace> border;
        base.edges().each_around_face(first, [&](const FacetPlace& p) {
            const Double3 corner = base.start(p), outward = cross(base.end(p) - corner, normal);
            const double speed = dot(along, outward);
            if (!(speed > 0)) return;
            const double share = std::max(place, -dot(from - corner, outward) / speed);
            if (share < leaves) leaves = share, border = p;
        });
        if (!(dot(normal, from + leaves * along - on) > 0)) return Outcome::lost;
        if (border) {
            at[face_side] = {edge, *border};
            at[1 - face_side] = {edge, edge_there};
        } else {
            at[face_side] = {face, {first, 0}};
            at[1 - face_side] = {vertex, HullEdges::next(edge_there)};
        }
        return Outcome::moved;
    }

    [[nodiscard]] Outcome from_face(std::size_t corner_side, std::size_t face_side) noexcept {
        const Ground& base = *ground_[face_side];
        const Ground& other = *ground_[corner_side];
        const std::uint32_t first = base.edges().first_of_face(at[face_side].place.facet);
        const Double3 point = other.start(at[corner_side].place);
        const Double3 normal = base.normal(first);
        const double height = dot(normal, point - base.corners(first)[0]);
        if (!(height > 0)) return Outcome::lost;
        if (const auto border = base.beyond(first, normal, point)) {
            at[face_side] = {edge, *border};
            return Outcome::moved;
        }
        if (const auto lower = lower_edge(other, at[corner_side].place, normal)) {
            return slide(face_side, first, *lower, 0);
        }
        at[face_side].place.facet = first;
        witness[corner_side] = point;
        const PointTriangleDistance nearest = nearest_on_face(base, first, point);
        witness[face_side] = nearest.nearest;
        upper = nearest.upper;
        size = largest_of(point - base.corners(first)[0]);
        gap = face_side == 0 ? normal : -normal;
        return Outcome::arrived;
    }

    static std::optional<FacetPlace> lower_edge(const Ground& ground, const FacetPlace& corner,
                                                const Double3& normal) noexcept {
        const Double3 from = ground.start(corner);
        std::optional<FacetPlace> best;
        double most = kParallel * kParallel * dot(normal, normal);
        ground.edges().each_from(corner, [&](const FacetPlace& p) {
            const Double3 along = ground.end(p) - from;
            const double rise = dot(normal, along);
            if (rise < 0 && rise * rise > most * dot(along, along)) {
                most = rise * rise / dot(along, along);
                best = p;
            }
        });
        return best;
    }

    static PointTriangleDistance nearest_on_face(const Ground& ground, std::uint32_t first,
                                                 const Double3& point) noexcept {
        const std::uint32_t end = ground.edges().end_of_face(first);
        PointTriangleDistance best = point_triangle_distance(point, ground.corners(first));
        for (std::uint32_t f = first + 1; f < end; ++f) {
            const PointTriangleDistance d = point_triangle_distance(point, ground.corners(f));
            if (d.upper < best.upper) best = d;
        }
        return best;
    }

    const Ground* ground_[2];
};

// --- Proof -------------------------------------------------------------------------

/// Returns a lower bound of the distance, by the farthest points along the gap. See gjk.cpp.
double proven_gap(const TwoHulls& hulls, const March& march, std::uint32_t near_a,
                  std::uint32_t near_b) noexcept {
    const double most = largest_of(march.gap);
    if (!(most > 0 && most < std::numeric_limits<double>::infinity())) return 0;
    const Double3 d = {march.gap.x / most, march.gap.y / most, march.gap.z / most};
    const auto of_a = hulls.a.proven(d, march.witness[0], near_a);
    const auto of_b = hulls.b.proven(-d, march.witness[1], near_b);
    const Double3 between = march.witness[1] - march.witness[0];
    const double size = dot_size(d, between) + std::fabs(of_a.bound) + std::fabs(of_b.bound);
    constexpr double kUnderflow = 0x1p-1050;  // more than products below the range of double lose
    const double gap = dot(d, between) - of_a.bound - of_b.bound - 8 * kUnit * size - kUnderflow;
    return std::max(0.0, gap / std::sqrt(dot(d, d)) * (1 - 8 * kUnit));
}

// --- Stations and features ---------------------------------------------------------

HullFeature feature_of(const HullEdges& edges, const Station& station) noexcept {
    const auto number = [](const FacetPlace& p) { return 3 * p.facet + p.corner; };
    switch (station.kind) {
        case FeatureKind::vertex:
            return {FeatureKind::vertex, edges.start(station.place)};
        case FeatureKind::edge:
            return {FeatureKind::edge,
                    std::min(number(station.place), number(edges.twin(station.place)))};
        default:
            return {FeatureKind::face, edges.first_of_face(station.place.facet)};
    }
}

/// Returns the station that a cache names, or nothing if it names none of this hull.
std::optional<Station> station_of(const HullEdges& edges, FeatureKind kind,
                                  std::uint32_t edge) noexcept {
    if (edge / 3 >= edges.facets().size()) return std::nullopt;
    const FacetPlace place{edge / 3, edge % 3};
    switch (kind) {
        case FeatureKind::vertex:
            return Station{kind, place};
        case FeatureKind::face:
            return Station{kind, {edges.first_of_face(place.facet), 0}};
        case FeatureKind::edge:
            return Station{edges.is_edge(place) ? kind : FeatureKind::vertex, place};
    }
    return std::nullopt;
}

/// The corners of one side that define a nearest point.
struct CornerSet {
    std::array<std::uint32_t, 4> corner{};
    std::size_t count = 0;

    CornerSet(const NearestSimplex& simplex, std::uint32_t Difference::*side) noexcept {
        for (std::size_t i = 0; i < simplex.count; ++i) add(simplex.corner[i].*side);
    }
    void add(std::uint32_t number) noexcept {
        assert(count < corner.size() || has(number));
        if (!has(number)) corner[count++] = number;
    }
    [[nodiscard]] bool has(std::uint32_t number) const noexcept {
        return std::find(corner.begin(), corner.begin() + count, number) != corner.begin() + count;
    }
};

/// Returns the face at a corner that contains the whole set and faces the gap most. A polygon has
/// two faces.
std::optional<Station> face_over(const Ground& ground, const FacetPlace& corner,
                                 const CornerSet& set, const Double3& gap) noexcept {
    const HullEdges& edges = ground.edges();
    std::optional<Station> best;
    double most = -std::numeric_limits<double>::infinity();
    edges.each_from(corner, [&](const FacetPlace& at) {
        const std::uint32_t first = edges.first_of_face(at.facet);
        std::size_t has = 0;
        edges.each_around_face(
            first, [&](const FacetPlace& p) { has += set.has(edges.start(p)) ? 1U : 0U; });
        if (has != set.count) return;
        const double along = dot(ground.normal(first), gap);
        if (along > most) most = along, best = Station{FeatureKind::face, {first, 0}};
    });
    return best;
}

/// Returns the first place that begins at a corner.
FacetPlace place_of(const HullEdges& edges, std::uint32_t number) noexcept {
    for (std::uint32_t f = 0; f < edges.facets().size(); ++f) {
        for (std::uint32_t k = 0; k < 3; ++k) {
            if (edges.start({f, k}) == number) return {f, k};
        }
    }
    return {0, 0};  // not on the surface, though every corner should be
}

/// Returns the face nearest to a point. In a hull thinner than rounding, the corners that define a
/// point may lie on both sides. Then no face has them all.
Station nearest_face(const Ground& ground, const Double3& point) noexcept {
    std::uint32_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t f = 0; f < ground.edges().facets().size(); ++f) {
        const double distance = point_triangle_distance(point, ground.corners(f)).computed;
        if (distance < least) least = distance, best = f;
    }
    return {FeatureKind::face, {ground.edges().first_of_face(best), 0}};
}

Station station_over(const Ground& ground, const CornerSet& set, const Double3& gap,
                     const Double3& witness) noexcept {
    const HullEdges& edges = ground.edges();
    assert(set.count > 0);
    const FacetPlace corner = place_of(edges, set.corner[0]);
    if (set.count == 1) return {FeatureKind::vertex, corner};
    std::optional<Station> edge;
    edges.each_from(corner, [&](const FacetPlace& p) {
        if (set.count == 2 && edges.end(p) == set.corner[1]) edge = Station{FeatureKind::edge, p};
    });
    if (edge) return *edge;
    const auto face = face_over(ground, corner, set, gap);
    return face ? *face : nearest_face(ground, witness);
}

/// The part of a hull that is nearest: a corner, an edge along a direction, or a face.
struct Level {
    int dimension;
    Double3 along;
};

bool is_level(const Double3& along, const Double3& gap) noexcept {
    return std::fabs(dot(along, gap)) <= kParallel * std::sqrt(dot(along, along) * dot(gap, gap));
}

Level level_of(const Ground& ground, const Station& station, const Double3& gap) noexcept {
    if (station.kind == FeatureKind::face) return {2, {}};
    Level level{0, {}};
    const auto take = [&](const FacetPlace& p) {
        const Double3 along = ground.end(p) - ground.start(p);
        if (!is_level(along, gap)) return;
        level.along = along;
        ++level.dimension;
    };
    ground.edges().each_from(station.place, take);
    if (station.kind == FeatureKind::edge) {
        // The edge itself is level and is counted twice. Another level edge at its end borders a
        // level face.
        ground.edges().each_from(ground.edges().twin(station.place), take);
        --level.dimension;
        level.along = ground.end(station.place) - ground.start(station.place);
    }
    level.dimension = std::min(level.dimension, 2);
    return level;
}

bool are_parallel(const Level& of_a, const Level& of_b) noexcept {
    if (of_a.dimension != 1 || of_b.dimension != 1) return of_a.dimension + of_b.dimension > 2;
    const Double3 across = cross(of_a.along, of_b.along);
    return dot(across, across) <=
           kParallel * kParallel * dot(of_a.along, of_a.along) * dot(of_b.along, of_b.along);
}

/// The result for one of the two hulls.
struct FoundStation {
    HullFeature feature;
    Level level;
};

FoundStation found_at(const Ground& ground, const Station& station, const Double3& gap) noexcept {
    return {feature_of(ground.edges(), station), level_of(ground, station, gap)};
}

/// The same for a hull that is a point or a segment.
FoundStation found_of_flat(const MovedHull& hull, const CornerSet& set,
                           const Double3& gap) noexcept {
    const Double3 along = hull.point(hull.count() - 1) - hull.point(0);
    if (set.count > 1) return {{FeatureKind::edge, 0}, {1, along}};
    const bool lies_along = hull.count() > 1 && is_level(along, gap);
    return {{FeatureKind::vertex, set.corner[0]}, {lies_along ? 1 : 0, along}};
}

class FeatureSearch {
public:
    FeatureSearch(const FeatureHull& a, const FeatureHull& b, const Placement& placement,
                  FeatureCache* cache, QueryCounts* counts) noexcept
        : hulls_(a.points, b.points, placement),
          ground_a_(a, hulls_.a),
          ground_b_(b, hulls_.b),
          cache_(cache),
          counts_(counts) {}

    [[nodiscard]] std::optional<ClosestFeatures> run() noexcept {
        if (const auto found = march()) return found;
        return search();
    }

private:
    [[nodiscard]] bool has_surfaces() const noexcept {
        return !ground_a_.edges().facets().empty() && !ground_b_.edges().facets().empty();
    }

    /// Marches from the cached features. Returns nothing where the result is not proved to be
    /// nearest.
    [[nodiscard]] std::optional<ClosestFeatures> march() noexcept {
        if (cache_ == nullptr || !cache_->is_set || !has_surfaces()) return std::nullopt;
        const auto from_a = station_of(ground_a_.edges(), cache_->kind[0], cache_->edge[0]);
        const auto from_b = station_of(ground_b_.edges(), cache_->kind[1], cache_->edge[1]);
        if (!from_a || !from_b) return std::nullopt;
        March march(ground_a_, ground_b_);
        march.at[0] = *from_a;
        march.at[1] = *from_b;
        if (!march.run()) return std::nullopt;
        const double lower = proven_gap(hulls_, march, ground_a_.edges().start(march.at[0].place),
                                        ground_b_.edges().start(march.at[1].place));
        if (!(lower > 0) || !is_near_enough(lower, march.upper, march.size)) {
            return std::nullopt;
        }
        if (counts_ != nullptr) ++counts_->hull_pairs;
        remember(march.at[0], 0);
        remember(march.at[1], 1);
        return answer(found_at(ground_a_, march.at[0], march.gap),
                      found_at(ground_b_, march.at[1], -march.gap), {lower, march.upper},
                      march.witness[0], march.witness[1]);
    }

    [[nodiscard]] std::optional<ClosestFeatures> search() noexcept {
        const auto found = hull_nearest(hulls_.a, hulls_.b, {}, nullptr, counts_);
        if (found->meet) {
            if (cache_ != nullptr) cache_->is_set = false;
            return std::nullopt;
        }
        const NearestSimplex& simplex = found->simplex;
        const CornerSet of_a(simplex, &Difference::a), of_b(simplex, &Difference::b);
        const Double3 on_a = weighted_sum(simplex, &Difference::at_a);
        const Double3 on_b = weighted_sum(simplex, &Difference::at_b);
        const Double3 gap = -nearest_direction(simplex);
        const auto found_on = [&](const Ground& ground, const MovedHull& hull, const CornerSet& set,
                                  const Double3& way, std::size_t side) {
            if (ground.edges().facets().empty()) return found_of_flat(hull, set, way);
            const Station at = station_over(ground, set, way, side == 0 ? on_a : on_b);
            remember(at, side);
            return found_at(ground, at, way);
        };
        return answer(found_on(ground_a_, hulls_.a, of_a, gap, 0),
                      found_on(ground_b_, hulls_.b, of_b, -gap, 1), found->bounds, on_a, on_b);
    }

    void remember(const Station& at, std::size_t side) const noexcept {
        if (cache_ == nullptr) return;
        assert(at.place.corner < 3);
        cache_->is_set = true;
        cache_->kind[side] = at.kind;
        cache_->edge[side] = 3 * at.place.facet + at.place.corner;
    }
    static ClosestFeatures answer(const FoundStation& a, const FoundStation& b,
                                  const DistanceBounds& bounds, const Double3& on_a,
                                  const Double3& on_b) noexcept {
        assert(bounds.lower <= bounds.upper);
        return {a.feature,
                b.feature,
                bounds.lower,
                bounds.upper,
                on_a,
                on_b,
                are_parallel(a.level, b.level)};
    }

    TwoHulls hulls_;
    Ground ground_a_;
    Ground ground_b_;
    FeatureCache* cache_;
    QueryCounts* counts_;
};

}  // namespace

std::optional<ClosestFeatures> closest_features(const FeatureHull& a, const FeatureHull& b,
                                                const Placement& placement, FeatureCache* cache,
                                                QueryCounts* counts) noexcept {
    const format::FloatEnvironment environment;
    if (a.points.count == 0 || b.points.count == 0) return std::nullopt;
    return FeatureSearch(a, b, placement, cache, counts).run();
}

}  // namespace cdprep
