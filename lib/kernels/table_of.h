// SPDX-License-Identifier: MIT
// The body that all instruction sets share; see kernels.h. A source includes it below its lanes.
#pragma once

#include "cells_met.h"
#include "exact_leaf.h"
#include "farthest.h"
#include "kernels.h"
#include "piece_ways.h"
#include "swept_spheres.h"
#include "weak_planes.h"
#include "world_boxes.h"

namespace cdprep::kernels {
namespace {

/// Returns the kernels of an instruction set: `Wide` has eight floats or sixteen.
template <class F8, class Wide, class D8>
constexpr Table table_of(const char* name) noexcept {
    return {name,
            overlapping_boxes_of<F8, Wide>,
            overlap_depths_of<F8, Wide>,
            near_boxes_of<F8, Wide>,
            near_triangles_of<F8, Wide, Wide>,
            triangles_within_of<F8, Wide, Wide>,
            find_contacts_of<F8, Wide, Wide>,
            find_own_contacts_of<F8, Wide, Wide>,
            place_among_cells_of<F8>,
            cells_met_of<F8>,
            {kSweptTests<0, F8, Wide>, kSweptTests<1, F8, Wide>, kSweptTests<2, F8, Wide>},
            farthest_of<D8>,
            farthest_moved_of<D8>,
            reaches_of<D8>,
            edges_across_of<D8>,
            weak_planes_of<Wide>,
            met_boxes_of<F8>,
            meeting_boxes_of<F8>,
            meeting_pairs_of<F8>,
            store_boxes_of<F8>,
            fill_leaf_of<F8, D8>};
}

}  // namespace
}  // namespace cdprep::kernels
