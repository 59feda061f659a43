// SPDX-License-Identifier: MIT
#include "c/c_pairs.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <tuple>

#include "c/pair_answers.h"
#include "c/pair_cache_words.h"
#include "cdprep/pairs.h"
#include "cdprep/parallel.h"
#include "core/smallest.h"
#include "walk/cell_searches.h"

namespace cdprep::c {
namespace {

constexpr std::array kPairFields = {
    Field{"a", offsetof(cdprep_pair, a), Holds::pointer},
    Field{"b", offsetof(cdprep_pair, b), Holds::pointer},
    Field{"moving", offsetof(cdprep_pair, moving), Holds::choice, CDPREP_MOVE_BOTH},
    Field{"body", offsetof(cdprep_pair, body), Holds::choice, CDPREP_SOLID},
    Field{"overlap", offsetof(cdprep_pair, overlap), Holds::choice, CDPREP_PROPER},
    Field{"degenerate", offsetof(cdprep_pair, degenerate), Holds::choice, CDPREP_SKIP_DEGENERATE},
    Field{"through", offsetof(cdprep_pair, through), Holds::choice, CDPREP_THROUGH_PIECES},
    Field{"reserved", offsetof(cdprep_pair, reserved), Holds::reserved},
    Field{"pose_a", offsetof(cdprep_pair, pose_a), Holds::number, 0, 12},
    Field{"pose_b", offsetof(cdprep_pair, pose_b), Holds::number, 0, 12},
};

constexpr std::array kDistanceFields = {
    Field{"relative_error", offsetof(cdprep_distance_options, relative_error), Holds::length},
    Field{"absolute_error", offsetof(cdprep_distance_options, absolute_error), Holds::length},
    Field{"max_distance", offsetof(cdprep_distance_options, max_distance), Holds::limit},
};

int refuse_meaning(Call& call, const Name& name, std::uint32_t value) noexcept {
    return call.refuse(CDPREP_WHY_NO_MEANING, name,
                       "is %u, which this query does not use; leave it at its default.", value);
}

int check_meaning(Call& call, const Name& name, const PairQuestion& question,
                  const cdprep_pair& pair) noexcept {
    if (pair.body != CDPREP_SURFACE && (question.uses & uses_body) == 0) {
        return refuse_meaning(call, name.of("body"), pair.body);
    }
    if (pair.overlap != CDPREP_CLOSED && (question.uses & uses_overlap) == 0) {
        return refuse_meaning(call, name.of("overlap"), pair.overlap);
    }
    if (pair.degenerate != CDPREP_KEEP_DEGENERATE && (question.uses & uses_degenerate) == 0) {
        return refuse_meaning(call, name.of("degenerate"), pair.degenerate);
    }
    if ((question.structures >> pair.through & 1) == 0) {
        return refuse_meaning(call, name.of("through"), pair.through);
    }
    return CDPREP_OK;
}

cdprep_overlap overlap_of(const TrianglePair& pair) noexcept {
    return {pair.a, pair.b};
}

cdprep_crossing crossing_of(const Crossing& crossing) noexcept {
    cdprep_crossing to{};
    to.pair = overlap_of(crossing.pair);
    to.is_flat = word(crossing.is_flat);
    store(crossing.from, to.ends[0]);
    store(crossing.to, to.ends[1]);
    return to;
}

struct ByPair {
    bool operator()(const cdprep_crossing& x, const cdprep_crossing& y) const noexcept {
        return std::tie(x.pair.a, x.pair.b) < std::tie(y.pair.a, y.pair.b);
    }
};

static_assert(sizeof(cdprep_overlap) == sizeof(TrianglePair) &&
              offsetof(cdprep_overlap, b) == offsetof(TrianglePair, b));

}  // namespace

// The first version ended before `front`.
const InputType Input<cdprep_pair>::type = {
    "cdprep_pair", 0xcd500003U, offsetof(cdprep_pair, front), sizeof(cdprep_pair), kPairFields};

cdprep_pair Input<cdprep_pair>::defaults() noexcept {
    cdprep_pair pair{};
    pair.pose_a = pair.pose_b = kIdentity;
    return pair;
}

const InputType Input<cdprep_distance_options>::type = {
    "cdprep_distance_options", 0xcd500004U, sizeof(cdprep_distance_options),
    sizeof(cdprep_distance_options), kDistanceFields};

cdprep_distance_options Input<cdprep_distance_options>::defaults() noexcept {
    return {{}, 0, 0, std::numeric_limits<double>::infinity()};
}

Structure structure_of(std::uint32_t through) noexcept {
    constexpr std::array kStructures = {
        Structure::bvh,           Structure::octree,     Structure::adaptive_octree,
        Structure::hashed_octree, Structure::tetra_tree, Structure::pieces};
    assert(through < kStructures.size());
    return kStructures[through];
}

Ask needs_of(std::uint32_t through) noexcept {
    constexpr std::array kNeeds = {Ask::nothing,       Ask::octree,     Ask::adaptive_octree,
                                   Ask::hashed_octree, Ask::tetra_tree, Ask::pieces};
    assert(through < kNeeds.size());
    return kNeeds[through];
}

int read_pair(Call& call, const Name& name, const PairQuestion& question, const cdprep_pair* given,
              AskedPair& asked) {
    cdprep_pair pair;
    if (const int code = read_input(call, name, given, pair)) return code;
    if (const int code =
            read_placement(call, name, pair.moving, pair.pose_a, pair.pose_b, asked.placement)) {
        return code;
    }
    if (const int code = check_meaning(call, name, question, pair)) return code;
    Ask needs = question.needs | needs_of(pair.through);
    if (pair.body == CDPREP_SOLID) needs = needs | Ask::solid;
    if (const int code = check_serves(call, name.of("a"), *pair.a, needs)) return code;
    if (const int code = check_serves(call, name.of("b"), *pair.b, needs)) return code;
    asked.a = &pair.a->model;
    asked.b = &pair.b->model;
    asked.options.body = pair.body == CDPREP_SOLID ? Body::solid : Body::surface;
    asked.options.overlap = pair.overlap == CDPREP_PROPER ? Overlap::proper : Overlap::closed;
    asked.options.degenerate =
        pair.degenerate == CDPREP_SKIP_DEGENERATE ? Degenerate::skip : Degenerate::keep;
    asked.options.through = structure_of(pair.through);
    asked.cache = pair.cache;
    const bool uses_front = asked.options.through == Structure::pieces && pair.cache != nullptr;
    asked.front = uses_front ? pair.front : nullptr;
    return CDPREP_OK;
}

int read_pair(Call& call, const Name& name, const PairQuestion& question, const cdprep_pair* given,
              const cdprep_workspace& workspace, AskedPair& asked) {
    if (const int code = read_pair(call, name, question, given, asked)) return code;
    return check_cells(call, workspace, question.needs | ask_of(asked.options.through));
}

int read_distance_options(Call& call, const cdprep_distance_options* given,
                          cdprep_distance_options& options) noexcept {
    return read_options(call, {"options"}, given, options);
}

std::uint32_t word(Answer answer) noexcept {
    switch (answer) {
        case Answer::no:
            return CDPREP_NO;
        case Answer::yes:
            return CDPREP_YES;
        default:
            return CDPREP_UNKNOWN;
    }
}

}  // namespace cdprep::c

