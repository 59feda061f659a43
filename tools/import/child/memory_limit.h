// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace cdprep::import {

/// Sets the maximum memory that this process may ever use. Returns false if the system refuses.
[[nodiscard]] bool set_memory_limit(std::uint64_t bytes);

/// Permits the memory that `input_bytes` bytes of input can fill (honest_memory()), up to that
/// maximum.
void allow_memory_for(std::uint64_t input_bytes);

}  // namespace cdprep::import
