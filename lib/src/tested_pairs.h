// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace cdprep {

/// Which triangles of which two BVH leaves a question has held against each other: bit
/// 8 j + i for triangle i of A's leaf and j of B's. What was found is remembered for
/// certain or refused; what was found to be nothing may be forgotten, and is then done
/// again. Where many cells list one triangle, this is what makes each pair one answer.
class TestedPairs {
public:
    static constexpr std::size_t kWays = 8;
    static constexpr std::size_t kBuckets = 1024;

    /// Forgets everything.
    void begin() noexcept {
        if (++question_ < kQuestions) return;
        question_ = 1;
        for (auto& bucket : key_) bucket.fill(0);
    }

    [[nodiscard]] std::uint64_t tested(std::uint32_t leaf_a, std::uint32_t leaf_b) const noexcept {
        const std::uint64_t key = key_of(leaf_a, leaf_b);
        const std::size_t bucket = bucket_of(key);
        const std::size_t way = way_of(bucket, key);
        return way < kWays ? bits_[bucket][way] : 0;
    }

    /// Adds `bits` to those of two leaves. False when `found` says that they must not be
    /// forgotten and there is no room: from then on there never is for these two.
    bool record(std::uint32_t leaf_a, std::uint32_t leaf_b, std::uint64_t bits,
                bool found) noexcept {
        const std::uint64_t key = key_of(leaf_a, leaf_b);
        const std::size_t bucket = bucket_of(key);
        std::size_t way = way_of(bucket, key);
        const bool is_new = way == kWays;
        if (is_new) way = free_way(bucket, key);
        if (way == kWays) return false;
        std::uint64_t& at = key_[bucket][way];
        const std::uint64_t kept = found || (!is_new && (at & kFound) != 0) ? kFound : 0;
        bits_[bucket][way] = is_new ? bits : bits_[bucket][way] | bits;
        at = key | kept;
        return true;
    }

    /// For tests: how many buckets are used, at least one.
    void limit(std::size_t buckets) noexcept {
        limit_ = buckets;
    }

private:
    // A key: which question in seven bits, whether something was found, and two leaves.
    static constexpr std::uint64_t kLeafBits = 28;
    static constexpr std::uint64_t kFound = std::uint64_t{1} << (2 * kLeafBits);
    static constexpr std::uint64_t kQuestions = 128;

    [[nodiscard]] std::uint64_t key_of(std::uint32_t leaf_a, std::uint32_t leaf_b) const noexcept {
        return question_ << (2 * kLeafBits + 1) | std::uint64_t{leaf_a} << kLeafBits | leaf_b;
    }
    [[nodiscard]] std::size_t bucket_of(std::uint64_t key) const noexcept {
        return static_cast<std::size_t>((key * 0x9e3779b97f4a7c15U) >> 40) % limit_;
    }
    [[nodiscard]] std::size_t way_of(std::size_t bucket, std::uint64_t key) const noexcept {
        std::size_t way = 0;
        while (way < kWays && (key_[bucket][way] & ~kFound) != key) ++way;
        return way;
    }
    /// An empty way, or one of which nothing need be remembered.
    [[nodiscard]] std::size_t free_way(std::size_t bucket, std::uint64_t key) const noexcept {
        const std::size_t begin = (key ^ key >> 7) % kWays;
        std::size_t free = kWays;
        for (std::size_t i = 0; i < kWays; ++i) {
            const std::size_t way = (begin + i) % kWays;
            const std::uint64_t at = key_[bucket][way];
            if (at >> (2 * kLeafBits + 1) != question_) return way;
            if (free == kWays && (at & kFound) == 0) free = way;
        }
        return free;
    }

    std::array<std::array<std::uint64_t, kWays>, kBuckets> key_{};
    std::array<std::array<std::uint64_t, kWays>, kBuckets> bits_;
    std::uint64_t question_ = 0;
    std::size_t limit_ = kBuckets;
};

}  // namespace cdprep
