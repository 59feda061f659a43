// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "cdprep/result.h"
#include "import/polygon_chunk.h"
#include "import/source_file.h"
#include "mesh/mesh.h"
#include "mesh/triangulate_polygon.h"

namespace cdprep::import {

/// The places where TriangleSoup::face starts from 0 again.
enum class FaceNumbers : std::uint8_t { once, every_chunk };

struct JoinOptions {
    /// The number that the format gives the first vertex: 1 in OBJ, else 0.
    std::int64_t first_index = 0;
    FaceNumbers face_numbers = FaceNumbers::once;
    std::uint64_t memory_bytes = ~std::uint64_t{0};
    std::uint64_t max_polygon_steps = mesh::kMaxPolygonSteps;
    ParallelFor parallel_for = serial_for;
};

/// Joins chunks in file order into one soup.
///
/// Numbers vertices and triangles consecutively and triangulates polygons. Lists non-finite
/// vertices and triangles with a corner out of range. Builds the runs of groups and materials,
/// and turns positions into floats if all of them permit it. A polygon with a bad corner or
/// coordinate is cut into a fan. Fails with `over_budget` if the soup exceeds memory_bytes or
/// the format's limits, or if a polygon takes more than max_polygon_steps. Fails with `unreadable`
/// if there are faces but no vertex. The result does not depend on the cuts between chunks.
[[nodiscard]] Result<mesh::TriangleSoup> join_chunks(const SourceFile& file,
                                                     std::vector<PolygonChunk> chunks,
                                                     const JoinOptions& options);

/// Fills TriangleSoup::bad_numbers with the non-finite positions of a soup, followed by
/// `bad_triangles`. Those must be sorted. Also fills TriangleSoup::out_of_range.
void list_bad_numbers(mesh::TriangleSoup& soup, const std::vector<mesh::BadNumber>& bad_triangles,
                      ParallelFor parallel_for);

}  // namespace cdprep::import
