// SPDX-License-Identifier: MIT
#include "cdprep/advanced/structure.h"

namespace cdprep {

Ask ask_of(Structure structure) noexcept {
    switch (structure) {
        case Structure::octree:
            return Ask::octree;
        case Structure::adaptive_octree:
            return Ask::adaptive_octree;
        case Structure::hashed_octree:
            return Ask::hashed_octree;
        case Structure::tetra_tree:
            return Ask::tetra_tree;
        case Structure::pieces:
            return Ask::pieces;
        default:
            return Ask::nothing;
    }
}

}  // namespace cdprep
