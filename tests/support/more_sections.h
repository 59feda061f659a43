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

/// A section's id and the bytes of its elements.
template <class T>
TinySection as_section(SectionId id, std::span<const T> elements) {
    const std::span<const std::byte> bytes = std::as_bytes(elements);
    return {id, {bytes.begin(), bytes.end()}};
}

/// The same file with these sections too, which it does not have.
[[nodiscard]] AlignedBytes with_sections(
    const AlignedBytes& file, std::vector<TinySection> sections,
    std::uint64_t section_alignment = format::kSectionAlignment);

/// The same file, its sections on pages of their own (GuardedPages).
[[nodiscard]] AlignedBytes on_pages(const AlignedBytes& file);

/// What builders take, of a model that is open: tree order, double precision.
struct BuilderInput {
    std::vector<Double3> positions;
    std::vector<Triangle> triangles;
};
[[nodiscard]] BuilderInput builder_input(const Model& model);

/// The same file with an octree, an adaptive octree, a tetra-tree over its triangles. To
/// have several, ask in this order. Boxes, where they are asked for, are in the frame of the
/// file, whatever options.boxes_in says.
[[nodiscard]] AlignedBytes with_octree(const AlignedBytes& file, build::OctreeOptions options = {});
[[nodiscard]] AlignedBytes with_adaptive_octree(const AlignedBytes& file,
                                                build::AdaptiveOctreeOptions options = {});
/// Radii are in the frame of the file.
[[nodiscard]] AlignedBytes with_tetra_tree(const AlignedBytes& file,
                                           build::TetraTreeOptions options = {});

/// The same file with the hull around the whole, and the same again as that of component 0: an
/// enclosing one, so that no point has to name a vertex, with groups, neighbours and starts.
/// Without hulls where all vertices lie in one plane, and with one of nothing without vertices.
[[nodiscard]] AlignedBytes with_hulls(const AlignedBytes& file);

/// The same file with every triangle as a convex piece of its own.
[[nodiscard]] AlignedBytes with_pieces(const AlignedBytes& file);

/// The same file with one piece, all of it, which is contained: for a closed convex mesh.
[[nodiscard]] AlignedBytes with_one_piece(const AlignedBytes& file);

/// The same file, which has pieces, with what contacts need besides. How edges bend is made up:
/// every way occurs.
[[nodiscard]] AlignedBytes with_contacts(const AlignedBytes& file);

}  // namespace cdprep::test
