// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace cdprep::report {

/// Times of many frames, in memory that does not grow with them. Each is kept to one part in 256.
class TimeHistogram {
public:
    void add(std::uint64_t nanoseconds);

    [[nodiscard]] std::uint64_t count() const noexcept {
        return count_;
    }
    /// The exact sum of all times.
    [[nodiscard]] std::uint64_t sum() const noexcept {
        return sum_;
    }
    /// Returns the least time that a share of all times does not exceed, in nanoseconds. Returns 0
    /// without times.
    [[nodiscard]] std::uint64_t at(double share) const noexcept;

private:
    std::vector<std::uint64_t> buckets_;  ///< counts, up to that of the longest time
    std::uint64_t count_ = 0;
    std::uint64_t sum_ = 0;
};

}  // namespace cdprep::report
