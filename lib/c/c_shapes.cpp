// SPDX-License-Identifier: MIT
#include <array>
#include <cassert>
#include <limits>
#include <type_traits>

#include "c/batch.h"
#include "c/c_pairs.h"
#include "cdprep/c/points.h"
#include "cdprep/format/float_environment.h"
#include "cdprep/points.h"

namespace cdprep::c {

template <>
struct Input<cdprep_shape_query> {
    static const InputType type;
    static cdprep_shape_query defaults() noexcept {
        cdprep_shape_query query{};
        query.max_distance = std::numeric_limits<double>::infinity();
        query.world_from_model = kIdentity;
        return query;
    }
};

namespace {

constexpr std::array kFields = {
    Field{"model", offsetof(cdprep_shape_query, model), Holds::pointer},
    Field{"shape", offsetof(cdprep_shape_query, shape), Holds::choice, CDPREP_TRIANGLE},
    Field{"degenerate", offsetof(cdprep_shape_query, degenerate), Holds::choice,
          CDPREP_SKIP_DEGENERATE},
    Field{"max_distance", offsetof(cdprep_shape_query, max_distance), Holds::limit},
    Field{"world_from_model", offsetof(cdprep_shape_query, world_from_model), Holds::number, 0, 12},
};

/// The number of points that a shape uses, and whether it has a radius.
struct ShapeFields {
    std::size_t points;
    bool has_radius;
};

ShapeFields fields_of(std::uint32_t shape) noexcept {
    switch (shape) {
        case CDPREP_SPHERE:
            return {1, true};
        case CDPREP_CAPSULE:
            return {2, true};
        case CDPREP_TRIANGLE:
            return {3, false};
        default:
            return {0, false};
    }
}

/// Limits may be infinite, but no lower limit may exceed its upper limit.
int check_box(Call& call, const Name& name, const cdprep_shape_query& query) noexcept {
    const format::FloatEnvironment environment;
    for (std::size_t i = 0; i < 3; ++i) {
        for (const bool is_lower : {true, false}) {
            const double limit = is_lower ? query.a[i] : query.b[i];
            const double open = std::numeric_limits<double>::infinity() * (is_lower ? -1 : 1);
            if (limit == open) continue;
            if (const int code = check_numbers(call, name.of(is_lower ? "a" : "b", i),
                                               Holds::number, &limit, 1)) {
                return code;
            }
        }
        if (query.a[i] > query.b[i]) {
            return call.refuse(CDPREP_WHY_OUT_OF_RANGE, name.of("b", i),
                               "is less than %s: the box is empty.", spelt(name.of("a", i)).data());
        }
    }
    return CDPREP_OK;
}

int check_shape(Call& call, const Name& name, const cdprep_shape_query& query) noexcept {
    if (query.shape == 0) {
        return call.refuse(CDPREP_WHY_OUT_OF_RANGE, name.of("shape"),
                           "is 0; choose CDPREP_BOX, _SPHERE, _CAPSULE or _TRIANGLE.");
    }
    if (query.shape == CDPREP_BOX) return check_box(call, name, query);
    const ShapeFields fields = fields_of(query.shape);
    const std::array<const double*, 3> points = {query.a, query.b, query.c};
    constexpr std::array kNames = {"a", "b", "c"};
    for (std::size_t i = 0; i < fields.points; ++i) {
        if (const int code = check_numbers(call, name.of(kNames[i]), Holds::number, points[i], 3)) {
            return code;
        }
    }
    if (!fields.has_radius) return CDPREP_OK;
    return check_numbers(call, name.of("radius"), Holds::length, &query.radius, 1);
}

int refuse_meaning(Call& call, const Name& name, const char* field) noexcept {
    return call.refuse(CDPREP_WHY_NO_MEANING, name.of(field),
                       "is set, but this query does not use it; leave it at its default.");
}

Double3 point_of(const double* numbers) noexcept {
    return {numbers[0], numbers[1], numbers[2]};
}

Shape shape_of(const cdprep_shape_query& query) noexcept {
    switch (query.shape) {
        case CDPREP_BOX:
            return Box{point_of(query.a), point_of(query.b)};
        case CDPREP_SPHERE:
            return Sphere{point_of(query.a), query.radius};
        case CDPREP_CAPSULE:
            return Capsule{point_of(query.a), point_of(query.b), query.radius};
        default:
            assert(query.shape == CDPREP_TRIANGLE);
            return TriangleShape{{point_of(query.a), point_of(query.b), point_of(query.c)}};
    }
}

/// A query whose every field was checked, except for what depends on the kind of query.
struct AskedShape {
    cdprep_shape_query query{};
    Shape shape;
    ShapeOptions options;
};

int read_shape(Call& call, const Name& name, const cdprep_shape_query* given, AskedShape& asked) {
    if (const int code = read_input(call, name, given, asked.query)) return code;
    if (const int code = check_shape(call, name, asked.query)) return code;
    asked.shape = shape_of(asked.query);
    asked.options.max_distance = asked.query.max_distance;
    if (asked.query.degenerate == CDPREP_SKIP_DEGENERATE) {
        asked.options.degenerate = Degenerate::skip;
    }
    return read_rigid(call, name.of("world_from_model"), asked.query.world_from_model,
                      asked.options.world_from_model);
}

int check_touch(Call& call, const Name& name, const AskedShape& asked) noexcept {
    return is_infinite(asked.query.max_distance) ? CDPREP_OK
                                                 : refuse_meaning(call, name, "max_distance");
}

int check_distance(Call& call, const Name& name, const AskedShape& asked) noexcept {
    const bool skips = asked.query.degenerate != CDPREP_KEEP_DEGENERATE;
    return skips ? refuse_meaning(call, name, "degenerate") : CDPREP_OK;
}

/// Reads a query and checks all of it; `check(call, name, shape)` checks what depends on its kind.
template <class Check>
int read_asked(Call& call, const Name& name, const cdprep_shape_query* given, Check&& check,
               AskedShape& asked) {
    if (const int code = read_shape(call, name, given, asked)) return code;
    if (const int code = check(call, name, asked)) return code;
    return check_serves(call, name.of("model"), *asked.query.model, Ask::touch);
}

/// Runs a query about a shape. Sets the answer to unknown, then checks everything; `check(call,
/// name, shape)` checks what depends on the kind of query. Then calls `ask(shape, model,
/// workspace)`.
template <class Answer, class Check, class Asker>
int ask_shape(const cdprep_shape_query* query, cdprep_workspace* workspace, Answer* answer,
              const char* answer_name, cdprep_error* error, Check&& check, Asker&& ask) noexcept {
    if constexpr (!std::is_function_v<Answer>) set_unknown(answer, 1);
    return guarded(error, [&](Call& call) -> int {
        const Name name = {"query"};
        if (const int code = call.need(query, name)) return code;
        if (const int code = call.need(workspace, {"workspace"})) return code;
        if (answer == nullptr) return call.need(nullptr, {answer_name});
        if constexpr (requires { answer->items; }) {
            if (const int code = check_list(call, {answer_name}, *answer)) return code;
        }
        AskedShape asked;
        if (const int code = read_asked(call, name, query, check, asked)) return code;
        InUse use;
        if (const int code = use.begin(call, *workspace)) return code;
        assert(!workspace->lanes.empty());
        ask(asked, asked.query.model->model, workspace->lanes[0]);
        return CDPREP_OK;
    });
}

template <class Answer>
using ShapeBatch = Batch<cdprep_shape_query, Answer>;

/// Runs each query about a shape; see ask_batch() and ask_shape().
template <class Answer, class Check, class Asker>
int ask_shapes(const ShapeBatch<Answer>& batch, Check&& check, Asker&& ask) noexcept {
    const auto read = [&](Call& call, const Name& name, const cdprep_shape_query* query,
                          AskedShape& asked) {
        return read_asked(call, name, query, check, asked);
    };
    return ask_batch<AskedShape>(batch, nothing_to_check, read, no_answer_to_check, ask);
}

cdprep_nearest in_c(const std::optional<ShapeDistance>& found) noexcept {
    cdprep_nearest to{};
    if (!found) return to;
    assert(found->lower <= found->upper);
    to.found = CDPREP_YES;
    to.triangle_a = found->triangle;
    to.triangle_b = CDPREP_NONE;
    to.lower = found->lower;
    to.upper = found->upper;
    store(found->on_model, to.on_a);
    store(found->on_shape, to.on_b);
    return to;
}

}  // namespace

const InputType Input<cdprep_shape_query>::type = {"cdprep_shape_query", 0xcd500009U,
                                                   sizeof(cdprep_shape_query),
                                                   sizeof(cdprep_shape_query), kFields};

}  // namespace cdprep::c

