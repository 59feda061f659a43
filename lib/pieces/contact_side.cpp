// SPDX-License-Identifier: MIT
#include "pieces/contact_side.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include "cdprep/hulls.h"
#include "core/triangle_facts.h"
#include "exact/point_triangle_distance.h"
#include "hull/hull_nearest.h"
#include "pieces/piece_parts.h"
#include "walk/triangles_at_vertex.h"

namespace cdprep {
namespace {

using format::EdgeConvexity;

/// The cosine above which two unit directions are equal up to rounding. 1 - 1e-10 is 1.4e-5
/// radians: far more than rounding turns a direction, far less than a surface bends.
constexpr double kAligned = 1 - 1e-10;
/// The greatest lean of a unit direction that is rounding alone.
constexpr double kNoLean = 1e-12;
/// The rise of an edge by its length, up to which it is level but for rounding.
constexpr double kNoRise = 1e-9;
/// The most that rounding may turn the normal of a face, in radians, for the face to tell which
/// directions its triangles face.
constexpr double kSureTurn = 1e-3;

/// Returns whether rounding turns the normal of a triangle by less than kSureTurn, if its corners
/// are off by at most `error`. See PieceShape::Face::error.
bool turns_little(const Corners& t, double error) {
    const Double3 e = t[1] - t[0], f = t[2] - t[0];
    const double sides = length(e) + length(f), product = length(e) * length(f);
    return 4 * error * sides + 0x1p-49 * product < kSureTurn * length(cross(e, f));
}

/// Takes every triangle.
constexpr auto kAll = [](std::uint32_t) { return true; };

/// Returns whether one of a triangle's three edges is reflex.
bool has_reflex_edge(const MovedModel& model, std::uint32_t triangle) {
    const std::uint8_t bits = model.model->mesh().edge_convexity[triangle];
    return format::edge_convexity(bits, 0) == EdgeConvexity::reflex ||
           format::edge_convexity(bits, 1) == EdgeConvexity::reflex ||
           format::edge_convexity(bits, 2) == EdgeConvexity::reflex;
}

unsigned corner_of(const format::Triangle& triangle, std::uint32_t vertex) {
    unsigned k = 0;
    while (k < 3 && triangle.vertex[k] != vertex) ++k;
    return k;
}

}  // namespace

ContactSide::ContactSide(const MovedModel& model, std::uint32_t piece, PlacedHull* large,
                         Workspace::Storage& scratch) noexcept
    : model_(&model),
      scratch_(&scratch),
      triangles_(part_of_piece(model.model->pieces().triangles, *model.model, piece,
                               &format::Piece::first_triangle)),
      hull_(feature_hull(*model.model, piece)),
      piece_(piece),
      contained_((model.model->pieces().pieces[piece].flags & format::piece_contained) != 0),
      is_exact_(model.model->pieces().pieces[piece].outer_error == 0) {
    assert(!triangles_.empty());
    place(piece, large);
}

void ContactSide::place(std::uint32_t piece, PlacedHull* large) noexcept {
    const std::uint32_t count = hull_.points.count;
    const std::size_t blocks = (count + format::kHullLanes - 1) / format::kHullLanes;
    const bool is_small = blocks <= kMostPlaced;
    if (!is_small && (large == nullptr || blocks > large->blocks.size())) return;
    const std::span<format::HullBlock> all = is_small ? std::span<format::HullBlock>(placed_)
                                                      : std::span<format::HullBlock>(large->blocks);
    const auto room = all.first(blocks);
    placed_points_.blocks = room;
    placed_points_.count = count;
    if (is_small || large->piece != piece) place_into(room);
    if (is_small) return;
    large_ = large;
    if (large->piece != piece) {
        large->piece = piece;
        large->has_normals = false;
        large->reach = {0, 0, 0};
        for (std::uint32_t i = 0; i < count; ++i) {
            const Double3 p = corner(i);
            large->reach = {std::max(large->reach.x, std::fabs(p.x)),
                            std::max(large->reach.y, std::fabs(p.y)),
                            std::max(large->reach.z, std::fabs(p.z))};
        }
    }
    placed_points_.reach = large->reach;
}

void ContactSide::place_into(std::span<format::HullBlock> blocks) const noexcept {
    const std::uint32_t count = hull_.points.count;
    Double3 p{};
    for (std::uint32_t i = 0; i < blocks.size() * format::kHullLanes; ++i) {
        if (i < count) p = model_->position(hull_.points.corners[i]);
        set_hull_point(blocks, i, p);
    }
}

double ContactSide::position_error() const noexcept {
    if (model_->pose == nullptr) return 0;
    const Double3& t = model_->pose->translation();
    double most = 0;  // of the stored coordinates, as turned
    for (std::uint32_t i = 0; i < points().count; ++i) {
        most = std::max(most, largest_of(corner(i) - t));
    }
    // Each coordinate is off by 4 u of the sizes of its terms. These are three products, whose sum
    // is at most 3 times the largest turned coordinate, and the translation.
    constexpr double kError = 8 * 0x1p-53;
    return kError * (3 * most + largest_of(t));
}

void ContactSide::place_triangles() noexcept {
    if (placed_triangles_count_ > 0 || triangles_.size() > kMostPlacedTriangles) return;
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
        const Corners at = model_->corners(triangles_[i]);
        placed_triangle_[i] = {at, unit_normal(at)};
    }
    placed_triangles_count_ = triangles_.size();
    has_reflex_edges_ = std::any_of(triangles_.begin(), triangles_.end(),
                                    [&](std::uint32_t t) { return has_reflex_edge(*model_, t); });
}

