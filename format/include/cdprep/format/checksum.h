// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "cdprep/format/api.h"

namespace cdprep::format {

/// Returns the 64-bit XXH3 hash of `bytes`, seed 0. It finds accidents, not attacks: whoever can
/// change a section can also change its checksum. Reads at memory speed, about 10 GB/s and more.
/// Never allocates.
[[nodiscard]] CDPREP_API std::uint64_t checksum(std::span<const std::byte> bytes) noexcept;

}  // namespace cdprep::format
