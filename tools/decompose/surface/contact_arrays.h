// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cdprep/format/find_damage.h"
#include "cdprep/format/pieces.h"
#include "cdprep/model.h"
#include "decompose/surface/piece_arrays.h"

namespace cdprep::convex {

/// The arrays that contacts between pieces use besides the pieces (format/pieces.h).
struct ContactArrays {
    std::vector<format::PieceAdjacency> adjacency;  ///< per facet
    std::vector<std::uint8_t> convexity;            ///< per triangle
    std::vector<std::uint32_t> piece_of;            ///< per triangle
};

/// Pairs the edges of the hulls of a mesh's pieces, and classifies exactly how the mesh bends at
/// its own edges. The same for any parallel_for. O(n log n) in the facets of a piece.
[[nodiscard]] ContactArrays make_contact_arrays(const mesh::Mesh& mesh, const PieceArrays& pieces,
                                                ParallelFor parallel_for);

/// Checks edge_convexity against the exact signs of a file's triangles. format::find_damage() must
/// find nothing in the file. Returns the first wrong value. Returns nothing if all are right, or if
/// the file has no such section. `model` is this file, opened with all its sections. O(n log n);
/// allocates.
[[nodiscard]] std::optional<format::Damage> find_convexity_falsehood(
    std::span<const std::byte> file, const Model& model);

}  // namespace cdprep::convex
