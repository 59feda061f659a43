// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace cdprep::study {

/// A query with numbered cases, such as poses. It runs case `number` `times` times and returns any
/// number that depends on the answers.
using Question = std::function<std::uint64_t(std::size_t number, std::size_t times)>;

/// Returns a Question that calls `ask(number)`, which must return a number. Each repetition runs
/// the query again.
template <class Ask>
[[nodiscard]] Question question_of(Ask ask) {
    return [ask = std::move(ask)](std::size_t number, std::size_t times) mutable {
        std::uint64_t sum = 0;
        for (std::size_t i = 0; i < times; ++i) {
            sum += static_cast<std::uint64_t>(ask(number));
            asm volatile("" : "+r"(sum) : : "memory");  // keeps the compiler from merging runs
        }
        return sum;
    };
}

/// The clock of a measurement.
enum class TimedBy : std::uint8_t {
    thread,  ///< processor time of the calling thread: other processes affect it little
    wall,    ///< wall-clock time: for work that several threads share
};

struct TimingOptions {
    std::size_t rounds = 5;  ///< measurements of each case; at least 1
    /// A measurement repeats a query until it takes this long, so that the resolution of the clock
    /// does not matter. Repetitions find their data in the caches. 0: no repetition.
    double least_sample_s = 50e-6;
    /// No round after the first begins later than this; a round that began is completed.
    double budget_s = std::numeric_limits<double>::infinity();
    std::function<bool()> stop{};  ///< true ends all soon; the return value is then no result
    TimedBy by = TimedBy::thread;
    /// Called before every run of query number `question`, outside the timing. Each measurement is
    /// then one run. For example, it evicts the query's data from the caches.
    std::function<void(std::size_t question)> before{};
};

/// The times of one query in seconds, by case and round, on the clock TimingOptions::by.
struct Timings {
    std::vector<std::vector<double>> seconds;  ///< [case][round], each the mean of a sample
    std::vector<std::size_t> times;            ///< [case]: runs per sample
};

/// Measures queries against each other. Each round measures every query in turn, in alternating
/// order, and all cases of a query one after the other. A first round, which is not counted, only
/// finds the number of repetitions. Runs in one thread. By default the time is that of the thread,
/// so other processes affect it little. Returns one Timings per query, all with equally many
/// rounds.
[[nodiscard]] std::vector<Timings> time_questions(std::size_t cases,
                                                  std::span<const Question> questions,
                                                  const TimingOptions& options = {});

/// The summary of Timings. The time of a case is the median of its rounds. Rounds differ because of
/// the machine, cases because of the query.
struct Timing {
    double median_s = 0;  ///< of the cases
    double p95_s = 0;     ///< 95 % of the cases take at most this
    double p999_s = 0;    ///< 99.9 %; the slowest of fewer than 1000 cases
    double spread_s = 0;  ///< the median over the cases of the interquartile range of their rounds
    double low_s = 0;     ///< the median lies between these with 95 % confidence, by bootstrap
    double high_s = 0;    ///< over the cases
    std::size_t cases = 0;
    std::size_t rounds = 0;
    std::size_t asked = 0;  ///< all runs, without the round that finds the repetitions
};

/// Returns the summary over the measured cases: all cases unless the measurement was stopped.
/// Without measured cases, all numbers are zero.
[[nodiscard]] Timing timing_of(const Timings& timings);

/// Returns the summary over some of the cases.
[[nodiscard]] Timing timing_of(const Timings& timings, std::span<const std::size_t> cases);

/// Returns the seconds of a case: the median of its rounds.
[[nodiscard]] double seconds_of(const Timings& timings, std::size_t number);

/// The ratio of the times of two queries that were measured in the same rounds.
struct TimeRatio {
    double ratio = 1;  ///< the median over the rounds; each round divides sums over the cases
    double low = 1;    ///< of the round with the smallest ratio
    double high = 1;   ///< of the round with the largest ratio

    /// Returns whether the two times are indistinguishable: 1 is within the spread. For equal
    /// queries, all n rounds are on the same side with probability 2^(1 - n).
    [[nodiscard]] bool holds_one() const noexcept {
        return low <= 1 && 1 <= high;
    }
};

/// Returns the ratio of two results of one call of time_questions().
[[nodiscard]] TimeRatio ratio_of(const Timings& numerator, const Timings& denominator);

/// Measures a query against itself, which shows the resolution of the measurement. If the range of
/// the ratio does not contain 1, the machine is too busy.
[[nodiscard]] TimeRatio ratio_to_itself(std::size_t cases, const Question& question,
                                        const TimingOptions& options = {.rounds = 9});

/// Returns the quantile of the values at `share`, by nearest rank: the lower median for 0.5.
/// Returns 0 without values.
[[nodiscard]] double quantile(std::vector<double> values, double share);

/// Returns the processor time of the calling thread in seconds.
[[nodiscard]] double thread_seconds() noexcept;

}  // namespace cdprep::study
