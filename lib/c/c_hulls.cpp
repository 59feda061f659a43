// SPDX-License-Identifier: MIT
#include <array>
#include <cassert>
#include <optional>

#include "c/c_pairs.h"
#include "cdprep/advanced/convex_penetration.h"
#include "cdprep/hulls.h"
#include "pieces/piece_parts.h"

namespace cdprep::c {

template <>
struct Input<cdprep_hull_pair> {
    static const InputType type;
    static cdprep_hull_pair defaults() noexcept {
        cdprep_hull_pair pair{};
        pair.pose_a = pair.pose_b = kIdentity;
        return pair;
    }
};

namespace {

static_assert(CDPREP_HULL_WHOLE == static_cast<int>(format::HullScope::whole) &&
              CDPREP_HULL_COMPONENT == static_cast<int>(format::HullScope::component) &&
              CDPREP_HULL_INSTANCE == static_cast<int>(format::HullScope::instance) &&
              CDPREP_HULL_PART == static_cast<int>(format::HullScope::part));

constexpr std::size_t kHullA = offsetof(cdprep_hull_pair, a);
constexpr std::size_t kHullB = offsetof(cdprep_hull_pair, b);

constexpr std::array kFields = {
    Field{"a.model", kHullA + offsetof(cdprep_hull, model), Holds::pointer},
    Field{"b.model", kHullB + offsetof(cdprep_hull, model), Holds::pointer},
    Field{"a.scope", kHullA + offsetof(cdprep_hull, scope), Holds::choice, CDPREP_HULL_PIECE},
    Field{"b.scope", kHullB + offsetof(cdprep_hull, scope), Holds::choice, CDPREP_HULL_PIECE},
    Field{"moving", offsetof(cdprep_hull_pair, moving), Holds::choice, CDPREP_MOVE_BOTH},
    Field{"reserved", offsetof(cdprep_hull_pair, reserved), Holds::reserved},
    Field{"pose_a", offsetof(cdprep_hull_pair, pose_a), Holds::number, 0, 12},
    Field{"pose_b", offsetof(cdprep_hull_pair, pose_b), Holds::number, 0, 12},
};

Ask needs_of_scope(std::uint32_t scope) noexcept {
    return scope == CDPREP_HULL_PIECE ? Ask::pieces | Ask::corners : Ask::hulls;
}

int check_scope(Call& call, const Name& name, std::uint32_t scope) noexcept {
    if (scope <= CDPREP_HULL_PIECE) return CDPREP_OK;
    return call.refuse(CDPREP_WHY_OUT_OF_RANGE, name, "is %u; the greatest value is %u.", scope,
                       static_cast<std::uint32_t>(CDPREP_HULL_PIECE));
}

/// Returns whether the model has the hull.
bool exists(const cdprep_hull& hull) noexcept {
    const Model& model = hull.model->model;
    if (hull.scope == CDPREP_HULL_PIECE) return hull.number < model.pieces().pieces.size();
    return find_hull(model, format::HullScope{hull.scope}, hull.number).has_value();
}

int check_exists(Call& call, const Name& name, const cdprep_hull& hull) noexcept {
    if (exists(hull)) return CDPREP_OK;
    return call.refuse(
        CDPREP_WHY_OUT_OF_RANGE, name,
        "is %u, but the model has no such hull: use a number from cdprep_hull_find().",
        hull.number);
}

/// Returns the corners of a hull that exists.
ConvexPoints points_of(const cdprep_hull& hull) noexcept {
    const Model& model = hull.model->model;
    if (hull.scope == CDPREP_HULL_PIECE) return piece_points(model, hull.number);
    const auto at = find_hull(model, format::HullScope{hull.scope}, hull.number);
    return at ? convex_points(model, *at) : ConvexPoints{};
}

/// Two hulls whose every field was checked.
struct AskedHulls {
    cdprep_hull a, b;
    Placement placement = Placement::b_moves(Pose());
    cdprep_hull_cache* cache = nullptr;
};

int read_hull(Call& call, const Name& name, const cdprep_hull& hull, bool is_a, Ask needs) {
    if (const int code =
            check_serves(call, name.of(is_a ? "a.model" : "b.model"), *hull.model, needs)) {
        return code;
    }
    return check_exists(call, name.of(is_a ? "a.number" : "b.number"), hull);
}

/// `needs` is Ask::contacts for queries about features, which only pieces have.
int read_hulls(Call& call, const cdprep_hull_pair* given, std::optional<Ask> needs,
               AskedHulls& asked) {
    const Name name = {"pair"};
    cdprep_hull_pair pair;
    if (const int code = read_input(call, name, given, pair)) return code;
    if (const int code =
            read_placement(call, name, pair.moving, pair.pose_a, pair.pose_b, asked.placement)) {
        return code;
    }
    const bool are_pieces = pair.a.scope == CDPREP_HULL_PIECE && pair.b.scope == CDPREP_HULL_PIECE;
    if (needs && !are_pieces) {
        return call.refuse(CDPREP_WHY_NO_MEANING,
                           name.of(pair.a.scope != CDPREP_HULL_PIECE ? "a.scope" : "b.scope"),
                           "is not CDPREP_HULL_PIECE: only hulls of pieces have features.");
    }
    const Ask needs_a = needs.value_or(needs_of_scope(pair.a.scope));
    const Ask needs_b = needs.value_or(needs_of_scope(pair.b.scope));
    if (const int code = read_hull(call, name, pair.a, true, needs_a)) return code;
    if (const int code = read_hull(call, name, pair.b, false, needs_b)) return code;
    asked.a = pair.a;
    asked.b = pair.b;
    asked.cache = pair.cache;
    return CDPREP_OK;
}

/// The contents of a hull cache in words: the cache of either kind of query.
struct CacheWords {
    std::array<std::uint32_t, 9> convex;
    std::array<std::uint32_t, 5> features;
    std::array<std::uint32_t, 2> rest;
};
static_assert(sizeof(CacheWords) == sizeof(cdprep_hull_cache) &&
              sizeof(CacheWords::convex) == sizeof(ConvexCache));

/// The C++ caches during one query. Any words are allowed: the queries check them.
class HullCacheWords {
public:
    explicit HullCacheWords(cdprep_hull_cache* words) noexcept : to_(words) {
        if (words == nullptr) return;
        std::memcpy(&words_, words, sizeof words_);
        std::memcpy(static_cast<void*>(&convex), &words_.convex, sizeof convex);
        const auto kind = [&](std::size_t i) {
            return static_cast<FeatureKind>(words_.features[i] % 3);
        };
        features.is_set = words_.features[0] != 0;
        features.kind = {kind(1), kind(2)};
        features.edge = {words_.features[3], words_.features[4]};
    }
    HullCacheWords(const HullCacheWords&) = delete;
    HullCacheWords& operator=(const HullCacheWords&) = delete;
    ~HullCacheWords() {
        if (to_ == nullptr) return;
        std::memcpy(&words_.convex, &convex, sizeof convex);
        words_.features = {features.is_set ? 1U : 0U, static_cast<std::uint32_t>(features.kind[0]),
                           static_cast<std::uint32_t>(features.kind[1]), features.edge[0],
                           features.edge[1]};
        std::memcpy(to_, &words_, sizeof words_);
    }
    ConvexCache* used_convex() noexcept {
        return to_ == nullptr ? nullptr : &convex;
    }
    FeatureCache* used_features() noexcept {
        return to_ == nullptr ? nullptr : &features;
    }

private:
    cdprep_hull_cache* to_;
    CacheWords words_{};
    ConvexCache convex;
    FeatureCache features;
};

/// Runs a query about two hulls: `check(call)`, then `ask(a, b, placement, cache)`.
template <class Answer, class Check, class Asker>
int ask_hulls(const cdprep_hull_pair* pair, Answer* answer, const char* answer_name,
              cdprep_error* error, Check&& check, Asker&& ask) noexcept {
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(pair, {"pair"})) return code;
        if (const int code = call.need(answer, {answer_name})) return code;
        if (const int code = check(call)) return code;
        AskedHulls asked;
        if (const int code = read_hulls(call, pair, std::nullopt, asked)) return code;
        HullCacheWords cache(asked.cache);
        ask(points_of(asked.a), points_of(asked.b), asked.placement, cache.used_convex());
        return CDPREP_OK;
    });
}