using cdprep::Model;
using cdprep::Workspace;
using cdprep::c::ask_shape;
using cdprep::c::ask_shapes;
using cdprep::c::AskedShape;
using cdprep::c::check_touch;
using cdprep::c::ShapeBatch;

void cdprep_shape_query_init(cdprep_shape_query* query, size_t size) {
    cdprep::c::initialise(query, size);
}

int cdprep_touch(const cdprep_shape_query* query, cdprep_workspace* workspace, uint32_t* touches,
                 cdprep_error* error) {
    return ask_shape(
        query, workspace, touches, "touches", error, check_touch,
        [&](const AskedShape& asked, const Model& model, Workspace& scratch) {
            *touches = cdprep::c::word(cdprep::touches(model, asked.shape, scratch, asked.options));
        });
}

int cdprep_touch_list(const cdprep_shape_query* query, cdprep_workspace* workspace,
                      cdprep_triangle_list* list, cdprep_error* error) {
    return ask_shape(query, workspace, list, "list", error, check_touch,
                     [&](const AskedShape& asked, const Model& model, Workspace& scratch) {
                         const std::span room(list->items, list->room);
                         list->count =
                             touching_triangles(model, asked.shape, scratch, room, asked.options);
                     });
}

int cdprep_touch_visit(const cdprep_shape_query* query, cdprep_workspace* workspace,
                       cdprep_triangle_visitor visit, void* context, cdprep_error* error) {
    return ask_shape(
        query, workspace, visit, "visit", error, check_touch,
        [&](const AskedShape& asked, const Model& model, Workspace& scratch) {
            const auto hand_on = [&](uint32_t triangle) { return visit(context, triangle) != 0; };
            visit_touching_triangles(model, asked.shape, scratch, hand_on, asked.options);
        });
}

