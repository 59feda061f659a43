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

/// What each step of the talk's algorithm leaves of two models, and what it finds when it is
/// taken to the letter. Numbers of triangles, in the mean where poses were added up.
struct Pruning {
    double pairs = 0;         ///< that overlap
    double found = 0;         ///< of them, by the literal form
    double cs_a = 0;          ///< triangles of A in those pairs
    double cs_b = 0;          ///< of B
    double literal_cs_a = 0;  ///< the same of the pairs found
    double literal_cs_b = 0;
    double all_b = 0;   ///< triangles of B
    double box_b = 0;   ///< of them, that touch A's axis-aligned box
    double leaf_b = 0;  ///< in leaves of the hierarchy that A's oriented box does not clip
    double pcs_b = 0;   ///< that it does not clip: the potentially colliding set
    double held_b = 0;  ///< of the model with fewer triangles, in leaves with boxes that meet
                        ///< cells of the other: what the repaired form keeps
    double listed_literal = 0;   ///< triangles of A that the cells found list, each time
    double listed_repaired = 0;  ///< likewise

    Pruning& operator+=(const Pruning& other) noexcept;
    /// Every number by that.
    Pruning& operator/=(double count) noexcept;
};

/// Asks the talk's algorithm about one placement; both models have hashed octrees. `missed`
/// gets the pairs that the literal form does not find.
[[nodiscard]] Pruning prune(const Model& a, const Model& b, const Pose& a_from_b, CellSearch search,
                            Workspace& workspace, std::vector<TrianglePair>& missed);

/// The talk's figures of some pairs of models: a row a pair and stratum. `forms` are those of
/// the meshes by number.
[[nodiscard]] Table pruning_table(const std::vector<StudyMesh>& meshes,
                                  const std::vector<PairStudy>& studies,
                                  std::span<const ModelForms* const> forms);

/// What the talk claims of its algorithm, and what is true of any.
[[nodiscard]] std::vector<Check> pruning_checks(const Table& table);

}  // namespace cdprep::study
