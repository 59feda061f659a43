// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "command_line/command_line.h"
#include "mesh/mesh.h"

namespace cdprep::cli {

/// Returns true if the path of a node or group marks geometry that an engine collides with and does
/// not show. Its name starts with UCX_, UBX_, USP_ or UCP_ (Unreal), or ends in -colonly or
/// -convcolonly (Godot). Or a node `colliders` is above it (`cdprep export --for unity`).
[[nodiscard]] bool is_collider(std::string_view path) noexcept;

/// Removes the colliders from a soup: their triangles, and the vertices that only these use. They
/// are nodes, or groups of a file without nodes. Returns their paths, each once. Triangles and
/// vertices are then numbered without them. Faces keep their numbers. Removes nothing from a soup
/// that has nothing else, nor from one with bad numbers.
[[nodiscard]] std::vector<std::string> leave_out_colliders(mesh::TriangleSoup& soup);

/// Returns the paths of the colliders that leave_out_colliders() would remove.
[[nodiscard]] std::vector<std::string> find_colliders(const mesh::TriangleSoup& soup);

/// Returns the sentences that tell what leave_out_colliders() returned.
[[nodiscard]] std::string left_out_text(std::span<const std::string> paths);

/// Returns the sentences that tell what find_colliders() returned. The last is "Leave them out
/// WAY."
[[nodiscard]] std::string kept_text(std::span<const std::string> paths, const std::string& way);

/// Adds --with-colliders to a command that leaves colliders out.
void add_with_colliders(const Command& command, bool& with_colliders);

/// Adds --without-colliders to a command that keeps colliders, and says so.
void add_without_colliders(const Command& command, bool& without_colliders);

}  // namespace cdprep::cli
