// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "cdprep/cdprep.h"
#include "support/run_threads.h"

namespace cdprep::test {

/// A thread for every task; counts the tasks, and keeps the most of one call.
struct CThreads {
    std::size_t calls = 0;
    std::size_t most = 0;

    static void run(void* threads, std::size_t count, cdprep_task task, const void* work) {
        auto* const self = static_cast<CThreads*>(threads);
        ++self->calls;
        self->most = std::max(self->most, count);
        run_threads(count, [&](std::size_t i) { task(work, i); });
    }
};

/// Runs some tasks twice, some never, and one number past the last.
inline void run_badly(void* /*context*/, std::size_t count, cdprep_task task, const void* work) {
    for (std::size_t i = 0; i < count; i += 2) task(work, i);
    for (std::size_t i = 0; i < count; i += 2) task(work, i);
    task(work, count + 1000);
}

/// A workspace of several lanes.
class CLanes {
public:
    explicit CLanes(std::uint32_t lanes,
                    void (*run)(void*, std::size_t, cdprep_task, const void*) = CThreads::run) {
        cdprep_workspace_options options;
        cdprep_workspace_options_init(&options, sizeof options);
        options.lanes = lanes;
        options.run = run;
        options.context = &threads;
        EXPECT_EQ(cdprep_workspace_make(&options, nullptr, 0, &workspace_, nullptr), CDPREP_OK);
    }
    CLanes(const CLanes&) = delete;
    CLanes& operator=(const CLanes&) = delete;
    ~CLanes() {
        cdprep_workspace_end(workspace_);
    }
    [[nodiscard]] cdprep_workspace* get() const {
        return workspace_;
    }
    CThreads threads;

private:
    cdprep_workspace* workspace_ = nullptr;
};

}  // namespace cdprep::test
