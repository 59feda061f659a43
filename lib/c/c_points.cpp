// SPDX-License-Identifier: MIT
#include "cdprep/c/points.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "c/c_pairs.h"
#include "cdprep/format/float_environment.h"
#include "cdprep/points.h"
#include "core/share_out.h"

namespace cdprep::c {

template <>
struct Input<cdprep_point_query> {
    static const InputType type;
    static cdprep_point_query defaults() noexcept {
        cdprep_point_query query{};
        query.count = 1;
        query.max_distance = std::numeric_limits<double>::infinity();
        return query;
    }
};

template <>
struct Input<cdprep_ray_query> {
    static const InputType type;
    static cdprep_ray_query defaults() noexcept {
        return {{}, nullptr, nullptr, 1};
    }
};

namespace {

constexpr std::array kPointFields = {
    Field{"model", offsetof(cdprep_point_query, model), Holds::pointer},
    Field{"through", offsetof(cdprep_point_query, through), Holds::choice, CDPREP_THROUGH_PIECES},
    Field{"reserved", offsetof(cdprep_point_query, reserved), Holds::reserved},
    Field{"max_distance", offsetof(cdprep_point_query, max_distance), Holds::limit},
};

constexpr std::array kRayFields = {
    Field{"model", offsetof(cdprep_ray_query, model), Holds::pointer},
};

constexpr Name kQuery = {"query"};

/// Refuses an array that is null or larger than memory.
template <class Element>
int check_array(Call& call, const Name& name, const Element* elements, std::size_t count,
                std::size_t size) noexcept {
    if (count == 0) return CDPREP_OK;
    if (const int code = call.need(elements, name)) return code;
    if (count <= PTRDIFF_MAX / size) return CDPREP_OK;
    return call.refuse(CDPREP_WHY_OUT_OF_RANGE, kQuery.of("count"), "is more than memory holds.");
}

int check_points(Call& call, const cdprep_point_query& query) noexcept {
    const Name points = kQuery.of("points");
    if (const int code = check_array(call, points, query.points, query.count, 3 * sizeof(double))) {
        return code;
    }
    for (std::size_t i = 0; i < query.count; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double* const number = query.points + 3 * i + axis;
            const Name name = kQuery.of("points", i);
            if (const int code = check_numbers(call, name, Holds::number, number, 1)) return code;
        }
    }
    return CDPREP_OK;
}

/// The caller's floating-point environment could make a short direction equal to 0.
bool is_zero(const double (&direction)[3]) noexcept {
    const format::FloatEnvironment environment;
    return direction[0] == 0 && direction[1] == 0 && direction[2] == 0;
}

int check_ray(Call& call, const cdprep_ray& ray, std::size_t i) noexcept {
    const Name name = kQuery.of("rays", i);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const double* const number : {&ray.origin[axis], &ray.direction[axis]}) {
            if (const int code = check_numbers(call, name, Holds::number, number, 1)) return code;
        }
    }
    if (const int code = check_numbers(call, name, Holds::limit, &ray.max_t, 1)) return code;
    if (!is_zero(ray.direction)) return CDPREP_OK;
    return call.refuse(CDPREP_WHY_OUT_OF_RANGE, name, "has a direction of length 0.");
}

int check_ray_array(Call& call, const cdprep_ray_query& query) noexcept {
    return check_array(call, kQuery.of("rays"), query.rays, query.count, sizeof(cdprep_ray));
}

/// Checks a list for each ray. Reads no list before the number of rays is known to be possible.
int check_ray_lists(Call& call, const cdprep_ray_query& query,
                    const cdprep_ray_hit_list* lists) noexcept {
    if (const int code = check_ray_array(call, query)) return code;
    for (std::size_t i = 0; i < query.count; ++i) {
        if (const int code = check_list(call, {"lists", i}, lists[i])) return code;
    }
    return CDPREP_OK;
}
static_assert(kMostAnswers<cdprep_ray> <= kMostAnswers<cdprep_ray_hit_list>);

int check_rays(Call& call, const cdprep_ray_query& query) noexcept {
    if (const int code = check_ray_array(call, query)) return code;
    for (std::size_t i = 0; i < query.count; ++i) {
        if (const int code = check_ray(call, query.rays[i], i)) return code;
    }
    return CDPREP_OK;
}

