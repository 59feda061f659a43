// SPDX-License-Identifier: MIT
// Hostile arguments: whatever the C API is called with, it answers or refuses.
//
// Every struct is made by its initialiser, as the header demands, and then changed at random:
// fields, sizes, tags, caches, pointers that may be null. What is refused must leave answers that
// say that nothing is known; what is answered must be finite; no call may report a mistake of the
// library.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>

#include "hostile_input.h"

#include "cdprep/cdprep.h"

namespace {

using namespace cdprep::test;  // NOLINT(google-build-using-namespace): a program of its own

template <class Cache>
void draw_cache(Draw& draw, Cache& cache) {
    if (!draw.one_in(4)) return;
    for (auto& word : cache.words) {
        if (draw.one_in(2))
            word = draw.number() > 0 ? ~std::uint64_t{0} / (1U + draw.byte()) : draw.byte();
    }
}

/// One call after the other, with one workspace and a few caches.
class Caller {
public:
    Caller(Draw& draw, const Models& models) : draw_(draw), models_(models) {
        cdprep_workspace_options options;
        cdprep_workspace_options_init(&options, sizeof options);
        if (draw.one_in(2)) options.cells = cdprep_cells();
        MUST(cdprep_workspace_make(&options, nullptr, 0, &workspace_, nullptr) == CDPREP_OK);
    }
    Caller(const Caller&) = delete;
    Caller& operator=(const Caller&) = delete;
    ~Caller() {
        cdprep_workspace_end(workspace_);
    }

