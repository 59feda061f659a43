// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "cdprep/advanced/parallel_for.h"
#include "cdprep/model.h"

namespace cdprep::cli {

/// A recorded fact that is not true of the mesh in the same file.
struct FalseFact {
    std::string field;     ///< its place: "section verdicts, element 0, field euler"
    std::string found;     ///< the value in the file
    std::string expected;  ///< the value that the mesh gives
};

/// Returns the first fact in a file that is not true of its mesh, or nothing. The facts are the
/// flags of the header, the order of vertices, degenerate bits, bounds, components, verdicts and
/// mass properties. Facts that bake decides exactly are decided again and must be equal.
///
/// Sums are computed again by the functions that bake uses. The sums of verdicts and components
/// are compared bit by bit if the file holds source_triangle. Without it, the order of summation
/// and of components is unknown; then they are compared within their rounding error. Mass
/// properties are always compared within theirs (info/mass_error.h). The oriented box is not
/// computed again: it must contain every vertex, up to the rounding of this check. It must not be
/// larger than the box along the axes.
///
/// `model` must be a file in which format::find_deep_damage() finds nothing, opened with all its
/// sections. Facts about absent sections are not checked. Costs about as much as
/// mesh::find_defects(). Allocates.
[[nodiscard]] std::optional<FalseFact> find_false_fact(const Model& model,
                                                       ParallelFor parallel_for = serial_for);

/// Returns a message with the file, the field, both values, and the next step for the user.
[[nodiscard]] std::string false_fact_sentence(const std::string& file, const FalseFact& fact);

}  // namespace cdprep::cli
