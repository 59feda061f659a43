// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "support/meshes.h"

namespace cdprep::test {

/// A point, and what must be said of it.
struct HardPoint {
    Double3 at;
    bool is_on_surface = false;
    /// Of a closed mesh an integer, exactly; of an open one the generalised winding number,
    /// up to 1e-12, or nothing where that is not known.
    std::optional<double> winding = 0;
    bool is_unknown = false;  ///< the mesh is open, and nothing may be guessed
};

/// A mesh and points that are hard to tell from inside.
struct HardPoints {
    std::string id;  ///< of the catalogue: P01 ... P09, with what is special
    TestMesh mesh;
    std::vector<HardPoint> points;
};

/// The catalogue's P01 to P09: known by hand, by counting shells, or by rays in exact numbers
/// (exact_winding.h).
[[nodiscard]] std::vector<HardPoints> hard_points();

/// [low, high]^3.
[[nodiscard]] TestMesh cube_at(double low, double high);

/// A closed surface around a corner that is folded: rays from below leave through it where
/// rules that count once for each sign fail.
[[nodiscard]] TestMesh folded_corner();

}  // namespace cdprep::test
