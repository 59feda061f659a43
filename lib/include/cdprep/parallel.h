// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "cdprep/advanced/parallel_for.h"
#include "cdprep/pairs.h"

namespace cdprep {

/// overlaps() on as many threads as there are workspaces (at least one): the same pairs in the same
/// order and the same number, whatever the threads do.
///
/// For one question that takes a millisecond or more, such as two large models that overlap deeply.
/// Calls `parallel_for` at most twice, each time for one task per workspace; a task that starts
/// late finds less to do or nothing. If `room` is too short for all pairs but not empty, the
/// question is asked once more on one thread, which keeps the smallest. Reads options.overlap and
/// degenerate. Needs Ask::overlap of both models. Never allocates.
[[nodiscard]] std::size_t split_overlaps(const Pair& pair, std::span<Workspace> workspaces,
                                         ParallelFor parallel_for,
                                         std::span<TrianglePair> room) noexcept;

/// collide() for many pairs: stores the answer for pairs[i] in answers[i], the same as one by one,
/// whatever the threads do. Pairs may share models in any mixture: many poses of one pair, or many
/// pairs. No two pairs of a batch may share a cache.
///
/// One thread works for each workspace, of which there is at least one; `parallel_for` is called
/// once. Processes min(pairs.size(), answers.size()) pairs. Never allocates. A few microseconds to
/// start a batch pay from some ten pairs. The same holds for the batches below. Needs Ask::collide
/// of both models of a pair; Body::solid also Ask::solid.
///
///     std::vector<cdprep::Workspace> workspaces(4);
///     std::vector<cdprep::Collision> answers(pairs.size());
///     cdprep::collide_many(pairs, workspaces, run, answers);  // run: see ParallelFor
void collide_many(std::span<const Pair> pairs, std::span<Workspace> workspaces,
                  ParallelFor parallel_for, std::span<Collision> answers) noexcept;

/// distance() for many pairs. Needs Ask::distance of both models of a pair.
void distance_many(std::span<const Pair> pairs, std::span<Workspace> workspaces,
                   ParallelFor parallel_for, std::span<std::optional<Distance>> answers,
                   const DistanceOptions& options = {}) noexcept;

/// within() for many pairs. Needs Ask::within of both models of a pair.
void within_many(std::span<const Pair> pairs, double tolerance, std::span<Workspace> workspaces,
                 ParallelFor parallel_for, std::span<bool> answers) noexcept;

/// overlaps() with an empty room for many pairs: stores the numbers of pairs of triangles. Needs
/// Ask::overlap of both models of a pair.
void count_overlaps_many(std::span<const Pair> pairs, std::span<Workspace> workspaces,
                         ParallelFor parallel_for, std::span<std::size_t> counts) noexcept;

/// The overlapping triangles of one pair of models.
struct OverlapList {
    std::span<TrianglePair> room;  ///< given; takes the smallest pairs, sorted
    std::size_t count = 0;         ///< found, also where the room is too short
};

/// overlaps() for many pairs. Needs Ask::overlap of both models of a pair.
void overlaps_many(std::span<const Pair> pairs, std::span<Workspace> workspaces,
                   ParallelFor parallel_for, std::span<OverlapList> answers) noexcept;

/// The marks that mark_overlaps() makes.
struct OverlapMarks {
    std::span<std::uint64_t> bits_a;  ///< given; too short: nothing is marked
    std::span<std::uint64_t> bits_b;  ///< given; too short: nothing is marked
    std::size_t count = 0;            ///< pairs found
};

/// mark_overlaps() for many pairs. Needs Ask::overlap of both models of a pair.
void mark_overlaps_many(std::span<const Pair> pairs, std::span<Workspace> workspaces,
                        ParallelFor parallel_for, std::span<OverlapMarks> answers) noexcept;

}  // namespace cdprep
