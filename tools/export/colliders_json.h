// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hull/convex_hull.h"
#include "write/hulls_file.h"

namespace cdprep::report {

struct NamedHull {
    std::string name;
    const convex::ConvexHull* hull;  ///< of dimension 3
};

/// Convex parts for the loaders of physics engines, in model units.
struct Colliders {
    std::string name;
    double metres_per_unit = 0;           ///< 0: unknown
    std::optional<write::BodyMass> mass;  ///< of density 1 in model units
    bool is_of_solid = false;             ///< the mass is that of the solid, exactly
    double error = 0;                     ///< how far parts stick out at most
    std::vector<NamedHull> parts;
};

/// Returns the text of a JSON file, which colliders.schema.json describes. Numbers are written in
/// as many digits as read back bit for bit.
[[nodiscard]] std::string colliders_json(const Colliders& colliders);

}  // namespace cdprep::report
