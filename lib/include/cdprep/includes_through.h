// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/containment.h"
#include "cdprep/structure.h"

namespace cdprep {

/// Returns what includes() returns, through another structure of the file: the
/// tetra-tree looks at the triangles of one cone alone, the octrees at the cells along a
/// ray. As exact as includes(); an open model's answer is includes()' own. The file must
/// have what sections_of() names.
[[nodiscard]] Inclusion includes_through(Structure structure, const Model& model, const Double3& p,
                                         Workspace& workspace) noexcept;

}  // namespace cdprep
