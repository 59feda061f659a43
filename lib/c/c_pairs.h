// SPDX-License-Identifier: MIT
#pragma once

#include <cassert>
#include <cstdint>
#include <span>
#include <type_traits>

#include "c/c_mesh.h"
#include "c/c_model.h"
#include "c/c_workspace.h"
#include "c/pair_cache_words.h"
#include "c/pose_input.h"
#include "cdprep/advanced/structure.h"
#include "cdprep/c/contacts.h"
#include "cdprep/c/pairs.h"
#include "cdprep/pairs.h"

namespace cdprep::c {

template <>
struct Input<cdprep_pair> {
    static const InputType type;
    static cdprep_pair defaults() noexcept;
};

template <>
struct Input<cdprep_distance_options> {
    static const InputType type;
    static cdprep_distance_options defaults() noexcept;
};

/// Fields of a pair that a query may use. The others must be at their defaults.
enum Uses : std::uint32_t { uses_body = 1, uses_overlap = 2, uses_degenerate = 4 };

/// Bits of the structures through which a query may be computed.
inline constexpr std::uint32_t kBvhAlone = 1U << CDPREP_THROUGH_BVH;
inline constexpr std::uint32_t kBvhOrPieces = kBvhAlone | 1U << CDPREP_THROUGH_PIECES;
inline constexpr std::uint32_t kAnyStructure = (2U << CDPREP_THROUGH_PIECES) - 1;
inline constexpr std::uint32_t kAnyButPieces = kAnyStructure & ~(1U << CDPREP_THROUGH_PIECES);

/// A query about two models: the parts of the model that it needs, and the fields and structures
/// that it uses.
struct PairQuestion {
    Ask needs;
    std::uint32_t uses;
    std::uint32_t structures;
};

inline constexpr PairQuestion kCollide = {Ask::collide, uses_body | uses_overlap | uses_degenerate,
                                          kAnyStructure};
inline constexpr PairQuestion kContainment = {Ask::collide | Ask::solid, 0, kBvhAlone};
inline constexpr PairQuestion kCollideAtLevel = {Ask::tetra_tree, 0, kBvhAlone};
inline constexpr PairQuestion kOverlaps = {Ask::overlap, uses_overlap | uses_degenerate,
                                           kAnyStructure};
/// Overlaps that are split, visited or marked.
inline constexpr PairQuestion kOverlapsOtherwise = {Ask::overlap, uses_overlap | uses_degenerate,
                                                    kBvhAlone};
inline constexpr PairQuestion kDistance = {Ask::distance, uses_body, kBvhOrPieces};
inline constexpr PairQuestion kBoundedDistance = {Ask::distance, 0, kBvhAlone};
inline constexpr PairQuestion kWithin = {Ask::within, 0, kBvhOrPieces};
inline constexpr PairQuestion kPairsWithin = {Ask::within, uses_degenerate, kBvhOrPieces};
inline constexpr PairQuestion kPairsWithinVisit = {Ask::within, uses_degenerate, kBvhAlone};
inline constexpr PairQuestion kContacts = {Ask::contacts, uses_body | uses_degenerate,
                                           kBvhOrPieces};

/// A pair whose every field was checked, as C++ types.
struct AskedPair {
    const Model* a = nullptr;
    const Model* b = nullptr;
    Placement placement = Placement::b_moves(Pose());
    PairOptions options;
    cdprep_cache* cache = nullptr;
    cdprep_front* front = nullptr;  ///< null unless the query goes through pieces with a cache