ConvexPoints ContactSide::points_of(std::uint32_t triangle) const noexcept {
    assert(triangle < model_->model->triangle_count());
    ConvexPoints points = hull_.points;
    points.corners = model_->model->mesh().triangles[triangle].vertex;
    points.count = 3;
    return points;
}

std::span<const std::uint32_t> ContactSide::triangles_around(std::uint32_t vertex,
                                                             Fan& room) const noexcept {
    if (!is_large()) return triangles_;
    const std::span<const std::uint32_t> piece_of = model_->model->pieces().of_triangle;
    std::size_t count = 0;
    const bool fit = visit_triangles_at(*model_->model, vertex, *scratch_, [&](std::uint32_t t) {
        if (piece_of[t] != piece_) return true;
        if (count == room.size()) return false;
        room[count++] = t;
        return true;
    });
    if (!fit) return triangles_;
    std::sort(room.begin(), room.begin() + static_cast<std::ptrdiff_t>(count));
    return std::span<const std::uint32_t>(room).first(count);
}

std::optional<PieceFeature> ContactSide::find_feature(const VertexSet& set) const noexcept {
    if (set.count == 0 || set.count > 3) return std::nullopt;
    Fan room;
    for (const std::uint32_t t : triangles_around(set.vertex[0], room)) {
        const format::Triangle& triangle = model_->model->mesh().triangles[t];
        unsigned has = 0;
        for (std::size_t i = 0; i < set.count; ++i) {
            has += corner_of(triangle, set.vertex[i]) < 3 ? 1U : 0U;
        }
        if (has != set.count) continue;
        if (set.count == 3) return PieceFeature{FeatureKind::face, t, 0};
        const unsigned first = corner_of(triangle, set.vertex[0]);
        if (set.count == 1) return PieceFeature{FeatureKind::vertex, t, first};
        const unsigned second = corner_of(triangle, set.vertex[1]);
        const bool in_order = (first + 1) % 3 == second;
        return PieceFeature{FeatureKind::edge, t, in_order ? first : second};
    }
    return std::nullopt;
}

std::optional<PieceFeature> ContactSide::find_part_of_edge(const StraightEdge& edge,
                                                           const Double3& near) const noexcept {
    std::optional<PieceFeature> best;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
        const Corners at = corners_of(i);
        const std::array<bool, 3> on = {edge.has(at[0]), edge.has(at[1]), edge.has(at[2])};
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t next = (k + 1) % 3;
            if (!on[k] || !on[next]) continue;
            const double distance =
                point_triangle_distance(near, {at[k], at[next], at[next]}).computed;
            if (distance < least) {
                least = distance;
                best = {FeatureKind::edge, triangles_[i], k};
            }
        }
    }
    return best;
}

bool ContactSide::begins_with(std::uint32_t vertex, const StraightEdge& edge) const noexcept {
    Fan room;
    for (const std::uint32_t t : triangles_around(vertex, room)) {
        const format::Triangle& triangle = model_->model->mesh().triangles[t];
        const unsigned k = corner_of(triangle, vertex);
        if (k == 3) continue;
        for (const unsigned next : {(k + 1) % 3, (k + 2) % 3}) {
            if (edge.has(model_->position(triangle.vertex[next]))) return true;
        }
    }
    return false;
}

