// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "decompose/enclose/approximate_pieces.h"

namespace cdprep::report {

/// What enclosing one file in convex pieces gave.
struct ApproximateReport {
    std::string input;
    std::string output;               ///< empty: nothing was written
    std::optional<double> max_error;  ///< asked for, model units
    std::optional<std::size_t> parts;
    std::size_t triangles = 0;
    double diagonal = 0;           ///< of the mesh's box, model units
    bool to_surface = false;       ///< the error is of the surface, not of the solid
    std::array<double, 3> size{};  ///< of that box along the axes, model units
    double metres_per_unit = 0;    ///< 0: unknown
    format::UpAxis up_axis = format::UpAxis::unknown;
    bool is_for_simulators = false;   ///< the output counts in metres, +z up
    std::size_t open_components = 0;  ///< whose surface is meant whatever was asked
    convex::ApproximatePieces result;
    std::vector<std::string> node_names;  ///< by ApproximatePiece::node; may be empty
    std::size_t left_out = 0;             ///< hulls that the output's format has no place for
    std::optional<double> mass;           ///< that was written, kilograms
    bool is_mass_of_pieces = false;       ///< what counts twice where they overlap; else exact
    bool has_table = false;
    double seconds = 0;  ///< of the decomposition alone
    int exit = 0;
    std::optional<std::string> error;  ///< the sentence, when it failed
};

/// The sentence for an output in metres of a mesh of unknown unit, with the size and mass that come
/// of it; empty when there is nothing to say.
[[nodiscard]] std::string unit_warning(const ApproximateReport& report);

/// A few lines for a person, and with a table a line for each piece.
[[nodiscard]] std::string approximate_text(const ApproximateReport& report);

/// One object: "pieces" is their number, "outer_error" and "inner_error" are proved, in the
/// mesh's unit; "proof" is what was tested for it.
[[nodiscard]] std::string approximate_json(const ApproximateReport& report);

}  // namespace cdprep::report