using cdprep::TrianglePair;
using cdprep::Workspace;
using cdprep::c::ask_pair;
using cdprep::c::AskedPair;
using cdprep::c::Call;
using cdprep::c::nothing_to_check;
using cdprep::c::PairCacheWords;
using cdprep::c::room_of;

void cdprep_pair_init(cdprep_pair* pair, size_t size) {
    cdprep::c::initialise(pair, size);
}

void cdprep_distance_options_init(cdprep_distance_options* options, size_t size) {
    cdprep::c::initialise(options, size);
}

int cdprep_collide(const cdprep_pair* pair, cdprep_workspace* workspace,
                   cdprep_collision* collision, cdprep_error* error) {
    return ask_pair(cdprep::c::kCollide, pair, workspace, collision, "collision", error,
                    nothing_to_check, [&](const AskedPair& asked, Workspace& scratch) {
                        *collision = cdprep::c::collision_of(asked, scratch);
                    });
}

int cdprep_containment(const cdprep_pair* pair, cdprep_workspace* workspace,
                       cdprep_collision* collision, cdprep_error* error) {
    return ask_pair(cdprep::c::kContainment, pair, workspace, collision, "collision", error,
                    nothing_to_check, [&](const AskedPair& asked, Workspace& scratch) {
                        *collision = cdprep::c::in_c(false, containment(asked.pair(), scratch));
                    });
}

