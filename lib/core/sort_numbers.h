// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

namespace cdprep {

/// Sorts numbers. Takes O(n) if `scratch` has room for all of them, and nearly O(n) otherwise.
/// Never allocates.
void sort_numbers(std::span<std::uint32_t> numbers, std::span<std::uint64_t> scratch) noexcept;

}  // namespace cdprep
