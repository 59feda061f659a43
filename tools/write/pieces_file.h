// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "cdprep/result.h"
#include "write/mesh_file.h"

namespace cdprep::write {

/// Triangles of a mesh by piece: piece i has triangles[first[i]] to triangles[first[i + 1] - 1].
struct PieceLists {
    std::span<const std::uint32_t> triangles;
    std::span<const std::uint32_t> first;  ///< one more than there are pieces
};

/// Writes a mesh cut into pieces: OBJ with a group for each, "piece_0" and so on, in which
/// its triangles stand; PLY with the triangles in the mesh's own order, each in the colour
/// of its piece and with its number as property "piece". Other formats have no groups and
/// are refused with `bad_argument`. The file appears under its name when it is whole.
[[nodiscard]] Result<Done> write_pieces(const std::filesystem::path& path, const MeshArrays& mesh,
                                        const PieceLists& pieces);

}  // namespace cdprep::write
