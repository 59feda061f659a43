// SPDX-License-Identifier: MIT
#include "c_face.h"

#include <string>

#include "cdprep/parallel_for.h"
#include "cdprep/split_overlap.h"
#include "share_out.h"

namespace cdprep {
namespace {

/// Like every task of a C program's threads: `work` is ours, a Task.
void run_task(const void* work, std::size_t number) {
    (*static_cast<const Task*>(work))(number);
}

/// The threads of a C program, as ParallelFor wants them.
struct CThreads {
    cdprep_parallel_for given;

    void operator()(std::size_t count, Task task) const {
        if (given.run == nullptr) return serial_for(count, task);
        given.run(given.context, count, run_task, &task);
    }
};

/// Whether the job can be asked, or a code with `error` filled.
int check_job(const cdprep_pair_job& job, cdprep_error* error) {
    if (any_null(job.a, job.b, job.placement)) return null_argument(error);
    std::optional<Placement> placed;
    return read_placement(*job.placement, placed, error);
}

/// The first thing that is wrong with a job, and its number.
int check_jobs(std::span<const cdprep_pair_job> jobs, cdprep_error* error) {
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        cdprep_error wrong{};
        const int code = check_job(jobs[i], &wrong);
        if (code == CDPREP_OK) continue;
        return fail(error, code,
                    "Job " + std::to_string(i) + ", the first being 0: " + wrong.message);
    }
    return CDPREP_OK;
}

/// A question about many pairs: checks what every such question checks, then calls
/// `ask(i, a, b, placement, workspace, cache)` for each.
template <class Ask>
int ask_jobs(const cdprep_pair_job* jobs, std::size_t count, cdprep_workspaces* workspaces,
             const cdprep_parallel_for* parallel_for, cdprep_error* error, Ask ask) noexcept {
    if (workspaces == nullptr || (jobs == nullptr && count > 0)) return null_argument(error);
    CThreads threads{};
    if (!read_sized(parallel_for, threads.given)) return bad_size(error);
    return guarded(error, [&]() -> int {
        if (const int code = check_jobs({jobs, count}, error)) return code;
        const std::span<Workspace> all = workspaces->all;
        share_jobs(count, all.size(), threads, [&](std::size_t i, std::size_t worker) {
            const cdprep_pair_job& job = jobs[i];
            std::optional<Placement> placed;
            if (read_placement(*job.placement, placed, nullptr) != CDPREP_OK) return;
            PairCacheCopy copy(job.cache);
            ask(i, job.a->model, job.b->model, *placed, all[worker], copy.get());
        });
        return CDPREP_OK;
    });
}

}  // namespace
}  // namespace cdprep

using cdprep::Model;
using cdprep::PairCache;
using cdprep::Placement;
using cdprep::Workspace;

int cdprep_collide_all(const cdprep_pair_job* jobs, size_t count, cdprep_workspaces* workspaces,
                       const cdprep_parallel_for* parallel_for,
                       const cdprep_contact_options* options, cdprep_collision* collisions,
                       cdprep_error* error) {
    if (collisions == nullptr && count > 0) return cdprep::null_argument(error);
    cdprep_contact_options given{};
    if (!cdprep::read_sized(options, given)) return cdprep::bad_size(error);
    const cdprep::CollideOptions asked = cdprep::contact_options(given);
    return cdprep::ask_jobs(
        jobs, count, workspaces, parallel_for, error,
        [&](size_t i, const Model& a, const Model& b, const Placement& placement,
            Workspace& scratch, PairCache* cache) {
            cdprep::store(cdprep::collide(a, b, placement, scratch, asked, cache), collisions[i]);
        });
}

int cdprep_distance_between_all(const cdprep_pair_job* jobs, size_t count,
                                cdprep_workspaces* workspaces,
                                const cdprep_parallel_for* parallel_for,
                                const cdprep_distance_options* options, int* found,
                                cdprep_distance* distances, cdprep_error* error) {
    if (count > 0 && cdprep::any_null(found, distances)) return cdprep::null_argument(error);
    cdprep_distance_options given = cdprep::default_distance_options();
    if (!cdprep::read_sized(options, given)) return cdprep::bad_size(error);
    const cdprep::DistanceOptions asked = cdprep::distance_options(given);
    return cdprep::ask_jobs(jobs, count, workspaces, parallel_for, error,
                            [&](size_t i, const Model& a, const Model& b,
                                const Placement& placement, Workspace& scratch, PairCache* cache) {
                                cdprep::store(
                                    cdprep::distance(a, b, placement, scratch, asked, cache),
                                    found[i], distances[i]);
                            });
}