int cdprep_shape_distance(const cdprep_shape_query* query, cdprep_workspace* workspace,
                          cdprep_nearest* nearest, cdprep_error* error) {
    return ask_shape(
        query, workspace, nearest, "nearest", error, cdprep::c::check_distance,
        [&](const AskedShape& asked, const Model& model, Workspace& scratch) {
            *nearest = cdprep::c::in_c(shape_distance(model, asked.shape, scratch, asked.options));
        });
}

int cdprep_touch_many(const cdprep_shape_query* queries, size_t count, cdprep_workspace* workspace,
                      uint32_t* touches, cdprep_error* error) {
    const ShapeBatch<uint32_t> batch = {queries, "queries", count, workspace,
                                        touches, "touches", error};
    return ask_shapes(
        batch, check_touch, [](uint32_t& to, const AskedShape& asked, Workspace& scratch) {
            to = cdprep::c::word(
                cdprep::touches(asked.query.model->model, asked.shape, scratch, asked.options));
        });
}

int cdprep_shape_distance_many(const cdprep_shape_query* queries, size_t count,
                               cdprep_workspace* workspace, cdprep_nearest* nearest,
                               cdprep_error* error) {
    const ShapeBatch<cdprep_nearest> batch = {queries, "queries", count, workspace,
                                              nearest, "nearest", error};
    return ask_shapes(batch, cdprep::c::check_distance,
                      [](cdprep_nearest& to, const AskedShape& asked, Workspace& scratch) {
                          to = cdprep::c::in_c(shape_distance(asked.query.model->model, asked.shape,
                                                              scratch, asked.options));
                      });
}
