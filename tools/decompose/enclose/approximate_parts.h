// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "decompose/enclose/hull_error.h"
#include "decompose/enclose/solid.h"
#include "hull/convex_hull.h"
#include "mesh/mesh.h"

namespace cdprep::convex {

struct ApproximateOptions {
    /// The largest distance by which a part may stick out, in model units. The search looks for as
    /// few parts as it can.
    std::optional<double> max_error;
    /// The largest number of parts. The search looks for the smallest error. With both limits, the
    /// looser one counts: the search does not go below max_error.
    std::optional<std::size_t> max_parts;
    /// The largest number of vertices of a hull; 0: any number, else at least
    /// kFewestEnclosingVertices. Hulls with more vertices are enclosed in hulls with this many.
    /// Errors are those of the final hulls.
    std::uint32_t max_vertices = 0;
    Reference reference = Reference::solid;
    /// Lets one part enclose several components and nodes.
    bool merge_components = false;
    /// The node of each triangle. A part stays within one node. Empty: one node.
    std::span<const std::uint32_t> node_of;
    /// For each node, 1 if it becomes its hull as one part, whatever the error. Empty: none does.
    std::span<const std::uint8_t> convex_node;
    /// The search budget, in units of about ten nanoseconds of one core; reading the mesh is not
    /// included. Distance fields, cells, searches at successive errors and the final bounds share
    /// it. Each takes at most a share of the rest. Work is counted, not timed, so results do not
    /// depend on the machine. If the budget does not suffice, the result is looser than requested
    /// and reports that.
    std::size_t work = 1'000'000'000;
    ParallelFor parallel_for = serial_for;
};

/// One convex part.
struct ApproximatePart {
    ConvexHull hull;  ///< `numbers` is empty: vertices may lie where triangles were cut
    HullError error;  ///< how far the part sticks out
    std::uint32_t node = 0;
    std::vector<std::uint32_t> triangles;  ///< that lie in it, whole or cut; ascending
};

/// The proof that the parts contain the surface. It is exact for the numbers as stored. Each
/// triangle is cut into fragments that cover it; each fragment lies in one hull.
struct EnclosureProof {
    std::uint64_t triangles = 0;
    std::uint64_t fragments = 0;
    std::uint64_t tests = 0;    ///< of a corner against a facet
    std::uint64_t outside = 0;  ///< corners found outside their hull: 0
};

struct ApproximateParts {
    std::vector<ApproximatePart> parts;
    /// Proved: no point of a part is farther from the solid (or surface). 0 is exact: no point
    /// sticks out.
    double outer_error = 0;
    double outer_lower = 0;  ///< some point is this far out, up to rounding
    double inner_error = 0;  ///< of the surface from the parts: 0, by the proof
    EnclosureProof proof;
    bool is_as_asked = true;  ///< max_error and max_parts are both met
    bool ran_out_of_work = false;
    std::size_t work = 0;  ///< work done, in units of ApproximateOptions::work
};

/// Encloses a mesh in convex parts that stick out of it by little.
///
/// The hulls contain every point of the surface and of the solid. Holes and slots wider than twice
/// outer_error stay open, because no point of a part is farther from the solid. A convex body
/// becomes its hull, exactly, with error 0. A body with few plane faces becomes parts cut along
/// those faces, with the error of rounding. This applies if that many parts are allowed and the
/// search finds no fewer within the error. Components that are not balanced count as surfaces. No
/// triangles give no parts.
///
/// `mesh` may be open, cross itself or have no volume. Coordinates may have any size up to
/// format::kMaxCoordinate. At a size of less than 2^-1000, hulls and errors are rounded outwards to
/// subnormal numbers. The parts are the same, to the last bit, for any parallel_for.
[[nodiscard]] ApproximateParts find_approximate_parts(const mesh::Mesh& mesh,
                                                      const ApproximateOptions& options);

}  // namespace cdprep::convex