cdprep_nearest in_c(const std::optional<ConvexDistance>& found) noexcept {
    cdprep_nearest to{};
    if (!found) return to;
    assert(found->lower <= found->upper);
    to.found = CDPREP_YES;
    to.triangle_a = to.triangle_b = CDPREP_NONE;
    to.lower = found->lower;
    to.upper = found->upper;
    store(found->witness_a, to.on_a);
    store(found->witness_b, to.on_b);
    return to;
}

cdprep_penetration in_c(const std::optional<Penetration>& found) noexcept {
    cdprep_penetration to{};
    if (!found) return to;
    assert(found->lower <= found->upper);
    to.found = CDPREP_YES;
    to.lower = found->lower;
    to.upper = found->upper;
    store(found->normal, to.normal);
    store(found->witness_a, to.on_a);
    store(found->witness_b, to.on_b);
    return to;
}

/// Returns a feature of a piece's hull as the vertices that define it, by source number.
cdprep_feature in_c(const Model& model, const FeatureHull& hull,
                    const HullFeature& feature) noexcept {
    cdprep_feature to = {static_cast<std::uint32_t>(feature.kind),
                         CDPREP_NONE,
                         CDPREP_NONE,
                         {CDPREP_NONE, CDPREP_NONE, CDPREP_NONE}};
    const auto vertex_of = [&](std::uint32_t corner) {
        return source_vertex_of(model, hull.points.corners[corner]);
    };
    if (feature.kind == FeatureKind::vertex) {
        assert(feature.number < hull.points.count);
        to.vertex[0] = vertex_of(feature.number);
        return to;
    }
    if (hull.facets.empty()) {
        for (std::uint32_t i = 0; i < hull.points.count && i < 3; ++i) to.vertex[i] = vertex_of(i);
        return to;
    }
    const bool is_edge = feature.kind == FeatureKind::edge;
    assert((is_edge ? feature.number / 3 : feature.number) < hull.facets.size());
    const std::uint32_t first = is_edge ? feature.number % 3 : 0;
    const auto& corner = hull.facets[is_edge ? feature.number / 3 : feature.number].corner;
    for (std::uint32_t i = 0; i < (is_edge ? 2U : 3U); ++i) {
        to.vertex[i] = vertex_of(corner[(first + i) % 3]);
    }
    return to;
}

