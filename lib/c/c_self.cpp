// SPDX-License-Identifier: MIT
#include <array>
#include <cassert>
#include <type_traits>

#include "c/c_pairs.h"
#include "cdprep/self.h"

namespace cdprep::c {

template <>
struct Input<cdprep_self_query> {
    static const InputType type;
    static cdprep_self_query defaults() noexcept {
        return {};
    }
};

namespace {

constexpr std::array kFields = {
    Field{"model", offsetof(cdprep_self_query, model), Holds::pointer},
    Field{"overlap", offsetof(cdprep_self_query, overlap), Holds::choice, CDPREP_PROPER},
    Field{"degenerate", offsetof(cdprep_self_query, degenerate), Holds::choice,
          CDPREP_SKIP_DEGENERATE},
};

constexpr Name kQuery = {"query"};

/// Runs a query about a model and itself. Checks everything first, then calls `ask(model,
/// workspace, options)`.
template <class Answer, class Asker>
int ask_self(const cdprep_self_query* given, cdprep_workspace* workspace, Answer* answer,
             const char* answer_name, cdprep_error* error, Asker&& ask) noexcept {
    if constexpr (!std::is_function_v<Answer>) set_unknown(answer, 1);
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(given, kQuery)) return code;
        if (const int code = call.need(workspace, {"workspace"})) return code;
        if (answer == nullptr) return call.need(nullptr, {answer_name});
        if constexpr (!std::is_function_v<Answer>) {
            if (const int code = check_list(call, {answer_name}, *answer)) return code;
        }
        cdprep_self_query query{};
        if (const int code = read_input(call, kQuery, given, query)) return code;
        if (const int code =
                check_serves(call, kQuery.of("model"), *query.model, Ask::overlap | Ask::corners)) {
            return code;
        }
        InUse use;
        if (const int code = use.begin(call, *workspace)) return code;
        assert(!workspace->lanes.empty());
        const SelfOptions options = {
            query.overlap == CDPREP_PROPER ? Overlap::proper : Overlap::closed,
            query.degenerate == CDPREP_SKIP_DEGENERATE ? Degenerate::skip : Degenerate::keep};
        ask(query.model->model, workspace->lanes[0], options);
        return CDPREP_OK;
    });
}

}  // namespace

const InputType Input<cdprep_self_query>::type = {"cdprep_self_query", 0xcd500013U,
                                                  sizeof(cdprep_self_query),
                                                  sizeof(cdprep_self_query), kFields};

}  // namespace cdprep::c

using cdprep::Model;
using cdprep::SelfOptions;
using cdprep::Workspace;
using cdprep::c::ask_self;

void cdprep_self_query_init(cdprep_self_query* query, size_t size) {
    cdprep::c::initialise(query, size);
}

int cdprep_self_overlaps(const cdprep_self_query* query, cdprep_workspace* workspace,
                         cdprep_overlap_list* list, cdprep_error* error) {
    return ask_self(query, workspace, list, "list", error,
                    [&](const Model& model, Workspace& scratch, const SelfOptions& options) {
                        list->count =
                            self_overlaps(model, scratch, cdprep::c::room_of(*list), options);
                    });
}

int cdprep_self_overlaps_visit(const cdprep_self_query* query, cdprep_workspace* workspace,
                               cdprep_overlap_visitor visit, void* context, cdprep_error* error) {
    return ask_self(query, workspace, visit, "visit", error,
                    [&](const Model& model, Workspace& scratch, const SelfOptions& options) {
                        const auto hand_on = [&](const cdprep::TrianglePair& found) {
                            const cdprep_overlap overlap = {found.a, found.b};
                            return visit(context, &overlap) != 0;
                        };
                        visit_self_overlaps(model, scratch, hand_on, options);
                    });
}
