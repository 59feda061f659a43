// SPDX-License-Identifier: MIT
#include "cdprep/parallel.h"

#include <algorithm>

#include "core/require.h"
#include "core/share_out.h"

namespace cdprep {
namespace {

/// Calls `ask(pair, answer, workspace)` for every pair, on all workers.
template <class Answer, class Ask>
void ask_all(std::span<const Pair> pairs, std::span<Workspace> workspaces, ParallelFor parallel_for,
             std::span<Answer> answers, Ask ask) noexcept {
    require_workspaces(workspaces.size());
    share_jobs(
        std::min(pairs.size(), answers.size()), workspaces.size(), parallel_for,
        [&](std::size_t i, std::size_t worker) { ask(pairs[i], answers[i], workspaces[worker]); });
}

}  // namespace

void collide_many(std::span<const Pair> pairs, std::span<Workspace> workspaces,
                  ParallelFor parallel_for, std::span<Collision> answers) noexcept {
    ask_all(pairs, workspaces, parallel_for, answers,
            [](const Pair& pair, Collision& answer, Workspace& workspace) {
                answer = collide(pair, workspace);
            });
}

void distance_many(std::span<const Pair> pairs, std::span<Workspace> workspaces,
                   ParallelFor parallel_for, std::span<std::optional<Distance>> answers,
                   const DistanceOptions& options) noexcept {
    ask_all(pairs, workspaces, parallel_for, answers,
            [&](const Pair& pair, std::optional<Distance>& answer, Workspace& workspace) {
                answer = distance(pair, workspace, options);
            });
}

void within_many(std::span<const Pair> pairs, double tolerance, std::span<Workspace> workspaces,
                 ParallelFor parallel_for, std::span<bool> answers) noexcept {
    ask_all(pairs, workspaces, parallel_for, answers,
            [&](const Pair& pair, bool& answer, Workspace& workspace) {
                answer = within(pair, tolerance, workspace);
            });
}

void count_overlaps_many(std::span<const Pair> pairs, std::span<Workspace> workspaces,
                         ParallelFor parallel_for, std::span<std::size_t> counts) noexcept {
    ask_all(pairs, workspaces, parallel_for, counts,
            [](const Pair& pair, std::size_t& count, Workspace& workspace) {
                count = overlaps(pair, workspace, {});
            });
}

void overlaps_many(std::span<const Pair> pairs, std::span<Workspace> workspaces,
                   ParallelFor parallel_for, std::span<OverlapList> answers) noexcept {
    ask_all(pairs, workspaces, parallel_for, answers,
            [](const Pair& pair, OverlapList& answer, Workspace& workspace) {
                answer.count = overlaps(pair, workspace, answer.room);
            });
}

void mark_overlaps_many(std::span<const Pair> pairs, std::span<Workspace> workspaces,
                        ParallelFor parallel_for, std::span<OverlapMarks> answers) noexcept {
    ask_all(pairs, workspaces, parallel_for, answers,
            [](const Pair& pair, OverlapMarks& answer, Workspace& workspace) {
                answer.count = mark_overlaps(pair, workspace, answer.bits_a, answer.bits_b);
            });
}

}  // namespace cdprep
