// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "decompose/surface/surface_pieces.h"

namespace cdprep::report {

/// The result of cutting one file into convex pieces of its surface.
struct SurfacePiecesReport {
    std::string input;
    std::string output;  ///< empty: nothing was written
    convex::PieceOrder order = convex::PieceOrder::greedy;
    double tolerance = 0;  ///< model units
    convex::SurfacePieces pieces;
    bool has_table = false;            ///< a row for each piece
    double seconds = 0;                ///< of the decomposition alone
    int exit = 0;                      ///< exit code for this file
    std::optional<std::string> error;  ///< the message, if it failed
};

/// Returns a few lines for a person. With a table, it adds one line per piece.
[[nodiscard]] std::string pieces_text(const SurfacePiecesReport& report);

/// Returns one JSON object, which decompose.schema.json describes. "pieces" is the number of
/// pieces. "outer_error" and "inner_error" are the greatest distances of the hulls above and below
/// the surface. They refer to the surface of the piece, in the mesh's unit.
[[nodiscard]] std::string pieces_json(const SurfacePiecesReport& report);

/// Returns the name of an order on the command line.
[[nodiscard]] const char* name_of(convex::PieceOrder order);

}  // namespace cdprep::report
