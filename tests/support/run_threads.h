// SPDX-License-Identifier: MIT
#pragma once

#include <thread>
#include <vector>

#include "cdprep/advanced/parallel_for.h"

namespace cdprep::test {

/// A parallel_for that starts a thread for every task.
inline constexpr auto run_threads = [](std::size_t count, Task task) {
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < count; ++i) threads.emplace_back(task, i);
    for (std::thread& thread : threads) thread.join();
};

}  // namespace cdprep::test
