// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "bake/bake_report.h"
#include "bake/stages.h"
#include "bake/structures.h"
#include "cdprep/advanced/build_bvh.h"
#include "cdprep/result.h"
#include "cli/program_threads.h"
#include "decompose/surface/piece_arrays.h"
#include "mesh/mesh.h"

namespace cdprep::cli {

/// Builds the chosen octrees and tetra-trees over a mesh in tree order. They hold triangle numbers
/// in this order.
[[nodiscard]] Structures build_structures(const mesh::Mesh& ordered, const build::Frame& frame,
                                          StructureChoice choice, const Threads& threads,
                                          Stages& stages);

struct BuiltHulls {
    convex::HullSections sections;
    std::optional<report::BakedParts> parts;  ///< the parts that enclose the mesh, if chosen
};

/// Builds hulls over the mesh in source order; components and instances are numbered in this order.
/// Errors name `input`.
[[nodiscard]] Result<BuiltHulls> build_hulls(const std::filesystem::path& input,
                                             const mesh::TriangleSoup& soup, const mesh::Mesh& mesh,
                                             const HullChoice& choice, const Threads& threads);

/// Decomposes the surface of a mesh in tree order into convex pieces, each vertex at most
/// `tolerance` above the triangles of its piece.
[[nodiscard]] convex::PieceArrays build_pieces(const mesh::Mesh& ordered, double tolerance,
                                               const Threads& threads);

[[nodiscard]] std::vector<report::StructureReport> structure_reports(const StructureChoice& choice,
                                                                     const Structures& built,
                                                                     const mesh::Mesh& mesh);

}  // namespace cdprep::cli
