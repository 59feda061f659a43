// SPDX-License-Identifier: MIT
#include "c_face.h"

#include "cdprep/crossing_segments.h"
#include "cdprep/triangles_within.h"

namespace cdprep {
namespace {

cdprep_crossing crossing_of(const Crossing& crossing) noexcept {
    cdprep_crossing to{};
    to.pair = {crossing.pair.a, crossing.pair.b};
    to.is_flat = crossing.is_flat ? 1 : 0;
    store(crossing.from, to.from);
    store(crossing.to, to.to);
    return to;
}

}  // namespace
}  // namespace cdprep

using cdprep::Model;
using cdprep::Placement;
using cdprep::Workspace;

int cdprep_collide(const cdprep_model* a, const cdprep_model* b, const cdprep_placement* placement,
                   cdprep_workspace* workspace, const cdprep_contact_options* options,
                   cdprep_pair_cache* cache, cdprep_collision* collision, cdprep_error* error) {
    if (collision == nullptr) return cdprep::null_argument(error);
    cdprep_contact_options given{};
    if (!cdprep::read_sized(options, given)) return cdprep::bad_size(error);
    return cdprep::ask_pair(
        a, b, placement, workspace, error,
        [&](const Model& ma, const Model& mb, const Placement& placed, Workspace& scratch) {
            cdprep::PairCacheCopy copy(cache);
            cdprep::store(cdprep::collide(ma, mb, placed, scratch, cdprep::contact_options(given),
                                          copy.get()),
                          *collision);
            return CDPREP_OK;
        });
}

int cdprep_find_containment(const cdprep_model* a, const cdprep_model* b,
                            const cdprep_placement* placement, cdprep_workspace* workspace,
                            cdprep_containment* containment, cdprep_error* error) {
    if (containment == nullptr) return cdprep::null_argument(error);
    return cdprep::ask_pair(
        a, b, placement, workspace, error,
        [&](const Model& ma, const Model& mb, const Placement& placed, Workspace& scratch) {
            const cdprep::Containment found = cdprep::find_containment(ma, mb, placed, scratch);
            *containment = {cdprep::word(found.answer), found.a_inside_b ? 1 : 0, found.winding};
            return CDPREP_OK;
        });
}

int cdprep_overlapping_triangles(const cdprep_model* a, const cdprep_model* b,
                                 const cdprep_placement* placement, cdprep_workspace* workspace,
                                 const cdprep_contact_options* options, cdprep_pair_cache* cache,
                                 cdprep_triangle_pair* pairs, size_t room, size_t* count,
                                 cdprep_error* error) {
    if (count == nullptr || (pairs == nullptr && room > 0)) return cdprep::null_argument(error);
    cdprep_contact_options given{};
    if (!cdprep::read_sized(options, given)) return cdprep::bad_size(error);
    return cdprep::ask_pair(
        a, b, placement, workspace, error,
        [&](const Model& ma, const Model& mb, const Placement& placed, Workspace& scratch) {
            cdprep::PairCacheCopy copy(cache);
            *count =
                cdprep::overlapping_triangles(ma, mb, placed, scratch, cdprep::room_of(pairs, room),
                                              cdprep::overlap_options(given), copy.get());
            return CDPREP_OK;
        });
}

int cdprep_visit_overlapping_triangles(const cdprep_model* a, const cdprep_model* b,
                                       const cdprep_placement* placement,
                                       cdprep_workspace* workspace,
                                       const cdprep_contact_options* options,
                                       cdprep_pair_cache* cache, cdprep_pair_visitor visit,
                                       void* context, cdprep_error* error) {
    if (visit == nullptr) return cdprep::null_argument(error);
    cdprep_contact_options given{};
    if (!cdprep::read_sized(options, given)) return cdprep::bad_size(error);
    return cdprep::ask_pair(
        a, b, placement, workspace, error,
        [&](const Model& ma, const Model& mb, const Placement& placed, Workspace& scratch) {
            cdprep::PairCacheCopy copy(cache);
            const auto hand_on = [&](const cdprep::TrianglePair& pair) {
                const cdprep_triangle_pair found = {pair.a, pair.b};
                return visit(context, &found) != 0;
            };
            cdprep::visit_overlapping_triangles(ma, mb, placed, scratch, hand_on,
                                                cdprep::overlap_options(given), copy.get());
            return CDPREP_OK;
        });
}

int cdprep_mark_overlapping_triangles(const cdprep_model* a, const cdprep_model* b,
                                      const cdprep_placement* placement,
                                      cdprep_workspace* workspace,
                                      const cdprep_contact_options* options,
                                      cdprep_pair_cache* cache, uint64_t* bits_a, size_t words_a,
                                      uint64_t* bits_b, size_t words_b, size_t* count,
                                      cdprep_error* error) {
    if (count == nullptr || (bits_a == nullptr && words_a > 0) ||
        (bits_b == nullptr && words_b > 0)) {
        return cdprep::null_argument(error);
    }
    cdprep_contact_options given{};
    if (!cdprep::read_sized(options, given)) return cdprep::bad_size(error);
    return cdprep::ask_pair(
        a, b, placement, workspace, error,
        [&](const Model& ma, const Model& mb, const Placement& placed, Workspace& scratch) {
            cdprep::PairCacheCopy copy(cache);
            *count = cdprep::mark_overlapping_triangles(ma, mb, placed, scratch, {bits_a, words_a},
                                                        {bits_b, words_b},
                                                        cdprep::overlap_options(given), copy.get());
            return CDPREP_OK;
        });
}

