// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

#if defined(__x86_64__) || defined(_M_X64)
#include <immintrin.h>
#endif

namespace cdprep::study {

/// Ranges of memory.
using Memory = std::vector<std::span<const std::byte>>;

template <class... Arrays>
Memory memory_of(const Arrays&... arrays) {
    return {std::as_bytes(std::span(arrays))...};
}

inline std::size_t bytes_of(const Memory& memory) {
    return std::accumulate(memory.begin(), memory.end(), std::size_t{0},
                           [](std::size_t sum, const auto& part) { return sum + part.size(); });
}

/// Evicts the memory from all caches.
inline void flush(const Memory& memory) {
#if defined(__x86_64__) || defined(_M_X64)
    for (const auto& part : memory) {
        for (std::size_t i = 0; i < part.size(); i += 64) _mm_clflush(part.data() + i);
    }
    _mm_mfence();
#else
    static std::vector<char> more_than_any_cache(std::size_t{256} << 20);
    for (std::size_t i = 0; i < more_than_any_cache.size(); i += 64) ++more_than_any_cache[i];
    (void)memory;
#endif
}

}  // namespace cdprep::study
