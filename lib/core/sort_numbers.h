// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

namespace cdprep {

/// Sorts; O(n) for as many numbers as `scratch` has room for, and nearly so for more.
/// Never allocates.
void sort_numbers(std::span<std::uint32_t> numbers, std::span<std::uint64_t> scratch) noexcept;

}  // namespace cdprep
