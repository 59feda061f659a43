// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <thread>
#include <vector>

#include "cdprep/advanced/parallel_for.h"

namespace cdprep {

/// Threads that wait for work: a parallel_for whose cost is not that of starting them.
class Crew {
public:
    explicit Crew(std::size_t threads) {
        for (std::size_t i = 1; i < threads; ++i) {
            threads_.emplace_back([this] { wait_for_work(); });
        }
    }
    ~Crew() {
        {
            const std::lock_guard lock(mutex_);
            ended_ = true;
        }
        changed_.notify_all();
        for (std::thread& thread : threads_) thread.join();
    }
    Crew(const Crew&) = delete;
    Crew& operator=(const Crew&) = delete;

    void operator()(std::size_t count, Task task) {
        if (threads_.empty() || count < 2) return serial_for(count, task);
        {
            const std::lock_guard lock(mutex_);
            task_ = task;
            count_ = count;
            next_ = 0;
            busy_ = threads_.size();
            ++round_;
        }
        changed_.notify_all();
        take_part();
        std::unique_lock lock(mutex_);
        done_.wait(lock, [this] { return busy_ == 0; });
    }

private:
    static constexpr auto kNothing = [](std::size_t /*number*/) {};

    void take_part() {
        for (std::size_t i = next_++; i < count_; i = next_++) task_(i);
    }
    void wait_for_work() {
        std::size_t seen = 0;
        for (;;) {
            {
                std::unique_lock lock(mutex_);
                changed_.wait(lock, [&] { return ended_ || round_ != seen; });
                if (ended_) return;
                seen = round_;
            }
            take_part();
            const std::lock_guard lock(mutex_);
            if (--busy_ == 0) done_.notify_one();
        }
    }

    std::vector<std::thread> threads_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::condition_variable done_;
    Task task_ = kNothing;
    std::size_t count_ = 0;
    std::atomic<std::size_t> next_ = 0;
    std::size_t busy_ = 0;
    std::size_t round_ = 0;
    bool ended_ = false;
};

}  // namespace cdprep
