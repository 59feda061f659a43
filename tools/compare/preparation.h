// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "compare/model_forms.h"
#include "study/table.h"
#include "study/timing.h"

namespace cdprep::study {

/// The exact hull of a mesh, and a hull of few vertices around it.
struct HullFigures {
    Timing one;  ///< on one thread
    int dimension = -1;
    std::size_t vertices = 0;
    std::size_t facets = 0;
    std::size_t groups = 0;              ///< maximal coplanar faces
    std::size_t enclosing_vertices = 0;  ///< 0: there is none
    double enclosing_distance = 0;       ///< upper bound from the exact hull, for a diagonal of 1
};

/// The BVH.
struct HierarchyFigures {
    Timing one;    ///< as bake builds it, on one thread
    Timing all;    ///< on all threads; wall time
    Timing swept;  ///< with PQP's volumes, on one thread
    std::uint64_t bytes = 0;
    std::uint64_t swept_bytes = 0;
};

/// The convex pieces.
struct PieceFigures {
    double seconds_all = 0;               ///< pieces and hierarchy, on all threads; wall time
    std::optional<double> seconds_one{};  ///< on one thread; empty if that was left out
    std::size_t pieces = 0;
    std::size_t contained = 0;      ///< pieces whose hull does not leave the solid
    std::size_t virtual_faces = 0;  ///< facets of hulls that are not triangles of the mesh
    std::uint64_t bytes = 0;
    std::size_t border_edges = 0;
    std::size_t non_manifold_edges = 0;
    std::size_t inconsistent_edges = 0;
    std::size_t flat_edges = 0;  ///< of triangles without area, and folds
};

struct Preparation {
    HullFigures hull;
    HierarchyFigures hierarchy;
    PieceFigures pieces;
};

struct PreparationOptions {
    std::size_t rounds = 5;
    bool pieces_alone = true;  ///< finds the pieces once more on one thread
    ParallelFor parallel_for = serial_for;
    std::function<bool()> stop{};
};

/// Builds the hull and the BVH again, and describes the pieces in `forms`.
[[nodiscard]] Preparation measure_preparation(const StudyMesh& mesh, const ModelForms& forms,
                                              const PreparationOptions& options);

/// Returns Table 3 as printed.
[[nodiscard]] Table preparation_table(const std::vector<StudyMesh>& meshes,
                                      const std::vector<Preparation>& prepared);
/// Returns the other figures of each mesh.
[[nodiscard]] Table preparation_details(const std::vector<StudyMesh>& meshes,
                                        const std::vector<Preparation>& prepared);
/// Returns the checks of the order of structures in Table 3.
[[nodiscard]] std::vector<Check> preparation_checks(const std::vector<StudyMesh>& meshes,
                                                    const std::vector<Preparation>& prepared);

}  // namespace cdprep::study
