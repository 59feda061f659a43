// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "cdprep/format/find_damage.h"

namespace cdprep::format {

/// Of a file whose table lies inside it: hulls of which a part is missing. Reads no section.
[[nodiscard]] std::optional<Damage> find_missing_hulls(std::span<const std::byte> file) noexcept;

/// Of a file without missing sections: proves its hulls, if it has any and `wanted` holds
/// sections 44 to 49 and 60, to be safe to query: parts without gaps, as many as the dimension
/// asks for, every point finite and within reach, facets that close, groups that follow
/// each other, neighbours and starts that are points. Whether they are hulls is not looked
/// at.
[[nodiscard]] std::optional<Damage> find_hull_damage(std::span<const std::byte> file,
                                                     SectionSet wanted) noexcept;

/// Of a file whose table lies inside it: a tetra-tree of which a part is missing, or the
/// triangles. Reads no section.
[[nodiscard]] std::optional<Damage> find_missing_tetra(std::span<const std::byte> file) noexcept;

/// Of a file without missing sections: proves the tetra-tree, if it has one and `wanted`
/// holds sections 36 to 39, to be a tree no deeper than it says, whose keys continue their
/// parents', with lists that hold numbers of triangles, rising, radii that are in order, and
/// a table that says what the nodes say. Whether leaves list the triangles that touch them is
/// not looked at.
[[nodiscard]] std::optional<Damage> find_tetra_damage(std::span<const std::byte> file,
                                                      SectionSet wanted) noexcept;

/// Of a file whose table lies inside it: an adaptive octree of which a part is missing, or
/// the triangles. Reads no section.
[[nodiscard]] std::optional<Damage> find_missing_adaptive_octree(
    std::span<const std::byte> file) noexcept;

/// Of a file without missing sections: proves the adaptive octree, if it has one and
/// `wanted` holds sections 33 to 35, to be a tree no deeper than it says, with links that
/// lead forward, splits inside the boxes that follow from those above, and leaves whose lists
/// hold numbers of triangles, rising. Whether leaves list the triangles that touch them is
/// not looked at.
[[nodiscard]] std::optional<Damage> find_adaptive_octree_damage(std::span<const std::byte> file,
                                                                SectionSet wanted) noexcept;

/// Of a file whose table lies inside it: pieces of which a part is missing, or the triangles;
/// section 57 or 59 without pieces, convexity without triangles.
/// Reads no section.
[[nodiscard]] std::optional<Damage> find_missing_pieces(std::span<const std::byte> file) noexcept;

/// Of a file without missing sections: proves that pieces, if it has some and `wanted` holds
/// sections 50 to 53, follow each other, name triangles and vertices that there are, rising
/// within each, as many triangles as the model has, and facets over their own corners, which
/// agree with the dimension; and, if it holds sections 57 and 59 too, that the edges of those
/// facets are paired as it says, and triangles are in their pieces. Whether the hulls are those of
/// the triangles is not looked at.
[[nodiscard]] std::optional<Damage> find_piece_damage(std::span<const std::byte> file,
                                                      SectionSet wanted) noexcept;

/// Of a file whose table lies inside it: a hierarchy over pieces of which a part is missing, or
/// without pieces. Reads no section.
[[nodiscard]] std::optional<Damage> find_missing_piece_tree(
    std::span<const std::byte> file) noexcept;

/// Of a file without missing sections, whose pieces are sound if `wanted` holds them: proves that
/// the hierarchy over them, if it has one and `wanted` holds sections 50, 51, 54 to 56 and 61, has
/// as many nodes and hulls as its leaves want, leaves that are runs of their piece's triangles, as
/// many as the model has, and hulls with finite corners. Whether boxes and hulls hold what is
/// below them is not looked at.
[[nodiscard]] std::optional<Damage> find_piece_tree_damage(std::span<const std::byte> file,
                                                           SectionSet wanted) noexcept;

/// Of a file whose table lies inside it: an octree of which a part is missing, sections 25
/// to 27 or, where there is one of them, 28 to 32. Reads no section.
[[nodiscard]] std::optional<Damage> find_missing_octree(std::span<const std::byte> file) noexcept;

/// Of a file without missing sections: proves the octree, if it has one and `wanted` holds
/// sections 25 to 27, to be a tree whose leaves hold numbers of triangles, and so that every
/// walk ends; and of sections 28 to 32 those that are wanted too: sorted leaves and their
/// table say what the nodes say, chains end and hold nodes of their own slot. Whether leaves
/// list the triangles that touch them is not looked at.
[[nodiscard]] std::optional<Damage> find_octree_damage(std::span<const std::byte> file,
                                                       SectionSet wanted) noexcept;

}  // namespace cdprep::format
