// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "support/tiny_baker.h"

#include "cdprep/cells/build_adaptive_octree.h"
#include "cdprep/cells/build_octree.h"
#include "cdprep/cells/build_tetra_tree.h"
#include "cdprep/model.h"

namespace cdprep::test {

/// Returns a section's id and the bytes of its elements.
template <class T>
TinySection as_section(SectionId id, std::span<const T> elements) {
    const std::span<const std::byte> bytes = std::as_bytes(elements);
    return {id, {bytes.begin(), bytes.end()}};
}

/// Returns the file with additional sections. It must not have them already.
[[nodiscard]] AlignedBytes with_sections(
    const AlignedBytes& file, std::vector<TinySection> sections,
    std::uint64_t section_alignment = format::kSectionAlignment);

/// Returns the file with each section on pages of its own (for GuardedPages).
[[nodiscard]] AlignedBytes on_pages(const AlignedBytes& file);

/// The input of builders, taken from an open model: tree order, double precision.
struct BuilderInput {
    std::vector<Double3> positions;
    std::vector<Triangle> triangles;
};
[[nodiscard]] BuilderInput builder_input(const Model& model);

/// Each returns the file with an additional structure over its triangles: an octree, an adaptive
/// octree, a tetra-tree. To add several, call these functions in this order. Boxes, if requested,
/// are in the frame of the file, whatever options.boxes_in is.
[[nodiscard]] AlignedBytes with_octree(const AlignedBytes& file, build::OctreeOptions options = {});
[[nodiscard]] AlignedBytes with_adaptive_octree(const AlignedBytes& file,
                                                build::AdaptiveOctreeOptions options = {});
/// Radii are in the frame of the file.
[[nodiscard]] AlignedBytes with_tetra_tree(const AlignedBytes& file,
                                           build::TetraTreeOptions options = {});

/// Returns the file with the hull of the whole model, and the same hull again for component 0. It
/// is an enclosing hull, so no point has to name a vertex, and has groups, neighbours and starts.
/// If all vertices lie in one plane, adds no hull. If there are no vertices, adds an empty hull.
[[nodiscard]] AlignedBytes with_hulls(const AlignedBytes& file);

/// Returns the file with every triangle as a convex piece of its own.
[[nodiscard]] AlignedBytes with_pieces(const AlignedBytes& file);

/// Returns the file with one contained piece, the whole mesh. The mesh must be closed and convex.
[[nodiscard]] AlignedBytes with_one_piece(const AlignedBytes& file);

/// Returns the file, which must have pieces, with the other sections for contacts. The bends of
/// edges are invented; every kind occurs.
[[nodiscard]] AlignedBytes with_contacts(const AlignedBytes& file);

}  // namespace cdprep::test
