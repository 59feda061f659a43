// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace cdprep::test {

// Pages of memory whose access is changed, on any operating system.

[[nodiscard]] std::size_t page_size();
[[nodiscard]] std::byte* allocate_pages(std::size_t size);  ///< to read and write
enum class PageAccess { read, none };
void protect_pages(std::byte* start, std::size_t size, PageAccess access);
void release_pages(std::byte* start, std::size_t size);

}  // namespace cdprep::test
