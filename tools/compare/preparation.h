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

/// What the exact hull of a mesh came to, and the one of few vertices around it.
struct HullFigures {
    Timing one;  ///< on one thread
    int dimension = -1;
    std::size_t vertices = 0;
    std::size_t facets = 0;
    std::size_t groups = 0;              ///< maximal coplanar faces
    std::size_t enclosing_vertices = 0;  ///< 0: there is none
    double enclosing_distance = 0;       ///< from the exact hull at most, of a diagonal of 1
};

/// What the hierarchy of boxes came to.
struct HierarchyFigures {
    Timing one;    ///< as bake builds it, on one thread
    Timing all;    ///< on all; by the wall
    Timing swept;  ///< with PQP's volumes, on one thread
    std::uint64_t bytes = 0;
    std::uint64_t swept_bytes = 0;
};

/// What the convex pieces came to.
struct PieceFigures {
    double seconds_all = 0;               ///< pieces and hierarchy, on all threads, by the wall
    std::optional<double> seconds_one{};  ///< on one thread; nothing where that was left out
    std::size_t pieces = 0;
    std::size_t contained = 0;      ///< of them, whose hull does not leave the solid
    std::size_t virtual_faces = 0;  ///< facets of hulls that are no triangles of the mesh
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
    bool pieces_alone = true;  ///< find the pieces on one thread once more
    ParallelFor parallel_for = serial_for;
    std::function<bool()> stop{};
};

/// Builds hull and hierarchy anew, and describes the pieces that `forms` has.
[[nodiscard]] Preparation measure_preparation(const StudyMesh& mesh, const ModelForms& forms,
                                              const PreparationOptions& options);

/// Table 3 as it was printed.
[[nodiscard]] Table preparation_table(const std::vector<StudyMesh>& meshes,
                                      const std::vector<Preparation>& prepared);
/// What else is known of each.
[[nodiscard]] Table preparation_details(const std::vector<StudyMesh>& meshes,
                                        const std::vector<Preparation>& prepared);
/// What Table 3 says of the order of structures.
[[nodiscard]] std::vector<Check> preparation_checks(const std::vector<StudyMesh>& meshes,
                                                    const std::vector<Preparation>& prepared);

}  // namespace cdprep::study