std::optional<StraightEdge> ContactSide::find_divided_edge(const VertexSet& set) const noexcept {
    if (set.count < 2) return std::nullopt;
    const auto vertices = std::span(set.vertex).first(set.count);
    const auto farthest_from = [&](std::uint32_t from) {
        std::uint32_t best = from;
        double most = 0;
        for (const std::uint32_t vertex : vertices) {
            const double far = largest_of(model_->position(vertex) - model_->position(from));
            if (far > most) most = far, best = vertex;
        }
        return best;
    };
    const std::uint32_t from = set.count == 2 ? vertices[0] : farthest_from(vertices[0]);
    const std::uint32_t to = set.count == 2 ? vertices[1] : farthest_from(from);
    const StraightEdge edge(model_->position(from), model_->position(to));
    const auto is_on = [&](std::uint32_t vertex) { return edge.has(model_->position(vertex)); };
    if (set.count > 2 && !std::all_of(vertices.begin(), vertices.end(), is_on)) return std::nullopt;
    return begins_with(from, edge) ? std::optional(edge) : std::nullopt;
}

std::uint32_t ContactSide::nearest_triangle(const Double3& near) const noexcept {
    std::uint32_t best = triangles_[0];
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
        const Corners at = placed(i, triangles_[i]).at;
        if (!(axis_gap({near, near}, box_around(at)) < least)) continue;
        const double distance = point_triangle_distance(near, at).computed;
        if (distance < least) least = distance, best = triangles_[i];
    }
    return best;
}

std::span<const std::uint32_t> ContactSide::triangles_facing(const Double3& direction,
                                                             Fan& room) const noexcept {
    if (!is_large() || !is_exact_) return triangles_;
    std::array<float, PlacedHull::kMostFacets> room_for_cosines;
    // The triangles of an exact piece are on faces of its hull.
    const std::span<const float> cosines = face_cosines(direction, room_for_cosines);
    if (cosines.empty() || !large_->has_sure_faces) return triangles_;
    constexpr float kLeast = 1 - static_cast<float>(kSureTurn * kSureTurn) - kCosineError;
    const auto all = facets();
    std::size_t count = 0;
    for (std::size_t f = 0; f < all.size(); ++f) {
        if (!(std::fabs(cosines[f]) > kLeast)) continue;
        const bool is_alone =
            f + 1 == all.size() || (all[f + 1].flags & format::facet_first_of_face) != 0;
        VertexSet corners;
        for (const std::uint32_t corner : all[f].corner) corners.add(points().corners[corner]);
        const auto triangle = is_alone ? find_feature(corners) : std::nullopt;
        if (!triangle || count == room.size()) return triangles_;
        room[count++] = triangle->triangle;
    }
    return std::span<const std::uint32_t>(room).first(count);
}

/// Calls visit(triangle, placed) for the triangles that face a unit direction squarely, until it
/// returns false. Those without is_taken(triangle) are left out.
template <class IsTaken, class Visit>
void ContactSide::each_facing(const Double3& direction, IsTaken&& is_taken,
                              Visit&& visit) const noexcept {
    const MovedModel still(*model_->model, nullptr);
    const Double3 local = turned_back(model_->pose, direction);
    Fan room;
    const auto triangles = triangles_facing(direction, room);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        if (!is_taken(triangles[i])) continue;
        PlacedTriangle moved;
        const bool is_placed = i < placed_triangles_count_;
        if (!is_placed) {
            if (is_surely_turned(still.corners(triangles[i]), local, kAligned)) continue;
            moved = placed(i, triangles[i]);
        }
        const PlacedTriangle& t = is_placed ? placed_triangle_[i] : moved;
        const double along = dot(t.normal, direction);
        // A surface that bounds no solid can be met from either side.
        if ((is_contained() ? along : std::fabs(along)) < kAligned) continue;
        if (!visit(triangles[i], t)) return;
    }
}

std::optional<PieceFeature> ContactSide::find_face(const Double3& direction,
                                                   const Double3* near) const noexcept {
    std::optional<PieceFeature> best;
    double least = std::numeric_limits<double>::infinity();
    each_facing(direction, kAll, [&](std::uint32_t triangle, const PlacedTriangle& t) {
        const double distance = near == nullptr ? 0 : point_triangle_distance(*near, t.at).computed;
        if (!best || distance < least) {
            least = distance;
            best = {FeatureKind::face, triangle, 0};
        }
        return near != nullptr;
    });
    return best;
}