inline void set_unknown(cdprep_closest_point& answer) noexcept {
    answer = {};
}
inline void set_unknown(cdprep_point_state& answer) noexcept {
    answer = {CDPREP_UNKNOWN, CDPREP_NO, 0};
}
inline void set_unknown(cdprep_ray_hit& answer) noexcept {
    answer = {};
}
inline void set_unknown(std::uint32_t& answer) noexcept {
    answer = CDPREP_UNKNOWN;
}
inline void set_unknown(cdprep_ray_hit_list& answer) noexcept {
    answer.count = 0;
}

/// Returns the number of answers that a query has room for. The query may be invalid; the result is
/// 0 if the number is not known.
template <class Query>
std::size_t count_of(const Query* query) noexcept {
    Query read{};
    Call call(nullptr);
    if (query == nullptr || check_head(call, kQuery, Input<Query>::type, query) != CDPREP_OK) {
        return 0;
    }
    read = Input<Query>::defaults();
    cdprep_head head;
    std::memcpy(&head, static_cast<const void*>(query), sizeof head);
    std::memcpy(static_cast<void*>(&read), static_cast<const void*>(query),
                std::min<std::size_t>(head.size, sizeof read));
    return read.count;
}

/// Runs a query for each point or ray. Sets all answers to unknown, checks everything (`check(call,
/// query)`), then calls `ask(answer, query, i, workspace)` on all lanes.
template <class Query, class Answer, class Check, class Asker>
int ask_each(const Query* query, cdprep_workspace* workspace, Answer* answers,
             const char* answers_name, cdprep_error* error, Check&& check, Asker&& ask) noexcept {
    const std::size_t count = count_of(query);
    if (answers != nullptr && count <= kMostAnswers<Answer>) {
        for (std::size_t i = 0; i < count; ++i) set_unknown(answers[i]);
    }
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(query, kQuery)) return code;
        if (const int code = call.need(workspace, {"workspace"})) return code;
        Query read;
        if (const int code = read_input(call, kQuery, query, read)) return code;
        if (read.count > 0) {
            if (const int code = call.need(answers, {answers_name})) return code;
        }
        if (const int code = check(call, read)) return code;
        InUse use;
        if (const int code = use.begin(call, *workspace)) return code;
        const std::span<Workspace> lanes = workspace->lanes;
        const CallersThreads threads(*workspace);
        share_jobs(read.count, lanes.size(), threads, [&](std::size_t i, std::size_t lane) {
            assert(lane < lanes.size());
            ask(answers[i], read, i, lanes[lane]);
        });
        return CDPREP_OK;
    });
}

Double3 point_of(const double* numbers) noexcept {
    return {numbers[0], numbers[1], numbers[2]};
}

cdprep_closest_point in_c(const std::optional<ClosestPoint>& found) noexcept {
    cdprep_closest_point to{};
    if (!found) return to;
    assert(found->lower <= found->upper);
    to.found = CDPREP_YES;
    to.triangle = found->triangle;
    store(found->point, to.point);
    to.lower = found->lower;
    to.upper = found->upper;
    return to;
}

cdprep_ray_hit in_c(const RayHit& hit) noexcept {
    cdprep_ray_hit to{CDPREP_YES, hit.triangle, hit.t, {}};
    store(hit.point, to.point);
    return to;
}

Ray ray_of(const cdprep_ray_query& query, std::size_t i) noexcept {
    assert(i < query.count);
    return {point_of(query.rays[i].origin), point_of(query.rays[i].direction)};
}

static_assert(sizeof(cdprep_ray_hit) == sizeof(RayHit));
static_assert(alignof(cdprep_ray_hit) == alignof(RayHit));

/// Converts the hits that C++ stored in the room of a list to C.
void turn_into_c(cdprep_ray_hit* hits, std::size_t count) noexcept {
    for (std::size_t i = 0; i < count; ++i) {
        RayHit hit{};
        std::memcpy(&hit, hits + i, sizeof hit);
        hits[i] = in_c(hit);
    }
}

}  // namespace

