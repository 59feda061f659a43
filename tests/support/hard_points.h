// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "support/meshes.h"

namespace cdprep::test {

/// A point and the expected results for it.
struct HardPoint {
    Double3 at;
    bool is_on_surface = false;
    /// For a balanced mesh the exact integer. For an unbalanced mesh the generalised winding
    /// number, up to 1e-12, or nothing if it is not known.
    std::optional<double> winding = 0;
    bool is_unknown = false;  ///< the mesh is unbalanced, so the result must be "unknown"
};

/// A mesh and points that are hard to classify as inside or outside.
struct HardPoints {
    std::string id;  ///< number in the catalogue, P01 ... P09, and a description
    TestMesh mesh;
    std::vector<HardPoint> points;
};

/// Returns P01 to P09 of the catalogue. Results are known by hand, from counted shells, or from
/// rays in exact numbers (exact_winding.h).
[[nodiscard]] std::vector<HardPoints> hard_points();

/// Returns the cube [low, high]^3.
[[nodiscard]] TestMesh cube_at(double low, double high);

/// Returns a closed surface around a folded corner. Rays from below leave through that corner;
/// rules that count once for each sign fail there.
[[nodiscard]] TestMesh folded_corner();

}  // namespace cdprep::test
