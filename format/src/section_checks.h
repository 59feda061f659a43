// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "cdprep/format/find_damage.h"

namespace cdprep::format {

/// Finds a missing section of the hulls. The file's table must lie inside it. Reads no section.
[[nodiscard]] std::optional<Damage> find_missing_hulls(std::span<const std::byte> file) noexcept;

/// Proves that the hulls are safe to query, if the file has any and `wanted` contains sections 44
/// to 49 and 60. The file must have no missing sections.
///
/// Parts must have no gaps and agree in number with the dimension. Every point must be finite and
/// within reach. Facets must form a closed surface, and groups must follow each other. Neighbours
/// and starts must be points. Does not check that they are the convex hulls.
[[nodiscard]] std::optional<Damage> find_hull_damage(std::span<const std::byte> file,
                                                     SectionSet wanted) noexcept;

/// Finds a missing section of the tetra-tree, or missing triangles. The file's table must lie
/// inside it. Reads no section.
[[nodiscard]] std::optional<Damage> find_missing_tetra(std::span<const std::byte> file) noexcept;

/// Proves that the tetra-tree is safe to query, if the file has one and `wanted` contains sections
/// 36 to 39. The file must have no missing sections.
///
/// The tree must be no deeper than it states. Keys must continue their parents' keys, and radii
/// must be in order. Lists must contain triangle numbers and rise. The table must agree with the
/// nodes. Does not check that leaves list the triangles that touch them.
[[nodiscard]] std::optional<Damage> find_tetra_damage(std::span<const std::byte> file,
                                                      SectionSet wanted) noexcept;

/// Finds a missing section of the adaptive octree, or missing triangles. The file's table must lie
/// inside it. Reads no section.
[[nodiscard]] std::optional<Damage> find_missing_adaptive_octree(
    std::span<const std::byte> file) noexcept;

/// Proves that the adaptive octree is safe to query, if the file has one and `wanted` contains
/// sections 33 to 35. The file must have no missing sections.
///
/// The tree must be no deeper than it states, and its links must lead forward. Splits must lie
/// inside the boxes that the splits above define. Leaves' lists must contain triangle numbers and
/// rise. Does not check that leaves list the triangles that touch them.
[[nodiscard]] std::optional<Damage> find_adaptive_octree_damage(std::span<const std::byte> file,
                                                                SectionSet wanted) noexcept;

/// Finds a missing section of the pieces, or missing triangles. Also finds section 57 or 59 without
/// pieces, and convexity without triangles. The file's table must lie inside it. Reads no section.
[[nodiscard]] std::optional<Damage> find_missing_pieces(std::span<const std::byte> file) noexcept;

/// Proves that the pieces are safe to query, if the file has some and `wanted` contains sections 50
/// to 53. The file must have no missing sections.
///
/// Pieces must follow each other. They must name existing triangles and vertices, rising within
/// each piece, and as many triangles as the model has. Facets must be over their own corners and
/// agree with the dimension. If `wanted` also contains section 57, the edges of facets must be
/// paired as it states. With section 59, triangles must be in their pieces. Does not check that the
/// hulls are those of the triangles.
[[nodiscard]] std::optional<Damage> find_piece_damage(std::span<const std::byte> file,
                                                      SectionSet wanted) noexcept;

/// Finds a missing section of the BVH over pieces, or such a BVH without pieces. The file's table
/// must lie inside it. Reads no section.
[[nodiscard]] std::optional<Damage> find_missing_piece_tree(
    std::span<const std::byte> file) noexcept;

/// Proves that the BVH over pieces is safe to query. Does so if the file has one and `wanted`
/// contains sections 50, 51, 54 to 56 and 61. The file must have no missing sections, and its
/// pieces must be sound if `wanted` contains them.
///
/// The numbers of nodes and hulls must be those for its leaves. Leaves must be runs of their
/// piece's triangles, as many as the model has. Hulls must have finite corners. Does not check that
/// boxes and hulls contain what is below them.
[[nodiscard]] std::optional<Damage> find_piece_tree_damage(std::span<const std::byte> file,
                                                           SectionSet wanted) noexcept;

/// Finds a missing section of the octree: one of 25 to 27, or one of 28 to 32 if another of these
/// is present. The file's table must lie inside it. Reads no section.
[[nodiscard]] std::optional<Damage> find_missing_octree(std::span<const std::byte> file) noexcept;

/// Proves that the octree is safe to query, if the file has one and `wanted` contains sections 25
/// to 27. The file must have no missing sections.
///
/// The octree must be a tree whose leaves contain triangle numbers, so every walk ends. The wanted
/// ones of sections 28 to 32 are checked too. Sorted leaves and their table must agree with the
/// nodes. Chains must end and contain nodes of their own slot. Does not check that leaves list the
/// triangles that touch them.
[[nodiscard]] std::optional<Damage> find_octree_damage(std::span<const std::byte> file,
                                                       SectionSet wanted) noexcept;

}  // namespace cdprep::format
