// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>

#include "core/carver.h"
#include "core/prefetch.h"

namespace cdprep {

/// The places of triangles by their numbers: a hash table with linear probing.
class IdMap {
public:
    static constexpr std::uint32_t kNone = 0xffffffff;

    /// Holds up to `count` numbers, in 16 to 32 bytes each.
    IdMap(Carver& carver, std::size_t count) noexcept
        : mask_(static_cast<std::size_t>(std::bit_ceil(2 * std::uint64_t{count} + 1) - 1)),
          entries_(carver.take<Entry>(std::uint64_t{mask_} + 1)) {
        for (std::size_t i = 0; entries_ != nullptr && i <= mask_; ++i) entries_[i].id = kNone;
    }

    /// Returns the place of a number, or kNone.
    [[nodiscard]] std::uint32_t find(std::uint32_t id) const noexcept {
        const Entry& entry = entries_[slot_of(id)];
        return entry.id == id && id != kNone ? entry.place : kNone;
    }
    /// Adds a number, or changes its place.
    void set(std::uint32_t id, std::uint32_t place) noexcept {
        assert(id != kNone);
        entries_[slot_of(id)] = {id, place};
    }
    /// Prefetches what set() of a number needs.
    void ask(std::uint32_t id) const noexcept {
        prefetch(&entries_[home_of(id)]);
    }
    void erase(std::uint32_t id) noexcept {
        std::size_t hole = slot_of(id);
        if (entries_[hole].id != id) return;
        // Moves entries back that would no longer be found behind the hole.
        for (std::size_t i = next(hole); entries_[i].id != kNone; i = next(i)) {
            const std::size_t home = home_of(entries_[i].id);
            if (((i - home) & mask_) < ((i - hole) & mask_)) continue;
            entries_[hole] = entries_[i];
            hole = i;
        }
        entries_[hole].id = kNone;
    }

private:
    struct Entry {
        std::uint32_t id;
        std::uint32_t place;
    };

    [[nodiscard]] std::size_t home_of(std::uint32_t id) const noexcept {
        return static_cast<std::size_t>((id * std::uint64_t{0x9e3779b97f4a7c15}) >> 32) & mask_;
    }
    [[nodiscard]] std::size_t next(std::size_t slot) const noexcept {
        return (slot + 1) & mask_;
    }
    /// Returns the slot of a number, or the free one where it belongs.
    [[nodiscard]] std::size_t slot_of(std::uint32_t id) const noexcept {
        std::size_t slot = home_of(id);
        while (entries_[slot].id != kNone && entries_[slot].id != id) slot = next(slot);
        return slot;
    }

    std::size_t mask_;
    Entry* entries_;
};

}  // namespace cdprep
