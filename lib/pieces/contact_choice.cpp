// SPDX-License-Identifier: MIT
#include "pieces/contact_choice.h"

#include <cmath>
#include <limits>

#include "exact/powers_of_two.h"

namespace cdprep {

void ContactChoice::add(const ContactCandidate& candidate) noexcept {
    const auto begin = room_.begin();
    if (count_ < room_.size()) {
        room_[count_++] = candidate;
        if (count_ == room_.size()) std::make_heap(begin, room_.end(), is_deeper);
    } else if (is_deeper(candidate, room_[0])) {
        std::pop_heap(begin, room_.end(), is_deeper);
        room_[count_ - 1] = candidate;
        std::push_heap(begin, room_.end(), is_deeper);
    }
}

std::span<ContactCandidate> ContactChoice::take_exact(std::size_t taken,
                                                      std::size_t most) noexcept {
    const auto all = room_.first(count_);
    const auto exact =
        std::partition(all.begin() + static_cast<std::ptrdiff_t>(taken), all.end(),
                       [](const ContactCandidate& c) { return c.known == Known::exactly; });
    std::sort(all.begin() + static_cast<std::ptrdiff_t>(taken), exact, is_deeper);
    const auto count = std::min(most, static_cast<std::size_t>(exact - all.begin()));
    std::sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count), is_deeper);
    return all.first(count);
}

void ContactChoice::bring_farthest(std::size_t first) noexcept {
    std::size_t best = first;
    for (std::size_t i = first + 1; i < count_; ++i) {
        const ContactCandidate &c = room_[i], &b = room_[best];
        const bool is_farther = c.squared_gap != b.squared_gap ? c.squared_gap > b.squared_gap
                                                               : c.near.key < b.near.key;
        if (is_farther) best = i;
    }
    std::swap(room_[first], room_[best]);
}

void ContactChoice::begin_gaps() noexcept {
    double size = 0;
    for (ContactCandidate& c : room_.first(count_)) {
        c.squared_gap = std::numeric_limits<double>::infinity();
        size = std::max(size, largest_of(c.at - room_[0].at));
    }
    constexpr double kLeast = 0x1p-200, kMost = 0x1p200;
    constexpr int kMostExponent = 1000;  // its power of two is a normal number
    const bool is_in_range = size == 0 || (size > kLeast && size < kMost);
    scale_ = is_in_range ? 1 : two_to(std::clamp(-std::ilogb(size), -kMostExponent, kMostExponent));
}

void ContactChoice::update_gaps(std::size_t taken) noexcept {
    for (std::size_t i = taken + 1; i < count_; ++i) {
        const Double3 d = scale_ * (room_[i].at - room_[taken].at);
        room_[i].squared_gap = std::min(room_[i].squared_gap, dot(d, d));
    }
}

}  // namespace cdprep