cdprep_closest_features in_c(const AskedHulls& asked, const FeatureHull& a, const FeatureHull& b,
                             const std::optional<ClosestFeatures>& found) noexcept {
    cdprep_closest_features to{};
    if (!found) return to;
    to.found = CDPREP_YES;
    to.parallel = word(found->parallel);
    to.a = in_c(asked.a.model->model, a, found->a);
    to.b = in_c(asked.b.model->model, b, found->b);
    to.lower = found->lower;
    to.upper = found->upper;
    store(found->witness_a, to.on_a);
    store(found->witness_b, to.on_b);
    return to;
}

/// Stores corners and facets of a piece's hull. Unlike feature queries, this does not read the
/// adjacency of the facets.
void write_piece(const Model& model, std::uint32_t piece, cdprep_mesh& mesh) noexcept {
    const ConvexPoints points = piece_points(model, piece);
    const auto facets =
        part_of_piece(model.pieces().facets, model, piece, &format::Piece::first_facet);
    mesh.vertex_count = points.count;
    mesh.triangle_count = facets.size();
    MeshWriter writer(mesh);
    for (std::uint32_t i = 0; i < points.count && writer.has_room_for_vertex(); ++i) {
        writer.add_vertex(points.point(i), source_vertex_of(model, points.corners[i]));
    }
    for (std::size_t i = 0; i < facets.size() && writer.has_room_for_triangle(); ++i) {
        writer.add_triangle(facets[i].corner);
    }
}

