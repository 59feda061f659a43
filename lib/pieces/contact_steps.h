// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/contacts.h"
#include "pieces/contact_side.h"
#include "walk/find_contact.h"
#include "walk/workspace_storage.h"

namespace cdprep {

/// Fills in the points of a contact from its normal, features and points: those of the face of
/// the one piece that stands across the normal and of the other's that faces it most, clipped by
/// it, as far as they are within the tolerance; the contact's own points where no face stands
/// across.
void add_manifold(const ContactSide& a, const ContactSide& b, const PieceFeature& feature_a,
                  const PieceFeature& feature_b, double tolerance, Contact& contact) noexcept;

/// Finds the two triangles of two pieces, of which none touch, that are nearest to each other as
/// far as triangle_distance() tells; of several the first, by A's and then by B's. `start` are
/// two of them, which are near each other. In tree order.
[[nodiscard]] TreePair nearest_triangles(const ContactSide& a, const ContactSide& b,
                                         const TreePair& start, Degenerate degenerate) noexcept;

/// What all pairs of pieces of a question share.
struct ContactQuestion {
    const Placement* placement;
    ContactOptions options;
    Degenerate degenerate;
    QueryCounts* counts;  ///< or null
};

/// Answers for one pair of pieces, of which two triangles are within the tolerance.
[[nodiscard]] Contact contact_of_pieces(const ContactSide& a, const ContactSide& b,
                                        const NearPieces& near,
                                        const ContactQuestion& question) noexcept;

}  // namespace cdprep
