// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/time_histogram.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace cdprep::report {
namespace {

// A time below 2^8 has a bucket of its own. Each octave above has 2^7 of the same width.
constexpr unsigned kBits = 7;
constexpr std::uint64_t kPerOctave = std::uint64_t{1} << kBits;

std::size_t bucket_of(std::uint64_t time) noexcept {
    if (time < 2 * kPerOctave) return time;
    const auto octave = static_cast<unsigned>(std::bit_width(time)) - 1 - kBits;
    return octave * kPerOctave + (time >> octave);
}

/// Returns the middle of a bucket.
std::uint64_t time_of(std::size_t bucket) noexcept {
    if (bucket < 2 * kPerOctave) return bucket;
    const std::uint64_t octave = bucket / kPerOctave - 1;
    const std::uint64_t first = (kPerOctave + bucket % kPerOctave) << octave;
    return first + ((std::uint64_t{1} << octave) - 1) / 2;
}

}  // namespace

void TimeHistogram::add(std::uint64_t nanoseconds) {
    const std::size_t bucket = bucket_of(nanoseconds);
    if (bucket >= buckets_.size()) buckets_.resize(bucket + 1);
    ++buckets_[bucket];
    ++count_;
    sum_ += nanoseconds;
}

std::uint64_t TimeHistogram::at(double share) const noexcept {
    if (count_ == 0) return 0;
    // The least time that is not below this share of all times.
    const auto above = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count_)));
    const std::uint64_t rank = std::max<std::uint64_t>(above, 1) - 1;
    std::uint64_t before = 0;
    for (std::size_t bucket = 0; bucket < buckets_.size(); ++bucket) {
        before += buckets_[bucket];
        if (before > rank) return time_of(bucket);
    }
    return time_of(buckets_.size() - 1);
}

}  // namespace cdprep::report
