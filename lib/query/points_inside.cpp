// SPDX-License-Identifier: MIT
#include "cdprep/format/float_environment.h"
#include "cdprep/points.h"
#include "core/require.h"
#include "walk/cell_searches.h"
#include "walk/inclusion.h"

namespace cdprep {

Inclusion points_inside(const Model& model, const Double3& p, Workspace& workspace,
                        Structure through) noexcept {
    const format::FloatEnvironment environment;
    require(model, Ask::inside | ask_of(through));
    // Pieces serve no query about one model; the BVH answers it.
    const bool by_bvh = through == Structure::bvh || through == Structure::pieces ||
                        !model.is_balanced() || model.triangle_count() == 0;
    return by_bvh ? inclusion({model, nullptr}, p, workspace.storage())
                  : require_cells(workspace).points_inside(model, p, workspace, through);
}

}  // namespace cdprep