int cdprep_collide_at_level(const cdprep_pair* pair, uint32_t level, cdprep_workspace* workspace,
                            uint32_t* hit, cdprep_error* error) {
    return ask_pair(cdprep::c::kCollideAtLevel, pair, workspace, hit, "hit", error,
                    nothing_to_check, [&](const AskedPair& asked, Workspace& scratch) {
                        const auto& cells = cdprep::require_cells(scratch);
                        *hit =
                            cdprep::c::word(cells.collide_at_level(asked.pair(), level, scratch));
                    });
}

int cdprep_overlaps(const cdprep_pair* pair, cdprep_workspace* workspace, cdprep_overlap_list* list,
                    cdprep_error* error) {
    return ask_pair(
        cdprep::c::kOverlaps, pair, workspace, list, "list", error,
        [&](Call& call) { return check_list(call, {"list"}, *list); },
        [&](const AskedPair& asked, Workspace& scratch) {
            list->count = cdprep::c::list_overlaps(asked, scratch, room_of(*list));
        });
}

int cdprep_overlaps_split(const cdprep_pair* pair, cdprep_workspace* workspace,
                          cdprep_overlap_list* list, cdprep_error* error) {
    return ask_pair(
        cdprep::c::kOverlapsOtherwise, pair, workspace, list, "list", error,
        [&](Call& call) { return check_list(call, {"list"}, *list); },
        [&](const AskedPair& asked, Workspace& /*scratch*/) {
            const cdprep::c::CallersThreads threads(*workspace);
            list->count = split_overlaps(asked.pair(), workspace->lanes, threads, room_of(*list));
        });
}

int cdprep_overlaps_visit(const cdprep_pair* pair, cdprep_workspace* workspace,
                          cdprep_overlap_visitor visit, void* context, cdprep_error* error) {
    return ask_pair(cdprep::c::kOverlapsOtherwise, pair, workspace, visit, "visit", error,
                    nothing_to_check, [&](const AskedPair& asked, Workspace& scratch) {
                        const auto hand_on = [&](const TrianglePair& found) {
                            const cdprep_overlap overlap = cdprep::c::overlap_of(found);
                            return visit(context, &overlap) != 0;
                        };
                        PairCacheWords cache(asked.cache);
                        visit_overlaps(asked.with(cache), scratch, hand_on);
                    });
}

int cdprep_overlaps_mark(const cdprep_pair* pair, cdprep_workspace* workspace, cdprep_marks* marks,
                         cdprep_error* error) {
    return ask_pair(cdprep::c::kOverlapsOtherwise, pair, workspace, marks, "marks", error,
                    nothing_to_check,
                    [&](Call& call, const AskedPair& asked, Workspace& scratch) -> int {
                        if (const int code = check_marks(call, {"marks"}, *marks, asked))
                            return code;
                        marks->count = cdprep::c::mark_overlaps(asked, scratch, *marks);
                        return CDPREP_OK;
                    });
}

int cdprep_crossings(const cdprep_pair* pair, cdprep_workspace* workspace,
                     cdprep_crossing_list* list, cdprep_error* error) {
    return ask_pair(
        cdprep::c::kOverlapsOtherwise, pair, workspace, list, "list", error,
        [&](Call& call) { return check_list(call, {"list"}, *list); },
        [&](const AskedPair& asked, Workspace& scratch) {
            const std::span room(list->items, list->room);
            cdprep::Smallest<cdprep_crossing, cdprep::c::ByPair> smallest(room);
            const auto keep = [&](const cdprep::Crossing& crossing) {
                smallest.add(cdprep::c::crossing_of(crossing));
                return true;
            };
            visit_crossings(asked.pair(), scratch, keep);
            std::sort(smallest.kept().begin(), smallest.kept().end(), cdprep::c::ByPair());
            list->count = smallest.count();
        });
}

