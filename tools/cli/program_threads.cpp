// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/program_threads.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <utility>
#include <vector>

#include "cdprep/format/float_environment.h"

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

namespace cdprep::cli {
namespace {

/// Declares to the thread sanitizer what oneTBB guarantees. Tasks see everything that happened
/// before they were handed out. After the wait, the caller sees everything that they did.
/// Debian's oneTBB is not instrumented, so the sanitizer cannot know this. Without the sanitizer
/// this class does nothing.
class ForkJoin {
public:
    ForkJoin() {
        release(fork_);
    }
    void begin_task() {
        acquire(fork_);
    }
    void end_task() {
        release(join_);
    }
    void joined() {
        acquire(join_);
    }

private:
#ifdef __SANITIZE_THREAD__
    static void acquire(char& at) {
        __tsan_acquire(&at);
    }
    static void release(char& at) {
        __tsan_release(&at);
    }
#else
    static void acquire(char& /*at*/) {}
    static void release(char& /*at*/) {}
#endif
    char fork_ = 0;
    char join_ = 0;
};

using Clock = std::chrono::steady_clock;

// The state of the running loop, read by the thread that reports progress.
std::atomic<bool> are_watched = false;
std::atomic<bool> is_taken = false;
std::atomic<std::size_t> loop_done = 0;
std::atomic<std::size_t> loop_count = 0;
std::atomic<Clock::time_point> loop_begun{};

/// Counts the tasks of a loop, if no other loop is counted at that time.
class WatchedLoop {
public:
    explicit WatchedLoop(std::size_t count)
        : counts_(are_watched.load(std::memory_order_relaxed) && !is_taken.exchange(true)) {
        if (!counts_) return;
        loop_done = 0;
        loop_begun = Clock::now();
        loop_count = count;
    }
    WatchedLoop(const WatchedLoop&) = delete;
    WatchedLoop& operator=(const WatchedLoop&) = delete;
    ~WatchedLoop() {
        if (!counts_) return;
        loop_count = 0;
        is_taken = false;
    }

    void count_one() const {
        if (counts_) loop_done.fetch_add(1, std::memory_order_relaxed);
    }

private:
    bool counts_;
};

}  // namespace

void watch_loops(bool watched) {
    are_watched = watched;
}

LoopShare watched_loop() {
    constexpr std::chrono::seconds kWorthTelling(1);
    const std::size_t count = loop_count;
    if (Clock::now() - loop_begun.load() < kWorthTelling) return {};
    return {std::min(loop_done.load(), count), count};
}

/// The threads of oneTBB, in the form that ParallelFor requires.
struct Threads::Pool {
    oneapi::tbb::global_control limit;

    void operator()(std::size_t count, Task task) const {
        ForkJoin edges;
        const WatchedLoop watched(count);
        oneapi::tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
            const format::FloatEnvironment environment;
            edges.begin_task();
            task(i);
            edges.end_task();
            watched.count_one();
        });
        edges.joined();
    }
};

Threads::Threads(std::size_t count)
    : pool_(new Pool{oneapi::tbb::global_control(
          oneapi::tbb::global_control::max_allowed_parallelism,
          count > 0 ? count
                    : static_cast<std::size_t>(oneapi::tbb::info::default_concurrency()))}) {}

Threads::~Threads() = default;

ParallelFor Threads::parallel_for() const {
    return *pool_;
}

void Threads::run_all(std::initializer_list<std::function<void()>> jobs) const {
    ForkJoin edges;
    oneapi::tbb::task_group group;
    for (const std::function<void()>& job : jobs) {
        group.run([&edges, &job] {
            const format::FloatEnvironment environment;
            edges.begin_task();
            job();
            edges.end_task();
        });
    }
    group.wait();
    edges.joined();
}

void Threads::run_in_order(std::size_t count,
                           const std::function<std::function<void()>(std::size_t)>& work) const {
    using Deliver = std::function<void()>;
    const std::size_t at_once = oneapi::tbb::global_control::active_value(
        oneapi::tbb::global_control::max_allowed_parallelism);
    ForkJoin edges;
    ForkJoin counter;
    std::size_t next = 0;
    // Stored here, not in the pipeline's own memory. There the sanitizer would report that one
    // thread makes a value and another takes it.
    std::vector<Deliver> deliveries(count);
    const auto number = [&](oneapi::tbb::flow_control& control) {
        counter.joined();
        if (next == count) control.stop();
        const std::size_t i = next++;
        counter.end_task();
        return i;
    };
    // Isolated: a thread that waits within one task starts no other.
    const auto run = [&](std::size_t i) {
        const format::FloatEnvironment environment;
        edges.begin_task();
        deliveries[i] = oneapi::tbb::this_task_arena::isolate([&] { return work(i); });
        edges.end_task();
        return i;
    };
    // Also sees the effects of earlier deliveries.
    const auto take = [&](std::size_t i) {
        const format::FloatEnvironment environment;
        edges.joined();
        std::exchange(deliveries[i], nullptr)();
        edges.end_task();
    };
    using oneapi::tbb::filter_mode;
    using oneapi::tbb::make_filter;
    oneapi::tbb::parallel_pipeline(
        at_once, make_filter<void, std::size_t>(filter_mode::serial_in_order, number) &
                     make_filter<std::size_t, std::size_t>(filter_mode::parallel, run) &
                     make_filter<std::size_t, void>(filter_mode::serial_in_order, take));
    edges.joined();
}

}  // namespace cdprep::cli
