// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/overlapping_triangles.h"
#include "walk_pairs.h"

namespace cdprep {

/// A triangle's number in the imported file, or in the tree order where that
/// section is absent.
inline std::uint32_t source_number(const Model& model, std::uint32_t triangle) noexcept {
    const auto source = model.source_triangle();
    return source.empty() ? triangle : source[triangle];
}

inline bool is_marked_degenerate(const Model& model, std::uint32_t triangle) noexcept {
    const auto bits = model.degenerate_bits();
    return !bits.empty() && ((bits[triangle / 64] >> (triangle % 64)) & 1) != 0;
}

/// The exact decision about one pair of triangles.
inline bool in_contact(const Corners& a, const Corners& b, Contact contact) noexcept {
    const TriangleContact kind = classify_contact(a, b);
    if (contact == Contact::closed) return kind != TriangleContact::disjoint;
    return kind == TriangleContact::cross || kind == TriangleContact::coplanar_overlap;
}

/// Calls `found(pair)` for every pair of triangles in contact, in the walk's
/// order, until it returns false; returns false when it did.
template <class Found>
bool for_each_contact(const Model& a, const Model& b, const Placement& placement,
                      Workspace& workspace, const OverlapOptions& options, Found&& found) noexcept {
    Workspace::Storage& scratch = workspace.storage();
    const MovedModel moved_a{&a, placement.a_is_moved() ? &placement.pose_a() : nullptr};
    const MovedModel moved_b{&b, placement.b_is_moved() ? &placement.pose_b() : nullptr};
    scratch.leaf_a.leaf = scratch.leaf_b.leaf = MovedLeaf::kNone;
    const bool skips = options.degenerate == Degenerate::skip;

    return walk_pairs(a, b, placement, scratch, [&](std::uint32_t at_a, std::uint32_t at_b) {
        MovedLeaf& leaf_a = scratch.leaf_a;
        MovedLeaf& leaf_b = scratch.leaf_b;
        leaf_a.load(moved_a, at_a);
        leaf_b.load(moved_b, at_b);
        if (!overlap(leaf_a.all, leaf_b.all)) return true;
        for (std::uint32_t j = 0; j < leaf_b.count; ++j) {
            if (!overlap(leaf_a.all, leaf_b.box[j])) continue;
            if (skips && is_marked_degenerate(b, leaf_b.first + j)) continue;
            for (std::uint32_t i = 0; i < leaf_a.count; ++i) {
                if (!overlap(leaf_a.box[i], leaf_b.box[j])) continue;
                if (skips && is_marked_degenerate(a, leaf_a.first + i)) continue;
                if (!in_contact(leaf_a.corners[i], leaf_b.corners[j], options.contact)) continue;
                const TrianglePair pair{source_number(a, leaf_a.first + i),
                                        source_number(b, leaf_b.first + j)};
                if (!found(pair)) return false;
            }
        }
        return true;
    });
}

}  // namespace cdprep
