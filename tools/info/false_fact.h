// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "cdprep/advanced/parallel_for.h"
#include "cdprep/model.h"

namespace cdprep::cli {

/// A recorded fact that is not true of the mesh in the same file.
struct FalseFact {
    std::string field;     ///< which: "section verdicts, element 0, field euler"
    std::string found;     ///< what the file says
    std::string expected;  ///< what its mesh gives
};

/// Compares what a file records about its mesh with the mesh: the flags of the header, the
/// order of vertices, degenerate bits, bounds, components, verdicts and mass properties.
/// Everything that bake decides exactly is decided again and must be equal.
///
/// Sums are computed again by the functions that bake uses. Those of verdicts and components
/// are compared bit by bit where the file holds source_triangle. Without it their order is
/// not known, nor that of the components, and they are compared within their rounding error,
/// as mass properties always are (convex/mass_error.h). An oriented box is not computed
/// again: it must contain every vertex, up to the rounding of this check, and be no larger
/// than the box along the axes.
///
/// `model` is a file in which format::find_deep_damage() finds nothing, opened with all its
/// sections. Facts about sections that the file does not hold are not looked at. Costs about
/// as much as finding the defects of a mesh (mesh::find_defects). Allocates.
[[nodiscard]] std::optional<FalseFact> find_false_fact(const Model& model,
                                                       ParallelFor parallel_for = serial_for);

/// A sentence for people: the file, the field, both values, and what to do next.
[[nodiscard]] std::string false_fact_sentence(const std::string& file, const FalseFact& fact);

}  // namespace cdprep::cli
