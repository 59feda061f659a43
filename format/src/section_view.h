// SPDX-License-Identifier: MIT
#pragma once

#include <cassert>
#include <cstring>
#include <optional>
#include <span>

#include "cdprep/format/find_damage.h"
#include "cdprep/format/section_set.h"
#include "cdprep/format/sections.h"

namespace cdprep::format {

/// The elements of one section, which is proven to lie inside the file. Every read is a copy,
/// because the file's bytes may have any alignment.
template <class T>
struct SectionView {
    std::span<const std::byte> file;
    SectionEntry entry{};

    /// Makes a view of a section by its entry in the table.
    SectionView(std::span<const std::byte> of, const SectionEntry& of_table) noexcept
        : file(of), entry(of_table) {
        assert(entry.count == 0 || entry.element_size == sizeof(T));
    }
    /// Makes a view of a section. It is empty if the section is missing or not wanted.
    SectionView(std::span<const std::byte> of, SectionId id, SectionSet wanted) noexcept
        : file(of) {
        entry.id = id;
        const std::optional<SectionEntry> found = find_section(of, id);
        if (found && wanted.contains(id)) entry = *found;
        assert(entry.count == 0 || entry.element_size == sizeof(T));
    }
    [[nodiscard]] std::uint64_t count() const noexcept {
        return entry.count;
    }
    /// Requires index < count().
    [[nodiscard]] T operator[](std::uint64_t index) const noexcept {
        assert(index < count());
        T value;
        std::memcpy(&value, file.data() + entry.offset + index * sizeof value, sizeof value);
        return value;
    }
    [[nodiscard]] Damage damage(DamageKind kind, std::uint64_t index, std::uint64_t found,
                                std::uint64_t limit) const noexcept {
        return {kind, entry.id, entry.offset + index * sizeof(T), found, limit};
    }
    /// Returns the damage of element `index`, which holds a number that is not below `end`.
    [[nodiscard]] Damage bad_index(std::uint64_t index, std::uint64_t found,
                                   std::uint64_t end) const noexcept {
        return damage(DamageKind::bad_index, index, found, end == 0 ? 0 : end - 1);
    }
};

}  // namespace cdprep::format
