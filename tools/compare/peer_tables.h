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

/// Why libraries were not asked, by their key: a reason for each of peers that a table has.
using PeerReasons = std::map<std::string, std::string>;

/// Of every library that tables have, that reason.
[[nodiscard]] PeerReasons all_absent(const std::string& reason);

/// What other libraries take to build their structures: a row a mesh. `runs` are one a mesh, or
/// none when nobody was asked.
[[nodiscard]] Table peer_build_table(const std::vector<StudyMesh>& meshes,
                                     const std::vector<PeerRun>& runs, const PeerReasons& reasons);

/// What other libraries take to answer about each pair, over the deep poses, beside the exact
/// hierarchy: a row a pair. Of peers that add_peer() has not set there it says why.
[[nodiscard]] Table peer_pair_table(const std::vector<StudyMesh>& meshes,
                                    const std::vector<PairStudy>& studies,
                                    const PeerReasons& reasons);

}  // namespace cdprep::study
