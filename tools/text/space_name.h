// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "cdprep/format/file_header.h"

namespace cdprep::report {

/// Returns "x", "y", "z" or "unknown".
[[nodiscard]] const char* axis_name(format::UpAxis axis) noexcept;

/// Returns "mm", "cm", "m", "in" or "ft"; "0.002 m" for another unit; "unknown" for 0.
[[nodiscard]] std::string unit_name(double metres_per_unit);

}  // namespace cdprep::report
