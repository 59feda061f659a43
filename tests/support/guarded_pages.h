// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>
#ifdef _WIN32
#define WIN32_LEAN_AND_MEAN
#define NOMINMAX
#include <windows.h>
#else
#include <sys/mman.h>
#include <unistd.h>
#endif

#include <cstddef>
#include <cstring>
#include <span>

#include "cdprep/format/file_header.h"
#include "cdprep/format/section_set.h"
#include "cdprep/format/sections.h"

namespace cdprep::test {

/// A file on read-only pages. Each section must begin a page of its own. Sections that are not
/// `wanted` are closed to every access.
class GuardedPages {
public:
    GuardedPages(std::span<const std::byte> file, format::SectionSet wanted) {
        const std::size_t page = page_size();
        size_ = (file.size() + page - 1) / page * page;
        start_ = static_cast<std::byte*>(allocate(size_));
        std::memcpy(start_, file.data(), file.size());
        protect(start_, size_, true);
        bytes_ = {start_, file.size()};
        for_each_section([&](const format::SectionEntry& entry) {
            if (wanted.contains(entry.id) || entry.count == 0) return;
            EXPECT_EQ(entry.offset % page, 0u);
            close(entry);
        });
    }
    ~GuardedPages() {
        release(start_, size_);
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
#ifdef _WIN32
    static std::size_t page_size() {
        SYSTEM_INFO info{};
        ::GetSystemInfo(&info);
        return info.dwPageSize;
    }
    static void* allocate(std::size_t size) {
        return ::VirtualAlloc(nullptr, size, MEM_COMMIT | MEM_RESERVE, PAGE_READWRITE);
    }
    static void protect(std::byte* start, std::size_t size, bool is_readable) {
        DWORD before = 0;
        ::VirtualProtect(start, size, is_readable ? PAGE_READONLY : PAGE_NOACCESS, &before);
    }
    static void release(std::byte* start, std::size_t /*size*/) {
        ::VirtualFree(start, 0, MEM_RELEASE);
    }
#else
    static std::size_t page_size() {
        return static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
    }
    static void* allocate(std::size_t size) {
        return ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    }
    static void protect(std::byte* start, std::size_t size, bool is_readable) {
        ::mprotect(start, size, is_readable ? PROT_READ : PROT_NONE);
    }
    static void release(std::byte* start, std::size_t size) {
        ::munmap(start, size);
    }
#endif
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
        protect(start_ + entry.offset, entry.count * entry.element_size, false);
        ++guarded_;
    }

    std::byte* start_ = nullptr;
    std::size_t size_ = 0;
    std::span<const std::byte> bytes_;
    int guarded_ = 0;
};

}  // namespace cdprep::test
