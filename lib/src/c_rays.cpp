// SPDX-License-Identifier: MIT
#include "c_face.h"

#include "cdprep/cast_ray.h"

namespace cdprep {
namespace {

static_assert(sizeof(cdprep_ray_hit) == sizeof(RayHit) &&
              offsetof(cdprep_ray_hit, point) == offsetof(RayHit, point) &&
              offsetof(cdprep_ray_hit, triangle) == offsetof(RayHit, triangle));

cdprep_ray_hit hit_of(const RayHit& hit) noexcept {
    cdprep_ray_hit to{};
    to.t = hit.t;
    store(hit.point, to.point);
    to.triangle = hit.triangle;
    return to;
}

Ray ray_of(const double* origin, const double* direction) noexcept {
    return {point_of(origin), point_of(direction)};
}

}  // namespace
}  // namespace cdprep

int cdprep_cast_ray(const cdprep_model* model, const double origin[3], const double direction[3],
                    double max_t, cdprep_workspace* workspace, int* found, cdprep_ray_hit* hit,
                    cdprep_error* error) {
    if (cdprep::any_null(model, origin, direction, workspace, found, hit)) {
        return cdprep::null_argument(error);
    }
    const auto result = cdprep::cast_ray(model->model, cdprep::ray_of(origin, direction),
                                         workspace->workspace, {max_t});
    *found = result ? 1 : 0;
    *hit = result ? cdprep::hit_of(*result) : cdprep_ray_hit{};
    return CDPREP_OK;
}

int cdprep_ray_hits(const cdprep_model* model, const double origin[3], const double direction[3],
                    double max_t, cdprep_workspace* workspace, int* hits, cdprep_error* error) {
    if (cdprep::any_null(model, origin, direction, workspace, hits)) {
        return cdprep::null_argument(error);
    }
    const cdprep::Ray ray = cdprep::ray_of(origin, direction);
    *hits = cdprep::ray_hits(model->model, ray, workspace->workspace, {max_t}) ? 1 : 0;
    return CDPREP_OK;
}

int cdprep_all_ray_hits(const cdprep_model* model, const double origin[3],
                        const double direction[3], double max_t, cdprep_workspace* workspace,
                        cdprep_ray_hit* hits, size_t room, size_t* count, cdprep_error* error) {
    if (cdprep::any_null(model, origin, direction, workspace, count) ||
        (hits == nullptr && room > 0)) {
        return cdprep::null_argument(error);
    }
    const std::span<cdprep::RayHit> kept(reinterpret_cast<cdprep::RayHit*>(hits), room);
    *count = cdprep::all_ray_hits(model->model, cdprep::ray_of(origin, direction),
                                  workspace->workspace, kept, {max_t});
    return CDPREP_OK;
}

int cdprep_visit_ray_hits(const cdprep_model* model, const double origin[3],
                          const double direction[3], double max_t, cdprep_workspace* workspace,
                          cdprep_ray_visitor visit, void* context, cdprep_error* error) {
    if (cdprep::any_null(model, origin, direction, workspace, visit)) {
        return cdprep::null_argument(error);
    }
    const auto hand_on = [&](const cdprep::RayHit& hit) {
        const cdprep_ray_hit found = cdprep::hit_of(hit);
        return visit(context, &found) != 0;
    };
    cdprep::visit_ray_hits(model->model, cdprep::ray_of(origin, direction), workspace->workspace,
                           hand_on, {max_t});
    return CDPREP_OK;
}
