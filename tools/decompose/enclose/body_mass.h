// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>

#include "decompose/enclose/approximate_pieces.h"
#include "write/hulls_file.h"

namespace cdprep::cli {

struct WeighedBody {
    write::BodyMass body;
    /// What is weighed: the pieces, each on its own, so that where they overlap counts as
    /// often; else what the mesh encloses.
    bool is_of_pieces = false;
};

/// Returns the mass of a mesh of even density: of the solid where it is closed and has a
/// volume, whichever way it is wound, else of the pieces; nothing where those have none
/// either. `density` is in kilograms per cubic metre; `metres_per_unit` 0 stands for 1.
[[nodiscard]] std::optional<WeighedBody> weigh(const mesh::Mesh& mesh, bool is_closed,
                                               std::span<const convex::ApproximatePiece> pieces,
                                               double density, double metres_per_unit);

}  // namespace cdprep::cli
