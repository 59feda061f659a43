// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "core/carver.h"

namespace cdprep {

/// Lists whose lengths are not known before they are computed, for several threads. Each thread
/// writes one list after the other into pages of its own; a list may go on in another page.
template <class T>
class ListPages {
public:
    /// One thread's access.
    class alignas(64) Writer {
    public:
        /// Begins a list. Returns its place for copy().
        std::size_t begin_list() noexcept {
            if (at_ == end_) pages_->take_page(*this);
            return at_;
        }
        /// Adds an item to the list, or only counts it if there is no room.
        void add(const T& item) noexcept {
            if (at_ == end_) pages_->take_page(*this);
            if (at_ != end_) pages_->items_[at_++] = item;
            ++count_;
        }
        /// Returns the number of items of all lists.
        [[nodiscard]] std::uint64_t count() const noexcept {
            return count_;
        }

    private:
        friend class ListPages;
        ListPages* pages_ = nullptr;
        std::size_t at_ = 0;
        std::size_t end_ = 0;
        std::uint64_t count_ = 0;
    };

    /// Takes room for any lists of `most` items together.
    ListPages(Carver& carver, std::uint32_t most, std::uint32_t threads) noexcept
        : page_count_(most / kPage + threads),
          threads_(threads),
          items_(carver.take<T>(std::uint64_t{page_count_} * kPage)),
          next_page_(carver.take<std::size_t>(page_count_)),
          writers_(carver.take<Writer>(threads)) {}

    /// Forgets all lists.
    void start() noexcept {
        taken_.store(0, std::memory_order_relaxed);
        for (std::uint32_t i = 0; i < threads_; ++i) {
            writers_[i] = Writer();
            writers_[i].pages_ = this;
        }
    }
    [[nodiscard]] Writer& writer(std::size_t thread) noexcept {
        return writers_[thread];
    }
    /// Returns the number of items of all lists. They are all stored if they are not more than the
    /// constructor took room for.
    [[nodiscard]] std::uint64_t count() const noexcept {
        std::uint64_t count = 0;
        for (std::uint32_t i = 0; i < threads_; ++i) count += writers_[i].count();
        return count;
    }
    /// Copies the `count` items of the list that begins at `place`.
    void copy(std::size_t place, std::size_t count, T* to) const noexcept {
        while (count > 0) {
            const std::size_t page = place / kPage;
            const std::size_t here = std::min(count, (page + 1) * kPage - place);
            to = std::copy_n(items_ + place, here, to);
            count -= here;
            place = next_page_[page] * kPage;
        }
    }

private:
    static constexpr std::size_t kPage = (16384 + sizeof(T) - 1) / sizeof(T);  ///< items

    void take_page(Writer& writer) noexcept {
        const std::size_t page = taken_.fetch_add(1, std::memory_order_relaxed);
        if (page >= page_count_) return;
        if (writer.end_ != 0) next_page_[writer.end_ / kPage - 1] = page;
        writer.at_ = page * kPage;
        writer.end_ = writer.at_ + kPage;
    }

    std::size_t page_count_;
    std::uint32_t threads_;
    T* items_;
    std::size_t* next_page_;  ///< by page: the writer's next one
    Writer* writers_;
    std::atomic<std::size_t> taken_ = 0;
};

}  // namespace cdprep
