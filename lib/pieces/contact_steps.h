// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "cdprep/contacts.h"
#include "pieces/contact_side.h"
#include "walk/find_contact.h"
#include "walk/workspace_storage.h"

namespace cdprep {

/// Fills in the manifold of a contact from its normal, features and points. The base is the face of
/// one piece that is perpendicular to the normal. It clips the face of the other piece that faces
/// it most. The manifold takes corners of the result within the tolerance, and the contact's own
/// points if none of them is as deep.
void add_manifold(const ContactSide& a, const ContactSide& b, const PieceFeature& feature_a,
                  const PieceFeature& feature_b, double tolerance, Contact& contact) noexcept;

/// Two triangles of two pieces.
struct NearestTriangles {
    TreePair pair;
    double least;  ///< no pair is nearer, up to the rounding of triangle_distance()
};

/// Returns the two nearest triangles of two pieces whose triangles do not touch, as computed by
/// triangle_distance(). Distances that differ by less than 2^-41 of them count as equal. Of equal
/// pairs it returns the first, by the triangle of the piece with more of them (A, if both have as
/// many), and then by the other one. `start` is a pair of triangles near each other. All numbers
/// are in tree order.
[[nodiscard]] NearestTriangles nearest_triangles(const ContactSide& a, const ContactSide& b,
                                                 const TreePair& start,
                                                 Degenerate degenerate) noexcept;

/// The values that all pairs of pieces of a query share.
struct ContactQuestion {
    const Placement* placement;
    ContactOptions options;
    Degenerate degenerate;
    QueryCounts* counts;  ///< or null
    /// The search covered the whole surface. If not, NearPieces::touch may be false although other
    /// triangles touch.
    bool searched = true;
};

/// Returns the first pair of triangles of two pieces that touch, by the triangle of A, then of B.
[[nodiscard]] std::optional<TreePair> touching_triangles(const ContactSide& a, const ContactSide& b,
                                                         const ContactQuestion& question) noexcept;

/// Returns a bound of -Contact::upper: of the shortest translation that separates two pieces, or
/// minus their distance. Costs little.
[[nodiscard]] double most_depth_of_pieces(const ContactSide& a, const ContactSide& b,
                                          const NearPieces& near) noexcept;

/// Returns a closer bound by the faces of both hulls, or infinity if they cannot be tested.
[[nodiscard]] double most_depth_by_faces(ContactSide& a, ContactSide& b,
                                         const NearPieces& near) noexcept;

/// Returns the contact of two pieces. Two of their triangles are within the tolerance.
[[nodiscard]] Contact contact_of_pieces(ContactSide& a, ContactSide& b, const NearPieces& near,
                                        const ContactQuestion& question) noexcept;

}  // namespace cdprep
