// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "import/named_runs.h"
#include "import/source_file.h"
#include "mesh/mesh.h"

namespace cdprep::import {

/// A corner that needs a second look once all vertices are known.
struct OddCorner {
    std::size_t slot;       ///< place in PolygonChunk::corners
    std::int64_t found;     ///< the index as the file has it
    std::int64_t vertex;    ///< counted from the chunk's first vertex, or from the file's
    bool from_chunk_start;  ///< says which
};

/// What one stretch of a file holds: its vertices and faces, in file order.
///
/// A corner below kFromChunkStart is a vertex number of the file, counted from
/// 0, in range or not. With the bit it is one of the chunk's own vertices. A
/// corner that neither can express stands in `odd` and counts as out of range
/// until join_chunks() has looked at it.
struct PolygonChunk {
    static constexpr std::uint32_t kFromChunkStart = 0x80000000;

    std::vector<mesh::Double3> positions;
    bool single_precision = true;        ///< of all positions, as TriangleSoup has it
    std::vector<std::uint32_t> corners;  ///< of all faces, one after the other
    /// Corners per face; empty as long as every face is a triangle.
    std::vector<std::uint32_t> sizes;
    std::vector<OddCorner> odd;         ///< sorted by slot
    std::vector<NamedStart> groups;     ///< triangles counted from the chunk's first
    std::vector<NamedStart> materials;  ///< likewise
    std::uint64_t triangle_count = 0;

    /// Ends a face of the last `count` corners. Faces of fewer than three give no
    /// triangle but keep their number.
    void end_face(std::size_t count) {
        if (count != 3 && sizes.empty()) sizes.assign((corners.size() - count) / 3, 3);
        if (count != 3 || !sizes.empty()) sizes.push_back(static_cast<std::uint32_t>(count));
        triangle_count += count < 3 ? 0 : count - 2;
    }

    /// Adds a corner that is any number, `found` in the file, `vertex` from 0.
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
