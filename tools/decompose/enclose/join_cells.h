// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "decompose/enclose/solid_cells.h"

namespace cdprep::convex {

/// Covers convex cells of a solid with few unions of neighbouring ones of one body, whose
/// hulls stick out by no more than an error: proved, for each. With an error of 0, only by
/// what rounding does. Unions grow from every cell to the nearest neighbours; those that
/// take in most of what is left are chosen. For some hundred cells, of simple solids: every
/// trial looks at all triangles around. `wanted`: which cells; the others are in none.
/// Numbers of cells, ascending. The same for any parallel_for.
[[nodiscard]] std::vector<std::vector<std::uint32_t>> join_cells(
    const SolidCells& cells, std::span<const std::uint32_t> wanted, const Solid& solid,
    double error, ParallelFor parallel_for);

}  // namespace cdprep::convex
