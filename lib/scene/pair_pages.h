// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cdprep/broad_phase.h"

namespace cdprep {

/// A list of pairs that several threads write: each takes a page at a time. The order of the pages
/// depends on the threads, so the list is sorted later.
class PairPages {
public:
    static constexpr std::size_t kPage = 256;  ///< pairs

    /// Returns the room that `pairs` pairs of so many threads take at most.
    static std::uint64_t room_for(std::uint32_t pairs, std::uint32_t threads) noexcept {
        return (std::uint64_t{pairs} / kPage + threads) * kPage;
    }

    /// One thread's access.
    class alignas(64) Writer {
    public:
        void start(PairPages& pages) noexcept {
            pages_ = &pages;
            at_ = end_ = nullptr;
            count_ = 0;
        }
        /// Adds a pair, or counts it if there is no room.
        void add(std::uint32_t one, std::uint32_t two) noexcept {
            if (at_ == end_) pages_->take_page(*this);
            if (at_ != end_) *at_++ = {std::min(one, two), std::max(one, two)};
            ++count_;
        }

    private:
        friend class PairPages;
        PairPages* pages_;
        BoxPair* at_;
        BoxPair* end_;
        std::uint64_t count_;
    };

    explicit PairPages(std::span<BoxPair> room) noexcept : room_(room) {
        assert(room.size() % kPage == 0);
    }

    /// Moves the pairs of all pages together. Returns how many there are; if they are more than the
    /// room, they are lost.
    std::uint64_t close(std::span<Writer> writers) noexcept {
        std::uint64_t count = 0;
        for (const Writer& writer : writers) count += writer.count_;
        if (count > room_.size()) return count;
        std::sort(writers.begin(), writers.end(),
                  [](const Writer& x, const Writer& y) { return x.end_ < y.end_; });
        // A page with a gap behind its pairs follows those that are full.
        BoxPair* to = nullptr;
        for (std::size_t i = 0; i < writers.size(); ++i) {
            if (writers[i].end_ == nullptr) continue;
            if (to == nullptr) {
                to = writers[i].at_;
                continue;
            }
            to = std::copy(writers[i - 1].end_, writers[i].at_, to);
        }
        const std::size_t pages = std::min(next_.load(), room_.size() / kPage);
        if (to != nullptr) std::copy(writers.back().end_, room_.data() + pages * kPage, to);
        return count;
    }

private:
    void take_page(Writer& writer) noexcept {
        const std::size_t first = next_.fetch_add(1, std::memory_order_relaxed) * kPage;
        if (first >= room_.size()) return;
        writer.at_ = room_.data() + first;
        writer.end_ = writer.at_ + kPage;
    }

    std::span<BoxPair> room_;
    std::atomic<std::size_t> next_ = 0;
};

}  // namespace cdprep
