// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "cdprep/advanced/parallel_for.h"
#include "mesh/mesh.h"

namespace cdprep::convex {

/// The winding numbers that a balanced mesh has around points in space.
enum class Windings : std::uint8_t {
    simple,   ///< proved: 0 and one other number, 1 or -1. The mesh bounds a solid
    unknown,  ///< may be others: the mesh meets itself, or its components lie in each other
    opposed,  ///< both signs: a component is inside out, but no other one is around it
};

/// Finds the winding numbers of a mesh. `opposed` is decided by the components and their nesting,
/// as if they did not cross.
///
/// Proof of `simple`. The triangles meet nowhere but at common vertices and edges. The surface is
/// closed, 2-manifold and oriented. So each component has one number on its inside and one on its
/// outside, and these follow from the nesting.
///
/// Takes O(n log n) time. If a budget that usually suffices does not, the result is `unknown`. The
/// same for any parallel_for.
[[nodiscard]] Windings find_windings(const mesh::Mesh& mesh, ParallelFor parallel_for);

/// Returns true if rounding changes the volume of a balanced mesh, as find_mass_properties()
/// computes it, by less than a thousandth. False for a volume of 0. O(n).
[[nodiscard]] bool has_known_volume(const mesh::Mesh& mesh);

}  // namespace cdprep::convex
