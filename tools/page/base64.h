// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace cdprep::report {

/// Returns the bytes as base64 (RFC 4648, padded, one line).
[[nodiscard]] std::string base64(std::span<const std::byte> bytes);

}  // namespace cdprep::report
