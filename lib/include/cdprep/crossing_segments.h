// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/overlapping_triangles.h"
#include "cdprep/visitor.h"

namespace cdprep {

/// A pair of triangles in contact, and all that they have in common.
struct Crossing {
    TrianglePair pair;
    /// Both lie in one plane, or one has no area: they may share an area, and no
    /// segment is given.
    bool is_flat;
    Double3 from;  ///< ends of the common segment, in no particular order; equal where
    Double3 to;    ///< the triangles touch in a point. 0 when `is_flat`
};

/// Calls `visit` with every pair that overlapping_triangles() finds, each once and in
/// no particular order, and the segment in which the two triangles meet. Returns
/// false when `visit` ended the search.
///
/// In the coordinates of `placement`: A's frame where B moves. Which edges end a
/// segment is decided exactly, for the vertices as `placement` moves them; then each
/// coordinate is rounded once: it is the double nearest to the exact one, but where
/// that lies within 2^-45 units in the last place of the middle between two
/// (crossing_segments_laws_test). Neighbours that share an edge so share the end on
/// it, bit for bit, up to those ties. Subnormal coordinates may be off by one unit.
///
/// Needs Ask::overlap of both models. Costs some microseconds more a pair than
/// overlapping_triangles(). Never allocates; takes some 20 KiB of stack.
bool visit_crossing_segments(const Model& a, const Model& b, const Placement& placement,
                             Workspace& workspace, Visitor<Crossing> visit,
                             const OverlapOptions& options = {}) noexcept;

}  // namespace cdprep
