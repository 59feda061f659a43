// SPDX-License-Identifier: MIT
#include "cdprep/batch.h"

#include <algorithm>

#include "share_out.h"

namespace cdprep {
namespace {

/// Calls `ask(job, answer, workspace)` for every job, by all workers.
template <class Answer, class Ask>
void ask_all(std::span<const PairJob> jobs, std::span<Workspace> workspaces,
             ParallelFor parallel_for, std::span<Answer> answers, Ask ask) noexcept {
    share_jobs(
        std::min(jobs.size(), answers.size()), workspaces.size(), parallel_for,
        [&](std::size_t i, std::size_t worker) { ask(jobs[i], answers[i], workspaces[worker]); });
}

}  // namespace

void collide_all(std::span<const PairJob> jobs, std::span<Workspace> workspaces,
                 ParallelFor parallel_for, std::span<Collision> answers,
                 const CollideOptions& options) noexcept {
    ask_all(jobs, workspaces, parallel_for, answers,
            [&](const PairJob& job, Collision& answer, Workspace& workspace) {
                answer = collide(*job.a, *job.b, job.placement, workspace, options, job.cache);
            });
}

void distance_all(std::span<const PairJob> jobs, std::span<Workspace> workspaces,
                  ParallelFor parallel_for, std::span<std::optional<Distance>> answers,
                  const DistanceOptions& options) noexcept {
    ask_all(jobs, workspaces, parallel_for, answers,
            [&](const PairJob& job, std::optional<Distance>& answer, Workspace& workspace) {
                answer = distance(*job.a, *job.b, job.placement, workspace, options, job.cache);
            });
}

void is_within_all(std::span<const PairJob> jobs, double tolerance, std::span<Workspace> workspaces,
                   ParallelFor parallel_for, std::span<bool> answers) noexcept {
    ask_all(jobs, workspaces, parallel_for, answers,
            [&](const PairJob& job, bool& answer, Workspace& workspace) {
                answer = is_within(*job.a, *job.b, job.placement, tolerance, workspace, job.cache);
            });
}

void count_overlaps_all(std::span<const PairJob> jobs, std::span<Workspace> workspaces,
                        ParallelFor parallel_for, std::span<std::size_t> counts,
                        const OverlapOptions& options) noexcept {
    ask_all(jobs, workspaces, parallel_for, counts,
            [&](const PairJob& job, std::size_t& count, Workspace& workspace) {
                count = overlapping_triangles(*job.a, *job.b, job.placement, workspace, {}, options,
                                              job.cache);
            });
}

void overlapping_triangles_all(std::span<const PairJob> jobs, std::span<Workspace> workspaces,
                               ParallelFor parallel_for, std::span<OverlapAnswer> answers,
                               const OverlapOptions& options) noexcept {
    ask_all(jobs, workspaces, parallel_for, answers,
            [&](const PairJob& job, OverlapAnswer& answer, Workspace& workspace) {
                answer.count = overlapping_triangles(*job.a, *job.b, job.placement, workspace,
                                                     answer.room, options, job.cache);
            });
}

void mark_overlapping_triangles_all(std::span<const PairJob> jobs, std::span<Workspace> workspaces,
                                    ParallelFor parallel_for, std::span<MarkedTriangles> answers,
                                    const OverlapOptions& options) noexcept {
    ask_all(jobs, workspaces, parallel_for, answers,
            [&](const PairJob& job, MarkedTriangles& answer, Workspace& workspace) {
                answer.count =
                    mark_overlapping_triangles(*job.a, *job.b, job.placement, workspace,
                                               answer.bits_a, answer.bits_b, options, job.cache);
            });
}

}  // namespace cdprep
