// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <span>

namespace cdprep {

/// Keeps the smallest of the values added, in the order of `Less`, up to the room for them.
template <class T, class Less = std::less<>>
class Smallest {
public:
    explicit Smallest(std::span<T> kept) noexcept : kept_(kept) {}

    void add(const T& value) noexcept {
        if (count_ < kept_.size()) {
            kept_[count_] = value;
        } else if (!kept_.empty()) {
            // From here on the values kept are a heap: its front is the greatest.
            if (count_ == kept_.size()) std::make_heap(kept_.begin(), kept_.end(), Less());
            if (Less()(value, kept_.front())) replace_greatest(value);
        }
        ++count_;
    }

    /// Returns the number of values added.
    [[nodiscard]] std::size_t count() const noexcept {
        return count_;
    }
    /// Returns the values kept, in no order.
    [[nodiscard]] std::span<T> kept() const noexcept {
        return kept_.first(std::min(count_, kept_.size()));
    }

private:
    void replace_greatest(const T& value) noexcept {
        std::pop_heap(kept_.begin(), kept_.end(), Less());
        kept_.back() = value;
        std::push_heap(kept_.begin(), kept_.end(), Less());
    }

    std::span<T> kept_;
    std::size_t count_ = 0;
};

}  // namespace cdprep
