// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <vector>

#include "compare/pair_study.h"
#include "compare/peer_answers.h"
#include "study/study_mesh.h"
#include "study/table.h"

namespace cdprep::study {

/// The reasons why libraries were not measured, by key: one for each peer in a table.
using PeerReasons = std::map<std::string, std::string>;

/// Returns this reason for every library in the tables.
[[nodiscard]] PeerReasons all_absent(const std::string& reason);

/// Returns the build times of other libraries: a row per mesh. `runs` has one entry per mesh, or
/// none if no library was measured.
[[nodiscard]] Table peer_build_table(const std::vector<StudyMesh>& meshes,
                                     const std::vector<PeerRun>& runs, const PeerReasons& reasons);

/// Returns the times of other libraries for each pair, over the deep poses, beside the exact
/// BVH: a row per pair. Peers that add_peer() did not add get their reason.
[[nodiscard]] Table peer_pair_table(const std::vector<StudyMesh>& meshes,
                                    const std::vector<PairStudy>& studies,
                                    const PeerReasons& reasons);

}  // namespace cdprep::study
