// SPDX-License-Identifier: MIT
#pragma once

#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "cdprep/format/find_damage.h"
#include "cdprep/format/sections.h"
#include "support/aligned_bytes.h"
#include "support/reseal.h"
#include "support/tiny_baker.h"

namespace cdprep::test {

// Files with one changed section that are otherwise sound.

[[nodiscard]] inline std::optional<format::Damage> damage_of(
    const AlignedBytes& file, format::SectionSet wanted = format::SectionSet::all()) {
    return format::find_damage(file.span(), wanted);
}

[[nodiscard]] inline format::SectionEntry entry_of(const AlignedBytes& file, format::SectionId id) {
    return format::find_section(file.span(), id).value();
}

/// Returns element `index` of a section.
template <class T>
[[nodiscard]] T element(const AlignedBytes& file, format::SectionId id, std::uint64_t index) {
    T value;
    std::memcpy(&value, file.span().data() + entry_of(file, id).offset + index * sizeof value,
                sizeof value);
    return value;
}

/// Returns the file with other bytes at a place, and with correct checksums.
template <class T>
[[nodiscard]] AlignedBytes with(const AlignedBytes& file, std::uint64_t at, const T& value) {
    AlignedBytes changed(file.span());
    std::memcpy(changed.span().data() + at, &value, sizeof value);
    reseal(changed.span());
    return changed;
}

/// The same at a place of a section.
template <class T>
[[nodiscard]] AlignedBytes with(const AlignedBytes& file, format::SectionId id, std::uint64_t at,
                                const T& value) {
    return with(file, entry_of(file, id).offset + at, value);
}

/// Returns the file with two elements of a section exchanged, and with correct checksums.
template <class T>
[[nodiscard]] AlignedBytes exchanged(const AlignedBytes& file, format::SectionId id,
                                     std::uint64_t i, std::uint64_t j) {
    const auto first = element<T>(file, id, i);
    const auto second = element<T>(file, id, j);
    return with(with(file, id, i * sizeof(T), second), id, j * sizeof(T), first);
}

/// Returns the file after `change` of a section's bytes, or without the section if `change`
/// returns false.
template <class Change>
[[nodiscard]] AlignedBytes with_changed(const AlignedBytes& file, format::SectionId id,
                                        Change change) {
    std::vector<TinySection> sections;
    for (std::uint32_t number = 1; number < 64; ++number) {
        const auto entry = format::find_section(file.span(), format::SectionId{number});
        if (!entry) continue;
        const auto bytes = file.span().subspan(entry->offset, entry->count * entry->element_size);
        TinySection section{entry->id, {bytes.begin(), bytes.end()}};
        if (entry->id != id || change(section.bytes)) sections.push_back(std::move(section));
    }
    return assemble(format::read_header(file.span()), sections);
}

[[nodiscard]] inline AlignedBytes without(const AlignedBytes& file, format::SectionId id) {
    return with_changed(file, id, [](std::vector<std::byte>& /*bytes*/) { return false; });
}

}  // namespace cdprep::test
