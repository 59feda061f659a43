// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "hull/convex_hull.h"
#include "decompose/enclose/hull_error.h"
#include "decompose/enclose/solid.h"
#include "mesh/mesh.h"

namespace cdprep::convex {

struct ApproximateOptions {
    /// No piece sticks out farther than this, model units; as few pieces as are found.
    std::optional<double> max_error;
    /// At most so many pieces, with the least error that is found. With both, whichever
    /// leaves more room: an error below max_error is not sought.
    std::optional<std::size_t> parts;
    /// Hulls of more vertices are enclosed in ones of as many; 0: any number. Else at least
    /// kFewestEnclosingVertices. Errors are of what comes out.
    std::uint32_t max_vertices = 0;
    Reference reference = Reference::solid;
    /// Pieces may take in several components and nodes.
    bool merge_components = false;
    /// Per triangle the node that it belongs to: pieces keep to one. Empty: one node.
    std::span<const std::uint32_t> node_of;
    /// Per node, whether it is one piece whatever the error: its hull. Empty: none.
    std::span<const std::uint8_t> convex_node;
    /// How much is looked at, in all: some ten nanoseconds of one core each, besides what
    /// reading the mesh takes. It is shared among fields of distances, cells, searches at one
    /// error after the other and the final bounds, each of which takes at most a part of what
    /// is left; counted, not timed, so that results do not depend on the machine. What is
    /// found with that is looser than asked where it does not suffice, and says so.
    std::size_t work = 1'000'000'000;
    ParallelFor parallel_for = serial_for;
};

/// One convex piece.
struct ApproximatePiece {
    ConvexHull hull;  ///< `numbers` is empty: corners may lie where triangles were cut
    HullError error;  ///< how far it sticks out
    std::uint32_t node = 0;
    std::vector<std::uint32_t> triangles;  ///< that lie in it, whole or in part; ascending
};

/// That pieces hold the surface, as it was tested: exactly, on the numbers as stored. Each
/// triangle is cut into fragments that cover it, each of which lies in one hull.
struct EnclosureProof {
    std::uint64_t triangles = 0;
    std::uint64_t fragments = 0;
    std::uint64_t tests = 0;    ///< of a corner against a facet
    std::uint64_t outside = 0;  ///< corners found outside of their hull: 0
};

struct ApproximatePieces {
    std::vector<ApproximatePiece> pieces;
    /// Proved: no point of a piece is farther from the solid (or surface). 0: exactly none is.
    double outer_error = 0;
    double outer_lower = 0;  ///< some point is that far, up to rounding
    double inner_error = 0;  ///< of the surface from the pieces: 0, by the proof
    EnclosureProof proof;
    bool is_as_asked = true;  ///< max_error, or parts
    bool ran_out_of_work = false;
    std::size_t work = 0;  ///< what was looked at, as ApproximateOptions::work counts it
};

/// Encloses a mesh in convex pieces that stick out of it little.
///
/// The hulls hold every point of the surface and of what it encloses; holes and slots wider
/// than twice outer_error stay open, for no point of a piece is farther from the solid.
/// A convex body comes back as its hull, exactly, with error 0; one with few plane faces, as
/// parts cut along those, with the error of rounding, where as many are allowed and fewer
/// within the error are not found. Components that are not closed are taken as surfaces. The same
/// pieces, to the last bit, for any parallel_for. `mesh` may be open, crossing itself, without
/// volume. Of no triangles there are no pieces.
[[nodiscard]] ApproximatePieces find_approximate_pieces(const mesh::Mesh& mesh,
                                                        const ApproximateOptions& options);

}  // namespace cdprep::convex
