// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "decompose/enclose/approximate_parts.h"
#include "decompose/enclose/body_mass.h"

namespace cdprep::report {

/// The result of enclosing one file in convex parts.
struct ApproximateReport {
    std::string input;
    std::string output;               ///< empty: nothing was written
    std::optional<double> max_error;  ///< the requested error, model units
    std::optional<std::size_t> max_parts;
    std::size_t triangles = 0;
    double diagonal = 0;           ///< of the mesh's box, model units
    bool to_surface = false;       ///< the error refers to the surface, not to the solid
    std::array<double, 3> size{};  ///< of that box along the axes, model units
    double metres_per_unit = 0;    ///< 0: unknown
    bool is_normalized = false;    ///< then there is no unit
    format::UpAxis up_axis = format::UpAxis::unknown;
    bool is_for_simulators = false;         ///< the output is in metres, +z up
    std::size_t unbalanced_components = 0;  ///< always measured as surfaces
    convex::ApproximateParts result;
    std::vector<std::string> node_names;  ///< by ApproximatePart::node; may be empty
    std::size_t left_out = 0;             ///< hulls that the output format cannot hold
    double rounding = 0;                  ///< of corners by the output; in the errors of `result`
    std::optional<double> mass;           ///< the mass written, kilograms
    cli::MassOf mass_of = cli::MassOf::solid;
    bool is_missed_by_rounding = false;  ///< the request, which was met before
    bool has_table = false;
    double seconds = 0;  ///< of the decomposition alone
    int exit = 0;
    std::optional<std::string> error;  ///< the message, if it failed
};

/// Returns the warning for an output in metres of a mesh with unknown unit. It states the resulting
/// size and mass. Empty if no warning applies.
[[nodiscard]] std::string unit_warning(const ApproximateReport& report);

/// Returns a few lines for a person. With a table, it adds one line per part.
[[nodiscard]] std::string approximate_text(const ApproximateReport& report);

/// Returns one JSON object, which decompose.schema.json describes. "parts" is the number of parts.
/// "outer_error" and "inner_error" are proved and in the mesh's unit; "proof" lists the tests of
/// the proof.
[[nodiscard]] std::string approximate_json(const ApproximateReport& report);

}  // namespace cdprep::report
