// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <initializer_list>
#include <memory>

#include "cdprep/advanced/parallel_for.h"

namespace cdprep::cli {

/// The program's threads. Only the source of this class knows the library that provides them.
class Threads {
public:
    /// 0 means one per processor.
    explicit Threads(std::size_t count);
    ~Threads();

    /// Returns the parallel loop for stages and builders. It is valid while this object lives.
    [[nodiscard]] ParallelFor parallel_for() const;

    /// Runs the jobs in parallel and returns when all are done.
    void run_all(std::initializer_list<std::function<void()>> jobs) const;

    /// Runs work(0) ... work(count - 1) in parallel, at most one per thread at a time. Calls the
    /// functions that they return in order, one after the other, on any thread. A result that
    /// waits for its turn keeps its place, so the number of stored results is bounded. `work` may
    /// use parallel_for(); all work together stays within the number of threads.
    void run_in_order(std::size_t count,
                      const std::function<std::function<void()>(std::size_t)>& work) const;

private:
    struct Pool;
    std::unique_ptr<Pool> pool_;
};

/// The progress of a loop.
struct LoopShare {
    std::size_t done = 0;
    std::size_t count = 0;  ///< 0: no loop runs
};

/// Switches the counting of finished tasks in outermost loops of parallel_for() on or off. It
/// costs nothing while off.
void watch_loops(bool watched);

/// Returns the progress of an outermost loop that has run for at least a second. If several such
/// loops run, returns that of one.
[[nodiscard]] LoopShare watched_loop();

}  // namespace cdprep::cli
