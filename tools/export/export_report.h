// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "cdprep/format/file_header.h"
#include "decompose/enclose/body_mass.h"

namespace cdprep::report {

/// The result of `cdprep export`.
struct ExportReport {
    std::string input;
    std::string output;
    std::string engine;
    std::size_t parts = 0;          ///< written
    bool is_of_whole = false;       ///< the file has no parts: the hull of the whole is written
    std::size_t left_out = 0;       ///< parts without a volume
    std::size_t stored_points = 0;  ///< of the written parts, in the baked file
    std::size_t points = 0;         ///< written
    std::size_t most_points = 0;    ///< of one part
    std::size_t low_points = 0;     ///< written, but engines may ignore them
    double growth = 0;              ///< parts contain the stored ones and grew by less; model units
    double rounding = 0;            ///< of corners to floats; parts enclose less by it; model units
    double outer_error = 0;         ///< how far parts stick out of the solid at most; model units
    bool is_in_metres = false;
    bool has_visual = false;
    bool is_visual_refused = false;  ///< the mesh is unbalanced or inverted, which MuJoCo refuses
    double metres_per_unit = 0;      ///< 0: unknown
    bool is_normalized = false;      ///< then there is no unit
    format::UpAxis up_axis = format::UpAxis::unknown;  ///< of the model
    format::UpAxis written_up = format::UpAxis::unknown;
    std::array<double, 3> size{};  ///< of the mesh's box along the written axes, model units
    std::optional<double> mass;    ///< the mass written, kilograms
    cli::MassOf mass_of = cli::MassOf::solid;
    double seconds = 0;
    int exit = 0;
    std::optional<std::string> error;  ///< the message, if it failed
};

/// Returns the reason why --strict refuses an output in metres of a model with unknown unit.
[[nodiscard]] std::string unknown_unit(const ExportReport& report);

/// Returns the warning for an output in metres of a model with unknown unit. It states the
/// resulting size, and the mass if there is one. Empty if no warning applies.
[[nodiscard]] std::string unit_warning(const ExportReport& report);

/// Returns a few lines for a person.
[[nodiscard]] std::string export_text(const ExportReport& report);

/// Returns one JSON object, which export.schema.json describes.
[[nodiscard]] std::string export_json(const ExportReport& report);

}  // namespace cdprep::report
