// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>
#include <vector>

#include "cdprep/cells/build_octree.h"
#include "cell_searches/pointer_octrees.h"
#include "cell_searches/search_contenders.h"

namespace cdprep::study::search {

/// All forms of one octree; the contenders refer to it.
struct Forms {
    explicit Forms(build::Octree made) : octree(std::move(made)) {}

    build::Octree octree;
    PointerOctree<BoxNode> boxes = box_octree(octree.grid, octree.nodes);
    PointerOctree<CentreNode> centres = centre_octree(octree.grid, octree.nodes);
    PointerOctree<PlainNode> plain = plain_octree(octree.nodes);
};

/// Returns every way to find the leaf of a point from its coordinates:
///
///   H0  descends recursively and tests the children's boxes      pointers
///   H1  descends and compares the point with each node's centre  pointers
///   H2  descends by the bits of the point's code                 pointers
///   H3  the same in the product's nodes                          numbers and masks
///   K0  looks its key up, from the deepest level up, in a chained table by modulus
///       (Ponce Atencio's talk)
///   K1  the same with mixed keys
///   K2  bisects the levels in K1's table, which holds all ancestors of a leaf
///   L1  bisects the sorted leaves without branches
///   L2  the same, starting from a top table: the product's default
///
/// The forms must outlive the contenders.
[[nodiscard]] std::vector<Contender> search_contenders(const Forms& forms);

}  // namespace cdprep::study::search