const InputType Input<cdprep_point_query>::type = {"cdprep_point_query", 0xcd500007U,
                                                   sizeof(cdprep_point_query),
                                                   sizeof(cdprep_point_query), kPointFields};
const InputType Input<cdprep_ray_query>::type = {"cdprep_ray_query", 0xcd500008U,
                                                 sizeof(cdprep_ray_query), sizeof(cdprep_ray_query),
                                                 kRayFields};

namespace {

/// Refuses directions so short that t could exceed the largest double. The greatest t is the
/// model's reach from the ray's origin, in lengths of the direction.
int check_lengths(Call& call, const cdprep_ray_query& query) noexcept {
    const format::FloatEnvironment environment;
    const format::FileHeader& header = query.model->model.header();
    const Double3& o = header.frame_origin;
    const double frame = std::max({std::fabs(o.x), std::fabs(o.y), std::fabs(o.z)}) +
                         std::ldexp(1.0, -header.frame_exponent);
    for (std::size_t i = 0; i < query.count; ++i) {
        const cdprep_ray& ray = query.rays[i];
        const auto largest = [](const double* v) {
            return std::max({std::fabs(v[0]), std::fabs(v[1]), std::fabs(v[2])});
        };
        const double most_t = 4 * (frame + largest(ray.origin)) / largest(ray.direction);
        if (most_t <= std::numeric_limits<double>::max()) continue;
        return call.refuse(CDPREP_WHY_OUT_OF_RANGE, kQuery.of("rays", i),
                           "has so short a direction that t would exceed the largest double.");
    }
    return CDPREP_OK;
}

}  // namespace

/// Checks rays, and whether the model serves them.
int check_ray_query(Call& call, const cdprep_ray_query& query) {
    if (const int code = check_rays(call, query)) return code;
    if (const int code = check_lengths(call, query)) return code;
    return check_serves(call, kQuery.of("model"), *query.model, Ask::ray);
}

}  // namespace cdprep::c

using cdprep::Ask;
using cdprep::Workspace;
using cdprep::c::ask_each;
using cdprep::c::Call;
using cdprep::c::check_ray_query;
using cdprep::c::kQuery;

void cdprep_point_query_init(cdprep_point_query* query, size_t size) {
    cdprep::c::initialise(query, size);
}

void cdprep_ray_query_init(cdprep_ray_query* query, size_t size) {
    cdprep::c::initialise(query, size);
}

int cdprep_points_closest(const cdprep_point_query* query, cdprep_workspace* workspace,
                          cdprep_closest_point* answers, cdprep_error* error) {
    return ask_each(
        query, workspace, answers, "answers", error,
        [](Call& call, const cdprep_point_query& asked) -> int {
            if (const int code = cdprep::c::check_points(call, asked)) return code;
            if (asked.through != CDPREP_THROUGH_BVH) {
                return call.refuse(CDPREP_WHY_NO_MEANING, kQuery.of("through"),
                                   "is %u, which this query does not use; leave it at its default.",
                                   asked.through);
            }
            return check_serves(call, kQuery.of("model"), *asked.model, Ask::closest);
        },
        [](cdprep_closest_point& to, const cdprep_point_query& asked, size_t i,
           Workspace& scratch) {
            to = cdprep::c::in_c(closest_point(asked.model->model,
                                               cdprep::c::point_of(asked.points + 3 * i), scratch,
                                               asked.max_distance));
        });
}