int cdprep_crossings_visit(const cdprep_pair* pair, cdprep_workspace* workspace,
                           cdprep_crossing_visitor visit, void* context, cdprep_error* error) {
    return ask_pair(cdprep::c::kOverlapsOtherwise, pair, workspace, visit, "visit", error,
                    nothing_to_check, [&](const AskedPair& asked, Workspace& scratch) {
                        const auto hand_on = [&](const cdprep::Crossing& found) {
                            const cdprep_crossing crossing = cdprep::c::crossing_of(found);
                            return visit(context, &crossing) != 0;
                        };
                        visit_crossings(asked.pair(), scratch, hand_on);
                    });
}

int cdprep_distance(const cdprep_pair* pair, const cdprep_distance_options* options,
                    cdprep_workspace* workspace, cdprep_nearest* nearest, cdprep_error* error) {
    cdprep_distance_options given{};
    return ask_pair(
        cdprep::c::kDistance, pair, workspace, nearest, "nearest", error,
        [&](Call& call) { return cdprep::c::read_distance_options(call, options, given); },
        [&](const AskedPair& asked, Workspace& scratch) {
            *nearest = cdprep::c::nearest_of(asked, given, scratch);
        });
}

int cdprep_distance_bounded(const cdprep_pair* pair, const cdprep_distance_options* options,
                            uint64_t work, cdprep_workspace* workspace, cdprep_bounded* bounded,
                            cdprep_error* error) {
    cdprep_distance_options given{};
    return ask_pair(
        cdprep::c::kBoundedDistance, pair, workspace, bounded, "bounded", error,
        [&](Call& call) { return cdprep::c::read_distance_options(call, options, given); },
        [&](const AskedPair& asked, Workspace& scratch) {
            cdprep::c::PairCacheWords cache(asked.cache);
            *bounded = cdprep::c::in_c(bounded_distance(asked.with(cache), scratch,
                                                        cdprep::c::in_cpp(given), {.work = work}));
        });
}

int cdprep_within(const cdprep_pair* pair, double tolerance, cdprep_workspace* workspace,
                  uint32_t* within, cdprep_error* error) {
    return ask_pair(
        cdprep::c::kWithin, pair, workspace, within, "within", error,
        [&](Call& call) {
            return check_number(call, "tolerance", cdprep::c::Holds::length, tolerance);
        },
        [&](const AskedPair& asked, Workspace& scratch) {
            *within = cdprep::c::word(cdprep::c::is_pair_within(asked, tolerance, scratch));
        });
}

int cdprep_pairs_within(const cdprep_pair* pair, double tolerance, cdprep_workspace* workspace,
                        cdprep_overlap_list* list, cdprep_error* error) {
    return ask_pair(
        cdprep::c::kPairsWithin, pair, workspace, list, "list", error,
        [&](Call& call) {
            if (const int code = check_list(call, {"list"}, *list)) return code;
            return check_number(call, "tolerance", cdprep::c::Holds::length, tolerance);
        },
        [&](const AskedPair& asked, Workspace& scratch) {
            list->count = cdprep::c::list_pairs_within(asked, tolerance, scratch, room_of(*list));
        });
}

int cdprep_pairs_within_visit(const cdprep_pair* pair, double tolerance,
                              cdprep_workspace* workspace, cdprep_overlap_visitor visit,
                              void* context, cdprep_error* error) {
    return ask_pair(
        cdprep::c::kPairsWithinVisit, pair, workspace, visit, "visit", error,
        [&](Call& call) {
            return check_number(call, "tolerance", cdprep::c::Holds::length, tolerance);
        },
        [&](const AskedPair& asked, Workspace& scratch) {
            const auto hand_on = [&](const TrianglePair& found) {
                const cdprep_overlap overlap = cdprep::c::overlap_of(found);
                return visit(context, &overlap) != 0;
            };
            visit_pairs_within(asked.pair(), tolerance, scratch, hand_on);
        });
}
