// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/advanced/parallel_for.h"
#include "cdprep/format/float_environment.h"

namespace cdprep {

/// The caller's threads, as a `run` for ParallelFor. The caller's function runs in the caller's
/// floating-point environment, and each task in the default one. Must be called on the thread that
/// created `environment`.
class GuardedFor {
public:
    GuardedFor(format::FloatEnvironment& environment, ParallelFor parallel_for) noexcept
        : environment_(environment), parallel_for_(parallel_for) {}

    void operator()(std::size_t count, Task task) const {
        environment_.outside([&] {
            parallel_for_(count, [&](std::size_t number) {
                const format::FloatEnvironment in_task;
                task(number);
            });
        });
    }

private:
    format::FloatEnvironment& environment_;
    ParallelFor parallel_for_;
};

}  // namespace cdprep
