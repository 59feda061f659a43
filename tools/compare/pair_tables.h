// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "compare/pair_study.h"
#include "study/table.h"

namespace cdprep::study {

/// Returns Table 4 as printed: a row per pair with collide and overlap of the comparative study's
/// strategies, at its settings, over the deep poses.
[[nodiscard]] Table pair_table(const std::vector<StudyMesh>& meshes,
                               const std::vector<PairStudy>& studies);
/// Returns everything measured for one pair: a row per strategy.
[[nodiscard]] Table pair_details(const std::vector<StudyMesh>& meshes, const PairStudy& study);
/// Returns the time of a strategy over the deep poses, or why there is none.
[[nodiscard]] Cell deep_cell(const PairStudy& study, const Contender& contender, Asked asked);
/// Returns the checks of each pair: the order of strategies in Table 4, and what holds for any
/// strategy.
[[nodiscard]] std::vector<Check> pair_checks(const std::vector<StudyMesh>& meshes,
                                             const std::vector<PairStudy>& studies);

}  // namespace cdprep::study