bool ContactSide::has_face_at(const Double3& direction, const Double3& point,
                              double most) const noexcept {
    bool found = false;
    each_facing(direction, kAll, [&](std::uint32_t, const PlacedTriangle& t) {
        found = axis_gap({point, point}, box_around(t.at)) <= most &&
                point_triangle_distance(point, t.at).computed <= most;
        return !found;
    });
    return found;
}

bool ContactSide::ends_at_reflex_edge(const Double3& direction) const noexcept {
    if (!has_reflex_edges_) return false;
    bool found = false;
    each_facing(
        direction, [&](std::uint32_t triangle) { return has_reflex_edge(*model_, triangle); },
        [&](std::uint32_t, const PlacedTriangle&) {
            found = true;
            return false;
        });
    return found;
}

bool ContactSide::ends_before(const Double3& direction, const Double3& point,
                              double most) const noexcept {
    double least = std::numeric_limits<double>::infinity();
    each_facing(direction, kAll, [&](std::uint32_t, const PlacedTriangle& t) {
        least = std::min(least, point_triangle_distance(point, t.at).computed);
        return true;
    });
    const auto ends = [&](std::uint32_t triangle) { return has_reflex_edge(*model_, triangle); };
    bool found = false;
    each_facing(direction, ends, [&](std::uint32_t triangle, const PlacedTriangle& t) {
        if (point_triangle_distance(point, t.at).computed > least + most) return true;
        const std::uint8_t bits = model_->model->mesh().edge_convexity[triangle];
        for (unsigned k = 0; k < 3 && !found; ++k) {
            if (format::edge_convexity(bits, k) != EdgeConvexity::reflex) continue;
            const Double3 outward = cross(unit(t.at[(k + 1) % 3] - t.at[k]), t.normal);
            found = dot(outward, point - t.at[k]) > most;
        }
        return !found;
    });
    return found;
}

bool ContactSide::has_face_at(const Double3& direction, const MovedHull& hull,
                              double most) const noexcept {
    bool found = false;
    each_facing(direction, kAll, [&](std::uint32_t triangle, const PlacedTriangle&) {
        const ConvexPoints points = points_of(triangle);
        const MovedHull face(points, model_->pose);
        found = hull_nearest(face, hull, {}, nullptr, nullptr)->bounds.lower <= most;
        return !found;
    });
    return found;
}

PieceFeature ContactSide::feature_along(const Double3& direction,
                                        const Double3& near) const noexcept {
    if (const auto face = find_face(direction, &near)) return *face;
    const auto here = [&] { return near; };
    if (const auto feature = find_feature(farthest_vertices(direction), here)) return *feature;
    return {FeatureKind::face, nearest_triangle(near), 0};
}

VertexSet ContactSide::farthest_vertices(const Double3& direction) const noexcept {
    double most = -std::numeric_limits<double>::infinity(), least = -most;
    for (std::uint32_t i = 0; i < points().count; ++i) {
        const double height = dot(direction, corner(i));
        most = std::max(most, height);
        least = std::min(least, height);
    }
    VertexSet level;
    for (std::uint32_t i = 0; i < points().count; ++i) {
        if (dot(direction, corner(i)) >= most - kLevel * (most - least)) {
            level.add(points().corners[i]);
        }
    }
    return level;
}

void ContactSide::set_face_normals() const noexcept {
    const auto all = facets();
    large_->has_sure_faces = true;
    const double position_error = this->position_error();
    for (std::size_t f = 0; f < all.size(); ++f) {
        Double3 n = {0, 0, 0};
        if ((all[f].flags & format::facet_virtual) != 0) {
            large_->has_sure_faces = false;
        } else if (all[f].flags == format::facet_first_of_face) {
            const auto& c = all[f].corner;
            const Corners at = {corner(c[0]), corner(c[1]), corner(c[2])};
            n = unit_normal(at);
            if (!turns_little(at, position_error)) large_->has_sure_faces = false;
        }
        large_->normals[0][f] = static_cast<float>(n.x);
        large_->normals[1][f] = static_cast<float>(n.y);
        large_->normals[2][f] = static_cast<float>(n.z);
    }
    large_->has_normals = true;
}

