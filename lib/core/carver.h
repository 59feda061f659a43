// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>

namespace cdprep {

inline constexpr std::size_t kCarveAlignment = 64;  ///< bytes: a line of the cache

/// Returns a number of bytes, or the largest multiple of kCarveAlignment if it does not fit into
/// std::size_t. Nothing provides that much.
constexpr std::size_t saturated(std::uint64_t size) noexcept {
    constexpr std::uint64_t kMost = SIZE_MAX / kCarveAlignment * kCarveAlignment;
    return static_cast<std::size_t>(std::min(size, kMost));
}

/// Divides a block of memory into arrays. Without memory it measures how much they take.
class Carver {
public:
    /// `memory` is null or aligned to kCarveAlignment.
    explicit Carver(std::byte* memory) noexcept : memory_(memory) {}

    /// Returns an array of `count` objects with initial values; null without memory. The count has
    /// 64 bits everywhere, so that no product of limits wraps.
    template <class T>
    T* take(std::uint64_t count) noexcept {
        static_assert(alignof(T) <= kCarveAlignment && std::is_trivially_destructible_v<T>);
        T* const begin = memory_ ? reinterpret_cast<T*>(memory_ + used_) : nullptr;
        add(count * sizeof(T));
        if (begin) {
            std::uninitialized_value_construct_n(begin, static_cast<std::size_t>(count));
        }
        return begin;
    }
    /// Returns room for an object, which is not made.
    template <class T>
    T* take_room() noexcept {
        static_assert(alignof(T) <= kCarveAlignment);
        T* const room = memory_ ? reinterpret_cast<T*>(memory_ + used_) : nullptr;
        add(sizeof(T));
        return room;
    }
    /// Returns the number of bytes taken, saturated().
    [[nodiscard]] std::size_t used() const noexcept {
        return used_;
    }

private:
    /// With 64 bits no size overflows. With 32 it stays at the largest.
    void add(std::uint64_t size) noexcept {
        const std::uint64_t whole =
            (size + kCarveAlignment - 1) / kCarveAlignment * kCarveAlignment;
        used_ = saturated(used_ + whole);
    }

    std::byte* memory_;
    std::size_t used_ = 0;
};

}  // namespace cdprep