/// Stores the same for a baked hull.
void write_hull(const Model& model, std::uint32_t number, cdprep_mesh& mesh) noexcept {
    const format::Hull& hull = model.hulls().hulls[number];
    const ConvexPoints points = convex_points(model, number);
    const auto vertices =
        model.hulls().vertices.subspan(std::size_t{hull.first_block} * format::kHullLanes);
    const auto facets = model.hulls().facets.subspan(hull.first_facet, hull.facet_count);
    mesh.vertex_count = hull.point_count;
    mesh.triangle_count = facets.size();
    MeshWriter writer(mesh);
    for (std::uint32_t i = 0; i < hull.point_count && writer.has_room_for_vertex(); ++i) {
        writer.add_vertex(points.point(i), vertices[i]);
    }
    for (std::size_t i = 0; i < facets.size() && writer.has_room_for_triangle(); ++i) {
        writer.add_triangle(facets[i].point);
    }
}

}  // namespace

const InputType Input<cdprep_hull_pair>::type = {
    "cdprep_hull_pair", 0xcd500006U, sizeof(cdprep_hull_pair), sizeof(cdprep_hull_pair), kFields};

}  // namespace cdprep::c

using cdprep::ConvexCache;
using cdprep::ConvexPoints;
using cdprep::Placement;
using cdprep::c::Call;
using cdprep::c::guarded;
using cdprep::c::Name;
using cdprep::c::nothing_to_check;

int cdprep_hull_find(const cdprep_model* model, uint32_t scope, uint32_t number, cdprep_hull* hull,
                     cdprep_error* error) {
    if (hull != nullptr) *hull = {};
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(model, {"model"})) return code;
        if (const int code = call.need(hull, {"hull"})) return code;
        if (const int code = cdprep::c::check_scope(call, {"scope"}, scope)) return code;
        if (const int code =
                check_serves(call, {"model"}, *model, cdprep::c::needs_of_scope(scope))) {
            return code;
        }
        const cdprep_hull sought = {model, scope, number};
        if (cdprep::c::exists(sought)) *hull = sought;
        return CDPREP_OK;
    });
}

int cdprep_hull_mesh(const cdprep_hull* hull, cdprep_mesh* mesh, cdprep_error* error) {
    return guarded(error, [&](Call& call) -> int {
        if (const int code = cdprep::c::begin_mesh(call, mesh)) return code;
        const Name name = {"hull"};
        if (const int code = call.need(hull, name)) return code;
        if (const int code = call.need(hull->model, name.of("model"))) return code;
        if (const int code = cdprep::c::check_scope(call, name.of("scope"), hull->scope)) {
            return code;
        }
        if (const int code = check_serves(call, name.of("model"), *hull->model,
                                          cdprep::c::needs_of_scope(hull->scope))) {
            return code;
        }
        if (const int code = cdprep::c::check_exists(call, name.of("number"), *hull)) return code;
        const cdprep::Model& model = hull->model->model;
        if (hull->scope == CDPREP_HULL_PIECE) {
            cdprep::c::write_piece(model, hull->number, *mesh);
        } else {
            const auto at = find_hull(model, cdprep::format::HullScope{hull->scope}, hull->number);
            assert(at.has_value());  // check_exists() found it
            cdprep::c::write_hull(model, *at, *mesh);
        }
        return CDPREP_OK;
    });
}

