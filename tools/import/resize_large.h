// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <memory>
#include <vector>

namespace cdprep::import {

/// Resizes an empty vector, on huge pages if the system has them. Otherwise the first access to
/// each 4 KiB page costs a quarter of a fast import.
template <class T>
void resize_large(std::vector<T>& values, std::size_t count) {
    constexpr std::size_t kHugePage = std::size_t{1} << 21;
    values.reserve(count);
    void* whole_pages = values.data();
    std::size_t bytes = count * sizeof(T);
    if (std::align(kHugePage, kHugePage, whole_pages, bytes)) {
        // This is advice: the program is correct if the system ignores it.
        (void)::madvise(whole_pages, bytes / kHugePage * kHugePage, MADV_HUGEPAGE);
    }
    values.resize(count);
}

}  // namespace cdprep::import
