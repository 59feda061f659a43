// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "decompose/surface/surface_pieces.h"

namespace cdprep::report {

/// What cutting one file into convex pieces of its surface gave.
struct SurfacePiecesReport {
    std::string input;
    std::string output;  ///< empty: nothing was written
    convex::PieceOrder order = convex::PieceOrder::greedy;
    double tolerance = 0;  ///< model units
    convex::SurfacePieces pieces;
    bool has_table = false;            ///< a row for each piece
    double seconds = 0;                ///< of the decomposition alone
    int exit = 0;                      ///< exit code for this file
    std::optional<std::string> error;  ///< the sentence, when it failed
};

/// A screen for a person, and with a table a line for each piece.
[[nodiscard]] std::string pieces_text(const SurfacePiecesReport& report);

/// One object: "pieces" is their number, "outer_error" and "inner_error" how far the hulls
/// lie over the surface of their pieces and under it at most, in the mesh's unit.
[[nodiscard]] std::string pieces_json(const SurfacePiecesReport& report);

/// The name of an order on the command line.
[[nodiscard]] const char* name_of(convex::PieceOrder order);

}  // namespace cdprep::report
