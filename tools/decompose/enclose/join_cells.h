// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "decompose/enclose/solid_cells.h"

namespace cdprep::convex {

/// Covers convex cells of a solid with few unions of neighbouring cells of one body. The hull of
/// each union sticks out by at most `error`, proved; with an error of 0, by rounding only. Unions
/// grow from every cell to the nearest neighbours; the ones that take in most of the rest are
/// chosen, and those of which others contain all cells are dropped.
///
/// Suits some hundred cells of simple solids, because every trial examines all triangles nearby.
/// `wanted` lists the cells to cover; the others are in no union. Returns cell numbers, ascending.
/// The same for any parallel_for.
[[nodiscard]] std::vector<std::vector<std::uint32_t>> join_cells(
    const SolidCells& cells, std::span<const std::uint32_t> wanted, const Solid& solid,
    double error, ParallelFor parallel_for);

}  // namespace cdprep::convex
