// SPDX-License-Identifier: MIT
#pragma once

#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <utility>
#include <vector>

#include "bench_input.h"

// The times of a haptic loop's steps, and the page faults within them.

namespace cdprep {

inline long page_faults() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_majflt + usage.ru_minflt;
}

/// The times of steps, in microseconds of the thread, and their page faults after a warm-up.
class Steps {
public:
    static constexpr std::size_t kWarmUp = 50;

    static void print_header() {
        std::printf("way,steps,median_us,p99_us,p999_us,max_us,faults,note\n");
    }
    /// Times one step; returns its result.
    template <class Step>
    auto time(Step&& step) {
        const long before = page_faults();
        const double begun = thread_us();
        auto result = step();
        const double took = thread_us() - begun;
        if (us_.size() >= kWarmUp) faults_ += page_faults() - before;
        us_.push_back(took);
        return result;
    }
    void print(const char* way, double note) const {
        std::printf("%s,%zu,%.2f,%.2f,%.2f,%.2f,%ld,%.4f\n", way, us_.size(), median(us_),
                    median(us_, 0.99), median(us_, 0.999), median(us_, 1), faults_, note);
    }

private:
    std::vector<double> us_;
    long faults_ = 0;
};

/// Times `step(i)` for each step. It returns a number whose mean is the note.
template <class Step>
void time_steps(const char* way, std::size_t count, Step&& step) {
    for (std::size_t i = 0; i < std::min(count, Steps::kWarmUp); ++i) step(i);
    Steps steps;
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) sum += steps.time([&] { return step(i); });
    steps.print(way, sum / static_cast<double>(count));
}

}  // namespace cdprep
