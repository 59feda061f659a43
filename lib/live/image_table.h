// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>

#include "cdprep/format/checksum.h"
#include "cdprep/format/file_header.h"
#include "cdprep/format/make_user_block.h"
#include "cdprep/format/sections.h"

namespace cdprep {

/// Returns the elements of a section of a checked image.
template <class Element>
std::span<Element> elements_of(std::span<std::byte> image, format::SectionId id) {
    const std::optional<format::SectionEntry> entry = format::find_section(image, id);
    if (!entry || entry->count == 0) return {};
    return {reinterpret_cast<Element*>(image.data() + entry->offset),
            static_cast<std::size_t>(entry->count)};
}

/// The section table of an image, to be changed and written back.
class ImageTable {
public:
    explicit ImageTable(std::span<std::byte> image)
        : image_(image), count_(format::read_header(image).section_count) {
        std::memcpy(entries_.data(), image.data() + format::kSectionTableOffset,
                    count_ * sizeof(format::SectionEntry));
    }
    [[nodiscard]] std::span<format::SectionEntry> entries() {
        return std::span(entries_).first(count_);
    }
    /// Computes the checksums of all sections.
    void add_checksums() {
        for (format::SectionEntry& entry : entries()) {
            entry.checksum = format::checksum(
                image_.subspan(static_cast<std::size_t>(entry.offset),
                               static_cast<std::size_t>(entry.count * entry.element_size)));
        }
    }
    /// Writes table and header.
    void write(const format::FileHeader& facts) {
        constexpr std::array<std::byte, sizeof(format::FileHeader::superblock)> kEmptySuperblock{};
        const format::UserBlock block =
            format::make_user_block(facts, entries(), kEmptySuperblock, image_.size());
        std::memcpy(image_.data(), block.data(), block.size());
    }

private:
    std::span<std::byte> image_;
    std::uint32_t count_;
    std::array<format::SectionEntry, format::kMaxSections> entries_{};
};

}  // namespace cdprep
