// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "cdprep/advanced/query_counts.h"
#include "cdprep/cells/overlap_through.h"
#include "cdprep/exact/predicates.h"
#include "cdprep/model.h"
#include "cdprep/pairs.h"
#include "cdprep/pose.h"

namespace cdprep::study {

/// The oriented box of one model among the triangles of another. A triangle beyond one of its six
/// planes touches no triangle in the box. The rest is the potentially colliding set (PCS) of Y.
/// Ponce Atencio, "Some techniques to speed up collision detection".
class PotentialSet {
public:
    /// The box is A's, the triangles are B's. A model without the section `bounds` gets the root
    /// box of its BVH.
    PotentialSet(const Model& a, const Model& b, const Placement& placement);

    /// Returns true if no plane clips a triangle of B, given by its stored corners.
    [[nodiscard]] bool holds(const Corners& t) const;

    /// Returns the number of triangles of B in leaves of its BVH that no plane clips.
    [[nodiscard]] std::size_t triangles_in_leaves() const;

private:
    /// The points p of B with |normal * p + offset| <= limit.
    struct Slab {
        Double3 normal;
        double offset;
        double limit;
    };
    [[nodiscard]] std::uint32_t leaves_below(std::uint32_t height, std::uint32_t index) const;
    [[nodiscard]] bool clips(const format::BvhNode& node, std::uint32_t lane) const;

    const Model& b_;
    std::array<Slab, 3> slab_{};
};

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
