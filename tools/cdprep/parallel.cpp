// SPDX-License-Identifier: GPL-3.0-or-later
#include "parallel.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_group.h>

namespace cdprep::cli {

struct Threads::Limit {
    oneapi::tbb::global_control control;
};

Threads::Threads(std::size_t count)
    : limit_(new Limit{oneapi::tbb::global_control(
          oneapi::tbb::global_control::max_allowed_parallelism,
          count > 0 ? count
                    : static_cast<std::size_t>(oneapi::tbb::info::default_concurrency()))}) {}

Threads::~Threads() = default;

build::ParallelFor Threads::parallel_for() const {
    return [](std::size_t count, const std::function<void(std::size_t)>& body) {
        oneapi::tbb::parallel_for(std::size_t{0}, count, body);
    };
}

void Threads::run_all(std::initializer_list<std::function<void()>> jobs) const {
    oneapi::tbb::task_group group;
    for (const std::function<void()>& job : jobs) group.run(job);
    group.wait();
}

}  // namespace cdprep::cli
