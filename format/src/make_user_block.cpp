// SPDX-License-Identifier: MIT
#include "cdprep/format/make_user_block.h"

#include <cassert>
#include <cstring>

#include "cdprep/format/checksum.h"
#include "cdprep/format/content_hash.h"

namespace cdprep::format {
namespace {

/// The facts that content_hash() covers, as one run of bytes without padding.
struct HashedFacts {
    std::uint32_t version;
    std::uint32_t required_features;
    std::uint32_t vertex_count;
    std::uint32_t triangle_count;
    std::uint32_t flags;
    UpAxis up_axis;
    double metres_per_unit;
    Double3 frame_origin;
    Double3 normalize_offset;
    double normalize_factor;
    std::int64_t frame_exponent;
};
static_assert(sizeof(HashedFacts) == 6 * 4 + 9 * 8);

/// A section without its offset.
struct HashedSection {
    SectionId id;
    std::uint32_t element_size;
    std::uint64_t count;
    std::uint64_t checksum;
};

}  // namespace

std::uint64_t content_hash(const FileHeader& header,
                           std::span<const SectionEntry> sections) noexcept {
    assert(sections.size() <= kMaxSections);
    const HashedFacts facts = {header.version,
                               header.required_features,
                               header.vertex_count,
                               header.triangle_count,
                               header.flags,
                               header.up_axis,
                               header.metres_per_unit,
                               header.frame_origin,
                               header.normalize_offset,
                               header.normalize_factor,
                               header.frame_exponent};
    std::array<std::byte, sizeof(HashedFacts) + kMaxSections * sizeof(HashedSection)> buffer;
    std::memcpy(buffer.data(), &facts, sizeof facts);
    std::size_t size = sizeof facts;
    for (const SectionEntry& entry : sections) {
        const HashedSection hashed = {entry.id, entry.element_size, entry.count, entry.checksum};
        std::memcpy(buffer.data() + size, &hashed, sizeof hashed);
        size += sizeof hashed;
    }
    return checksum(std::span(buffer).first(size));
}

std::uint64_t header_checksum(std::span<const std::byte, kUserBlockSize> user_block) noexcept {
    UserBlock block;
    std::memcpy(block.data(), user_block.data(), block.size());
    std::memset(block.data() + offsetof(FileHeader, header_checksum), 0, sizeof(std::uint64_t));
    return checksum(block);
}

UserBlock make_user_block(const FileHeader& facts, std::span<const SectionEntry> sections,
                          std::span<const std::byte, 40> superblock,
                          std::uint64_t file_size) noexcept {
    FileHeader header = facts;
    header.magic = kMagic;
    header.version = kVersion;
    header.endian_mark = kEndianMark;
    header.ieee_check = kIeeeCheck;
    header.file_size = file_size;
    header.header_checksum = 0;
    std::memcpy(header.superblock.data(), superblock.data(), superblock.size());
    header.section_count = static_cast<std::uint32_t>(sections.size());
    header.content_hash = content_hash(header, sections);

    UserBlock block{};
    std::memcpy(block.data(), &header, sizeof header);
    std::memcpy(block.data() + kSectionTableOffset, sections.data(), sections.size_bytes());
    const std::uint64_t sum = header_checksum(block);
    std::memcpy(block.data() + offsetof(FileHeader, header_checksum), &sum, sizeof sum);
    return block;
}

}  // namespace cdprep::format
