// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace cdprep {

/// Prefetches an object's cache lines. A hint: any address is allowed.
template <class T>
void prefetch(const T* object) noexcept {
#if defined(__GNUC__) || defined(__clang__)
    constexpr std::size_t kLine = 64;
    const char* bytes = reinterpret_cast<const char*>(object);
    for (std::size_t at = 0; at < sizeof(T); at += kLine) __builtin_prefetch(bytes + at);
#else
    static_cast<void>(object);
#endif
}

}  // namespace cdprep
