// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <thread>
#include <vector>

#include "cdprep/advanced/parallel_for.h"

namespace cdprep::test {

/// A parallel_for with a fixed number of threads, whatever the number of tasks.
class Team {
public:
    explicit Team(unsigned threads) : threads_(threads) {}
    void operator()(std::size_t count, Task task) const {
        std::atomic<std::size_t> next{0};
        std::vector<std::jthread> team;
        for (unsigned t = 0; t < threads_; ++t) {
            team.emplace_back([&] {
                for (std::size_t i = next++; i < count; i = next++) task(i);
            });
        }
    }

private:
    unsigned threads_;
};

}  // namespace cdprep::test
