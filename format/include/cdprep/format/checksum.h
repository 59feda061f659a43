// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "cdprep/format/api.h"

namespace cdprep::format {

/// Returns the 64-bit XXH3 hash of `bytes`, with seed 0. It detects accidental changes, not
/// attacks: whoever can change a section can also change its checksum. Runs at the speed of memory,
/// about 10 GB/s or more. Never allocates.
[[nodiscard]] CDPREP_API std::uint64_t checksum(std::span<const std::byte> bytes) noexcept;

}  // namespace cdprep::format