int cdprep_points_inside(const cdprep_point_query* query, cdprep_workspace* workspace,
                         cdprep_point_state* answers, cdprep_error* error) {
    return ask_each(
        query, workspace, answers, "answers", error,
        [&](Call& call, const cdprep_point_query& asked) -> int {
            if (const int code = cdprep::c::check_points(call, asked)) return code;
            if (!cdprep::c::is_infinite(asked.max_distance)) {
                return call.refuse(
                    CDPREP_WHY_NO_MEANING, kQuery.of("max_distance"),
                    "is %.17g, which this query does not use; leave it at its default.",
                    asked.max_distance);
            }
            if ((cdprep::c::kAnyButPieces >> asked.through & 1) == 0) {
                return call.refuse(CDPREP_WHY_NO_MEANING, kQuery.of("through"),
                                   "is CDPREP_THROUGH_PIECES, which this query does not support.");
            }
            const Ask needs = Ask::inside | cdprep::c::needs_of(asked.through);
            if (const int code = check_serves(call, kQuery.of("model"), *asked.model, needs)) {
                return code;
            }
            return check_cells(call, *workspace, needs);
        },
        [](cdprep_point_state& to, const cdprep_point_query& asked, size_t i, Workspace& scratch) {
            const cdprep::Inclusion found =
                points_inside(asked.model->model, cdprep::c::point_of(asked.points + 3 * i),
                              scratch, cdprep::c::structure_of(asked.through));
            to = {cdprep::c::word(found.answer), cdprep::c::word(found.on_surface), found.winding};
        });
}

int cdprep_rays_cast(const cdprep_ray_query* query, cdprep_workspace* workspace,
                     cdprep_ray_hit* hits, cdprep_error* error) {
    return ask_each(
        query, workspace, hits, "hits", error, check_ray_query,
        [](cdprep_ray_hit& to, const cdprep_ray_query& asked, size_t i, Workspace& scratch) {
            const auto found = cast_ray(asked.model->model, cdprep::c::ray_of(asked, i), scratch,
                                        {asked.rays[i].max_t});
            if (found) to = cdprep::c::in_c(*found);
        });
}

int cdprep_rays_any(const cdprep_ray_query* query, cdprep_workspace* workspace, uint32_t* hits,
                    cdprep_error* error) {
    return ask_each(
        query, workspace, hits, "hits", error, check_ray_query,
        [](uint32_t& to, const cdprep_ray_query& asked, size_t i, Workspace& scratch) {
            to = cdprep::c::word(ray_hits(asked.model->model, cdprep::c::ray_of(asked, i), scratch,
                                          {asked.rays[i].max_t}));
        });
}

int cdprep_rays_all(const cdprep_ray_query* query, cdprep_workspace* workspace,
                    cdprep_ray_hit_list* lists, cdprep_error* error) {
    return ask_each(
        query, workspace, lists, "lists", error,
        [&](Call& call, const cdprep_ray_query& asked) -> int {
            if (const int code = cdprep::c::check_ray_lists(call, asked, lists)) return code;
            return check_ray_query(call, asked);
        },
        [](cdprep_ray_hit_list& to, const cdprep_ray_query& asked, size_t i, Workspace& scratch) {
            const std::span<cdprep::RayHit> room(reinterpret_cast<cdprep::RayHit*>(to.items),
                                                 to.room);
            to.count = all_ray_hits(asked.model->model, cdprep::c::ray_of(asked, i), scratch, room,
                                    {asked.rays[i].max_t});
            cdprep::c::turn_into_c(to.items, std::min(to.room, to.count));
        });
}

int cdprep_rays_visit(const cdprep_ray_query* query, cdprep_workspace* workspace,
                      cdprep_ray_visitor visit, void* context, cdprep_error* error) {
    return cdprep::c::guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(query, kQuery)) return code;
        if (const int code = call.need(workspace, {"workspace"})) return code;
        if (visit == nullptr) return call.need(nullptr, {"visit"});
        cdprep_ray_query asked;
        if (const int code = read_input(call, kQuery, query, asked)) return code;
        if (asked.count != 1) {
            return call.refuse(
                CDPREP_WHY_NO_MEANING, kQuery.of("count"),
                "is %zu, but a visitor does not receive the number of the ray; it must be 1.",
                asked.count);
        }
        if (const int code = check_ray_query(call, asked)) return code;
        cdprep::c::InUse use;
        if (const int code = use.begin(call, *workspace)) return code;
        const auto hand_on = [&](const cdprep::RayHit& found) {
            const cdprep_ray_hit hit = cdprep::c::in_c(found);
            return visit(context, &hit) != 0;
        };
        visit_ray_hits(asked.model->model, cdprep::c::ray_of(asked, 0), workspace->lanes[0],
                       hand_on, {asked.rays[0].max_t});
        return CDPREP_OK;
    });
}
