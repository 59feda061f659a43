// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "decompose/enclose/distance_field.h"

namespace cdprep::convex {

/// A part of a body that pieces take in whole.
struct CoverCell {
    mesh::Box box;
    std::uint32_t body;
    std::vector<Double3> points;  ///< whose hull stands for it
};

struct CoverOptions {
    double error = 0;      ///< pieces are estimated to stick out by no more than this, model units
    double margin = 0.25;  ///< a share of it: hulls grow among nodes that are nearer by that
    std::size_t rounds = 16;     ///< of attempts to do with fewer pieces
    std::size_t few_enough = 0;  ///< no more attempts when there are as few
    /// Pieces within the error that take in all cells: what is left is to do with fewer.
    std::span<const std::vector<std::uint32_t>> begin_with = {};
    std::span<const Estimate> known = {};  ///< points of the space around, and how far out
    /// Gives up, incomplete, after so much work, some ten nanoseconds of one core each; or
    /// sooner, when far more is going to be needed.
    std::size_t most_work = 1'000'000'000;
    ParallelFor parallel_for = serial_for;
};

struct Cover {
    std::vector<std::vector<std::uint32_t>> pieces;  ///< cells, ascending; every cell is in one
    bool complete = true;                            ///< else there are no pieces
    double share = 1;             ///< of the cells, that pieces had taken in when it gave up
    std::vector<Estimate> found;  ///< more of what is known
    std::size_t work = 0;
};

/// Covers cells with few sets of cells of one body each, whose hulls stick out of the solid
/// by no more than an error; a single cell whose hull does so all the same is a piece of
/// its own. Pieces grow from a cell to its neighbours until nothing more goes in, and may
/// overlap; those that take in most of what is left are chosen, and neighbouring ones are
/// given up together where fewer do. The same for any parallel_for.
[[nodiscard]] Cover cover_with_pieces(std::span<const CoverCell> cells, const DistanceField& field,
                                      const CoverOptions& options);

}  // namespace cdprep::convex
