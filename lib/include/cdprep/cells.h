// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/format/api.h"

namespace cdprep {

struct CellSearches;

/// Returns the searches through octrees and tetra-trees, for a Workspace. The library cdprep::cells
/// defines this function. A program links that library only if its queries use these structures.
///
///     cdprep::Workspace workspace(cdprep::cells());
///     pair.options.through = cdprep::Structure::octree;
///     bool hit = collide(pair, workspace).hit == cdprep::Answer::yes;
[[nodiscard]] CDPREP_API const CellSearches& cells() noexcept;

}  // namespace cdprep
