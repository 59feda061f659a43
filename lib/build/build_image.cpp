// SPDX-License-Identifier: MIT
#include "cdprep/advanced/build_image.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include "build/bad_argument.h"
#include "build/section_places.h"
#include "cdprep/format/checksum.h"
#include "cdprep/format/make_user_block.h"
#include "cdprep/format/sections.h"

namespace cdprep::build {
namespace {

/// The place where HDF5 would begin. An image has zeroes there: as many bytes as the header keeps,
/// and as a reader compares.
constexpr std::array<std::byte, sizeof(format::FileHeader::superblock)> kNoSuperblock{};

std::string name_of(const Section& section) {
    return "Section " + std::to_string(static_cast<std::uint32_t>(section.id)) + " (" +
           format::section_name(section.id) + ")";
}

std::optional<Error> find_fault(const Section& section) {
    const std::uint32_t element = format::element_size(section.id);
    if (element == 0) {
        return bad_argument(name_of(section) + " is unknown to this version.");
    }
    if (section.bytes.size() % element == 0) return std::nullopt;
    return bad_argument(name_of(section) + " has " + std::to_string(section.bytes.size()) +
                        " bytes, which is not a multiple of the element size, " +
                        std::to_string(element) + " bytes.");
}

/// Gives every section its place; returns the end of the image.
std::uint64_t place(SectionTable& table, std::uint64_t alignment) {
    SectionPlaces places(alignment);
    for (std::uint32_t i = 0; i < table.count; ++i) {
        table.entries[i].offset = places.next(table.sections[i].bytes.size());
    }
    return places.end();
}

struct PlacedTable {
    SectionTable table;
    std::uint64_t size;
};

Result<PlacedTable> placed_table(std::span<const Section> sections, const ImageOptions& options) {
    const std::uint64_t alignment = options.section_alignment;
    if (!std::has_single_bit(alignment) || alignment < format::kSectionAlignment ||
        alignment > kLargestAlignment) {
        return bad_argument("Sections cannot be aligned to " + std::to_string(alignment) +
                            " bytes: the alignment must be a power of two from " +
                            std::to_string(format::kSectionAlignment) + " to " +
                            std::to_string(kLargestAlignment) + ".");
    }
    Result<SectionTable> made = make_section_table(sections);
    if (!made) return made.error();
    PlacedTable placed{std::move(made).value(), 0};
    placed.size = place(placed.table, alignment);
    if (placed.size <= PTRDIFF_MAX) return placed;
    return bad_argument("The image would have " + std::to_string(placed.size) +
                        " bytes, more than memory holds.");
}

std::optional<Error> find_fault(std::span<const std::byte> memory, std::uint64_t size) {
    const auto misaligned =
        reinterpret_cast<std::uintptr_t>(memory.data()) % format::kSectionAlignment;
    if (misaligned != 0) {
        return bad_argument("The memory for the image starts " + std::to_string(misaligned) +
                            " bytes past a multiple of " +
                            std::to_string(format::kSectionAlignment) +
                            "; it must start at such a multiple.");
    }
    if (memory.size() >= size) return std::nullopt;
    return bad_argument("The image needs " + std::to_string(size) +
                        " bytes, but the memory for it has " + std::to_string(memory.size()) + ".");
}

/// Copies the sections in the order of their places. Writes zeroes in front of each and after the
/// last.
void fill(std::span<std::byte> image, const SectionTable& table) {
    std::uint64_t end = format::kUserBlockSize;
    const auto clear_up_to = [&](std::uint64_t begin) {
        assert(end <= begin && begin <= image.size());
        std::memset(image.data() + end, 0, static_cast<std::size_t>(begin - end));
    };
    for (std::uint32_t i = 0; i < table.count; ++i) {
        const std::span<const std::byte> bytes = table.sections[i].bytes;
        if (bytes.empty()) continue;
        const std::uint64_t offset = table.entries[i].offset;
        clear_up_to(offset);
        std::memcpy(image.data() + offset, bytes.data(), bytes.size());
        end = offset + bytes.size();
    }
    clear_up_to(image.size());
}

}  // namespace

Result<SectionTable> make_section_table(std::span<const Section> sections) {
    if (sections.size() > format::kMaxSections) {
        return bad_argument(std::to_string(sections.size()) + " sections are more than the " +
                            std::to_string(format::kMaxSections) + " that a model may have.");
    }
    SectionTable table;
    table.count = static_cast<std::uint32_t>(sections.size());
    std::ranges::copy(sections, table.sections.begin());
    const std::span<Section> sorted = std::span(table.sections).first(table.count);
    std::ranges::sort(sorted, {}, &Section::id);
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        if (const auto fault = find_fault(sorted[i])) return *fault;
        if (i > 0 && sorted[i].id == sorted[i - 1].id) {
            return bad_argument(name_of(sorted[i]) + " is given twice.");
        }
        const std::uint32_t element = format::element_size(sorted[i].id);
        table.entries[i] = {sorted[i].id, element, 0, sorted[i].bytes.size() / element, 0};
    }
    return table;
}

void add_checksums(SectionTable& table) noexcept {
    for (std::uint32_t i = 0; i < table.count; ++i) {
        table.entries[i].checksum = format::checksum(table.sections[i].bytes);
    }
}

Result<std::size_t> image_size(std::span<const Section> sections, const ImageOptions& options) {
    const Result<PlacedTable> placed = placed_table(sections, options);
    if (!placed) return placed.error();
    return static_cast<std::size_t>(placed.value().size);
}

Result<std::span<std::byte>> build_image(const format::FileHeader& facts,
                                         std::span<const Section> sections,
                                         std::span<std::byte> memory, const ImageOptions& options) {
    Result<PlacedTable> placed = placed_table(sections, options);
    if (!placed) return placed.error();
    auto& [table, size] = placed.value();
    if (const auto fault = find_fault(memory, size)) return *fault;
    const std::span<std::byte> image = memory.first(static_cast<std::size_t>(size));
    add_checksums(table);
    fill(image, table);
    const format::UserBlock block =
        format::make_user_block(facts, table.used_entries(), kNoSuperblock, size);
    std::memcpy(image.data(), block.data(), block.size());
    return image;
}

}  // namespace cdprep::build
