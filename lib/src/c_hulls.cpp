// SPDX-License-Identifier: MIT
#include "c_face.h"

#include "cdprep/convex_penetration.h"
#include "cdprep/model_hulls.h"

namespace cdprep {
namespace {

using ConvexCacheCopy = CacheCopy<cdprep_convex_cache, ConvexCache>;

static_assert(CDPREP_HULL_WHOLE == static_cast<int>(format::HullScope::whole) &&
              CDPREP_HULL_COMPONENT == static_cast<int>(format::HullScope::component) &&
              CDPREP_HULL_INSTANCE == static_cast<int>(format::HullScope::instance) &&
              CDPREP_HULL_PART == static_cast<int>(format::HullScope::part));

/// A hull's corners, or nothing where it names none.
std::optional<ConvexPoints> points_of(const cdprep_hull& hull) noexcept {
    if (hull.model == nullptr || hull.number >= hull.model->model.hulls().size()) {
        return std::nullopt;
    }
    return convex_points(hull.model->model, hull.number);
}

/// A question about two hulls: checks what every such question checks, then calls
/// `ask(a, b, placement, cache)`.
template <class Ask>
int ask_hulls(const cdprep_hull* a, const cdprep_hull* b, const cdprep_placement* placement,
              cdprep_convex_cache* cache, cdprep_error* error, Ask ask) noexcept {
    if (any_null(a, b, placement)) return null_argument(error);
    return guarded(error, [&]() -> int {
        const auto of_a = points_of(*a), of_b = points_of(*b);
        if (!of_a || !of_b) {
            return fail(error, CDPREP_BAD_ARGUMENT,
                        "A hull is none of its model: take what cdprep_find_hull() stores.");
        }
        std::optional<Placement> placed;
        if (const int code = read_placement(*placement, placed, error)) return code;
        ConvexCacheCopy copy(cache);
        ask(*of_a, *of_b, *placed, copy.get());
        return CDPREP_OK;
    });
}

void store_distance(const std::optional<ConvexDistance>& result, int& found,
                    cdprep_distance& to) noexcept {
    found = result ? 1 : 0;
    to = {};
    to.triangle_a = to.triangle_b = UINT32_MAX;
    if (!result) return;
    to.lower = result->lower;
    to.upper = result->upper;
    store(result->witness_a, to.witness_a);
    store(result->witness_b, to.witness_b);
}

void store_depth(const std::optional<Penetration>& result, int& found,
                 cdprep_penetration& to) noexcept {
    found = result ? 1 : 0;
    to = {};
    if (!result) return;
    to.lower = result->lower;
    to.upper = result->upper;
    store(result->normal, to.normal);
    store(result->witness_a, to.witness_a);
    store(result->witness_b, to.witness_b);
}

}  // namespace
}  // namespace cdprep

using cdprep::ConvexCache;
using cdprep::ConvexPoints;
using cdprep::Placement;

int cdprep_find_hull(const cdprep_model* model, uint32_t scope, uint32_t number, int* found,
                     cdprep_hull* hull, cdprep_error* error) {
    if (cdprep::any_null(model, found, hull)) return cdprep::null_argument(error);
    if (scope > CDPREP_HULL_PART) {
        return cdprep::fail(error, CDPREP_BAD_ARGUMENT, "The scope of a hull is not 0 to 3.");
    }
    const auto at = cdprep::find_hull(model->model, cdprep::format::HullScope{scope}, number);
    *found = at ? 1 : 0;
    *hull = {model, at.value_or(UINT32_MAX)};
    return CDPREP_OK;
}

int cdprep_hulls_collide(const cdprep_hull* a, const cdprep_hull* b,
                         const cdprep_placement* placement, cdprep_convex_cache* cache, int* hit,
                         cdprep_error* error) {
    if (hit == nullptr) return cdprep::null_argument(error);
    return cdprep::ask_hulls(
        a, b, placement, cache, error,
        [&](const ConvexPoints& pa, const ConvexPoints& pb, const Placement& placed,
            ConvexCache* used) { *hit = cdprep::convex_collide(pa, pb, placed, used) ? 1 : 0; });
}

int cdprep_hull_distance(const cdprep_hull* a, const cdprep_hull* b,
                         const cdprep_placement* placement, const cdprep_distance_options* options,
                         cdprep_convex_cache* cache, int* found, cdprep_distance* distance,
                         cdprep_error* error) {
    if (cdprep::any_null(found, distance)) return cdprep::null_argument(error);
    cdprep_distance_options given = cdprep::default_distance_options();
    if (!cdprep::read_sized(options, given)) return cdprep::bad_size(error);
    return cdprep::ask_hulls(
        a, b, placement, cache, error,
        [&](const ConvexPoints& pa, const ConvexPoints& pb, const Placement& placed,
            ConvexCache* used) {
            cdprep::store_distance(
                cdprep::convex_distance(
                    pa, pb, placed,
                    {given.relative_error, given.absolute_error, given.max_distance}, used),
                *found, *distance);
        });
}

int cdprep_hulls_within(const cdprep_hull* a, const cdprep_hull* b,
                        const cdprep_placement* placement, double tolerance,
                        cdprep_convex_cache* cache, int* within, cdprep_error* error) {
    if (within == nullptr) return cdprep::null_argument(error);
    return cdprep::ask_hulls(
        a, b, placement, cache, error,
        [&](const ConvexPoints& pa, const ConvexPoints& pb, const Placement& placed,
            ConvexCache* used) {
            *within = cdprep::convex_is_within(pa, pb, placed, tolerance, used) ? 1 : 0;
        });
}

int cdprep_hull_penetration(const cdprep_hull* a, const cdprep_hull* b,
                            const cdprep_placement* placement,
                            const cdprep_distance_options* options, cdprep_convex_cache* cache,
                            int* found, cdprep_penetration* penetration, cdprep_error* error) {
    if (cdprep::any_null(found, penetration)) return cdprep::null_argument(error);
    cdprep_distance_options given = cdprep::default_distance_options();
    if (!cdprep::read_sized(options, given)) return cdprep::bad_size(error);
    return cdprep::ask_hulls(
        a, b, placement, cache, error,
        [&](const ConvexPoints& pa, const ConvexPoints& pb, const Placement& placed,
            ConvexCache* used) {
            cdprep::store_depth(
                cdprep::convex_penetration(pa, pb, placed,
                                           {given.relative_error, given.absolute_error}, used),
                *found, *penetration);
        });
}
