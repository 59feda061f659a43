// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "cdprep/advanced/structure.h"
#include "cdprep/cells/overlap_through.h"
#include "cdprep/model.h"
#include "cdprep/pairs.h"
#include "cdprep/pose.h"
#include "cdprep/workspace.h"
#include "compare/pair_study.h"
#include "study/table.h"

namespace cdprep::study {

/// The triangles that each step of the search in Ponce Atencio's talk leaves of two models, and the
/// pairs that its literal form finds. Numbers of triangles; means where several poses were added
/// up.
struct Pruning {
    double pairs = 0;         ///< overlapping pairs
    double found = 0;         ///< of them, by the literal form
    double cs_a = 0;          ///< triangles of A in those pairs
    double cs_b = 0;          ///< triangles of B
    double literal_cs_a = 0;  ///< the same for the pairs found
    double literal_cs_b = 0;
    double all_b = 0;      ///< triangles of B
    double box_b = 0;      ///< of them, those that touch A's axis-aligned box
    double cluster_b = 0;  ///< in clusters of 64 that A's oriented box does not clip
    double slab_b = 0;     ///< in those of these clusters that groups_in_slabs() keeps
    double leaf_b = 0;     ///< in leaves of the BVH that A's oriented box does not clip
    double pcs_b = 0;      ///< that it does not clip: the potentially colliding set
    double held_b = 0;     ///< of the model with fewer triangles, in leaves with boxes that meet
                           ///< cells of the other: the repaired form keeps these
    double listed_literal = 0;   ///< triangles of A that the cells found list, each time
    double listed_repaired = 0;  ///< the same for the repaired form
    double lost = 0;  ///< pairs of which the leaves, clusters or slabs do not keep both triangles

    Pruning& operator+=(const Pruning& other) noexcept;
    /// Divides every number by `count`.
    Pruning& operator/=(double count) noexcept;
};

/// Runs that search for one placement; both models have hashed octrees. Sets `missed` to the pairs
/// that the literal form misses.
[[nodiscard]] Pruning prune(const Model& a, const Model& b, const Pose& a_from_b, CellSearch search,
                            Workspace& workspace, std::vector<TrianglePair>& missed);

/// The steps that look at whole models, by rising cost. A number is 1 if the shapes around the
/// models meet, otherwise 0. Means of several poses are shares.
struct ObjectPruning {
    double boxes = 0;     ///< boxes along the axes of the world
    double oriented = 0;  ///< boxes along the axes of each model
    double hulls = 0;     ///< convex hulls, which may also be apart by the rounding of moved points

    ObjectPruning& operator+=(const ObjectPruning& other) noexcept;
    /// Divides every number by `count`.
    ObjectPruning& operator/=(double count) noexcept;
};

/// Returns those steps for one placement. Both models have the hull of the whole and a diagonal of
/// about 1, and are near each other.
[[nodiscard]] ObjectPruning prune_objects(const Model& a, const Model& b, const Pose& a_from_b);

/// Returns whether no step rules the models out.
[[nodiscard]] bool keeps_models(const ObjectPruning& pruning) noexcept;

/// Returns the figures of some pairs of models: a row per pair and stratum. `forms` are those of
/// the meshes, by index.
[[nodiscard]] Table pruning_table(const std::vector<StudyMesh>& meshes,
                                  const std::vector<PairStudy>& studies,
                                  std::span<const ModelForms* const> forms);

/// Returns the checks of the claims in Ponce Atencio's talk, and of what holds for any search.
[[nodiscard]] std::vector<Check> pruning_checks(const Table& table);

}  // namespace cdprep::study
