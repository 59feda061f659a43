// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "cdprep/result.h"
#include "import/polygon_chunk.h"
#include "import/source_file.h"
#include "mesh/mesh.h"

namespace cdprep::import {

/// Where TriangleSoup::face starts from 0 again.
enum class FaceNumbers : std::uint8_t { once, every_chunk };

struct JoinOptions {
    /// The number that the format gives the first vertex: 1 in OBJ, else 0.
    std::int64_t first_index = 0;
    FaceNumbers face_numbers = FaceNumbers::once;
    std::uint64_t memory_bytes = ~std::uint64_t{0};
    ParallelFor parallel_for = serial_for;
};

/// Makes one soup of chunks in file order.
///
/// Numbers vertices and triangles through, triangulates polygons, lists
/// non-finite vertices and triangles with a corner out of range, builds the runs
/// of groups and materials, and turns positions into floats where all of them
/// allow it. A polygon with a bad corner or coordinate is cut into a fan.
/// `over_budget` when the soup would not fit memory_bytes or the format's
/// limits; `unreadable` when there are faces but no vertex at all. The result
/// does not depend on how the file was cut.
[[nodiscard]] Result<mesh::TriangleSoup> join_chunks(const SourceFile& file,
                                                     std::vector<PolygonChunk> chunks,
                                                     const JoinOptions& options);

/// Lists the non-finite positions of a soup in front of `bad_triangles`, which
/// are sorted, as TriangleSoup::bad_numbers says.
void list_bad_numbers(mesh::TriangleSoup& soup, const std::vector<mesh::BadNumber>& bad_triangles,
                      ParallelFor parallel_for);

}  // namespace cdprep::import