std::span<const float> ContactSide::face_cosines(
    const Double3& direction, std::array<float, PlacedHull::kMostFacets>& room) const noexcept {
    const std::size_t count = facets().size();
    if (large_ == nullptr || count > room.size()) return {};
    if (!large_->has_normals) set_face_normals();
    const auto& [x, y, z] = large_->normals;
    const auto of_x = static_cast<float>(direction.x), of_y = static_cast<float>(direction.y),
               of_z = static_cast<float>(direction.z);
    for (std::size_t f = 0; f < count; ++f) room[f] = of_x * x[f] + of_y * y[f] + of_z * z[f];
    return std::span(room).first(count);
}

double ContactSide::reach(const Double3& direction, const Double3& from) const noexcept {
    if (!is_placed() || large_ != nullptr) return hull().proven_by_all(direction, from).bound;
    constexpr double kError = 6 * 0x1p-53;  // a difference, three products and two sums
    double most = -std::numeric_limits<double>::infinity();
    for (std::uint32_t i = 0; i < points().count; ++i) {
        const Double3 p = corner(i) - from;
        most = std::max(most, dot(p, direction) + kError * dot_size(p, direction));
    }
    return most;
}

// --- Edges inside the surface --------------------------------------------------------

/// Calls visit(triangle, placed, edges) for the piece's triangles that have the feature. `edges`
/// has a bit for each of their edges that has it.
template <class Visit>
void ContactSide::each_around(const PieceFeature& feature, Visit&& visit) const noexcept {
    if (feature.kind == FeatureKind::face) {
        visit(feature.triangle, placed(triangles_.size(), feature.triangle), 0U);
        return;
    }
    const auto mesh = model_->model->mesh().triangles;
    const std::uint32_t from = mesh[feature.triangle].vertex[feature.corner];
    const std::uint32_t to = mesh[feature.triangle].vertex[(feature.corner + 1) % 3];
    Fan room;
    const auto around = triangles_around(from, room);
    for (std::size_t i = 0; i < around.size(); ++i) {
        const format::Triangle& triangle = mesh[around[i]];
        const unsigned k = corner_of(triangle, from);
        if (k == 3) continue;
        const unsigned previous = (k + 2) % 3;
        unsigned edges = 0;
        if (feature.kind == FeatureKind::vertex) {
            edges = 1U << k | 1U << previous;
        } else if (triangle.vertex[(k + 1) % 3] == to) {
            edges = 1U << k;
        } else if (triangle.vertex[previous] == to) {
            edges = 1U << previous;
        } else {
            continue;
        }
        visit(around[i], placed(i, around[i]), edges);
    }
}

double ContactSide::facing(const PieceFeature& feature, const Double3& direction) const noexcept {
    double most = -1;
    each_around(feature, [&](std::uint32_t, const PlacedTriangle& triangle, unsigned) {
        most = std::max(most, dot(triangle.normal, direction));
    });
    return most;
}

bool ContactSide::leads_out(const PieceFeature& feature, const Double3& direction) const noexcept {
    const double most = facing(feature, direction);
    if (most > 0) return true;
    return most >= -kNoLean && feature.kind != FeatureKind::face &&
           find_lean(feature, direction, kNoLean, Over::convex).has_value();
}

bool ContactSide::is_seen_from_behind(const PieceFeature& feature,
                                      const Double3& direction) const noexcept {
    return is_contained() && facing(feature, direction) < -kNoLean;
}

/// Returns whether another triangle of the piece has the edge. Then the hull determines the normals
/// there.
bool ContactSide::is_inner(std::uint32_t triangle, unsigned edge) const noexcept {
    const auto& vertex = model_->model->mesh().triangles[triangle].vertex;
    const std::uint32_t from = vertex[edge], to = vertex[(edge + 1) % 3];
    Fan room;
    const auto around = triangles_around(from, room);
    return std::any_of(around.begin(), around.end(), [&](std::uint32_t t) {
        const format::Triangle& other = model_->model->mesh().triangles[t];
        return t != triangle && corner_of(other, from) < 3 && corner_of(other, to) < 3;
    });
}

/// Returns whether an edge is one of those. Seen from outside, `inward` is reflex.
bool ContactSide::is_among(EdgeConvexity edge, EdgeConvexity inward, Over over) noexcept {
    if (edge == EdgeConvexity::unknown) return false;
    if (over == Over::convex) return edge != EdgeConvexity::flat && edge != inward;
    return edge == EdgeConvexity::flat || (edge == inward && over == Over::flat_or_reflex);
}

