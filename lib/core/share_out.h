// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cstddef>

#include "cdprep/advanced/parallel_for.h"

namespace cdprep {

/// Hands out the numbers 0 ... count - 1 to workers, a few at a time.
class Shares {
public:
    Shares(std::size_t count, std::size_t at_a_time) noexcept
        : count_(count), at_a_time_(at_a_time) {
        assert(at_a_time > 0);
    }

    /// Calls `body(first, last)` for shares of this worker until none is left. `last` is one past
    /// the share.
    template <class Body>
    void take_runs(Body&& body) noexcept {
        while (true) {
            const std::size_t first = next_.fetch_add(at_a_time_, std::memory_order_relaxed);
            if (first >= count_) return;
            body(first, std::min(count_, first + at_a_time_));
        }
    }
    /// As above, but calls `body(number)` for each number.
    template <class Body>
    void take(Body&& body) noexcept {
        take_runs([&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) body(i);
        });
    }

private:
    std::size_t count_;
    std::size_t at_a_time_;
    std::atomic<std::size_t> next_ = 0;
};

/// Calls `work(worker)` once for each worker, on the caller's threads.
template <class Work>
void run_workers(std::size_t workers, ParallelFor parallel_for, Work&& work) noexcept {
    assert(workers > 0);
    if (workers == 1) {
        work(std::size_t{0});
    } else {
        parallel_for(workers, Task(work));
    }
}

/// Shares out the jobs below `count` on the caller's threads. Calls `body(first, last, worker)` for
/// each share. A worker's number is below `most_workers`; a worker does one share at a time.
template <class Body>
void share_runs(std::size_t count, std::size_t most_workers, ParallelFor parallel_for,
                Body body) noexcept {
    assert(most_workers > 0);
    // Jobs differ in cost. Small shares keep all workers busy to the end; large shares reduce
    // contention.
    constexpr std::size_t kSharesOfAWorker = 16;
    const std::size_t workers = std::min(most_workers, count);
    if (workers == 0) return;
    Shares shares(count, 1 + count / (kSharesOfAWorker * workers));
    run_workers(workers, parallel_for, [&](std::size_t worker) {
        shares.take_runs([&](std::size_t first, std::size_t last) { body(first, last, worker); });
    });
}

/// As above, but calls `body(job, worker)` once for each job.
template <class Body>
void share_jobs(std::size_t count, std::size_t most_workers, ParallelFor parallel_for,
                Body body) noexcept {
    share_runs(count, most_workers, parallel_for,
               [&](std::size_t first, std::size_t last, std::size_t worker) {
                   for (std::size_t job = first; job < last; ++job) body(job, worker);
               });
}

}  // namespace cdprep