void cdprep_hull_pair_init(cdprep_hull_pair* pair, size_t size) {
    cdprep::c::initialise(pair, size);
}

int cdprep_hulls_collide(const cdprep_hull_pair* pair, uint32_t* hit, cdprep_error* error) {
    if (hit != nullptr) *hit = CDPREP_UNKNOWN;
    return cdprep::c::ask_hulls(pair, hit, "hit", error, nothing_to_check,
                                [&](const ConvexPoints& a, const ConvexPoints& b,
                                    const Placement& placement, ConvexCache* cache) {
                                    *hit = cdprep::c::word(convex_collide(a, b, placement, cache));
                                });
}

int cdprep_hulls_distance(const cdprep_hull_pair* pair, const cdprep_distance_options* options,
                          cdprep_nearest* nearest, cdprep_error* error) {
    if (nearest != nullptr) *nearest = {};
    cdprep_distance_options given{};
    return cdprep::c::ask_hulls(
        pair, nearest, "nearest", error,
        [&](Call& call) { return cdprep::c::read_distance_options(call, options, given); },
        [&](const ConvexPoints& a, const ConvexPoints& b, const Placement& placement,
            ConvexCache* cache) {
            *nearest = cdprep::c::in_c(convex_distance(
                a, b, placement, {given.relative_error, given.absolute_error, given.max_distance},
                cache));
        });
}

int cdprep_hulls_within(const cdprep_hull_pair* pair, double tolerance, uint32_t* within,
                        cdprep_error* error) {
    if (within != nullptr) *within = CDPREP_UNKNOWN;
    return cdprep::c::ask_hulls(
        pair, within, "within", error,
        [&](Call& call) {
            return check_number(call, "tolerance", cdprep::c::Holds::length, tolerance);
        },
        [&](const ConvexPoints& a, const ConvexPoints& b, const Placement& placement,
            ConvexCache* cache) {
            *within = cdprep::c::word(convex_within(a, b, placement, tolerance, cache));
        });
}

int cdprep_hulls_penetration(const cdprep_hull_pair* pair, const cdprep_distance_options* options,
                             cdprep_penetration* penetration, cdprep_error* error) {
    if (penetration != nullptr) *penetration = {};
    cdprep_distance_options given{};
    return cdprep::c::ask_hulls(
        pair, penetration, "penetration", error,
        [&](Call& call) -> int {
            if (const int code = cdprep::c::read_distance_options(call, options, given)) {
                return code;
            }
            if (cdprep::c::is_infinite(given.max_distance)) return CDPREP_OK;
            return call.refuse(CDPREP_WHY_NO_MEANING, Name{"options"}.of("max_distance"),
                               "is %.17g, which this query does not use; leave it at its default.",
                               given.max_distance);
        },
        [&](const ConvexPoints& a, const ConvexPoints& b, const Placement& placement,
            ConvexCache* cache) {
            *penetration = cdprep::c::in_c(convex_penetration(
                a, b, placement, {given.relative_error, given.absolute_error}, cache));
        });
}

int cdprep_hulls_features(const cdprep_hull_pair* pair, cdprep_closest_features* features,
                          cdprep_error* error) {
    if (features != nullptr) *features = {};
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(pair, {"pair"})) return code;
        if (const int code = call.need(features, {"features"})) return code;
        cdprep::c::AskedHulls asked;
        if (const int code = read_hulls(call, pair, cdprep::Ask::contacts, asked)) return code;
        cdprep::c::HullCacheWords cache(asked.cache);
        const auto a = cdprep::feature_hull(asked.a.model->model, asked.a.number);
        const auto b = cdprep::feature_hull(asked.b.model->model, asked.b.number);
        *features = cdprep::c::in_c(asked, a, b,
                                    closest_features(a, b, asked.placement, cache.used_features()));
        return CDPREP_OK;
    });
}
