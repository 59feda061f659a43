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

/// A question that can be asked in numbered cases, such as poses: asks case `number` so many
/// times and returns anything that depends on the answers.
using Question = std::function<std::uint64_t(std::size_t number, std::size_t times)>;

/// Makes a Question of `ask(number)`, which returns a number. No answer is kept from one time
/// to the next.
template <class Ask>
[[nodiscard]] Question question_of(Ask ask) {
    return [ask = std::move(ask)](std::size_t number, std::size_t times) mutable {
        std::uint64_t sum = 0;
        for (std::size_t i = 0; i < times; ++i) {
            sum += static_cast<std::uint64_t>(ask(number));
            asm volatile("" : "+r"(sum) : : "memory");  // or a short question is asked once
        }
        return sum;
    };
}

/// Whose seconds are measured.
enum class TimedBy : std::uint8_t {
    thread,  ///< the processor's, for the calling thread: others on the machine count little
    wall,    ///< the clock's: for work that several threads share
};

struct TimingOptions {
    std::size_t rounds = 5;  ///< how often each case is measured; 1 at least
    /// A measurement asks as often as takes this long, so that the clock does not count:
    /// what is shorter is asked again at once, and then finds its data in the caches. 0: once.
    double least_sample_s = 50e-6;
    /// No round after the first begins later than this; those begun are ended.
    double budget_s = std::numeric_limits<double>::infinity();
    std::function<bool()> stop{};  ///< true ends all soon; what is returned is then no result
    TimedBy by = TimedBy::thread;
    /// Called before every time that this question of all is asked, and not timed; each
    /// measurement then asks once. Drops what the question reads from the caches, say.
    std::function<void(std::size_t question)> before{};
};

/// What one question took: seconds of processor time, by case and round.
struct Timings {
    std::vector<std::vector<double>> seconds;  ///< [case][round], each the mean of a sample
    std::vector<std::size_t> times;            ///< [case]: asked so often in a sample
};

/// Measures questions against each other: in every round each of them in turn, in changing
/// order, all cases of one after the other. Single thread, after one round that only finds
/// out how often to ask. The time is that of the thread, so others on the machine count
/// little. One Timings a question, all with equally many rounds.
[[nodiscard]] std::vector<Timings> time_questions(std::size_t cases,
                                                  std::span<const Question> questions,
                                                  const TimingOptions& options = {});

/// Timings in numbers to print. A case's time is the median of its rounds: what differs
/// between rounds is the machine's, what differs between cases the question's.
struct Timing {
    double median_s = 0;  ///< of the cases
    double p95_s = 0;     ///< 95 % of the cases take at most this
    double p999_s = 0;    ///< 99.9 %; of fewer than 1000 cases the slowest
    double spread_s = 0;  ///< the middle half of a case's rounds lie so far apart: the median
    double low_s = 0;     ///< the median lies between these with 95 % confidence, by bootstrap
    double high_s = 0;    ///< over the cases
    std::size_t cases = 0;
    std::size_t rounds = 0;
    std::size_t asked = 0;  ///< in all, the round that found out not counted
};

/// Of the cases that were measured, which are all unless it was stopped. All zero without any.
[[nodiscard]] Timing timing_of(const Timings& timings);

/// The same over some of the cases.
[[nodiscard]] Timing timing_of(const Timings& timings, std::span<const std::size_t> cases);

/// Seconds of a case: the median of its rounds.
[[nodiscard]] double seconds_of(const Timings& timings, std::size_t number);

/// How many times as long one question takes as another, measured in the same rounds.
struct TimeRatio {
    double ratio = 1;  ///< the median over the rounds of sum by sum of the cases
    double low = 1;    ///< the least round's
    double high = 1;   ///< the greatest round's

    /// Whether the two cannot be told apart: 1 is within the spread. Of equal questions
    /// n rounds are all on one side with probability 2^(1 - n).
    [[nodiscard]] bool holds_one() const noexcept {
        return low <= 1 && 1 <= high;
    }
};

/// Both from one call of time_questions().
[[nodiscard]] TimeRatio ratio_of(const Timings& numerator, const Timings& denominator);

/// Measures a question against itself: what the clock can tell apart here. A rung whose
/// ratio to itself does not hold 1 was measured on a machine that is too busy.
[[nodiscard]] TimeRatio ratio_to_itself(std::size_t cases, const Question& question,
                                        const TimingOptions& options = {.rounds = 9});

/// The value below which a share of the values lies, by nearest rank: with share 0.5 the
/// lower median. 0 without values.
[[nodiscard]] double quantile(std::vector<double> values, double share);

/// Seconds of processor time of the calling thread.
[[nodiscard]] double thread_seconds() noexcept;

}  // namespace cdprep::study
