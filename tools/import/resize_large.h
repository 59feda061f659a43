// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace cdprep::import {

/// Resizes an empty vector, on huge pages where the system has them: first
/// touches of 4 KiB pages otherwise cost a quarter of a fast import.
template <class T>
void resize_large(std::vector<T>& values, std::size_t count) {
    constexpr std::uintptr_t kHugePage = std::uintptr_t{1} << 21;
    values.reserve(count);
    const auto first = reinterpret_cast<std::uintptr_t>(values.data());
    const std::uintptr_t begin = (first + kHugePage - 1) / kHugePage * kHugePage;
    const std::uintptr_t end = (first + count * sizeof(T)) / kHugePage * kHugePage;
    if (begin < end) {
        // Advice: nothing is lost where it is not taken.
        (void)::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
    }
    values.resize(count);
}

}  // namespace cdprep::import