    void call() {
        error_.code = 99;
        switch (draw_.below(17)) {
            case 0:
                return collide();
            case 1:
                return list_pairs();
            case 2:
                return distance();
            case 3:
                return mark();
            case 4:
                return contacts();
            case 5:
                return hulls();
            case 6:
                return points();
            case 7:
                return rays();
            case 8:
                return shapes();
            case 9:
                return geometry();
            case 10:
                return batch();
            case 11:
                return poses();
            case 12:
                return visit();
            case 13:
                return build();
            case 14:
                return itself();
            case 15:
                return impact();
            default:
                return open();
        }
    }

private:
    /// Whether the call was answered; checks what every call promises.
    bool is_answered(int code) {
        MUST(code == CDPREP_OK || code == CDPREP_BAD_ARGUMENT || code == CDPREP_UNREADABLE);
        MUST(error_.code == code && (error_.why != 0) == (code == CDPREP_BAD_ARGUMENT));
        MUST(std::memchr(error_.message, 0, sizeof error_.message) != nullptr);
        MUST((error_.message[0] != 0) == (code != CDPREP_OK));
        return code == CDPREP_OK;
    }
    cdprep_workspace* workspace() {
        return draw_.one_in(40) ? nullptr : workspace_;
    }
    const cdprep_pair* pair() {
        cdprep_pair_init(&pair_.value, sizeof pair_.value);
        cdprep_pair& p = pair_.value;
        p.a = models_.any(draw_);
        p.b = models_.any(draw_);
        if (draw_.one_in(2)) p.cache = &cache_;
        draw_cache(draw_, cache_);
        if (draw_.one_in(2)) p.front = &front_;
        if (draw_.one_in(4)) front_.words[draw_.below(3600)] ^= draw_.word();
        draw_pose(draw_, p.pose_a);
        draw_pose(draw_, p.pose_b);
        if (draw_.one_in(2)) p.moving = draw_.below(3);
        if (draw_.one_in(4)) p.body = draw_.below(2);
        if (draw_.one_in(4)) p.overlap = draw_.below(2);
        if (draw_.one_in(4)) p.degenerate = draw_.below(2);
        if (draw_.one_in(3)) p.through = draw_.below(6);
        if (draw_.one_in(20)) (&p.moving)[draw_.below(6)] = draw_.word();
        pair_.spoil(draw_);
        return draw_.one_in(40) ? nullptr : &pair_.value;
    }
    const cdprep_distance_options* options() {
        cdprep_distance_options_init(&distance_.value, sizeof distance_.value);
        if (draw_.one_in(3)) distance_.value.relative_error = draw_.number();
        if (draw_.one_in(3)) distance_.value.absolute_error = draw_.number();
        if (draw_.one_in(3)) distance_.value.max_distance = draw_.number();
        distance_.spoil(draw_);
        return draw_.one_in(3) ? nullptr : &distance_.value;
    }
    void collide() {
        cdprep_collision found = {9, 9, 9, 9, 9};
        std::uint32_t hit = 9;
        int code = 0;
        const cdprep_pair* const given = pair();
        switch (draw_.below(4)) {
            case 0:
                code = cdprep_containment(given, workspace(), &found, &error_);
                break;
            case 1:
                code = cdprep_collide_at_level(given, draw_.word(), workspace(), &hit, &error_);
                MUST(hit <= CDPREP_UNKNOWN && (is_answered(code) || hit == CDPREP_UNKNOWN));
                return;
            case 2:
                code = cdprep_within(given, draw_.number(), workspace(), &hit, &error_);
                MUST(is_answered(code) ? hit <= CDPREP_YES : hit == CDPREP_UNKNOWN);
                return;
            default:
                code = cdprep_collide(given, workspace(), &found, &error_);
        }
        MUST(found.hit <= CDPREP_UNKNOWN && std::isfinite(found.winding));
        MUST(is_answered(code) || found.hit == CDPREP_UNKNOWN);
    }
    void list_pairs() {
        cdprep_overlap_list list = {draw_.one_in(8) ? nullptr : overlaps_.data(),
                                    draw_.below(kRoom + 1), 99};
        const cdprep_pair* const given = pair();
        int code = 0;
        if (draw_.one_in(3)) {
            code = cdprep_pairs_within(given, draw_.number(), workspace(), &list, &error_);
        } else if (draw_.one_in(3)) {
            code = cdprep_overlaps_split(given, workspace(), &list, &error_);
        } else {
            code = cdprep_overlaps(given, workspace(), &list, &error_);
        }
        if (!is_answered(code)) MUST(list.count == 0);
        cdprep_crossing_list crossings = {crossings_.data(), draw_.below(kRoom + 1), 99};
        code = cdprep_crossings(given, workspace(), &crossings, &error_);
        if (!is_answered(code)) {
            MUST(crossings.count == 0);
            return;
        }
        for (std::size_t i = 0; i < std::min(crossings.count, crossings.room); ++i) {
            MUST(is_finite(crossings_[i].ends[0]) && is_finite(crossings_[i].ends[1]));
        }
    }
    void itself() {
        Longer<cdprep_self_query> given{};
        cdprep_self_query_init(&given.value, sizeof given.value);
        given.value.model = models_.any(draw_);
        if (draw_.one_in(4)) given.value.overlap = draw_.below(3);
        if (draw_.one_in(4)) given.value.degenerate = draw_.below(3);
        given.spoil(draw_);
        cdprep_overlap_list list = {draw_.one_in(8) ? nullptr : overlaps_.data(),
                                    draw_.below(kRoom + 1), 99};
        if (!is_answered(cdprep_self_overlaps(&given.value, workspace(), &list, &error_)))
            MUST(list.count == 0);
        const auto see = [](void* /*context*/, const cdprep_overlap* found) {
            MUST(found->a < found->b);
            return 1;
        };
        (void)is_answered(cdprep_self_overlaps_visit(
            &given.value, workspace(), draw_.one_in(20) ? nullptr : +see, this, &error_));
    }
    void distance() {
        cdprep_nearest nearest{};
        nearest.found = 99;
        const cdprep_pair* const given = pair();
        const int code = cdprep_distance(given, options(), workspace(), &nearest, &error_);
        if (!is_answered(code)) MUST(nearest.found == CDPREP_NO);
        MUST(is_finite(nearest));
    }
    void draw_motion(cdprep_motion& motion) {
        draw_pose(draw_, motion.start);
        if (draw_.one_in(2)) draw_pose(draw_, motion.end);
        if (draw_.one_in(4)) motion.given_by = draw_.below(2);
        if (draw_.one_in(3)) motion.centre[draw_.below(3)] = draw_.number();
        if (draw_.one_in(3)) motion.shift[draw_.below(3)] = draw_.number();
        if (draw_.one_in(3)) motion.turn[draw_.below(3)] = draw_.number();
        if (draw_.one_in(20)) motion.given_by = draw_.word();
    }
    void impact() {
        Longer<cdprep_moving_pair> given{};
        cdprep_moving_pair_init(&given.value, sizeof given.value);
        cdprep_moving_pair& p = given.value;
        p.a = models_.any(draw_);
        p.b = models_.any(draw_);
        draw_motion(p.motion_a);
        draw_motion(p.motion_b);
        if (draw_.one_in(4)) p.body = draw_.below(2);
        if (draw_.one_in(2)) p.tolerance = draw_.number();
        if (draw_.one_in(4)) p.most_steps = draw_.below(300);
        given.spoil(draw_);
        cdprep_impact found{};
        if (!is_answered(cdprep_time_of_impact(&p, workspace(), &found, &error_))) {
            MUST(found.kind == CDPREP_IMPACT_UNKNOWN);
            return;
        }
        MUST(found.kind <= CDPREP_IMPACT_UNFINISHED && found.steps <= p.most_steps);
        MUST(found.lower >= 0 && found.lower <= 1 && found.upper >= found.lower);
        MUST(is_finite(found.nearest));
        cdprep_pose pose;
        MUST(cdprep_motion_pose(&p.motion_b, found.lower, &pose, &error_) == CDPREP_OK);
    }
    void mark() {
        std::array<std::uint64_t, 2> bits_a{}, bits_b{};
        cdprep_marks marks = {draw_.one_in(8) ? nullptr : bits_a.data(), bits_b.data(),
                              draw_.below(3), draw_.below(3), 99};
        const int code = cdprep_overlaps_mark(pair(), workspace(), &marks, &error_);
        if (!is_answered(code)) MUST(marks.count == 0);
    }
    void contacts() {
        Longer<cdprep_contact_options> given{};
        cdprep_contact_options_init(&given.value, sizeof given.value);
        given.value.tolerance = draw_.number();
        if (draw_.one_in(2)) given.value.manifold = 4;
        if (draw_.one_in(8)) given.value.manifold = draw_.word();
        if (draw_.one_in(4)) given.value.most = draw_.below(300);
        if (draw_.one_in(4)) given.value.cluster_angle = draw_.number();
        if (draw_.one_in(4)) given.value.work = draw_.word();
        given.spoil(draw_);
        std::array<cdprep_contact, 8> items{};
        cdprep_contact_list list = {items.data(), draw_.below(9), 99, 99, 99, 99, 99, 99};
        const int code = cdprep_contacts(pair(), &given.value, workspace(), &list, &error_);
        if (!is_answered(code)) MUST(list.count == 0 && list.complete == CDPREP_NO);
        for (std::size_t i = 0; i < std::min(list.count, list.room); ++i) {
            MUST(is_finite(items[i].normal) && std::isfinite(items[i].upper));
        }
    }
    void draw_hull(cdprep_hull& hull) {
        hull = {models_.any(draw_), draw_.below(5), draw_.below(3)};
        if (draw_.one_in(10)) hull.scope = draw_.word();
        if (draw_.one_in(10)) hull.number = draw_.word();
    }
    void hulls() {
        Longer<cdprep_hull_pair> given{};
        cdprep_hull_pair_init(&given.value, sizeof given.value);
        draw_hull(given.value.a);
        draw_hull(given.value.b);
        draw_pose(draw_, given.value.pose_a);
        draw_pose(draw_, given.value.pose_b);
        draw_cache(draw_, hull_cache_);
        if (draw_.one_in(2)) given.value.cache = &hull_cache_;
        if (draw_.one_in(2)) given.value.moving = draw_.below(4);
        given.spoil(draw_);
        std::uint32_t yes = 9;
        cdprep_nearest nearest{};
        cdprep_penetration depth{};
        cdprep_closest_features features{};
        switch (draw_.below(5)) {
            case 0:
                if (!is_answered(cdprep_hulls_collide(&given.value, &yes, &error_)))
                    MUST(yes == CDPREP_UNKNOWN);
                return;
            case 1:
                if (!is_answered(cdprep_hulls_within(&given.value, draw_.number(), &yes, &error_)))
                    MUST(yes == CDPREP_UNKNOWN);
                return;
            case 2:
                if (!is_answered(cdprep_hulls_distance(&given.value, options(), &nearest, &error_)))
                    MUST(nearest.found == CDPREP_NO);
                MUST(is_finite(nearest));
                return;
            case 3:
                if (!is_answered(
                        cdprep_hulls_penetration(&given.value, options(), &depth, &error_)))
                    MUST(depth.found == CDPREP_NO);
                MUST(is_finite(depth.normal) && std::isfinite(depth.upper));
                return;
            default:
                if (!is_answered(cdprep_hulls_features(&given.value, &features, &error_)))
                    MUST(features.found == CDPREP_NO);
                MUST(std::isfinite(features.upper) && is_finite(features.on_a));
                return;
        }
    }
    void points() {
        std::array<double, 9> numbers{};
        for (double& number : numbers)
            number = draw_.one_in(3) ? draw_.number() : draw_.byte() / 64.0;
        Longer<cdprep_point_query> given{};
        cdprep_point_query_init(&given.value, sizeof given.value);
        given.value.model = models_.any(draw_);
        given.value.points = draw_.one_in(20) ? nullptr : numbers.data();
        given.value.count = draw_.below(4);
        if (draw_.one_in(4)) given.value.max_distance = draw_.number();
        if (draw_.one_in(4)) given.value.through = draw_.below(7);
        given.spoil(draw_);
        std::array<cdprep_closest_point, 3> closest{};
        std::array<cdprep_point_state, 3> states{};
        if (draw_.one_in(2)) {
            if (!is_answered(
                    cdprep_points_closest(&given.value, workspace(), closest.data(), &error_)))
                MUST(closest[0].found == CDPREP_NO);
            for (const auto& c : closest)
                MUST(is_finite(c.point) && std::isfinite(c.upper) && c.lower <= c.upper);
        } else {
            (void)is_answered(
                cdprep_points_inside(&given.value, workspace(), states.data(), &error_));
            for (const auto& s : states)
                MUST(s.inside <= CDPREP_UNKNOWN && std::isfinite(s.winding));
        }
    }
    void rays() {
        std::array<cdprep_ray, 2> rays{};
        for (auto& ray : rays) {
            for (std::size_t i = 0; i < 3; ++i) {
                ray.origin[i] = draw_.one_in(4) ? draw_.number()
                                                : static_cast<std::int8_t>(draw_.byte()) / 32.0;
                ray.direction[i] = draw_.one_in(4) ? draw_.number()
                                                   : static_cast<std::int8_t>(draw_.byte()) / 32.0;
            }
            ray.max_t = draw_.one_in(4) ? draw_.number() : std::numeric_limits<double>::infinity();
        }
        Longer<cdprep_ray_query> given{};
        cdprep_ray_query_init(&given.value, sizeof given.value);
        given.value.model = models_.any(draw_);
        given.value.rays = draw_.one_in(20) ? nullptr : rays.data();
        given.value.count = draw_.below(3);
        given.spoil(draw_);
        const auto see = [](void* /*context*/, const cdprep_ray_hit* hit) {
            MUST(hit->found == CDPREP_YES && std::isfinite(hit->t) && is_finite(hit->point));
            return 1;
        };
        // A visitor has one ray and no room for answers, so that any count is safe.
        Longer<cdprep_ray_query> visited = given;
        if (draw_.one_in(2)) visited.value.count = draw_.one_in(4) ? SIZE_MAX : draw_.word();
        (void)is_answered(cdprep_rays_visit(&visited.value, workspace(),
                                            draw_.one_in(20) ? nullptr : +see, this, &error_));
        std::array<cdprep_ray_hit, 4> items{};
        std::array<cdprep_ray_hit, 2> hits{};
        std::array<std::uint32_t, 2> any{};
        std::array<cdprep_ray_hit_list, 2> lists = {
            {{items.data(), 2, 0}, {items.data() + 2, 2, 0}}};
        (void)is_answered(cdprep_rays_any(&given.value, workspace(), any.data(), &error_));
        (void)is_answered(cdprep_rays_all(&given.value, workspace(), lists.data(), &error_));
        (void)is_answered(cdprep_rays_cast(&given.value, workspace(), hits.data(), &error_));
        for (const auto& hit : hits) MUST(std::isfinite(hit.t) && is_finite(hit.point));
        for (const auto& hit : items) MUST(std::isfinite(hit.t) && is_finite(hit.point));
    }
    void shapes() {
        Longer<cdprep_shape_query> given{};
        cdprep_shape_query_init(&given.value, sizeof given.value);
        cdprep_shape_query& q = given.value;
        q.model = models_.any(draw_);
        q.shape = draw_.below(6);
        for (double* const point : {q.a, q.b, q.c}) {
            for (std::size_t i = 0; i < 3; ++i) {
                point[i] = draw_.one_in(5) ? draw_.number()
                                           : static_cast<std::int8_t>(draw_.byte()) / 32.0;
            }
        }
        q.radius = draw_.number();
        if (draw_.one_in(4)) q.max_distance = draw_.number();
        if (draw_.one_in(4)) q.degenerate = draw_.below(3);
        draw_pose(draw_, q.world_from_model);
        given.spoil(draw_);
        std::array<std::uint32_t, 4> items{};
        cdprep_triangle_list list = {items.data(), 4, 99};
        std::uint32_t touches = 9;
        cdprep_nearest nearest{};
        if (!is_answered(cdprep_touch(&q, workspace(), &touches, &error_)))
            MUST(touches == CDPREP_UNKNOWN);
        if (!is_answered(cdprep_touch_list(&q, workspace(), &list, &error_))) MUST(list.count == 0);
        const auto see = [](void* /*context*/, std::uint32_t /*triangle*/) { return 1; };
        (void)is_answered(
            cdprep_touch_visit(&q, workspace(), draw_.one_in(20) ? nullptr : +see, this, &error_));
        if (!is_answered(cdprep_shape_distance(&q, workspace(), &nearest, &error_)))
            MUST(nearest.found == CDPREP_NO);
        MUST(is_finite(nearest));
        shapes_of(q);
    }
    /// A batch of three, of which the last is `q`.
    void shapes_of(const cdprep_shape_query& q) {
        std::array<cdprep_shape_query, 3> queries;
        for (cdprep_shape_query& each : queries) {
            cdprep_shape_query_init(&each, sizeof each);
            each.model = models_.any(draw_);
            each.shape = CDPREP_SPHERE;
            each.radius = 1;
        }
        queries[2] = q;
        // A size that is not the array's would be a lie about memory.
        queries[2].head.size = sizeof q;
        std::array<std::uint32_t, 3> touches = {9, 9, 9};
        std::array<cdprep_nearest, 3> nearest{};
        const bool is_touched =
            is_answered(cdprep_touch_many(queries.data(), 3, workspace(), touches.data(), &error_));
        for (const std::uint32_t one : touches) {
            MUST(is_touched ? one <= CDPREP_YES : one == CDPREP_UNKNOWN);
        }
        if (!is_answered(cdprep_shape_distance_many(queries.data(), 3, workspace(), nearest.data(),
                                                    &error_))) {
            for (const auto& one : nearest) MUST(one.found == CDPREP_NO);
        }
        for (const auto& one : nearest) MUST(is_finite(one));
    }
    void geometry() {
        const cdprep_model* const model = models_.any(draw_);
        std::array<std::uint32_t, 3> triangles = {draw_.word(), draw_.byte(), 0};
        std::array<cdprep_corners, 3> corners{};
        cdprep_model_info info;
        cdprep_array array;
        cdprep_verdict verdict;
        cdprep_mass mass;
        const char* text = nullptr;
        std::size_t length = 0;
        double bound = 0;
        std::array<double, 12> positions{};
        std::array<std::uint32_t, 12> indices{};
        cdprep_mesh mesh = {positions.data(), indices.data(), nullptr, 4, 4, 0, 0};
        cdprep_hull hull;
        draw_hull(hull);
        (void)is_answered(cdprep_model_describe(model, &info, &error_));
        (void)is_answered(
            cdprep_model_corners(model, triangles.data(), draw_.below(4), corners.data(), &error_));
        (void)is_answered(cdprep_model_section(
            model, draw_.one_in(4) ? draw_.word() : draw_.byte() % 70U, &array, &error_));
        (void)is_answered(
            cdprep_model_text(model, draw_.below(6), draw_.word(), &text, &length, &error_));
        (void)is_answered(cdprep_model_verdict(model, draw_.word(), &verdict, &error_));
        (void)is_answered(cdprep_model_mass(model, &mass, &error_));
        (void)is_answered(cdprep_model_level_error(model, draw_.word(), &bound, &error_));
        (void)is_answered(cdprep_model_mesh(model, &mesh, &error_));
        (void)is_answered(cdprep_model_serves(model, draw_.word(), &error_));
        (void)is_answered(cdprep_model_prefetch(model, draw_.word(), &error_));
        (void)is_answered(cdprep_hull_mesh(&hull, &mesh, &error_));
        (void)is_answered(cdprep_hull_find(model, hull.scope, hull.number, &hull, &error_));
        (void)is_answered(cdprep_model_bytes(model, &array, &error_));
        (void)cdprep_ask_name(draw_.word());
        picture(model);
    }
    /// The shapes that a picture hands on are finite. It ends after at most 50 of them.
    struct Shapes {
        int left;
        int take(std::span<const double> numbers) {
            for (const double x : numbers) MUST(std::isfinite(x));
            return left-- > 1 ? 1 : 0;
        }
    };
    void picture(const cdprep_model* model) {
        Shapes shapes = {1 + static_cast<int>(draw_.below(50))};
        Longer<cdprep_draw> given{};
        cdprep_draw_init(&given.value, sizeof given.value);
        cdprep_draw& d = given.value;
        d.what = draw_.one_in(8) ? draw_.word() : draw_.below(128) & 0x4f;
        if (draw_.one_in(4)) d.level = draw_.word();
        d.context = &shapes;
        if (!draw_.one_in(20)) {
            d.line = [](void* to, const double* start, const double* end, std::uint32_t /*rgba*/) {
                for (const double* const point : {start, end}) {
                    for (int i = 0; i < 3; ++i) MUST(std::isfinite(point[i]));
                }
                return static_cast<Shapes*>(to)->take({});
            };
        }
        if (!draw_.one_in(20)) {
            d.triangle = [](void* to, const double* corners, std::uint32_t /*rgba*/) {
                return static_cast<Shapes*>(to)->take({corners, 9});
            };
        }
        if (!draw_.one_in(20)) {
            d.label = [](void* to, const double* at, const char* text, std::uint32_t /*rgba*/) {
                MUST(text[0] != 0 && std::strlen(text) < 16);
                return static_cast<Shapes*>(to)->take({at, 3});
            };
        }
        given.spoil(draw_);
        cdprep_pose pose = {{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}};
        draw_pose(draw_, pose);
        (void)is_answered(cdprep_model_draw(model, &pose, &d, &error_));
        const std::array<double, 3> origin = {draw_.number(), 0, 0};
        cdprep_world_box box{};
        if (!is_answered(cdprep_model_box(model, &pose, draw_.number(),
                                          draw_.one_in(2) ? origin.data() : nullptr, &box,
                                          &error_))) {
            MUST(box.lower[0] > box.upper[0]);
        }
        for (int i = 0; i < 3; ++i) MUST(!std::isnan(box.lower[i]) && !std::isnan(box.upper[i]));
    }
    void batch() {
        std::array<cdprep_pair, 3> pairs;
        for (cdprep_pair& p : pairs) {
            const cdprep_pair* const drawn = pair();
            p = drawn == nullptr ? cdprep_pair{} : *drawn;
            // A size that is not the array's would be a lie about memory.
            p.head.size = sizeof p;
            p.cache = nullptr;
            p.front = nullptr;
        }
        std::array<cdprep_collision, 3> found{};
        std::array<cdprep_nearest, 3> nearest{};
        std::array<cdprep_overlap_list, 3> lists = {
            {{overlaps_.data(), 4, 9}, {overlaps_.data() + 4, 4, 9}, {nullptr, draw_.below(2), 9}}};
        const std::size_t count = draw_.below(4);
        if (!is_answered(
                cdprep_collide_many(pairs.data(), count, workspace(), found.data(), &error_))) {
            for (std::size_t i = 0; i < count; ++i) MUST(found[i].hit == CDPREP_UNKNOWN);
        }
        if (!is_answered(
                cdprep_overlaps_many(pairs.data(), count, workspace(), lists.data(), &error_))) {
            for (std::size_t i = 0; i < count; ++i) MUST(lists[i].count == 0);
        }
        (void)is_answered(cdprep_distance_many(pairs.data(), count, options(), workspace(),
                                               nearest.data(), &error_));
        for (const auto& n : nearest) MUST(is_finite(n));
    }
    void poses() {
        std::array<double, 16> matrix = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
        for (int i = 0; i < 3; ++i) matrix[draw_.below(16)] = draw_.number();
        cdprep_pose pose = {{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}}, other = pose, made;
        draw_pose(draw_, pose);
        draw_pose(draw_, other);
        (void)is_answered(
            cdprep_pose_nearest(matrix.data(), draw_.word(), draw_.number(), &made, &error_));
        MUST(is_finite(made.rows));
        (void)is_answered(cdprep_pose_compose(&pose, &other, &made, &error_));
        MUST(is_finite(made.rows));
        (void)is_answered(cdprep_pose_inverse(&pose, &made, &error_));
        MUST(is_finite(made.rows));
        if (is_answered(cdprep_pose_relative(&pose, &other, &made, &error_))) {
            MUST(is_answered(cdprep_pose_relative(&made, &made, &made, &error_)) ||
                 error_.why == CDPREP_WHY_NOT_RIGID);
        }
        MUST(is_finite(made.rows));
        std::array<double, 3> point = {draw_.number(), draw_.number(), draw_.number()};
        if (is_answered(cdprep_pose_move(&pose, point.data(), 1, point.data(), &error_)))
            MUST(is_finite(point));
    }
    /// A visitor that asks with the workspace that is in use.
    static int ask_again(void* caller, const cdprep_overlap* /*overlap*/) {
        auto* const self = static_cast<Caller*>(caller);
        cdprep_pair inner;
        cdprep_pair_init(&inner, sizeof inner);
        inner.a = self->pair_.value.a;
        inner.b = self->pair_.value.b;
        cdprep_collision found = {9, 9, 9, 9, 9};
        cdprep_error error;
        const int code = cdprep_collide(&inner, self->workspace_, &found, &error);
        MUST(code == CDPREP_BAD_ARGUMENT && found.hit == CDPREP_UNKNOWN);
        return self->draw_.byte() % 4;
    }
    void visit() {
        (void)is_answered(cdprep_overlaps_visit(
            pair(), workspace(), draw_.one_in(20) ? nullptr : ask_again, this, &error_));
        (void)is_answered(cdprep_pairs_within_visit(pair(), draw_.number(), workspace(), ask_again,
                                                    this, &error_));
        const auto see_crossing = [](void* /*context*/, const cdprep_crossing* crossing) {
            MUST(is_finite(crossing->ends[0]) && is_finite(crossing->ends[1]));
            return 1;
        };
        (void)is_answered(cdprep_crossings_visit(pair(), workspace(), see_crossing, this, &error_));
        const auto see_contact = [](void* /*context*/, const cdprep_contact* contact) {
            MUST(is_finite(contact->normal) && std::isfinite(contact->upper));
            return 1;
        };
        (void)is_answered(
            cdprep_contacts_visit(pair(), nullptr, workspace(), see_contact, this, &error_));
    }
    void open() {
        Longer<cdprep_open_options> given{};
        cdprep_open_options_init(&given.value, sizeof given.value);
        if (draw_.one_in(2)) given.value.ask = draw_.word();
        given.value.mode = draw_.below(4);
        given.spoil(draw_);
        std::array<std::uint8_t, 128> bytes{};
        for (auto& byte : bytes) byte = draw_.byte();
        cdprep_model* model = nullptr;
        (void)is_answered(cdprep_model_open_memory(bytes.data(), draw_.below(128), &given.value,
                                                   &model, &error_));
        MUST(model == nullptr);
        Longer<cdprep_workspace_options> options{};
        cdprep_workspace_options_init(&options.value, sizeof options.value);
        if (draw_.one_in(2)) options.value.lanes = draw_.word();
        options.value.counting = draw_.below(3);
        options.spoil(draw_);
        std::size_t size = 99;
        if (!is_answered(cdprep_workspace_size(&options.value, &size, &error_))) MUST(size == 0);
    }

