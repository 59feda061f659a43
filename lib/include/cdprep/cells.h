// SPDX-License-Identifier: MIT
#pragma once

namespace cdprep {

struct CellSearches;

/// The searches through octrees and tetra-trees, for a Workspace. Defined in the library
/// cdprep::cells, which a program links only when it asks questions through these structures.
///
///     cdprep::Workspace workspace(cdprep::cells());
///     pair.options.through = cdprep::Structure::octree;
///     bool hit = collide(pair, workspace).hit == cdprep::Answer::yes;
[[nodiscard]] const CellSearches& cells() noexcept;

}  // namespace cdprep