int cdprep_crossing_segments(const cdprep_model* a, const cdprep_model* b,
                             const cdprep_placement* placement, cdprep_workspace* workspace,
                             const cdprep_contact_options* options, cdprep_crossing* crossings,
                             size_t room, size_t* count, cdprep_error* error) {
    if (count == nullptr || (crossings == nullptr && room > 0)) {
        return cdprep::null_argument(error);
    }
    cdprep_contact_options given{};
    if (!cdprep::read_sized(options, given)) return cdprep::bad_size(error);
    return cdprep::ask_pair(
        a, b, placement, workspace, error,
        [&](const Model& ma, const Model& mb, const Placement& placed, Workspace& scratch) {
            std::size_t found = 0;
            const auto take = [&](const cdprep::Crossing& crossing) {
                if (found++ < room) crossings[found - 1] = cdprep::crossing_of(crossing);
                return true;
            };
            cdprep::visit_crossing_segments(ma, mb, placed, scratch, take,
                                            cdprep::overlap_options(given));
            *count = found;
            return CDPREP_OK;
        });
}

int cdprep_visit_crossing_segments(const cdprep_model* a, const cdprep_model* b,
                                   const cdprep_placement* placement, cdprep_workspace* workspace,
                                   const cdprep_contact_options* options,
                                   cdprep_crossing_visitor visit, void* context,
                                   cdprep_error* error) {
    if (visit == nullptr) return cdprep::null_argument(error);
    cdprep_contact_options given{};
    if (!cdprep::read_sized(options, given)) return cdprep::bad_size(error);
    return cdprep::ask_pair(
        a, b, placement, workspace, error,
        [&](const Model& ma, const Model& mb, const Placement& placed, Workspace& scratch) {
            const auto hand_on = [&](const cdprep::Crossing& crossing) {
                const cdprep_crossing found = cdprep::crossing_of(crossing);
                return visit(context, &found) != 0;
            };
            cdprep::visit_crossing_segments(ma, mb, placed, scratch, hand_on,
                                            cdprep::overlap_options(given));
            return CDPREP_OK;
        });
}

int cdprep_distance_between(const cdprep_model* a, const cdprep_model* b,
                            const cdprep_placement* placement, cdprep_workspace* workspace,
                            const cdprep_distance_options* options, cdprep_pair_cache* cache,
                            int* found, cdprep_distance* distance, cdprep_error* error) {
    if (cdprep::any_null(found, distance)) return cdprep::null_argument(error);
    cdprep_distance_options given = cdprep::default_distance_options();
    if (!cdprep::read_sized(options, given)) return cdprep::bad_size(error);
    return cdprep::ask_pair(
        a, b, placement, workspace, error,
        [&](const Model& ma, const Model& mb, const Placement& placed, Workspace& scratch) {
            cdprep::PairCacheCopy copy(cache);
            cdprep::store(cdprep::distance(ma, mb, placed, scratch, cdprep::distance_options(given),
                                           copy.get()),
                          *found, *distance);
            return CDPREP_OK;
        });
}

int cdprep_is_within(const cdprep_model* a, const cdprep_model* b,
                     const cdprep_placement* placement, cdprep_workspace* workspace,
                     double tolerance, cdprep_pair_cache* cache, int* within, cdprep_error* error) {
    if (within == nullptr) return cdprep::null_argument(error);
    return cdprep::ask_pair(
        a, b, placement, workspace, error,
        [&](const Model& ma, const Model& mb, const Placement& placed, Workspace& scratch) {
            cdprep::PairCacheCopy copy(cache);
            *within = cdprep::is_within(ma, mb, placed, tolerance, scratch, copy.get()) ? 1 : 0;
            return CDPREP_OK;
        });
}

int cdprep_triangles_within(const cdprep_model* a, const cdprep_model* b,
                            const cdprep_placement* placement, cdprep_workspace* workspace,
                            double tolerance, const cdprep_contact_options* options,
                            cdprep_triangle_pair* pairs, size_t room, size_t* count,
                            cdprep_error* error) {
    if (count == nullptr || (pairs == nullptr && room > 0)) return cdprep::null_argument(error);
    cdprep_contact_options given{};
    if (!cdprep::read_sized(options, given)) return cdprep::bad_size(error);
    return cdprep::ask_pair(
        a, b, placement, workspace, error,
        [&](const Model& ma, const Model& mb, const Placement& placed, Workspace& scratch) {
            *count = cdprep::triangles_within(ma, mb, placed, tolerance, scratch,
                                              cdprep::room_of(pairs, room),
                                              {cdprep::overlap_options(given).degenerate});
            return CDPREP_OK;
        });
}
