// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/cells/build_tetra_tree.h"
#include "cells/cone_children.h"

namespace cdprep::build {

/// Fills tree.boxes and tree.oriented from its nodes and references. `exponent` is that of
/// input.scale. O(levels * references); 240 bytes of scratch a node.
void make_tetra_boxes(const TetraInput& input, std::int32_t exponent,
                      const TetraTreeOptions& options, TetraTree& tree);

}  // namespace cdprep::build
