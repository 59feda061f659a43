// SPDX-License-Identifier: MIT
#include "cdprep/format/sections.h"

#include <array>
#include <cassert>
#include <cstring>

#include "elements.h"

namespace cdprep::format {
namespace {

constexpr std::array kKinds = {
// clang-format off
#define CDPREP_SECTION(member, name, id, Element, count, when, serves, units, description) \
    SectionKind{SectionId::name, #name, element_of<Element>, \
                count, when, serves, units, description},
#include "cdprep/format/section_table.inc"
    // clang-format on
};

}  // namespace

std::span<const SectionKind> section_kinds() noexcept {
    return kKinds;
}

const SectionKind* find_section_kind(SectionId id) noexcept {
    for (const SectionKind& kind : kKinds) {
        if (kind.id == id) return &kind;
    }
    return nullptr;
}

FileHeader read_header(std::span<const std::byte> file) noexcept {
    assert(file.size() >= sizeof(FileHeader));
    FileHeader header;
    std::memcpy(&header, file.data(), sizeof header);
    return header;
}

std::optional<SectionEntry> find_section(std::span<const std::byte> file, SectionId id) noexcept {
    const FileHeader header = read_header(file);
    assert(header.section_count <= kMaxSections);
    for (std::uint32_t i = 0; i < header.section_count; ++i) {
        SectionEntry entry;
        std::memcpy(&entry, file.data() + kSectionTableOffset + i * sizeof entry, sizeof entry);
        if (entry.id == id) return entry;
    }
    return std::nullopt;
}

std::uint32_t element_size(SectionId id) noexcept {
    const SectionKind* kind = find_section_kind(id);
    return kind ? kind->element.size : 0;
}

const char* section_name(SectionId id) noexcept {
    const SectionKind* kind = find_section_kind(id);
    return kind ? kind->name : "unknown";
}

}  // namespace cdprep::format