    /// A mesh of a few triangles, in memory of exactly the size that is said to be enough.
    void build() {
        std::array<double, 30> doubles{};
        std::array<float, 30> floats{};
        std::array<std::uint32_t, 36> triangles{};
        const bool is_hostile = draw_.one_in(4);
        for (std::size_t i = 0; i < doubles.size(); ++i) {
            doubles[i] = is_hostile && draw_.one_in(8)
                             ? draw_.number()
                             : static_cast<std::int8_t>(draw_.byte()) / 32.0;
            floats[i] = static_cast<float>(doubles[i]);
        }
        for (std::uint32_t& vertex : triangles) {
            vertex = is_hostile && draw_.one_in(20) ? draw_.word() : draw_.below(8);
        }
        Longer<cdprep_build_options> given{};
        cdprep_build_options_init(&given.value, sizeof given.value);
        cdprep_build_options& b = given.value;
        if (!draw_.one_in(3)) b.positions = doubles.data();
        if (draw_.one_in(3)) b.positions_f32 = floats.data();
        if (!draw_.one_in(20)) b.triangles = triangles.data();
        b.vertex_count = draw_.below(11);
        b.triangle_count = draw_.below(13);
        // A count above that of the array is a lie about memory, but for what no model may have.
        if (draw_.one_in(30)) b.vertex_count = SIZE_MAX - draw_.byte();
        if (draw_.one_in(30)) b.triangle_count = (SIZE_MAX >> 1) - draw_.byte();
        if (draw_.one_in(3)) b.ask = draw_.one_in(2) ? draw_.word() : 1U << draw_.below(32);
        if (draw_.one_in(3)) b.precision = draw_.below(3);
        given.spoil(draw_);
        const cdprep_build_options* const options = draw_.one_in(40) ? nullptr : &b;
        std::size_t size = 99;
        const bool is_sized = is_answered(cdprep_model_build_size(options, &size, &error_));
        MUST(is_sized == (size > 0));
        const std::size_t less = draw_.one_in(10) ? 1 : 0;
        AlignedBytes memory(is_sized ? size - less : 0);
        const bool is_own = !is_sized || draw_.one_in(3);
        void* const start = is_own ? nullptr : memory.span().data();
        const std::size_t room = is_own ? draw_.one_in(20) : memory.size();
        cdprep_model* model = nullptr;
        const int code = cdprep_model_build(options, start, room, workspace(), &model, &error_);
        if (!is_answered(code)) {
            MUST(model == nullptr);
            return;
        }
        MUST(is_sized && (is_own || less == 0));
        ask(model);
        cdprep_model_close(model);
    }
    /// Every answer about a model that was just built is finite, or it says so.
    void ask(const cdprep_model* model) {
        cdprep_pair p;
        cdprep_pair_init(&p, sizeof p);
        p.a = model;
        p.b = draw_.one_in(2) ? model : models_.any(draw_);
        cdprep_nearest nearest{};
        cdprep_collision found{};
        if (!is_answered(cdprep_distance(&p, nullptr, workspace_, &nearest, &error_)))
            MUST(nearest.found == CDPREP_NO);
        MUST(is_finite(nearest));
        (void)is_answered(cdprep_collide(&p, workspace_, &found, &error_));
        const std::uint32_t triangle = draw_.below(13);
        cdprep_corners corners{};
        if (is_answered(cdprep_model_corners(model, &triangle, 1, &corners, &error_))) {
            for (const auto& point : corners.point) MUST(is_finite(point));
        }
    }

    static constexpr std::uint32_t kRoom = 16;
    Draw& draw_;
    const Models& models_;
    cdprep_workspace* workspace_ = nullptr;
    cdprep_error error_{};
    Longer<cdprep_pair> pair_{};
    Longer<cdprep_distance_options> distance_{};
    cdprep_cache cache_{};
    cdprep_front front_{};
    cdprep_hull_cache hull_cache_{};
    std::array<cdprep_overlap, kRoom> overlaps_{};
    std::array<cdprep_crossing, kRoom> crossings_{};
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const Models models;
    Draw draw({data, size});
    Caller caller(draw, models);
    for (int calls = 0; calls < 32 && !draw.is_at_end(); ++calls) caller.call();
    return 0;
}