    [[nodiscard]] Pair pair() const noexcept {
        assert(a != nullptr && b != nullptr);
        return {*a, *b, placement, options};
    }
    /// Returns the same with a cache, if the query uses the BVH.
    [[nodiscard]] Pair with(PairCacheWords& words) const noexcept {
        assert(a != nullptr && b != nullptr);
        const bool uses_cache = options.through == Structure::bvh;
        return {*a, *b, placement, options, uses_cache ? words.get() : nullptr};
    }
    /// Returns the same with a front too, if the query goes through pieces.
    [[nodiscard]] Pair with(PairCacheWords& words, PairFrontWords& planes) const noexcept {
        Pair with_cache = with(words);
        if (planes.get() == nullptr) return with_cache;
        with_cache.cache = words.get();
        with_cache.front = planes.get();
        return with_cache;
    }
};

/// Reads a pair and checks all of it but the workspace.
int read_pair(Call& call, const Name& name, const PairQuestion& question, const cdprep_pair* given,
              AskedPair& asked);
/// Reads a pair and checks all of it.
int read_pair(Call& call, const Name& name, const PairQuestion& question, const cdprep_pair* given,
              const cdprep_workspace& workspace, AskedPair& asked);

/// Returns the structure, and the Ask that a model must serve for it.
[[nodiscard]] Structure structure_of(std::uint32_t through) noexcept;
[[nodiscard]] Ask needs_of(std::uint32_t through) noexcept;

/// Reads and checks the options of a distance. Null gives the defaults.
int read_distance_options(Call& call, const cdprep_distance_options* given,
                          cdprep_distance_options& options) noexcept;

[[nodiscard]] std::uint32_t word(Answer answer) noexcept;
[[nodiscard]] inline std::uint32_t word(bool answer) noexcept {
    return answer ? CDPREP_YES : CDPREP_NO;
}

/// Sets one answer to unknown.
inline void set_unknown(std::uint32_t& answer) noexcept {
    answer = CDPREP_UNKNOWN;
}
inline void set_unknown(cdprep_collision& answer) noexcept {
    answer = {CDPREP_UNKNOWN, CDPREP_UNKNOWN, CDPREP_NO, 0, 0};
}
inline void set_unknown(cdprep_nearest& answer) noexcept {
    answer = {};
}
inline void set_unknown(cdprep_bounded& answer) noexcept {
    answer = {};
    answer.complete = CDPREP_UNKNOWN;
}
inline void set_unknown(cdprep_marks& answer) noexcept {
    answer.count = 0;
}
/// The same for any list.
template <class List>
requires requires(List list) {
    list.room;
}
void set_unknown(List& list) noexcept {
    list.count = 0;
}

/// The maximum number of answers of a batch that fit into memory.
template <class Answer>
inline constexpr std::size_t kMostAnswers = PTRDIFF_MAX / sizeof(Answer);

/// Sets all answers to unknown.
template <class Answer>
void set_unknown(Answer* answers, std::size_t count) noexcept {
    if (answers == nullptr || count > kMostAnswers<Answer>) return;
    for (std::size_t i = 0; i < count; ++i) set_unknown(answers[i]);
}

/// Refuses a list whose room is null.
template <class List>
int check_list(Call& call, const Name& name, const List& list) noexcept {
    if (list.items != nullptr || list.room == 0) return CDPREP_OK;
    return call.need(nullptr, name.of("items"));
}

[[nodiscard]] inline std::span<TrianglePair> room_of(const cdprep_overlap_list& list) noexcept {
    return {reinterpret_cast<TrianglePair*>(list.items), list.room};
}

/// Runs a query about one pair. Sets the answer to unknown, then checks everything; `check(call)`
/// checks the query's own arguments. Then calls `ask(pair, workspace)`, or `ask(call, pair,
/// workspace)`, which may still refuse.
template <class Answer, class Check, class Asker>
int ask_pair(const PairQuestion& question, const cdprep_pair* pair, cdprep_workspace* workspace,
             Answer* answer, const char* answer_name, cdprep_error* error, Check&& check,
             Asker&& ask) noexcept {
    if constexpr (!std::is_function_v<Answer>) set_unknown(answer, 1);
    return guarded(error, [&](Call& call) -> int {
        if (const int code = call.need(pair, {"pair"})) return code;
        if (const int code = call.need(workspace, {"workspace"})) return code;
        if (answer == nullptr) return call.need(nullptr, {answer_name});
        if (const int code = check(call)) return code;
        AskedPair asked;
        if (const int code = read_pair(call, {"pair"}, question, pair, *workspace, asked))
            return code;
        InUse use;
        if (const int code = use.begin(call, *workspace)) return code;
        assert(!workspace->lanes.empty());
        if constexpr (std::is_invocable_v<Asker, Call&, const AskedPair&, Workspace&>) {
            return ask(call, asked, workspace->lanes[0]);
        } else {
            ask(asked, workspace->lanes[0]);
            return CDPREP_OK;
        }
    });
}

/// The check of queries without arguments of their own.
inline constexpr auto nothing_to_check = [](Call& /*call*/) -> int { return CDPREP_OK; };

}  // namespace cdprep::c
