// SPDX-License-Identifier: MIT
#include "c/batch.h"
#include "c/c_pairs.h"
#include "c/pair_answers.h"

namespace cdprep::c {
namespace {

template <class Answer>
using PairBatch = Batch<cdprep_pair, Answer>;

/// Runs a query about each pair; see ask_batch().
template <class Answer, class CheckOptions, class Check, class Asker>
int ask_pairs(const PairQuestion& question, const PairBatch<Answer>& batch,
              CheckOptions&& check_options, Check&& check, Asker&& ask) noexcept {
    const auto read = [&](Call& call, const Name& name, const cdprep_pair* pair, AskedPair& asked) {
        return read_pair(call, name, question, pair, *batch.workspace, asked);
    };
    return ask_batch<AskedPair>(batch, check_options, read, check, ask);
}

}  // namespace
}  // namespace cdprep::c

using cdprep::Workspace;
using cdprep::c::ask_pairs;
using cdprep::c::AskedPair;
using cdprep::c::Call;
using cdprep::c::no_answer_to_check;
using cdprep::c::nothing_to_check;
using cdprep::c::PairBatch;

int cdprep_collide_many(const cdprep_pair* pairs, size_t count, cdprep_workspace* workspace,
                        cdprep_collision* collisions, cdprep_error* error) {
    const PairBatch<cdprep_collision> batch = {pairs,      "pairs",      count, workspace,
                                               collisions, "collisions", error};
    return ask_pairs(cdprep::c::kCollide, batch, nothing_to_check, no_answer_to_check,
                     [](cdprep_collision& to, const AskedPair& asked, Workspace& scratch) {
                         to = cdprep::c::collision_of(asked, scratch);
                     });
}

int cdprep_distance_many(const cdprep_pair* pairs, size_t count,
                         const cdprep_distance_options* options, cdprep_workspace* workspace,
                         cdprep_nearest* nearest, cdprep_error* error) {
    cdprep_distance_options given{};
    const PairBatch<cdprep_nearest> batch = {pairs,   "pairs",   count, workspace,
                                             nearest, "nearest", error};
    return ask_pairs(
        cdprep::c::kDistance, batch,
        [&](Call& call) { return cdprep::c::read_distance_options(call, options, given); },
        no_answer_to_check,
        [&](cdprep_nearest& to, const AskedPair& asked, Workspace& scratch) {
            to = cdprep::c::nearest_of(asked, given, scratch);
        });
}

int cdprep_within_many(const cdprep_pair* pairs, size_t count, double tolerance,
                       cdprep_workspace* workspace, uint32_t* within, cdprep_error* error) {
    const PairBatch<uint32_t> batch = {pairs, "pairs", count, workspace, within, "within", error};
    return ask_pairs(
        cdprep::c::kWithin, batch,
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
    const PairBatch<cdprep_overlap_list> batch = {pairs, "pairs", count, workspace,
                                                  lists, "lists", error};
    return ask_pairs(
        cdprep::c::kOverlaps, batch, nothing_to_check,
        [&](Call& call, size_t i, const AskedPair& /*asked*/) {
            return check_list(call, {"lists", i}, lists[i]);
        },
        [](cdprep_overlap_list& to, const AskedPair& asked, Workspace& scratch) {
            to.count = cdprep::c::list_overlaps(asked, scratch, cdprep::c::room_of(to));
        });
}

int cdprep_overlaps_mark_many(const cdprep_pair* pairs, size_t count, cdprep_workspace* workspace,
                              cdprep_marks* marks, cdprep_error* error) {
    const PairBatch<cdprep_marks> batch = {pairs, "pairs", count, workspace, marks, "marks", error};
    return ask_pairs(
        cdprep::c::kOverlapsOtherwise, batch, nothing_to_check,
        [&](Call& call, size_t i, const AskedPair& asked) {
            return check_marks(call, {"marks", i}, marks[i], asked);
        },
        [](cdprep_marks& to, const AskedPair& asked, Workspace& scratch) {
            to.count = cdprep::c::mark_overlaps(asked, scratch, to);
        });
}
