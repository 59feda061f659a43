// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>

namespace cdprep {

/// The pairs of triangles of two BVH leaves that a query has tested. Bit 8 j + i is for triangle i
/// of A's leaf and j of B's. Where many cells list one triangle, this set makes each pair one
/// answer and one test.
///
/// Two leaves are held while their test is pending. Settled leaves are remembered for certain when
/// the test found anything, otherwise for as long as there is room. Testing the latter again yields
/// no answer twice.
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

    struct Held {
        std::uint64_t fresh;  ///< those of the given pairs that were not tested before
        bool has_room;        ///< false: nothing is held, and all given pairs are fresh
    };

    /// Holds some pairs of two leaves. If there is no room now, there may be after the pending
    /// pairs are settled; otherwise never for these two.
    [[nodiscard]] Held hold(std::uint32_t leaf_a, std::uint32_t leaf_b,
                            std::uint64_t bits) noexcept {
        assert(question_ > 0);
        const std::uint64_t key = key_of(leaf_a, leaf_b);
        const std::size_t bucket = bucket_of(key);
        std::size_t way = way_of(bucket, key);
        if (way == kWays) {
            way = free_way(bucket, key);
            if (way == kWays) return {bits, false};
            key_[bucket][way] = key;
            bits_[bucket][way] = 0;
        }
        const std::uint64_t fresh = bits & ~bits_[bucket][way];
        if (fresh == 0) return {0, true};
        bits_[bucket][way] |= bits;
        key_[bucket][way] |= kPending;
        return {fresh, true};
    }

    /// Records the test of two leaves that were held.
    void settle(std::uint32_t leaf_a, std::uint32_t leaf_b, bool found) noexcept {
        const std::uint64_t key = key_of(leaf_a, leaf_b);
        const std::size_t bucket = bucket_of(key);
        const std::size_t way = way_of(bucket, key);
        if (way == kWays) return;
        std::uint64_t& at = key_[bucket][way];
        at = (at & ~kPending) | (found ? kFound : 0);
    }

    /// For tests: sets the number of buckets used, at least one.
    void limit(std::size_t buckets) noexcept {
        assert(buckets > 0 && buckets <= kBuckets);
        limit_ = buckets;
    }

private:
    // A key: the query in six bits, whether something was found, whether it is pending, and two
    // leaves.
    static constexpr std::uint64_t kLeafBits = 28;
    static constexpr std::uint64_t kPending = std::uint64_t{1} << (2 * kLeafBits);
    static constexpr std::uint64_t kFound = kPending << 1;
    static constexpr std::uint64_t kQuestions = 64;

    [[nodiscard]] std::uint64_t key_of(std::uint32_t leaf_a, std::uint32_t leaf_b) const noexcept {
        assert(leaf_a >> kLeafBits == 0 && leaf_b >> kLeafBits == 0);
        return question_ << (2 * kLeafBits + 2) | std::uint64_t{leaf_a} << kLeafBits | leaf_b;
    }
    [[nodiscard]] std::size_t bucket_of(std::uint64_t key) const noexcept {
        constexpr std::uint64_t kMixer = 0x9e3779b97f4a7c15U;
        return static_cast<std::size_t>(((key * kMixer) >> 40) * limit_ >> 24);
    }
    [[nodiscard]] std::size_t way_of(std::size_t bucket, std::uint64_t key) const noexcept {
        std::size_t way = 0;
        while (way < kWays && (key_[bucket][way] & ~(kFound | kPending)) != key) ++way;
        return way;
    }
    /// Returns an empty way, or one whose contents need not be remembered; kWays if there is none.
    [[nodiscard]] std::size_t free_way(std::size_t bucket, std::uint64_t key) const noexcept {
        const std::size_t begin = (key ^ key >> 7) % kWays;
        std::size_t free = kWays;
        for (std::size_t i = 0; i < kWays; ++i) {
            const std::size_t way = (begin + i) % kWays;
            const std::uint64_t at = key_[bucket][way];
            if (at >> (2 * kLeafBits + 2) != question_) return way;
            if (free == kWays && (at & (kFound | kPending)) == 0) free = way;
        }
        return free;
    }

    std::array<std::array<std::uint64_t, kWays>, kBuckets> key_{};
    std::array<std::array<std::uint64_t, kWays>, kBuckets> bits_;
    std::uint64_t question_ = 0;
    std::size_t limit_ = kBuckets;
};

/// The places that own pairs of triangles for which there was no room: the last ones looked up.
struct FirstPlaces {
    static constexpr std::size_t kSlots = 512;

    struct Slot {
        std::uint64_t walk;  ///< 0: empty
        std::uint32_t at_a;
        std::uint32_t at_b;
        std::uint64_t place;
    };
    std::array<Slot, kSlots> slot{};

    [[nodiscard]] Slot& of(std::uint32_t at_a, std::uint32_t at_b) noexcept {
        return slot[(at_a * 31 + at_b) % kSlots];
    }
};

/// The data of a pair of leaves that waits for its test.
struct PendingLeaves {
    std::uint64_t place;  ///< the pair of cells that brought it
    std::uint64_t fresh;  ///< as TestedPairs::Held
    bool is_held;
};

}  // namespace cdprep