template <class Take>
void ContactSide::each_lean(const PieceFeature& feature, const Double3& direction,
                            const double& least, Over over, Take&& take) const noexcept {
    each_around(feature, [&](std::uint32_t t, const PlacedTriangle& triangle, unsigned edges) {
        const std::uint8_t bits = model_->model->mesh().edge_convexity[t];
        const auto& [at, front] = triangle;
        const bool from_front = is_contained() || dot(front, direction) >= 0;
        // Seen from behind, a convex edge is reflex.
        const EdgeConvexity inward = from_front ? EdgeConvexity::reflex : EdgeConvexity::convex;
        for (unsigned k = 0; k < 3; ++k) {
            const EdgeConvexity edge = format::edge_convexity(bits, k);
            if ((edges >> k & 1) == 0 || !is_among(edge, inward, over)) continue;
            // A sign decides most edges: a root takes as long as all else here.
            const Double3 along = at[(k + 1) % 3] - at[k];
            if (!(dot(cross(along, front), direction) > 0)) continue;
            const Double3 outward = cross(unit(along), front);
            const double by = dot(outward, direction);
            if (!(by > least) || is_inner(t, k)) continue;
            take(Lean{by, outward, from_front ? front : -front});
        }
    });
}

std::optional<ContactSide::Lean> ContactSide::find_lean(const PieceFeature& feature,
                                                        const Double3& direction, double least,
                                                        Over over) const noexcept {
    std::optional<Lean> most;
    each_lean(feature, direction, least, over, [&](const Lean& lean) {
        least = lean.by;
        most = lean;
    });
    return most;
}

UnitDirections ContactSide::faces_left_across(const PieceFeature& feature,
                                              const Double3& direction) const noexcept {
    UnitDirections faces;
    each_lean(feature, direction, kAligned, Over::flat_or_reflex,
              [&](const Lean& lean) { faces.add(lean.face); });
    return faces;
}

bool ContactSide::goes_on_beyond(const PieceFeature& feature,
                                 const Double3& direction) const noexcept {
    if (feature.kind != FeatureKind::vertex) return true;
    const auto triangles = model_->model->mesh().triangles;
    const std::uint32_t vertex = triangles[feature.triangle].vertex[feature.corner];
    const Double3 at = model_->position(vertex);
    return !visit_triangles_at(*model_->model, vertex, *scratch_, [&](std::uint32_t t) {
        for (const std::uint32_t other : triangles[t].vertex) {
            const Double3 way = model_->position(other) - at;
            if (dot(way, direction) > kNoRise * largest_of(way)) return false;
        }
        return true;
    });
}

UnitDirections ContactSide::upright(const PieceFeature& feature,
                                    const Double3& direction) const noexcept {
    const auto only = [](const Double3& way) { return UnitDirections{{way}, 1}; };
    if (feature.kind == FeatureKind::face) return {};
    const auto first = find_lean(feature, direction, 0, Over::flat_or_reflex);
    if (!first || !goes_on_beyond(feature, direction)) return {};
    if (feature.kind == FeatureKind::edge) return only(first->face);
    // Without its lean, a direction straight across an edge is rounding alone.
    if (first->by > kAligned) return faces_left_across(feature, direction);
    // Removes the lean over one edge. If the result leans over another edge, takes the direction
    // that is upright on both.
    const Double3 turned = unit(direction - first->by * first->outward);
    const auto second = find_lean(feature, turned, kNoLean, Over::flat_or_reflex);
    if (!second) return only(turned);
    const Double3 both = cross(first->outward, second->outward);
    if (!(dot(both, both) > kNoLean)) return only(first->face);
    return only(dot(both, first->face) < 0 ? unit(-both) : unit(both));
}

bool ContactSide::leans_over_flat_edge(const PieceFeature& feature,
                                       const Double3& direction) const noexcept {
    return feature.kind != FeatureKind::face &&
           find_lean(feature, direction, kNoLean, Over::flat).has_value();
}

ContactFeature ContactSide::in_source(const PieceFeature& feature) const noexcept {
    const Model& model = *model_->model;
    const std::uint32_t vertex = model.mesh().triangles[feature.triangle].vertex[feature.corner];
    const bool is_edge = feature.kind == FeatureKind::edge;
    return {feature.kind, static_cast<std::uint8_t>(is_edge ? feature.corner : 0),
            source_number(model, feature.triangle), source_vertex(vertex)};
}

}  // namespace cdprep
