// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <initializer_list>

#include "cdprep/format/file_header.h"

namespace cdprep::format {

/// A set of section ids, such as those to check, map or write.
class SectionSet {
public:
    constexpr SectionSet() noexcept = default;
    constexpr SectionSet(std::initializer_list<SectionId> ids) noexcept {
        for (const SectionId id : ids) insert(id);
    }

    /// Returns the set of all ids below 64: those known to this version and future ones.
    [[nodiscard]] static constexpr SectionSet all() noexcept {
        SectionSet set;
        set.bits_ = ~std::uint64_t{0};
        return set;
    }

    constexpr void insert(SectionId id) noexcept {
        bits_ |= bit(id);
    }
    constexpr void erase(SectionId id) noexcept {
        bits_ &= ~bit(id);
    }
    constexpr void insert(SectionSet other) noexcept {
        bits_ |= other.bits_;
    }
    constexpr void erase(SectionSet other) noexcept {
        bits_ &= ~other.bits_;
    }
    [[nodiscard]] constexpr bool contains(SectionId id) const noexcept {
        return (bits_ & bit(id)) != 0;
    }
    [[nodiscard]] constexpr bool contains(SectionSet other) const noexcept {
        return (bits_ & other.bits_) == other.bits_;
    }
    friend constexpr bool operator==(SectionSet, SectionSet) noexcept = default;

private:
    /// Returns 0 for ids of 64 and more, which no set contains. They can only belong to later
    /// versions, and readers of this version ignore them.
    static constexpr std::uint64_t bit(SectionId id) noexcept {
        const auto number = static_cast<std::uint32_t>(id);
        return number < 64 ? std::uint64_t{1} << number : 0;
    }
    std::uint64_t bits_ = 0;
};

}  // namespace cdprep::format
