// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "cdprep/advanced/parallel_for.h"
#include "cdprep/format/api.h"
#include "cdprep/pairs.h"

namespace cdprep {

/// Returns the same as overlaps(), computed on at most one thread per workspace. There must be at
/// least one workspace: otherwise the program stops with a message. The pairs, their order and
/// their number do not depend on the threads.
///
/// Use it for one query that takes a millisecond or more, such as two large models that overlap
/// deeply. Calls `parallel_for` at most twice, each time with at most one task per workspace. A
/// task that starts late finds less work or none. If `room` is not empty but too short, one thread
/// repeats the query to keep the smallest pairs. Uses the BVH and no cache. Reads options.overlap
/// and degenerate. Needs Ask::overlap of both models. Never allocates.
[[nodiscard]] CDPREP_API std::size_t split_overlaps(const Pair& pair,
                                                    std::span<Workspace> workspaces,
                                                    ParallelFor parallel_for,
                                                    std::span<TrianglePair> room) noexcept;

/// Runs collide() for many pairs: stores the result for pairs[i] in answers[i]. The results are
/// those of single calls and do not depend on the threads. Pairs may share models freely: a batch
/// may hold many poses of the same two models. No two pairs of a batch may share a cache or a
/// front.
///
/// There must be at least one workspace: otherwise the program stops with a message. The batch uses
/// at most one thread per workspace. Calls `parallel_for` at most once. Processes min(pairs.size(),
/// answers.size()) pairs. Never allocates. Starting a batch on several threads takes a few
/// microseconds, so a batch pays off from about ten pairs. The rules of this comment up to here
/// also hold for the batches below. Needs Ask::collide of both models of each pair, Ask::solid with
/// Body::solid, and ask_of(options.through).
///
///     std::vector<cdprep::Workspace> workspaces(4);
///     std::vector<cdprep::Collision> answers(pairs.size());
///     cdprep::collide_many(pairs, workspaces, run, answers);  // run: see ParallelFor
CDPREP_API void collide_many(std::span<const Pair> pairs, std::span<Workspace> workspaces,
                             ParallelFor parallel_for, std::span<Collision> answers) noexcept;

/// Runs distance() for many pairs. Needs Ask::distance of both models of each pair, Ask::solid with
/// Body::solid, and ask_of(options.through).
CDPREP_API void distance_many(std::span<const Pair> pairs, std::span<Workspace> workspaces,
                              ParallelFor parallel_for, std::span<std::optional<Distance>> answers,
                              const DistanceOptions& options = {}) noexcept;

/// Runs within() for many pairs. Needs Ask::within and ask_of(options.through) of both models of
/// each pair.
CDPREP_API void within_many(std::span<const Pair> pairs, double tolerance,
                            std::span<Workspace> workspaces, ParallelFor parallel_for,
                            std::span<bool> answers) noexcept;

/// Runs overlaps() with an empty room for many pairs, and stores the numbers of triangle pairs.
/// Needs Ask::overlap and ask_of(options.through) of both models of each pair.
CDPREP_API void count_overlaps_many(std::span<const Pair> pairs, std::span<Workspace> workspaces,
                                    ParallelFor parallel_for,
                                    std::span<std::size_t> counts) noexcept;

/// The overlapping triangles of one pair of models.
struct OverlapList {
    std::span<TrianglePair> room;  ///< input; receives the smallest pairs, sorted
    std::size_t count = 0;         ///< output: number of pairs found, even if the room is too short
};

/// Runs overlaps() for many pairs. Needs Ask::overlap and ask_of(options.through) of both models of
/// each pair.
CDPREP_API void overlaps_many(std::span<const Pair> pairs, std::span<Workspace> workspaces,
                              ParallelFor parallel_for, std::span<OverlapList> answers) noexcept;

/// The marks that mark_overlaps() makes.
struct OverlapMarks {
    std::span<std::uint64_t> bits_a;  ///< input; cleared, but not marked if too short
    std::span<std::uint64_t> bits_b;  ///< input; cleared, but not marked if too short
    std::size_t count = 0;            ///< output: number of pairs found
};

/// Runs mark_overlaps() for many pairs. Needs Ask::overlap of both models of each pair.
CDPREP_API void mark_overlaps_many(std::span<const Pair> pairs, std::span<Workspace> workspaces,
                                   ParallelFor parallel_for,
                                   std::span<OverlapMarks> answers) noexcept;

}  // namespace cdprep
