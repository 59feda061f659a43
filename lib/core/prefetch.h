// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "cdprep/format/portable.h"

namespace cdprep {

/// Prefetches an object's cache lines. A hint: any address is allowed.
template <class T>
void prefetch(const T* object) noexcept {
    constexpr std::size_t kLine = 64;
    const char* bytes = reinterpret_cast<const char*>(object);
    for (std::size_t at = 0; at < sizeof(T); at += kLine) format::prefetch_line(bytes + at);
}

}  // namespace cdprep
