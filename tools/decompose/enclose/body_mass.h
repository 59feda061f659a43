// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "cdprep/advanced/parallel_for.h"
#include "hull/convex_hull.h"
#include "mesh/mesh.h"
#include "write/hulls_file.h"

namespace cdprep::cli {

/// What was weighed.
enum class MassOf : std::uint8_t {
    solid,  ///< the volume that the mesh encloses, exact up to rounding
    mesh,   ///< the same, but the mesh may meet itself: regions count by their winding numbers
    parts,  ///< the sum over the parts: overlaps count more than once
};

/// Returns the word for JSON: "solid", "mesh" or "parts".
[[nodiscard]] const char* word_of(MassOf of) noexcept;

/// Returns what follows "mass 5 kg, of ".
[[nodiscard]] std::string text_of(MassOf of);

struct WeighedBody {
    write::BodyMass body;
    MassOf of = MassOf::solid;
};

struct WeighOptions {
    bool is_balanced = false;    ///< the mesh is; false also where it counts as a surface
    double density = 1;          ///< kilograms per cubic metre
    double metres_per_unit = 1;  ///< 0 counts as 1
    ParallelFor parallel_for = serial_for;
};

/// Returns the mass of a mesh of uniform density. It is that of the mesh if this is balanced and
/// has a volume, whichever way it is wound. It is that of the parts otherwise, and if a component
/// is inside out and would count as negative. Returns nothing if the parts have no volume either. A
/// volume that rounding changes by a thousandth counts as none.
[[nodiscard]] std::optional<WeighedBody> weigh(const mesh::Mesh& mesh,
                                               std::span<const convex::ConvexHull> parts,
                                               const WeighOptions& options);

}  // namespace cdprep::cli
