// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "cdprep/format/verdict.h"
#include "mesh/component_numbers.h"
#include "mesh/nesting.h"
#include "validate/defects/boundary.h"
#include "validate/defects/edge_flaws.h"
#include "validate/defects/meetings.h"
#include "validate/defects/orientability.h"
#include "validate/defects/sound_mesh.h"
#include "validate/defects/surface_measures.h"

namespace cdprep::mesh {

/// The inputs of make_verdicts(). References must outlive the call.
struct VerdictGrounds {
    const SoundMesh& sound;
    const ComponentNumbers& components;
    const EdgeFlaws& flaws;  ///< its list of boundary edges may have moved to `boundary`
    const Boundary& boundary;
    const std::vector<NonOrientable>& non_orientable;
    const std::vector<bool>& balanced;
    const SurfaceMeasures& measures;
    const std::vector<Nested>& nested;
    const ComponentMeetings* meetings;  ///< null: not examined
};

/// Returns the verdict on the whole, then on each component. A triangle that repeats a corner
/// counts with the component of its first vertex that has one.
[[nodiscard]] std::vector<format::Verdict> make_verdicts(const VerdictGrounds& grounds);

}  // namespace cdprep::mesh
