// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cdprep/advanced/closest_features.h"
#include "cdprep/pairs.h"

namespace cdprep {

/// The feature of the imported mesh at a contact, in source numbers.
struct ContactFeature {
    FeatureKind kind;
    /// The corner of the triangle where the edge starts; it ends at the next. 0 for other kinds.
    std::uint8_t edge;
    std::uint32_t triangle;  ///< a triangle with the vertex or edge, or around the point
    std::uint32_t vertex;    ///< the vertex; the first of an edge; the first corner of a face
};

/// A pair of points at which two faces are within the tolerance, or overlap.
struct ManifoldPoint {
    Double3 on_a;
    Double3 on_b;
    double distance;  ///< from on_a to on_b along the normal, rounded; negative: overlap
    /// Stays the same for the same point of the same contact after a small motion. It is made of
    /// the source numbers of the vertex, or of the two crossing edges. 0 for the only point of a
    /// contact. In a cluster, it also differs between points of different members.
    std::uint64_t id;
};

/// Bits of Contact::flags.
enum ContactFlags : std::uint32_t {
    /// The pieces overlap: their hulls have a common point, and both are contained or their
    /// triangles touch (format/pieces.h). The distance is 0 or negative: minus the length of the
    /// shortest translation that separates the hulls.
    contact_overlap = 1,
    /// The normal is that of a face, because the shortest way would snag: see contacts().
    contact_internal_edge = 2,
    /// The pieces do not overlap, but one lies behind the other's triangles, inside the solid.
    /// Ignore this contact in a solver; other piece pairs give the separating direction.
    contact_from_behind = 4,
    /// A component of one model lies inside the other, with no surface near: see contacts(). The
    /// points are on the hulls that were separated.
    contact_deep = 8,
};

inline constexpr std::size_t kMostManifoldPoints = 4;

/// The contact of two convex pieces of two surfaces. Points and the normal are in the frame into
/// which the placement moves both models.
struct Contact {
    std::uint32_t piece_a;  ///< an index into Model::pieces().pieces
    std::uint32_t piece_b;
    /// Stays the same as long as the two pieces are in contact, whatever moves. The high 32 bits
    /// are the source number of a triangle of A's piece, the low ones of B's. With contact_deep,
    /// the half of the enclosing model is 2^32 - 1. A cluster has the smallest id of its members.
    std::uint64_t id;
    ContactFeature feature_a;
    ContactFeature feature_b;
    Double3 point_a;  ///< on A, up to rounding
    Double3 point_b;  ///< on B, up to rounding
    Double3 normal;   ///< from A to B, of length 1 up to rounding
    /// The distance is in [lower, upper], in model units; both bounds are proven. With
    /// contact_overlap it is 0 or negative. Then no translation shorter than -upper moves B out of
    /// A, and a translation by -lower along `normal` does.
    double lower;
    double upper;
    std::uint32_t flags;        ///< ContactFlags
    std::uint32_t members;      ///< the number of contacts in this cluster; 1 without clusters
    std::uint32_t point_count;  ///< in `points`; 0 if no manifold was requested
    std::array<ManifoldPoint, kMostManifoldPoints> points;  ///< the deepest first
};

/// The number of points of a contact.
enum class Manifold : std::uint8_t { none, four };

/// The largest ContactOptions::most.
inline constexpr std::uint32_t kMostListedContacts = 256;

struct ContactOptions {
    double tolerance = 0;  ///< model units; inclusive
    Manifold manifold = Manifold::none;
    /// The maximum number of contacts, at most kMostListedContacts: the deepest, and others spread
    /// over the surface. 0: all contacts, in the order of their pieces.
    std::uint32_t most = 0;
    /// The maximum work, 0 for no limit: each pair of near triangles counts 1, and each contact
    /// kWorkOfContact. The search for near triangles takes at most half of it.
    std::uint64_t work = 0;
    /// Joins contacts of common pieces whose normals are at most this far apart, in radians. A
    /// joined contact has at most four points. 0: joins none. Needs `most`.
    double cluster_angle = 0;
};

inline constexpr std::uint64_t kWorkOfContact = 32;

/// How complete a list of contacts is, and what the limits left out.
struct ContactsVerdict {
    std::size_t count;       ///< contacts stored in `room`
    std::uint64_t found;     ///< pairs of pieces within the tolerance, as far as was searched, and
                             ///< enclosed components
    std::uint64_t computed;  ///< those of them whose contact was computed
    std::uint64_t work;      ///< as ContactOptions::work counts it
    bool searched;           ///< The search covered the whole surface; false if `work` ended it
    bool complete;           ///< all contacts are in `room`, or in the clusters there
};

/// Finds one contact for each pair of convex pieces that have triangles at most options.tolerance
/// apart. This test is exact, as in pairs_within(). A negative tolerance or NaN gives no contacts.
///
/// Without options.most, stores the first contacts in `room`, in the order of (piece_a, piece_b),
/// and then those of enclosed components. With an empty span it only counts them (`found`). With
/// options.most, stores at most so many, the deepest first (by `upper`, then by pieces). If there
/// are more, the choice alternates between the deepest remaining contact and the one farthest from
/// all chosen ones. Then only contacts that may be listed are computed.
///
/// If `lower` is negative, a solver must move B by -lower along `normal` to separate the pieces.
///
///     +---+                 +---+                    +---+
///     | B |                 | B |                    | B |
///     +---+             ----|   |----  A        -----|   |-+-----  A: two faces in one plane
///       | lower             +---+ | -lower           +---+ | -lower
///     ---------  A                                   --> -upper: shorter, but sideways
///     apart             shallow                 at an edge inside a surface
///
/// If two pieces are apart, their contact has the nearest features of the mesh. The distance
/// interval is no wider than that of convex_distance(). Pieces overlap if their hulls do, and both
/// are contained or their triangles touch. Then `normal` is the direction of the shortest
/// separating translation that does not snag. The candidates are the normals of both hulls' faces
/// and the directions across two of their edges. A piece is contained if its hull lies within the
/// solid. For other overlapping hulls, the contact has the distance of the triangles. If triangles
/// do not cover a face of a hull, the triangles decide. If several pairs of points are nearest, as
/// between parallel faces, the contact has one of them.
///
/// A translation snags if it tilts across a flat or reflex edge, towards the adjacent face. It also
/// snags if it leads through a part of the hull that no triangle covers. Then the shortest
/// translation that does not snag is used, and contact_internal_edge is set. A translation that
/// snags is used instead if it is less than half as long. It must lead neither along a plane nor
/// deeper into a solid. `upper` is still minus the length of the shortest separating translation.
/// For shallow contacts away from such edges, `lower` and `upper` are equal up to rounding. Bodies
/// may overlap by more than the size of a piece. Then a contact separates its two pieces only, not
/// the bodies: push by the deepest, and query again. Inside a solid, the inner side of a wall may
/// be near (contact_from_behind); such a contact should not push.
///
/// With Body::solid, a component that is proven to be inside the other model makes a contact of its
/// own (contact_deep). No such contact is made if any triangles of the two models touch. It names
/// one piece of the component and the nearest piece of the other model. The translation moves the
/// component out of hulls that enclose the other model. They are its parts (`bake --structures hull
/// --parts`), else its whole hull, else the box around it. A translation by -lower along `normal`
/// frees the component. No translation shorter than -upper frees it: that is the distance of one of
/// its vertices from the other surface. Such a contact counts in `found`, and with options.most it
/// is listed before others of no greater depth. An open model encloses nothing.
///
/// The manifold spans the nearest pairs. Its points are corners of one face, clipped by the other,
/// and each distance is between the two faces there. The deepest point is first, then those that
/// span the largest area.
///
/// The answer is the same on every processor. With Body::surface, a piece inside another's hull
/// makes no contact if it is farther than the tolerance from the other's triangles.
///
/// Reads the options body, degenerate and through of the pair. The only structure beside the BVH is
/// Structure::pieces, which is slower (1.7 times for near poses, 1.1 times for others). Needs
/// Ask::contacts of both models; Body::solid also Ask::solid, and options.through its ask_of(). A
/// deep contact reads hulls if the models serve Ask::hulls. Takes the time of pairs_within(), plus
/// 5 to 10 microseconds per contact and 1 more with a manifold (tests/bench/results, contacts.csv).
/// Body::solid adds the time of containment(). Never allocates.
[[nodiscard]] ContactsVerdict contacts(const Pair& pair, Workspace& workspace,
                                       std::span<Contact> room,
                                       const ContactOptions& options = {}) noexcept;

using ContactVisitor = Visitor<Contact>;

/// Calls `visit` once with every contact that contacts() finds without options.most and
/// options.cluster_angle. The order is the same: by pieces, then those of enclosed components.
/// Returns false if `visit` or options.work ended the search. Needs Ask::contacts of
/// both models; Body::solid also Ask::solid, and options.through its ask_of().
bool visit_contacts(const Pair& pair, Workspace& workspace, ContactVisitor visit,
                    const ContactOptions& options = {}) noexcept;

}  // namespace cdprep
