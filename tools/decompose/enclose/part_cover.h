// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "decompose/enclose/distance_field.h"

namespace cdprep::convex {

/// A cell of a body. A part contains it as a whole or not at all.
struct CoverCell {
    mesh::Box box;
    std::uint32_t body;
    std::vector<Double3> points;  ///< whose hull represents the cell
};

/// One sample of a field, in the unit of CoverOptions::most_work.
inline constexpr std::size_t kWorkOfSample = 10;

struct CoverOptions {
    double error = 0;            ///< estimated limit by which parts may stick out, model units
    std::size_t rounds = 16;     ///< of attempts with fewer parts
    std::size_t few_enough = 0;  ///< attempts end at this number of parts
    /// Parts within the error that take in all cells. The search then only tries to use fewer.
    std::span<const std::vector<std::uint32_t>> begin_with = {};
    std::span<const Estimate> known = {};  ///< points outside the solid, and how far out
    /// The work limit, in units of about ten nanoseconds of one core. The search gives up,
    /// incomplete, beyond it, or sooner if it predicts a much larger need.
    std::size_t most_work = 1'000'000'000;
    ParallelFor parallel_for = serial_for;
};

struct Cover {
    std::vector<std::vector<std::uint32_t>> parts;  ///< cells, ascending; every cell is in one
    bool complete = true;                           ///< else there are no parts
    double share = 1;             ///< of the cells that parts took in, if it gave up
    std::vector<Estimate> found;  ///< new points like CoverOptions::known
    std::size_t work = 0;
};

/// Covers cells with few sets of cells of one body each. The hulls stick out of the solid by at
/// most the error, by estimate. A single cell whose hull sticks out farther is a part by itself.
/// Parts grow from a cell to its neighbours until no more fit, and may overlap. The parts that
/// take in most of the rest are chosen. Then neighbouring parts are given up together where fewer
/// suffice. The same for any parallel_for.
[[nodiscard]] Cover cover_with_parts(std::span<const CoverCell> cells, const DistanceField& field,
                                     const CoverOptions& options);

}  // namespace cdprep::convex
