// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <vector>

#include "bake/bake_report.h"

namespace cdprep::cli {

/// Names the stages of a bake as they begin, and times them.
class Stages {
public:
    explicit Stages(const std::function<void(const char*)>& begins) : begins_(begins) {}

    template <class Work>
    auto run(const char* name, Work work) {
        begins_(name);
        double& seconds = add(name);
        const Clock::time_point begin = Clock::now();
        auto result = work();
        seconds = since(begin);
        return result;
    }

    /// Adds a stage that runs in parallel with others. `timed()` sets its time.
    double& add(const char* name) {
        return times_.emplace_back(report::StageTime{name, 0}).seconds;
    }

    template <class Work>
    static auto timed(double& seconds, Work work) {
        return [&seconds, work] {
            const Clock::time_point begin = Clock::now();
            work();
            seconds = since(begin);
        };
    }

    [[nodiscard]] std::vector<report::StageTime> times() const {
        return {times_.begin(), times_.end()};
    }

    /// Returns the seconds since the construction of this object.
    [[nodiscard]] double total() const {
        return since(begin_);
    }

private:
    using Clock = std::chrono::steady_clock;

    [[nodiscard]] static double since(Clock::time_point begin) {
        return std::chrono::duration<double>(Clock::now() - begin).count();
    }

    const std::function<void(const char*)>& begins_;
    Clock::time_point begin_ = Clock::now();
    std::deque<report::StageTime> times_;  ///< a deque, because add() returns references
};

}  // namespace cdprep::cli
