// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <new>

// Counts the bytes that a program allocates. It replaces the operators new and delete of the
// program, so cdprep_add_tests() must list the test under ALONE.

namespace cdprep::test {

inline std::size_t used = 0;  ///< bytes that are allocated now
inline std::size_t most = 0;  ///< the maximum of `used`

/// The bytes in front of each block, which hold its size. They keep every required alignment.
inline constexpr std::size_t kFront = alignof(std::max_align_t);

inline void* counted(std::size_t size) noexcept {
    auto* block = static_cast<std::byte*>(std::malloc(kFront + size));
    if (block == nullptr) std::abort();
    std::memcpy(block, &size, sizeof size);
    used += size;
    most = std::max(most, used);
    return block + kFront;
}

inline void forget(void* memory) noexcept {
    if (memory == nullptr) return;
    std::byte* block = static_cast<std::byte*>(memory) - kFront;
    std::size_t size = 0;
    std::memcpy(&size, block, sizeof size);
    used -= size;
    std::free(block);
}

}  // namespace cdprep::test

// NOLINTBEGIN(misc-definitions-in-headers)

void* operator new(std::size_t size) {
    return cdprep::test::counted(size);
}
void* operator new[](std::size_t size) {
    return cdprep::test::counted(size);
}
// The standard library's own versions would call the first operator, but sanitizers replace them.
void* operator new(std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
    return cdprep::test::counted(size);
}
void* operator new[](std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
    return cdprep::test::counted(size);
}
void operator delete(void* memory) noexcept {
    cdprep::test::forget(memory);
}
void operator delete[](void* memory) noexcept {
    cdprep::test::forget(memory);
}
void operator delete(void* memory, std::size_t /*size*/) noexcept {
    cdprep::test::forget(memory);
}
void operator delete[](void* memory, std::size_t /*size*/) noexcept {
    cdprep::test::forget(memory);
}
// NOLINTEND(misc-definitions-in-headers)
