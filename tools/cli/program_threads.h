// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <initializer_list>
#include <memory>

#include "cdprep/advanced/parallel_for.h"

namespace cdprep::cli {

/// The program's threads: the only place that knows who provides them.
class Threads {
public:
    /// 0 means one per processor.
    explicit Threads(std::size_t count);
    ~Threads();

    /// For stages and builders; valid while this object lives.
    [[nodiscard]] ParallelFor parallel_for() const;

    /// Runs the jobs side by side and returns when all are done.
    void run_all(std::initializer_list<std::function<void()>> jobs) const;

    /// Runs work(0) ... work(count - 1) side by side, at most one a thread at a time, and
    /// what each returns in order, one after the other on any thread. While one waits
    /// for its turn, no new one takes its place: results held are bounded. Stages that
    /// work runs may use parallel_for(): all together keep to the number of threads.
    void run_in_order(std::size_t count,
                      const std::function<std::function<void()>(std::size_t)>& work) const;

private:
    struct Pool;
    std::unique_ptr<Pool> pool_;
};

/// How far a loop is.
struct LoopShare {
    std::size_t done = 0;
    std::size_t count = 0;  ///< 0: no loop runs
};

/// Whether outermost loops of parallel_for() count what they have done; off, they cost nothing.
void watch_loops(bool watched);

/// The outermost loop that has run for a second; of several, one.
[[nodiscard]] LoopShare watched_loop();

}  // namespace cdprep::cli
