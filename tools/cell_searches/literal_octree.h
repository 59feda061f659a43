// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cdprep/advanced/query_counts.h"
#include "cdprep/cells/overlap_through.h"
#include "cdprep/model.h"
#include "cdprep/pairs.h"

namespace cdprep::study {

struct LiteralOptions {
    CellSearch search = CellSearch::modulus;
    Overlap overlap = Overlap::closed;
    Degenerate degenerate = Degenerate::keep;
    QueryCounts* counts = nullptr;  ///< the work is added here, unless null
};

/// Calls `visit` with pairs of overlapping triangles, each once, until it returns false; then
/// returns false. This is the search through hashed octrees as Ponce Atencio's talk describes it.
/// For each triangle of B in the PCS, it takes the triangles of A in the leaf cells that hold its
/// corners. Known to be incomplete: it misses a triangle that crosses cells without a corner in
/// them. Pairs that it finds overlap, exactly. Both models serve Ask::hashed_octree. Allocates.
bool visit_literal_overlaps(const Model& a, const Model& b, const Placement& placement,
                            const LiteralOptions& options, PairVisitor visit);

}  // namespace cdprep::study
