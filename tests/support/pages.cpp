// SPDX-License-Identifier: MIT
#include "support/pages.h"

#ifdef _WIN32
#define WIN32_LEAN_AND_MEAN
#include <windows.h>
#else
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace cdprep::test {

#ifdef _WIN32

std::size_t page_size() {
    SYSTEM_INFO info{};
    ::GetSystemInfo(&info);
    return info.dwPageSize;
}

std::byte* allocate_pages(std::size_t size) {
    return static_cast<std::byte*>(
        ::VirtualAlloc(nullptr, size, MEM_COMMIT | MEM_RESERVE, PAGE_READWRITE));
}

void protect_pages(std::byte* start, std::size_t size, PageAccess access) {
    DWORD before = 0;
    const DWORD after = access == PageAccess::read ? PAGE_READONLY : PAGE_NOACCESS;
    ::VirtualProtect(start, size, after, &before);
}

void release_pages(std::byte* start, std::size_t /*size*/) {
    ::VirtualFree(start, 0, MEM_RELEASE);
}

#else

std::size_t page_size() {
    return static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

std::byte* allocate_pages(std::size_t size) {
    void* const start =
        ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    return start == MAP_FAILED ? nullptr : static_cast<std::byte*>(start);
}

void protect_pages(std::byte* start, std::size_t size, PageAccess access) {
    ::mprotect(start, size, access == PageAccess::read ? PROT_READ : PROT_NONE);
}

void release_pages(std::byte* start, std::size_t size) {
    ::munmap(start, size);
}

#endif

}  // namespace cdprep::test
