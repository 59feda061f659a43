// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "accuracy/scoreboard.h"
#include "support/hard_meshes.h"

namespace cdprep::test {

/// Which cases are asked.
struct HardCaseOptions {
    CaseSize size = CaseSize::small;
    std::string family{};  ///< that ids begin with; empty: every one

    [[nodiscard]] bool wants(const std::string& id) const {
        return id.starts_with(family);
    }
};

// Each asks the cases of one feature through every way to answer that claims it, and says on
// the scoreboard what was wrong.

/// T, B and what D05 to D07 ask of overlaps: which triangles of two meshes overlap.
void score_overlaps(const HardCaseOptions& options, Scoreboard& board);
/// T: how two triangles stand, by the predicates alone, which know no instruction sets.
void score_predicates(const HardCaseOptions& options, Scoreboard& board);
/// P: which points are inside.
void score_inclusion(const HardCaseOptions& options, Scoreboard& board);
/// G: how far convex hulls are apart, and how deep in each other.
void score_hulls(const HardCaseOptions& options, Scoreboard& board);
/// X: how far two meshes are apart.
void score_distances(const HardCaseOptions& options, Scoreboard& board);
/// S12 and S13, without a simulation: overlaps of what deforms and tears.
void score_frames(const HardCaseOptions& options, Scoreboard& board);
/// B10's boxes, B14's poses, B16's files and T21's coordinates: what is refused, and what not.
void score_refusals(const HardCaseOptions& options, Scoreboard& board);
#ifdef CDPREP_HAVE_TOOLS
/// C: hulls of points.
void score_point_sets(const HardCaseOptions& options, Scoreboard& board);
/// S16 and K: contacts.
void score_contacts(const HardCaseOptions& options, Scoreboard& board);
/// D: pieces, parts, findings and repairs.
void score_surfaces(const HardCaseOptions& options, Scoreboard& board);
#endif

}  // namespace cdprep::test