int cdprep_is_within_all(const cdprep_pair_job* jobs, size_t count, cdprep_workspaces* workspaces,
                         const cdprep_parallel_for* parallel_for, double tolerance, int* within,
                         cdprep_error* error) {
    if (within == nullptr && count > 0) return cdprep::null_argument(error);
    return cdprep::ask_jobs(
        jobs, count, workspaces, parallel_for, error,
        [&](size_t i, const Model& a, const Model& b, const Placement& placement,
            Workspace& scratch, PairCache* cache) {
            within[i] = cdprep::is_within(a, b, placement, tolerance, scratch, cache) ? 1 : 0;
        });
}

int cdprep_overlapping_triangles_all(const cdprep_pair_job* jobs, size_t count,
                                     cdprep_workspaces* workspaces,
                                     const cdprep_parallel_for* parallel_for,
                                     const cdprep_contact_options* options,
                                     cdprep_overlap_answer* answers, cdprep_error* error) {
    if (answers == nullptr && count > 0) return cdprep::null_argument(error);
    for (size_t i = 0; i < count; ++i) {
        if (answers[i].pairs == nullptr && answers[i].room > 0) {
            return cdprep::null_argument(error);
        }
    }
    cdprep_contact_options given{};
    if (!cdprep::read_sized(options, given)) return cdprep::bad_size(error);
    const cdprep::OverlapOptions asked = cdprep::overlap_options(given);
    return cdprep::ask_jobs(jobs, count, workspaces, parallel_for, error,
                            [&](size_t i, const Model& a, const Model& b,
                                const Placement& placement, Workspace& scratch, PairCache* cache) {
                                cdprep_overlap_answer& to = answers[i];
                                to.count = cdprep::overlapping_triangles(
                                    a, b, placement, scratch, cdprep::room_of(to.pairs, to.room),
                                    asked, cache);
                            });
}

int cdprep_mark_overlapping_triangles_all(const cdprep_pair_job* jobs, size_t count,
                                          cdprep_workspaces* workspaces,
                                          const cdprep_parallel_for* parallel_for,
                                          const cdprep_contact_options* options,
                                          cdprep_marked_triangles* answers, cdprep_error* error) {
    if (answers == nullptr && count > 0) return cdprep::null_argument(error);
    for (size_t i = 0; i < count; ++i) {
        const cdprep_marked_triangles& to = answers[i];
        if ((to.bits_a == nullptr && to.words_a > 0) || (to.bits_b == nullptr && to.words_b > 0)) {
            return cdprep::null_argument(error);
        }
    }
    cdprep_contact_options given{};
    if (!cdprep::read_sized(options, given)) return cdprep::bad_size(error);
    const cdprep::OverlapOptions asked = cdprep::overlap_options(given);
    return cdprep::ask_jobs(jobs, count, workspaces, parallel_for, error,
                            [&](size_t i, const Model& a, const Model& b,
                                const Placement& placement, Workspace& scratch, PairCache* cache) {
                                cdprep_marked_triangles& to = answers[i];
                                to.count = cdprep::mark_overlapping_triangles(
                                    a, b, placement, scratch, {to.bits_a, to.words_a},
                                    {to.bits_b, to.words_b}, asked, cache);
                            });
}

int cdprep_split_overlapping_triangles(const cdprep_model* a, const cdprep_model* b,
                                       const cdprep_placement* placement,
                                       cdprep_workspaces* workspaces,
                                       const cdprep_parallel_for* parallel_for,
                                       const cdprep_contact_options* options,
                                       cdprep_triangle_pair* pairs, size_t room, size_t* count,
                                       cdprep_error* error) {
    if (cdprep::any_null(a, b, placement, workspaces, count) || (pairs == nullptr && room > 0)) {
        return cdprep::null_argument(error);
    }
    cdprep_contact_options given{};
    cdprep::CThreads threads{};
    if (!cdprep::read_sized(options, given) || !cdprep::read_sized(parallel_for, threads.given)) {
        return cdprep::bad_size(error);
    }
    return cdprep::guarded(error, [&]() -> int {
        std::optional<Placement> placed;
        if (const int code = cdprep::read_placement(*placement, placed, error)) return code;
        *count = cdprep::split_overlapping_triangles(a->model, b->model, *placed, workspaces->all,
                                                     threads, cdprep::room_of(pairs, room),
                                                     cdprep::overlap_options(given));
        return CDPREP_OK;
    });
}
