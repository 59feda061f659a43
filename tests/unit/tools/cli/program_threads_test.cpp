// SPDX-License-Identifier: MIT
#include "cli/program_threads.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

namespace cdprep::cli {
namespace {

/// The most that were there at once.
class Gauge {
public:
    void enter() {
        const int here = ++here_;
        int most = most_;
        while (here > most && !most_.compare_exchange_weak(most, here)) {
        }
    }
    void leave() {
        --here_;
    }
    [[nodiscard]] int most() const {
        return most_;
    }

private:
    std::atomic<int> here_ = 0;
    std::atomic<int> most_ = 0;
};

// By construction: the first take longest, so that the last finish first.
TEST(RunInOrder, DeliversInOrderWhateverFinishesFirst) {
    constexpr std::size_t kCount = 40;
    const Threads threads(4);
    std::vector<std::size_t> delivered;
    threads.run_in_order(kCount, [&](std::size_t i) -> std::function<void()> {
        std::this_thread::sleep_for(std::chrono::milliseconds((kCount - i) % 7));
        return [&delivered, i] { delivered.push_back(i); };
    });
    ASSERT_EQ(delivered.size(), kCount);
    for (std::size_t i = 0; i < kCount; ++i) EXPECT_EQ(delivered[i], i);
}

TEST(RunInOrder, KeepsToTheThreadsInAllAndHoldsNoMoreResults) {
    constexpr int kThreads = 3;
    const Threads threads(kThreads);
    Gauge working;
    Gauge held;
    threads.run_in_order(30, [&](std::size_t i) -> std::function<void()> {
        held.enter();
        threads.parallel_for()(8, [&](std::size_t) {
            working.enter();
            std::this_thread::sleep_for(std::chrono::milliseconds(i == 0 ? 5 : 1));
            working.leave();
        });
        return [&held] { held.leave(); };
    });
    EXPECT_LE(working.most(), kThreads);
    EXPECT_LE(held.most(), kThreads);
}

TEST(RunInOrder, OfNothingDoesNothing) {
    const Threads threads(2);
    threads.run_in_order(0, [&](std::size_t) -> std::function<void()> {
        ADD_FAILURE();
        return [] {};
    });
}

}  // namespace
}  // namespace cdprep::cli
