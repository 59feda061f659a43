// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cdprep/advanced/closest_features.h"
#include "cdprep/pairs.h"

namespace cdprep {

/// The feature of the imported mesh where a contact is, in source numbers.
struct ContactFeature {
    FeatureKind kind;
    /// Of the triangle: the edge from its corner `edge` to the next; 0 for other kinds.
    std::uint8_t edge;
    std::uint32_t triangle;  ///< one with the vertex or edge, or around the point
    std::uint32_t vertex;    ///< the vertex; of an edge its first; of a face its first corner
};

/// A point where two faces are within the tolerance, or overlap.
struct ManifoldPoint {
    Double3 on_a;
    Double3 on_b;
    double distance;  ///< from on_a to on_b along the normal, rounded; negative: overlap
};

/// Bits of Contact::flags.
enum ContactFlags : std::uint32_t {
    /// The hulls of the two pieces have a common point: the distance is 0 or negative, the
    /// shortest way apart.
    contact_overlap = 1,
    /// The nearest points or the shortest way apart would lean over a flat or reflex edge,
    /// where the surface goes on: the normal is that of the face instead.
    contact_internal_edge = 2,
    /// The pieces do not overlap, but one lies behind the other's triangles, inside the solid.
    /// Ignore this contact in a solver; other piece pairs give the separating direction.
    contact_from_behind = 4,
};

inline constexpr std::size_t kMostManifoldPoints = 4;

/// The contact of two convex pieces of two surfaces. Points and the normal are in the frame to
/// which the placement moves both models.
struct Contact {
    std::uint32_t piece_a;  ///< in Model::pieces().pieces
    std::uint32_t piece_b;
    ContactFeature feature_a;
    ContactFeature feature_b;
    Double3 point_a;  ///< on A, up to rounding
    Double3 point_b;  ///< on B, up to rounding
    Double3 normal;   ///< from A to B, of length 1 up to rounding
    /// The distance is in [lower, upper], both proved, model units. Where the pieces' hulls
    /// overlap it is negative: -upper is a lower bound of the way that takes B out of A, and
    /// along `normal` -lower is enough.
    double lower;
    double upper;
    std::uint32_t flags;        ///< ContactFlags
    std::uint32_t point_count;  ///< in `points`; 0 where no manifold was asked for
    std::array<ManifoldPoint, kMostManifoldPoints> points;  ///< the deepest first
};

/// The number of points of a contact.
enum class Manifold : std::uint8_t { none, four };

struct ContactOptions {
    double tolerance = 0;  ///< model units; inclusive
    Manifold manifold = Manifold::none;
};

/// Finds the contacts of two surfaces: one for each pair of convex pieces that have triangles at
/// most options.tolerance apart, exactly as pairs_within() decides.
///
/// Returns the number of contacts and stores the first of them, in the order of (piece_a,
/// piece_b), in `room`; an empty span counts. A negative tolerance or NaN gives none.
///
/// Pieces that are apart answer with the features of the mesh where they are nearest to each other;
/// the interval of the distance is no wider than that of convex_distance(). Pieces whose hulls
/// overlap answer with the shortest way apart (convex_penetration()) if they are contained or
/// their triangles touch; otherwise with the distance of their triangles. Where triangles do not
/// cover a face of a hull, the triangles decide. Of many nearest pairs, as between parallel faces,
/// one answers. The manifold spans them: corners of one face clipped by the other, within the
/// tolerance, the deepest first and then those that span most.
///
/// Normals do not catch on edges inside a surface: at a flat or reflex edge, or a vertex between
/// two such edges, the normal is that of the face (contact_internal_edge). Inside a solid, a wall
/// may be near on its inner side (contact_from_behind); such a contact should not push.
///
/// The answer is the same on every processor. A piece that lies inside another's hull, farther than
/// the tolerance from its triangles, makes no contact: collide() with Body::solid detects it.
///
/// Reads pair.options.degenerate and, of pair.options.through, Structure::pieces, which is slower
/// than the BVH (1.7 times for near poses, 1.1 times for others). Needs Ask::contacts of both
/// models, and options.through its ask_of(). Costs as pairs_within(), and 5 to 9 microseconds for
/// each pair of pieces, 1 more with its manifold (tests/bench/results, contacts.csv). Never
/// allocates.
[[nodiscard]] std::size_t contacts(const Pair& pair, Workspace& workspace, std::span<Contact> room,
                                   const ContactOptions& options = {}) noexcept;

using ContactVisitor = Visitor<Contact>;

/// Calls `visit` with every contact that contacts() finds, each once and in the same order. Returns
/// false if `visit` ended the search. Needs Ask::contacts of both models, and options.through its
/// ask_of().
bool visit_contacts(const Pair& pair, Workspace& workspace, ContactVisitor visit,
                    const ContactOptions& options = {}) noexcept;

}  // namespace cdprep
