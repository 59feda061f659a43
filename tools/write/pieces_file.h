// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "cdprep/result.h"
#include "write/mesh_file.h"

namespace cdprep::write {

/// The triangles of each piece: piece i has triangles[first[i]] to triangles[first[i + 1] - 1].
struct PieceLists {
    std::span<const std::uint32_t> triangles;
    std::span<const std::uint32_t> first;  ///< one entry more than pieces
};

/// Writes a mesh cut into pieces. OBJ has a group with the triangles of each piece: "piece_0"
/// and so on. PLY has the triangles in the mesh's own order, each with the colour of its piece
/// and the piece's number as property "piece". Other formats have no groups; they fail with
/// `bad_argument`. The file appears under its name when it is complete.
[[nodiscard]] Result<Done> write_pieces(const std::filesystem::path& path, const MeshArrays& mesh,
                                        const PieceLists& pieces);

}  // namespace cdprep::write
