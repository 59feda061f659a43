// SPDX-License-Identifier: MIT
#include "c_face.h"

#include <limits>
#include <type_traits>

#include "cdprep/closest_point.h"
#include "cdprep/touching_box.h"
#include "cdprep/touching_capsule.h"
#include "cdprep/touching_sphere.h"
#include "cdprep/touching_triangle.h"

namespace cdprep {
namespace {

/// What is asked about a shape, beside the shape.
struct ShapeAsked {
    cdprep_shape shape{};
    TouchOptions options;
    double max_distance = std::numeric_limits<double>::infinity();
};

/// Reads both structs, or returns a code with `error` filled.
int read_shape(const cdprep_shape& shape, const cdprep_shape_options* options, ShapeAsked& asked,
               cdprep_error* error) {
    cdprep_shape_options given{};
    given.max_distance = asked.max_distance;
    if (!read_sized(&shape, asked.shape) || !read_sized(options, given)) return bad_size(error);
    if (shape.size < sizeof shape) return bad_size(error);
    asked.max_distance = given.max_distance;
    if (given.degenerate == CDPREP_SKIP_DEGENERATE) asked.options.degenerate = Degenerate::skip;
    if (given.is_moved == 0) return CDPREP_OK;
    const Result<Pose> pose = pose_of(given.world_from_model);
    if (!pose) return fail(error, pose.error());
    asked.options.world_from_model = pose.value();
    return CDPREP_OK;
}

/// Calls `ask` with the shape that the kind names.
template <class Ask>
int ask_shape(const cdprep_shape& s, cdprep_error* error, Ask ask) {
    switch (s.kind) {
        case CDPREP_BOX:
            return ask(Box{point_of(s.a), point_of(s.b)});
        case CDPREP_SPHERE:
            return ask(Sphere{point_of(s.a), s.radius});
        case CDPREP_CAPSULE:
            return ask(Capsule{point_of(s.a), point_of(s.b), s.radius});
        case CDPREP_TRIANGLE:
            return ask(LooseTriangle{{point_of(s.a), point_of(s.b), point_of(s.c)}});
        default:
            return fail(error, CDPREP_BAD_ARGUMENT, "The kind of a shape is not 0 to 3.");
    }
}

}  // namespace
}  // namespace cdprep

int cdprep_find_closest_point(const cdprep_model* model, const double query[3], double max_distance,
                              cdprep_workspace* workspace, int* found,
                              cdprep_closest_point* closest, cdprep_error* error) {
    if (cdprep::any_null(model, query, workspace, found, closest)) {
        return cdprep::null_argument(error);
    }
    const auto result = cdprep::closest_point(model->model, {query[0], query[1], query[2]},
                                              workspace->workspace, max_distance);
    *found = result ? 1 : 0;
    *closest = {};
    if (!result) return CDPREP_OK;
    cdprep::store(result->point, closest->point);
    closest->lower = result->lower;
    closest->upper = result->upper;
    closest->triangle = result->triangle;
    return CDPREP_OK;
}

int cdprep_includes(const cdprep_model* model, const double point[3], cdprep_workspace* workspace,
                    cdprep_inclusion* inclusion, cdprep_error* error) {
    if (cdprep::any_null(model, point, workspace, inclusion)) {
        return cdprep::null_argument(error);
    }
    const cdprep::Inclusion result =
        cdprep::includes(model->model, {point[0], point[1], point[2]}, workspace->workspace);
    *inclusion = {cdprep::word(result.answer), result.on_surface ? 1 : 0, result.winding};
    return CDPREP_OK;
}

int cdprep_touches(const cdprep_model* model, const cdprep_shape* shape,
                   cdprep_workspace* workspace, const cdprep_shape_options* options, int* touches,
                   cdprep_error* error) {
    if (cdprep::any_null(model, shape, workspace, touches)) return cdprep::null_argument(error);
    return cdprep::guarded(error, [&]() -> int {
        cdprep::ShapeAsked asked;
        if (const int code = cdprep::read_shape(*shape, options, asked, error)) return code;
        return cdprep::ask_shape(asked.shape, error, [&](const auto& given) {
            const bool found =
                cdprep::touches(model->model, given, workspace->workspace, asked.options);
            *touches = found ? 1 : 0;
            return CDPREP_OK;
        });
    });
}

int cdprep_touching_triangles(const cdprep_model* model, const cdprep_shape* shape,
                              cdprep_workspace* workspace, const cdprep_shape_options* options,
                              uint32_t* triangles, size_t room, size_t* count,
                              cdprep_error* error) {
    if (cdprep::any_null(model, shape, workspace, count) || (triangles == nullptr && room > 0)) {
        return cdprep::null_argument(error);
    }
    return cdprep::guarded(error, [&]() -> int {
        cdprep::ShapeAsked asked;
        if (const int code = cdprep::read_shape(*shape, options, asked, error)) return code;
        return cdprep::ask_shape(asked.shape, error, [&](const auto& given) {
            *count = cdprep::touching_triangles(model->model, given, workspace->workspace,
                                                std::span(triangles, room), asked.options);
            return CDPREP_OK;
        });
    });
}

int cdprep_visit_touching_triangles(const cdprep_model* model, const cdprep_shape* shape,
                                    cdprep_workspace* workspace,
                                    const cdprep_shape_options* options,
                                    cdprep_triangle_visitor visit, void* context,
                                    cdprep_error* error) {
    if (cdprep::any_null(model, shape, workspace, visit)) return cdprep::null_argument(error);
    return cdprep::guarded(error, [&]() -> int {
        cdprep::ShapeAsked asked;
        if (const int code = cdprep::read_shape(*shape, options, asked, error)) return code;
        return cdprep::ask_shape(asked.shape, error, [&](const auto& given) {
            const auto hand_on = [&](std::uint32_t triangle) {
                return visit(context, triangle) != 0;
            };
            cdprep::visit_touching_triangles(model->model, given, workspace->workspace, hand_on,
                                             asked.options);
            return CDPREP_OK;
        });
    });
}

int cdprep_distance_to(const cdprep_model* model, const cdprep_shape* shape,
                       cdprep_workspace* workspace, const cdprep_shape_options* options, int* found,
                       cdprep_shape_distance* distance, cdprep_error* error) {
    if (cdprep::any_null(model, shape, workspace, found, distance)) {
        return cdprep::null_argument(error);
    }
    return cdprep::guarded(error, [&]() -> int {
        cdprep::ShapeAsked asked;
        if (const int code = cdprep::read_shape(*shape, options, asked, error)) return code;
        return cdprep::ask_shape(asked.shape, error, [&]<class Shape>(const Shape& given) {
            if constexpr (std::is_same_v<Shape, cdprep::Capsule> ||
                          std::is_same_v<Shape, cdprep::LooseTriangle>) {
                const auto result =
                    cdprep::distance_to(model->model, given, workspace->workspace,
                                        {asked.options.world_from_model, asked.max_distance});
                *found = result ? 1 : 0;
                *distance = {};
                if (!result) return static_cast<int>(CDPREP_OK);
                distance->lower = result->lower;
                distance->upper = result->upper;
                cdprep::store(result->on_model, distance->on_model);
                cdprep::store(result->on_shape, distance->on_shape);
                distance->triangle = result->triangle;
                return static_cast<int>(CDPREP_OK);
            } else {
                return cdprep::fail(error, CDPREP_BAD_ARGUMENT,
                                    "Distances are measured to capsules and triangles alone.");
            }
        });
    });
}
