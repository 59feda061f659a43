// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "compare/pair_study.h"
#include "study/table.h"

namespace cdprep::study {

/// Table 4 as it was printed: a row a pair, collide and overlap of the paper's strategies at
/// its setting, over the deep poses.
[[nodiscard]] Table pair_table(const std::vector<StudyMesh>& meshes,
                               const std::vector<PairStudy>& studies);
/// Everything measured of one pair: a row a strategy.
[[nodiscard]] Table pair_details(const std::vector<StudyMesh>& meshes, const PairStudy& study);
/// What a strategy takes over the deep poses, or why nothing stands there.
[[nodiscard]] Cell deep_cell(const PairStudy& study, const Contender& contender, Asked asked);
/// What Table 4 says of the order of strategies, and what must hold of any, pair by pair.
[[nodiscard]] std::vector<Check> pair_checks(const std::vector<StudyMesh>& meshes,
                                             const std::vector<PairStudy>& studies);

}  // namespace cdprep::study
