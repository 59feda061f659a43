// SPDX-License-Identifier: MIT
#include <cassert>

#include "c/c_pairs.h"
#include "c/pair_answers.h"
#include "core/share_out.h"

namespace cdprep::c {
namespace {

/// A batch of queries about two models.
template <class Answer>
struct Batch {
    const PairQuestion& question;
    const cdprep_pair* pairs;
    std::size_t count;
    cdprep_workspace* workspace;
    Answer* answers;
    const char* answers_name;
    cdprep_error* error;
};

/// Checks every pair and its answer by `check(call, i, asked)`.
template <class Answer, class Check>
int check_pairs(Call& call, const Batch<Answer>& batch, Check&& check) {
    for (std::size_t i = 0; i < batch.count; ++i) {
        const Name name = {"pairs", i};
        const cdprep_pair* const pair = element(batch.pairs, i);
        if (const int code = check_stride(call, name, batch.pairs, pair)) return code;
        AskedPair asked;
        if (const int code = read_pair(call, name, batch.question, pair, *batch.workspace, asked))
            return code;
        if (const int code = check(call, i, asked)) return code;
    }
    return CDPREP_OK;
}

/// Sets all answers to unknown, checks everything (`check_options(call)`, then `check(call, i,
/// pair)`), then calls `ask(answer, pair, workspace)` for each pair, on all lanes.
template <class Answer, class CheckOptions, class Check, class Asker>
int ask_pairs(const Batch<Answer>& batch, CheckOptions&& check_options, Check&& check,
              Asker&& ask) noexcept {
    set_unknown(batch.answers, batch.count);
    return guarded(batch.error, [&](Call& call) -> int {
        if (const int code = call.need(batch.workspace, {"workspace"})) return code;
        if (batch.count > 0) {
            if (const int code = call.need(batch.pairs, {"pairs"})) return code;
            if (const int code = call.need(batch.answers, {batch.answers_name})) return code;
        }
        if (batch.count > kMostAnswers<Answer>) {
            return call.refuse(CDPREP_WHY_OUT_OF_RANGE, {"count"}, "is more than memory holds.");
        }
        if (const int code = check_options(call)) return code;
        if (const int code = check_pairs(call, batch, check)) return code;
        InUse use;
        if (const int code = use.begin(call, *batch.workspace)) return code;
        const std::span<Workspace> lanes = batch.workspace->lanes;
        const CallersThreads threads(*batch.workspace);
        share_jobs(batch.count, lanes.size(), threads, [&](std::size_t i, std::size_t lane) {
            assert(lane < lanes.size());
            AskedPair asked;
            Call again(nullptr);
            const cdprep_pair* const pair = element(batch.pairs, i);
            if (read_pair(again, {"pairs", i}, batch.question, pair, *batch.workspace, asked) !=
                CDPREP_OK) {
                return;
            }
            ask(batch.answers[i], asked, lanes[lane]);
        });
        return CDPREP_OK;
    });
}

constexpr auto no_answer_to_check = [](Call& /*call*/, std::size_t /*i*/,
                                       const AskedPair& /*asked*/) -> int { return CDPREP_OK; };

}  // namespace
}  // namespace cdprep::c

using cdprep::Workspace;
using cdprep::c::ask_pairs;
using cdprep::c::AskedPair;
using cdprep::c::Batch;
using cdprep::c::Call;
using cdprep::c::no_answer_to_check;
using cdprep::c::nothing_to_check;

int cdprep_collide_many(const cdprep_pair* pairs, size_t count, cdprep_workspace* workspace,
                        cdprep_collision* collisions, cdprep_error* error) {
    const Batch<cdprep_collision> batch = {cdprep::c::kCollide, pairs,        count, workspace,
                                           collisions,          "collisions", error};
    return ask_pairs(batch, nothing_to_check, no_answer_to_check,
                     [](cdprep_collision& to, const AskedPair& asked, Workspace& scratch) {
                         to = cdprep::c::collision_of(asked, scratch);
                     });
}

int cdprep_distance_many(const cdprep_pair* pairs, size_t count,
                         const cdprep_distance_options* options, cdprep_workspace* workspace,
                         cdprep_nearest* nearest, cdprep_error* error) {
    cdprep_distance_options given{};
    const Batch<cdprep_nearest> batch = {
        cdprep::c::kDistance, pairs, count, workspace, nearest, "nearest", error};
    return ask_pairs(
        batch, [&](Call& call) { return cdprep::c::read_distance_options(call, options, given); },
        no_answer_to_check,
        [&](cdprep_nearest& to, const AskedPair& asked, Workspace& scratch) {
            to = cdprep::c::nearest_of(asked, given, scratch);
        });
}

int cdprep_within_many(const cdprep_pair* pairs, size_t count, double tolerance,
                       cdprep_workspace* workspace, uint32_t* within, cdprep_error* error) {
    const Batch<uint32_t> batch = {cdprep::c::kWithin, pairs, count, workspace, within,
                                   "within",           error};
    return ask_pairs(
        batch,
        [&](Call& call) {
            return check_number(call, "tolerance", cdprep::c::Holds::length, tolerance);
        },
        no_answer_to_check,
        [&](uint32_t& to, const AskedPair& asked, Workspace& scratch) {
            to = cdprep::c::word(cdprep::c::is_pair_within(asked, tolerance, scratch));
        });
}

int cdprep_overlaps_many(const cdprep_pair* pairs, size_t count, cdprep_workspace* workspace,
                         cdprep_overlap_list* lists, cdprep_error* error) {
    const Batch<cdprep_overlap_list> batch = {
        cdprep::c::kOverlaps, pairs, count, workspace, lists, "lists", error};
    return ask_pairs(
        batch, nothing_to_check,
        [&](Call& call, size_t i, const AskedPair& /*asked*/) {
            return check_list(call, {"lists", i}, lists[i]);
        },
        [](cdprep_overlap_list& to, const AskedPair& asked, Workspace& scratch) {
            to.count = cdprep::c::list_overlaps(asked, scratch, cdprep::c::room_of(to));
        });
}

int cdprep_overlaps_mark_many(const cdprep_pair* pairs, size_t count, cdprep_workspace* workspace,
                              cdprep_marks* marks, cdprep_error* error) {
    const Batch<cdprep_marks> batch = {
        cdprep::c::kOverlapsOtherwise, pairs, count, workspace, marks, "marks", error};
    return ask_pairs(
        batch, nothing_to_check,
        [&](Call& call, size_t i, const AskedPair& asked) {
            return check_marks(call, {"marks", i}, marks[i], asked);
        },
        [](cdprep_marks& to, const AskedPair& asked, Workspace& scratch) {
            to.count = cdprep::c::mark_overlaps(asked, scratch, to);
        });
}
