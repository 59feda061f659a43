// SPDX-License-Identifier: MIT
#include "simulate/time_histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace cdprep::report {
namespace {

// The oracle sorts the times.
TEST(TimeHistogram, QuantilesAreThoseOfTheSortedTimes) {
    std::mt19937_64 random(1);
    std::vector<std::uint64_t> times;
    TimeHistogram histogram;
    std::uint64_t sum = 0;
    for (int i = 0; i < 10'000; ++i) {
        // Below 2^50 ns, so that the sum fits.
        times.push_back(random() >> (14 + random() % 50));
        histogram.add(times.back());
        sum += times.back();
    }
    std::sort(times.begin(), times.end());
    EXPECT_EQ(histogram.count(), times.size());
    EXPECT_EQ(histogram.sum(), sum);
    for (const double share : {0.0, 0.1, 0.5, 0.95, 0.99, 1.0}) {
        const std::uint64_t found = histogram.at(share);
        // The least time that at least this share does not exceed.
        const std::uint64_t exact = *std::ranges::find_if(times, [&](const std::uint64_t& time) {
            const auto count = std::ranges::upper_bound(times, time) - times.begin();
            return static_cast<double>(count) >= share * static_cast<double>(times.size());
        });
        const std::uint64_t error = std::max(exact, found) - std::min(exact, found);
        EXPECT_LE(error, exact / 256) << share;
    }
}

// By hand: 99 % of few times are all of them.
TEST(TimeHistogram, FewTimesHaveTheirQuantiles) {
    TimeHistogram two, ten;
    for (const std::uint64_t time : {3, 7}) two.add(time);
    for (std::uint64_t time = 1; time <= 10; ++time) ten.add(time);
    EXPECT_EQ(two.at(0.5), 3u);
    EXPECT_EQ(two.at(0.99), 7u);
    EXPECT_EQ(ten.at(0.5), 5u);
    EXPECT_EQ(ten.at(0.95), 10u);
    EXPECT_EQ(ten.at(0.9), 9u);
    EXPECT_EQ(ten.at(0), 1u);
}

TEST(TimeHistogram, ShortTimesAreExact) {
    for (std::uint64_t time = 0; time < 256; ++time) {
        TimeHistogram histogram;
        histogram.add(time);
        EXPECT_EQ(histogram.at(0.5), time);
    }
}

TEST(TimeHistogram, HoldsAnyTime) {
    TimeHistogram histogram;
    EXPECT_EQ(histogram.at(0.5), 0u) << "no time";
    constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();
    histogram.add(kMost);
    EXPECT_GE(histogram.at(1), kMost - kMost / 256);
}

}  // namespace
}  // namespace cdprep::report
