// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "import/named_runs.h"
#include "import/source_file.h"
#include "mesh/mesh.h"

namespace cdprep::import {

/// A corner that must be resolved when all vertices are known.
struct OddCorner {
    std::size_t slot;       ///< place in PolygonChunk::corners
    std::int64_t found;     ///< the index as written in the file
    std::int64_t vertex;    ///< counted from the first vertex of the chunk or of the file
    bool from_chunk_start;  ///< `vertex` counts from the first vertex of the chunk
};

/// The vertices and faces of one contiguous part of a file, in file order.
///
/// A corner below kFromChunkStart is a vertex number of the file, counted from
/// 0, in range or not. A corner with that bit is one of the chunk's own vertices. A
/// corner that neither can express is in `odd` and counts as out of range until
/// join_chunks() resolves it.
struct PolygonChunk {
    static constexpr std::uint32_t kFromChunkStart = 0x80000000;

    std::vector<mesh::Double3> positions;
    bool single_precision = true;        ///< of all positions, as in TriangleSoup
    std::vector<std::uint32_t> corners;  ///< of all faces, one after the other
    /// The number of corners per face; empty while every face is a triangle.
    std::vector<std::uint32_t> sizes;
    std::vector<OddCorner> odd;         ///< sorted by slot
    std::vector<NamedStart> groups;     ///< triangles counted from the chunk's first
    std::vector<NamedStart> materials;  ///< likewise
    std::uint64_t triangle_count = 0;

    /// Ends a face of the last `count` corners. Faces of fewer than three corners give no
    /// triangle but keep their number.
    void end_face(std::size_t count) {
        if (count != 3 && sizes.empty()) sizes.assign((corners.size() - count) / 3, 3);
        if (count != 3 || !sizes.empty()) sizes.push_back(static_cast<std::uint32_t>(count));
        triangle_count += count < 3 ? 0 : count - 2;
    }

    /// Adds a corner. `found` is the number in the file, `vertex` the same number counted from 0.
    /// Any number is permitted.
    void add_corner(std::int64_t found, std::int64_t vertex) {
        if (vertex >= 0 && vertex < kFromChunkStart) {
            corners.push_back(static_cast<std::uint32_t>(vertex));
        } else {
            odd.push_back({corners.size(), found, vertex, false});
            corners.push_back(0);
        }
    }
};

}  // namespace cdprep::import
