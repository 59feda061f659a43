// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/timing.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <iterator>
#include <numeric>
#include <tuple>

#include "study/seeded_random.h"

namespace cdprep::study {
namespace {

constexpr std::size_t kMostTimes = std::size_t{1} << 24;
constexpr std::size_t kResamples = 400;
constexpr std::uint64_t kBootstrapSeed = 20240601;

bool must_stop(const TimingOptions& options) {
    return options.stop && options.stop();
}

double now_by(TimedBy by) {
    if (by == TimedBy::thread) return thread_seconds();
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

double seconds_for(const Question& question, std::size_t number, std::size_t times, TimedBy by) {
    const double begun = now_by(by);
    static_cast<void>(question(number, times));
    return now_by(by) - begun;
}

/// The largest assumed ratio of a first run, which finds nothing in the caches, to later runs.
constexpr double kOfFirst = 8;

/// Returns the number of runs that take long enough. If the first run is so long that every later
/// one will be too, no other run is made.
std::size_t times_for(const Question& question, std::size_t number, const TimingOptions& options) {
    if (seconds_for(question, number, 1, options.by) >= kOfFirst * options.least_sample_s) return 1;
    std::size_t times = 1;
    while (times < kMostTimes) {
        const double taken = seconds_for(question, number, times, options.by);
        if (taken >= options.least_sample_s) break;
        const double wanted = taken > 0 ? 1.2 * options.least_sample_s / taken : 16;
        times = std::min(
            kMostTimes, static_cast<std::size_t>(
                            std::ceil(static_cast<double>(times) * std::clamp(wanted, 1.5, 16.0))));
    }
    return times;
}

std::vector<double> case_seconds(const Timings& timings, std::span<const std::size_t> cases) {
    std::vector<double> seconds;
    seconds.reserve(cases.size());
    for (const std::size_t number : cases) seconds.push_back(seconds_of(timings, number));
    return seconds;
}

/// Returns the bootstrap confidence interval of the median.
std::pair<double, double> bootstrap(const std::vector<double>& values) {
    SeededRandom random(kBootstrapSeed);
    std::vector<double> medians;
    std::vector<double> drawn(values.size());
    for (std::size_t i = 0; i < kResamples; ++i) {
        for (double& value : drawn) value = values[random.below(values.size())];
        medians.push_back(quantile(drawn, 0.5));
    }
    return {quantile(medians, 0.025), quantile(medians, 0.975)};
}

double sum_of_round(const Timings& timings, std::size_t round) {
    return std::accumulate(
        timings.seconds.begin(), timings.seconds.end(), 0.0,
        [round](double sum, const std::vector<double>& rounds) { return sum + rounds[round]; });
}

}  // namespace

double thread_seconds() noexcept {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

double quantile(std::vector<double> values, double share) {
    if (values.empty()) return 0;
    const double rank = std::ceil(share * static_cast<double>(values.size()));
    const auto at =
        static_cast<std::ptrdiff_t>(std::clamp(rank, 1.0, static_cast<double>(values.size())) - 1);
    std::nth_element(values.begin(), values.begin() + at, values.end());
    return values[static_cast<std::size_t>(at)];
}

std::vector<Timings> time_questions(std::size_t cases, std::span<const Question> questions,
                                    const TimingOptions& options) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point begun = Clock::now();
    std::vector<Timings> all(questions.size());
    for (std::size_t q = 0; q < questions.size(); ++q) {
        all[q].seconds.resize(cases);
        for (std::size_t i = 0; i < cases && !must_stop(options); ++i) {
            all[q].times.push_back(options.before ? 1 : times_for(questions[q], i, options));
        }
    }
    for (std::size_t round = 0; round < std::max<std::size_t>(1, options.rounds); ++round) {
        const double passed = std::chrono::duration<double>(Clock::now() - begun).count();
        if (round > 0 && passed > options.budget_s) break;
        for (std::size_t turn = 0; turn < questions.size(); ++turn) {
            const std::size_t q = round % 2 == 0 ? turn : questions.size() - 1 - turn;
            for (std::size_t i = 0; i < cases; ++i) {
                if (must_stop(options)) return all;
                const std::size_t times = all[q].times[i];
                if (options.before) options.before(q);
                all[q].seconds[i].push_back(seconds_for(questions[q], i, times, options.by) /
                                            static_cast<double>(times));
            }
        }
    }
    return all;
}

double seconds_of(const Timings& timings, std::size_t number) {
    return quantile(timings.seconds[number], 0.5);
}

Timing timing_of(const Timings& timings, std::span<const std::size_t> wanted) {
    Timing timing;
    std::vector<std::size_t> cases;
    std::ranges::copy_if(wanted, std::back_inserter(cases),
                         [&](std::size_t number) { return !timings.seconds[number].empty(); });
    if (cases.empty()) return timing;
    const std::vector<double> seconds = case_seconds(timings, cases);
    timing.median_s = quantile(seconds, 0.5);
    timing.p95_s = quantile(seconds, 0.95);
    timing.p999_s = quantile(seconds, 0.999);
    std::tie(timing.low_s, timing.high_s) = bootstrap(seconds);
    std::vector<double> spreads;
    for (const std::size_t number : cases) {
        const std::vector<double>& rounds = timings.seconds[number];
        spreads.push_back(quantile(rounds, 0.75) - quantile(rounds, 0.25));
        timing.asked += rounds.size() * timings.times[number];
    }
    timing.spread_s = quantile(spreads, 0.5);
    timing.cases = cases.size();
    timing.rounds = timings.seconds[cases.front()].size();
    return timing;
}

Timing timing_of(const Timings& timings) {
    std::vector<std::size_t> all(timings.seconds.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    return timing_of(timings, all);
}

TimeRatio ratio_of(const Timings& numerator, const Timings& denominator) {
    if (numerator.seconds.empty() || denominator.seconds.empty()) return {};
    const std::size_t rounds =
        std::min(numerator.seconds.front().size(), denominator.seconds.front().size());
    std::vector<double> ratios;
    for (std::size_t round = 0; round < rounds; ++round) {
        const double below = sum_of_round(denominator, round);
        if (below > 0) ratios.push_back(sum_of_round(numerator, round) / below);
    }
    if (ratios.empty()) return {};
    const auto [low, high] = std::ranges::minmax(ratios);
    return {quantile(ratios, 0.5), low, high};
}

TimeRatio ratio_to_itself(std::size_t cases, const Question& question,
                          const TimingOptions& options) {
    const std::vector<Question> twice = {question, question};
    const std::vector<Timings> timings = time_questions(cases, twice, options);
    return ratio_of(timings[0], timings[1]);
}

}  // namespace cdprep::study
