// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/advanced/section_list.h"
#include "cdprep/cells/build_adaptive_octree.h"
#include "cdprep/cells/build_octree.h"
#include "cdprep/cells/build_tetra_tree.h"
#include "cdprep/format/api.h"

namespace cdprep::build {

/// Adds the arrays of an octree. The wanted set of the list decides which tables and boxes the
/// model has. Empty arrays do not show this, because a mesh without triangles has only empty ones.
CDPREP_API void add_sections(SectionList& list, const Octree& octree);
CDPREP_API void add_sections(SectionList& list, const AdaptiveOctree& octree);  ///< likewise
CDPREP_API void add_sections(SectionList& list, const TetraTree& tetra);        ///< likewise

}  // namespace cdprep::build
