// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "mesh/mesh.h"

namespace cdprep::import {

/// The start of a run: triangles from `first_triangle` on have the name `name`.
struct NamedStart {
    std::uint32_t first_triangle;
    std::string name;
};

/// Returns the runs between the starts, which must be sorted by triangle. The last of several
/// starts at one triangle counts. Triangles before the first start have the name `default_name`.
/// Neighbouring runs of equal name are one run, empty runs are omitted, and names are in the order
/// of their first run. No starts give no runs.
[[nodiscard]] mesh::NamedRuns named_runs(std::span<const NamedStart> starts,
                                         std::uint32_t triangle_count,
                                         std::string_view default_name);

/// Returns `text` as UTF-8 without control characters. U+FFFD replaces each control character and
/// each byte that is not UTF-8.
[[nodiscard]] std::string utf8_name(std::string_view text);

}  // namespace cdprep::import
