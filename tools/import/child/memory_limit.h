// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace cdprep::import {

/// Sets the most memory that this process may ever use. False when the system refuses.
[[nodiscard]] bool set_memory_limit(std::uint64_t bytes);

/// Lets the process use what input of so many bytes can fill (honest_memory()), within that most.
void allow_memory_for(std::uint64_t input_bytes);

}  // namespace cdprep::import
