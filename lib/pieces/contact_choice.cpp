// SPDX-License-Identifier: MIT
#include "pieces/contact_choice.h"

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

void ContactChoice::update_gaps(std::size_t taken) noexcept {
    for (std::size_t i = taken + 1; i < count_; ++i) {
        const Double3 d = room_[i].at - room_[taken].at;
        room_[i].squared_gap = std::min(room_[i].squared_gap, dot(d, d));
    }
}

}  // namespace cdprep
