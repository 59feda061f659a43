// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstring>
#include <span>

#include "cdprep/format/file_header.h"
#include "cdprep/format/section_set.h"
#include "cdprep/format/sections.h"
#include "support/pages.h"

namespace cdprep::test {

/// A file on read-only pages. Each section must begin a page of its own. Sections that are not
/// `wanted` are closed to every access.
class GuardedPages {
public:
    GuardedPages(std::span<const std::byte> file, format::SectionSet wanted) {
        const std::size_t page = page_size();
        size_ = (file.size() + page - 1) / page * page;
        start_ = allocate_pages(size_);
        std::memcpy(start_, file.data(), file.size());
        protect_pages(start_, size_, PageAccess::read);
        bytes_ = {start_, file.size()};
        for_each_section([&](const format::SectionEntry& entry) {
            if (wanted.contains(entry.id) || entry.count == 0) return;
            EXPECT_EQ(entry.offset % page, 0u);
            close(entry);
        });
    }
    ~GuardedPages() {
        release_pages(start_, size_);
    }
    GuardedPages(const GuardedPages&) = delete;
    GuardedPages& operator=(const GuardedPages&) = delete;
    [[nodiscard]] std::span<const std::byte> bytes() const {
        return bytes_;
    }
    [[nodiscard]] int guarded() const {
        return guarded_;
    }
    /// Closes a section that was wanted.
    void close(format::SectionId id) {
        for_each_section([&](const format::SectionEntry& entry) {
            if (entry.id == id) close(entry);
        });
    }

private:
    template <class Visit>
    void for_each_section(const Visit& visit) {
        const format::FileHeader header = format::read_header(bytes_);
        for (std::uint32_t i = 0; i < header.section_count; ++i) {
            format::SectionEntry entry;
            std::memcpy(&entry, start_ + format::kSectionTableOffset + i * sizeof entry,
                        sizeof entry);
            visit(entry);
        }
    }
    void close(const format::SectionEntry& entry) {
        protect_pages(start_ + entry.offset, entry.count * entry.element_size, PageAccess::none);
        ++guarded_;
    }

    std::byte* start_ = nullptr;
    std::size_t size_ = 0;
    std::span<const std::byte> bytes_;
    int guarded_ = 0;
};

}  // namespace cdprep::test
