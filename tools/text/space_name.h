// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "cdprep/format/file_header.h"

namespace cdprep::report {

/// "y", or "unknown".
[[nodiscard]] const char* axis_name(format::UpAxis axis) noexcept;

/// "mm", "cm", "m", "in" or "ft"; "0.002 m" of another unit; "unknown" of 0.
[[nodiscard]] std::string unit_name(double metres_per_unit);

}  // namespace cdprep::report
