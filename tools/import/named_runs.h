// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "mesh/mesh.h"

namespace cdprep::import {

/// From `first_triangle` on, triangles carry `name`.
struct NamedStart {
    std::uint32_t first_triangle;
    std::string name;
};

/// Returns the runs between the starts, which are sorted by triangle; the last
/// of several at one triangle holds. Triangles before the first start carry
/// `default_name`. Neighbours of equal name are one run, empty runs are left
/// out, and names stand in the order of their first run. No starts: no runs.
[[nodiscard]] mesh::NamedRuns named_runs(std::span<const NamedStart> starts,
                                         std::uint32_t triangle_count,
                                         std::string_view default_name);

/// Returns `text` as UTF-8 without control characters: U+FFFD stands for every
/// byte that is neither.
[[nodiscard]] std::string utf8_name(std::string_view text);

}  // namespace cdprep::import
