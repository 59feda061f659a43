// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <numeric>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "crossings/self_intersections.h"

namespace cdprep::mesh {

/// The share of a search's limits that one job may use in one round.
class SearchTurn {
public:
    SearchTurn(const SearchLimits& share, const StopCheck& stop, const TakeMeetings& take,
               std::mutex& taking)
        : share_(share), stop_(stop), take_(take), taking_(taking) {}

    void add(const TriangleMeeting& meeting) {
        ++used_.pairs;
        found_.push_back(meeting);
        if (found_.size() == kBatch) deliver();
    }

    /// Counts work. Returns is_over().
    bool count(std::size_t steps) {
        used_.steps += steps;
        if (used_.steps >= next_check_) {
            next_check_ = used_.steps + kStepsPerCheck;
            is_stopped_ = is_stopped_ || is_stopped(stop_);
        }
        return is_over();
    }

    [[nodiscard]] bool is_over() const {
        return is_stopped_ || used_.pairs >= share_.pairs || used_.steps >= share_.steps;
    }

    /// Delivers the last meetings. Returns the work done.
    SearchLimits finish() {
        deliver();
        return used_;
    }

private:
    static constexpr std::size_t kBatch = 1024;           ///< meetings
    static constexpr std::uint64_t kStepsPerCheck = 512;  ///< usually below a millisecond

    void deliver() {
        if (found_.empty()) return;
        const std::lock_guard lock(taking_);
        take_(found_);
        found_.clear();
    }

    SearchLimits share_;
    const StopCheck& stop_;
    const TakeMeetings& take_;
    std::mutex& taking_;
    SearchLimits used_{0, 0};
    std::uint64_t next_check_ = 0;
    bool is_stopped_ = false;
    std::vector<TriangleMeeting> found_;
};

/// Runs the jobs of a search in parallel, in rounds. In each round the open jobs get equal
/// shares of the remaining limits. The shares depend only on the jobs. So if the limits end the
/// search, the result does not depend on the number of threads.
class MeetingSearch {
public:
    MeetingSearch(const SearchOptions& options, const TakeMeetings& take)
        : left_(options.limits),
          stop_(options.stop),
          parallel_for_(options.parallel_for),
          take_(take) {}

    [[nodiscard]] ParallelFor parallel_for() const {
        return parallel_for_;
    }

    [[nodiscard]] const StopCheck& stop() const {
        return stop_;
    }

    /// Returns whether every job was completed.
    [[nodiscard]] bool is_complete() const {
        return is_complete_;
    }

    /// Runs jobs to completion, or until the limits are used up. A Job has is_done() and
    /// go_on(SearchTurn&), which works until the turn is over.
    template <class Job>
    void run(std::vector<Job>& jobs) {
        std::vector<std::size_t> open(jobs.size());
        std::iota(open.begin(), open.end(), std::size_t{0});
        while (!open.empty()) {
            if (left_.pairs == 0 || left_.steps == 0 || is_stopped(stop_)) {
                is_complete_ = false;
                return;
            }
            run_round(jobs, open);
            std::erase_if(open, [&jobs](std::size_t i) { return jobs[i].is_done(); });
        }
    }

private:
    /// Returns the number of jobs in a round. It falls as the limits come near, since each job
    /// exceeds its share by a step of up to 64 leaf pairs.
    [[nodiscard]] std::size_t jobs_per_round(std::size_t open) const {
        constexpr std::uint64_t kLeastShare = 4096;  ///< pairs of triangles in such a step
        const std::uint64_t most = std::min(left_.pairs, left_.steps) / kLeastShare;
        return std::clamp<std::uint64_t>(most, 1, open);
    }

    template <class Job>
    void run_round(std::vector<Job>& jobs, const std::vector<std::size_t>& open) {
        const std::size_t count = jobs_per_round(open.size());
        const SearchLimits share{(left_.pairs - 1) / count + 1, (left_.steps - 1) / count + 1};
        std::vector<SearchLimits> used(count);
        const auto run = [&](std::size_t i) {
            SearchTurn turn(share, stop_, take_, taking_);
            if (!turn.count(0)) jobs[open[i]].go_on(turn);
            used[i] = turn.finish();
        };
        parallel_for_(count, run);
        for (const SearchLimits& job : used) {
            left_.pairs -= std::min(left_.pairs, job.pairs);
            left_.steps -= std::min(left_.steps, job.steps);
        }
    }

    SearchLimits left_;
    const StopCheck& stop_;
    ParallelFor parallel_for_;
    const TakeMeetings& take_;
    std::mutex taking_;
    bool is_complete_ = true;
};

}  // namespace cdprep::mesh
