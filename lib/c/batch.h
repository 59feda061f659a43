// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <span>

#include "c/c_pairs.h"
#include "core/share_out.h"

namespace cdprep::c {

/// Queries of one kind, in an array, and an answer to each.
template <class Query, class Answer>
struct Batch {
    const Query* queries;
    const char* queries_name;
    std::size_t count;
    cdprep_workspace* workspace;
    Answer* answers;
    const char* answers_name;
    cdprep_error* error;
};

/// Checks that the arrays are there and fit into memory.
template <class Query, class Answer>
int check_arrays(Call& call, const Batch<Query, Answer>& batch) noexcept {
    if (const int code = call.need(batch.workspace, {"workspace"})) return code;
    if (batch.count > 0) {
        if (const int code = call.need(batch.queries, {batch.queries_name})) return code;
        if (const int code = call.need(batch.answers, {batch.answers_name})) return code;
    }
    if (batch.count <= std::min(kMostAnswers<Answer>, kMostAnswers<Query>)) return CDPREP_OK;
    return call.refuse(CDPREP_WHY_OUT_OF_RANGE, {"count"}, "is more than memory holds.");
}

/// Sets all answers to unknown and checks everything. `check_options(call)` checks what all queries
/// share. `read(call, name, query, asked)` reads a query and checks it, and `check(call, i, asked)`
/// its answer. Then calls `ask(answer, asked, workspace)` for each query, on all lanes. A query
/// that changes meanwhile keeps its answer unknown.
template <class Asked, class Query, class Answer, class CheckOptions, class Read, class Check,
          class Asker>
int ask_batch(const Batch<Query, Answer>& batch, CheckOptions&& check_options, Read&& read,
              Check&& check, Asker&& ask) noexcept {
    set_unknown(batch.answers, batch.count);
    return guarded(batch.error, [&](Call& call) -> int {
        if (const int code = check_arrays(call, batch)) return code;
        if (const int code = check_options(call)) return code;
        for (std::size_t i = 0; i < batch.count; ++i) {
            const Name name = {batch.queries_name, i};
            const Query* const query = element(batch.queries, i);
            if (const int code = check_stride(call, name, batch.queries, query)) return code;
            Asked asked;
            if (const int code = read(call, name, query, asked)) return code;
            if (const int code = check(call, i, asked)) return code;
        }
        InUse use;
        if (const int code = use.begin(call, *batch.workspace)) return code;
        const std::span<Workspace> lanes = batch.workspace->lanes;
        const CallersThreads threads(*batch.workspace);
        share_jobs(batch.count, lanes.size(), threads, [&](std::size_t i, std::size_t lane) {
            assert(lane < lanes.size());
            Asked asked;
            Call again(nullptr);
            const Query* const query = element(batch.queries, i);
            if (read(again, {batch.queries_name, i}, query, asked) != CDPREP_OK) return;
            ask(batch.answers[i], asked, lanes[lane]);
        });
        return CDPREP_OK;
    });
}

/// The check of an answer that may be any.
inline constexpr auto no_answer_to_check = [](Call& /*call*/, std::size_t /*i*/,
                                              const auto& /*asked*/) -> int { return CDPREP_OK; };

}  // namespace cdprep::c
