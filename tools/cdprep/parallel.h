// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <initializer_list>
#include <memory>

#include "cdprep/parallel_for.h"

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

private:
    struct Pool;
    std::unique_ptr<Pool> pool_;
};

}  // namespace cdprep::cli
