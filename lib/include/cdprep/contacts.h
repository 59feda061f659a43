// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cdprep/closest_features.h"
#include "cdprep/overlapping_triangles.h"
#include "cdprep/structure.h"

namespace cdprep {

/// Where on the imported mesh a contact is, in its numbering.
struct ContactFeature {
    FeatureKind kind;
    /// Of the triangle: the edge from its corner `edge` to the next; 0 for other kinds.
    std::uint8_t edge;
    std::uint32_t triangle;  ///< one with the vertex or edge, or around the point
    std::uint32_t vertex;    ///< the vertex; of an edge its first; of a face its first corner
};

/// A place where two faces are within tolerance of each other, or in each other.
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
    /// Not overlapping, but one piece sees the backs of the other's triangles, whose hull is
    /// contained: it is in the solid. Nothing is to be kept off there, and which way is out
    /// other pairs of pieces say.
    contact_from_behind = 4,
};

inline constexpr std::size_t kMostManifoldPoints = 4;

/// How two convex pieces of two surfaces touch, or nearly do. Points and the normal are in the
/// frame that the placement moves both models to.
struct Contact {
    std::uint32_t piece_a;  ///< in Model::pieces().pieces
    std::uint32_t piece_b;
    ContactFeature feature_a;
    ContactFeature feature_b;
    Double3 point_a;  ///< on A, up to rounding
    Double3 point_b;  ///< on B, up to rounding
    Double3 normal;   ///< from A to B, of length 1 up to rounding: the way that B must not go back
    /// The distance is in [lower, upper], both proved, model units. Where the pieces' hulls
    /// overlap it is negative: -upper is a lower bound of the way that takes B out of A, and
    /// along `normal` -lower is enough.
    double lower;
    double upper;
    std::uint32_t flags;        ///< ContactFlags
    std::uint32_t point_count;  ///< in `points`; 0 where no manifold was asked for
    std::array<ManifoldPoint, kMostManifoldPoints> points;  ///< the deepest first
};

/// Whether contacts come with up to four points.
enum class Manifold : std::uint8_t { none, four };

struct ContactOptions {
    Manifold manifold = Manifold::none;
    Degenerate degenerate = Degenerate::keep;
    /// What is walked for pieces that are near: Structure::pieces or, for every other, the
    /// hierarchies of boxes, which are faster (near poses 1.7 times, others 1.1). The answers are
    /// the same.
    Structure structure = Structure::bvh;
};

/// Finds how two surfaces touch within a tolerance, model units, which belongs to it: a contact
/// for each pair of convex pieces that have triangles at most so far apart (exactly as
/// triangles_within() says).
///
/// Returns how many there are and stores the first of them, in the order of (piece_a,
/// piece_b), in `contacts`. A negative tolerance or NaN gives none. Needs Ask::contacts and
/// ask_of() the structure of both models.
///
/// Pieces that are apart answer with the features of the mesh where they are nearest to each
/// other, the distance an interval no wider than convex_distance() has it. Pieces whose hulls
/// overlap answer with the shortest way apart (convex_penetration()), if they are contained or
/// their triangles touch; else they are apart as their triangles are. Where the faces of a hull
/// are not covered by triangles, the triangles decide. Of many nearest pairs, as between
/// parallel faces, one answers; the manifold spans them: corners of the one face clipped by the
/// other, as far as they are within the tolerance, the deepest, and those that span most.
///
/// Normals do not catch on edges inside a surface: at an edge that is flat or reflex, or a
/// vertex between two such, they are the face's (contact_internal_edge). Where solids are in each
/// other a wall may be near on its inner side (contact_from_behind): a contact that should not
/// push.
///
/// The same for any processor. A piece that lies wholly inside another's hull, farther than the
/// tolerance from its triangles, is no contact: collide() of solids tells. Costs what
/// triangles_within() does, and some 5 to 9 microseconds for each pair of pieces, 1 more with its
/// manifold (tests/bench/results, contacts.csv). Never allocates.
[[nodiscard]] std::size_t contacts(const Model& a, const Model& b, const Placement& placement,
                                   double tolerance, Workspace& workspace,
                                   std::span<Contact> contacts,
                                   const ContactOptions& options = {}) noexcept;

using ContactVisitor = Visitor<Contact>;

/// Calls `visit` with every contact that contacts() finds, each once and in their order. Returns
/// false when `visit` ended the search.
bool visit_contacts(const Model& a, const Model& b, const Placement& placement, double tolerance,
                    Workspace& workspace, ContactVisitor visit,
                    const ContactOptions& options = {}) noexcept;

}  // namespace cdprep
