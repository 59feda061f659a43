// SPDX-License-Identifier: MIT
#include "support/reseal.h"

#include <algorithm>
#include <cstring>
#include <vector>

#include "cdprep/format/checksum.h"
#include "cdprep/format/content_hash.h"
#include "cdprep/format/file_header.h"

namespace cdprep::test {
namespace {

using format::FileHeader;
using format::SectionEntry;

/// Recomputes an entry's checksum when it lies inside the file.
void reseal_entry(std::span<std::byte> file, std::uint64_t at) {
    SectionEntry entry;
    std::memcpy(&entry, file.data() + at, sizeof entry);
    if (entry.element_size == 0 || entry.offset > file.size() ||
        entry.count > (file.size() - entry.offset) / entry.element_size) {
        return;
    }
    entry.checksum =
        format::checksum(file.subspan(static_cast<std::size_t>(entry.offset),
                                      static_cast<std::size_t>(entry.count * entry.element_size)));
    std::memcpy(file.data() + at + offsetof(SectionEntry, checksum), &entry.checksum,
                sizeof entry.checksum);
}

}  // namespace

void reseal(std::span<std::byte> file) {
    if (file.size() < format::kUserBlockSize) return;
    FileHeader header;
    std::memcpy(&header, file.data(), sizeof header);
    const std::uint32_t count = std::min(header.section_count, format::kMaxSections);
    for (std::uint32_t i = 0; i < count; ++i) {
        reseal_entry(file, format::kSectionTableOffset + i * sizeof(SectionEntry));
    }
    std::vector<SectionEntry> entries(count);
    if (count > 0) {
        std::memcpy(entries.data(), file.data() + format::kSectionTableOffset,
                    count * sizeof(SectionEntry));
    }
    const std::uint64_t hash = format::content_hash(header, entries);
    std::memcpy(file.data() + offsetof(FileHeader, content_hash), &hash, sizeof hash);
    const std::uint64_t sum = format::header_checksum(file.first<format::kUserBlockSize>());
    std::memcpy(file.data() + offsetof(FileHeader, header_checksum), &sum, sizeof sum);
}

}  // namespace cdprep::test
