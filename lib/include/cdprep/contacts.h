// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cdprep/advanced/closest_features.h"
#include "cdprep/format/api.h"
#include "cdprep/pairs.h"

namespace cdprep {

/// The feature of the imported mesh at a contact, in source numbers.
struct ContactFeature {
    FeatureKind kind;
    /// The corner of `triangle` at which the edge starts; the edge ends at the next corner. 0 for
    /// other kinds.
    std::uint8_t edge;
    std::uint32_t triangle;  ///< a triangle that has the vertex or edge, or contains the point
    std::uint32_t vertex;    ///< the vertex; the first of an edge; the first corner of a face
};

/// A pair of points at which two faces are within the tolerance, or overlap.
struct ManifoldPoint {
    Double3 on_a;
    Double3 on_b;
    /// The distance from on_a to on_b along the normal, rounded. Negative: the faces overlap. In a
    /// cluster, the normal is that of the point's own contact. It may differ from Contact::normal
    /// by up to ContactOptions::cluster_angle.
    double distance;
    /// Stays the same for the same point of the same contact after a small motion. It is made of
    /// the source number of the vertex at the point. If two edges cross there, it is made of the
    /// source numbers of their ends. 0 for the contact's own points point_a and point_b, which may
    /// be the only ones. With clusters, this number is combined with the id of the point's own
    /// contact. So it also differs between points of different members.
    std::uint64_t id;
};

/// Bits of Contact::flags.
enum ContactFlags : std::uint32_t {
    /// The pieces overlap: their hulls have a common point, and either their triangles touch or
    /// both pieces are contained (format::piece_contained). The distance is 0 or negative: minus
    /// the length of the shortest translation that separates the hulls. Also set with contact_deep,
    /// whose pieces need not overlap.
    contact_overlap = 1,
    /// The shortest line between the pieces, or the shortest way out of their overlap, snags. So
    /// `normal` has a different direction: see contacts().
    contact_internal_edge = 2,
    /// The pieces do not overlap, but one lies behind the other's triangles, inside the solid.
    /// Ignore this contact in a solver; other piece pairs give the separating direction.
    contact_from_behind = 4,
    /// A component of one model lies inside the other, and no triangles of the two models touch:
    /// see contacts(). The component's point lies on a hull or box around the component, and may be
    /// off the surface. The translation by -lower along `normal` moves point_b to point_a.
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
    /// contact_overlap it is 0 or negative. Then no translation of B shorter than -upper separates
    /// the pieces or, with contact_deep, frees the component. A translation of B by -lower along
    /// `normal` does so.
    double lower;
    double upper;
    std::uint32_t flags;        ///< ContactFlags
    std::uint32_t members;      ///< the number of contacts in this cluster; 1 without clusters
    std::uint32_t point_count;  ///< in `points`; 0 with neither a manifold nor clusters
    std::array<ManifoldPoint, kMostManifoldPoints> points;  ///< the deepest first
};

/// The manifold of a contact: none, or up to four points.
enum class Manifold : std::uint8_t { none, four };

/// The largest ContactOptions::most.
inline constexpr std::uint32_t kMostListedContacts = 256;

struct ContactOptions {
    double tolerance = 0;  ///< model units; inclusive
    Manifold manifold = Manifold::none;
    /// The maximum number of contacts, at most kMostListedContacts: the deepest, and others spread
    /// over the surface. 0: all contacts, in the order of their pieces.
    std::uint32_t most = 0;
    /// The maximum work, 0 for no limit. Each pair of near triangles counts 1. Each contact counts
    /// kWorkOfContact and, between two pieces, 1 for every kTrianglesOfWork of their triangles. The
    /// search for near triangles takes at most half of the work. The last contact may bring the
    /// total above it. If the work allows all contacts, but `most` allows fewer than half, some
    /// depths are first bounded more closely. Each such bound counts kWorkOfBound.
    std::uint64_t work = 0;
    /// Joins contacts that are linked by common pieces, if their normals differ little. The value
    /// limits the angle to the normal of the deepest contact, in radians. A joined contact has at
    /// most four points. 0: joins none. Needs `most`.
    double cluster_angle = 0;
};

inline constexpr std::uint64_t kWorkOfContact = 32;
inline constexpr std::uint64_t kTrianglesOfWork = 8;
inline constexpr std::uint64_t kWorkOfBound = 8;

/// The completeness of a list of contacts, and what the limits left out.
struct ContactsVerdict {
    std::size_t count;       ///< contacts stored in `room`
    std::uint64_t found;     ///< pairs of pieces found within the tolerance, and
                             ///< enclosed components
    std::uint64_t computed;  ///< the number of these whose contact was computed
    std::uint64_t work;      ///< counted as in ContactOptions::work
    bool searched;           ///< the search covered the whole surface; false if `work` ended it
    bool complete;           ///< all contacts are in `room`, or in the clusters there
};

/// Finds one contact for each pair of convex pieces that have triangles at most options.tolerance
/// apart. The test of the tolerance is exact, as in pairs_within(). A negative tolerance or NaN
/// gives no contacts but those of enclosed components (see below).
///
/// Without options.most, stores the first contacts in `room`, in the order of (piece_a, piece_b),
/// and then those of enclosed components. With an empty span, the function only counts the contacts
/// (`found`). With options.most, stores at most that many contacts, the deepest first (by `upper`,
/// then by pieces). If there are more, the choice alternates between the deepest remaining contact
/// and the one farthest from all chosen ones. With options.most, only contacts that may be listed
/// are computed.
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
/// A piece is contained if its hull lies within the solid. Two pieces overlap if their hulls
/// overlap and either their triangles touch or both pieces are contained.
///
/// If two pieces do not overlap, their contact names the nearest features of their hulls. If no
/// triangle has these features, or the hulls overlap, the nearest triangles give the features and
/// the distance. The distance interval is no wider than that of convex_distance(). If several pairs
/// of points are equally near, as between parallel faces, the contact has one of them. The normal
/// is the direction of the shortest line between the pieces. If this line snags at a feature, the
/// normal is turned until it no longer tilts across the feature's edges. If it leads from a vertex
/// straight across edges, it becomes the normal of a face there. Of several, it is the one along
/// which B leaves A soonest. If either feature is a face, the normal is turned only if it tilts
/// across a flat edge. Across a gap below 2^-36 of the coordinates, rounding may turn this line.
/// Then the normal, the points and the features are found as if the pieces overlapped.
///
/// If two pieces overlap, `normal` is the direction of the shortest separating translation, unless
/// this translation snags (see below). The candidate directions are the face normals of both hulls
/// and the directions perpendicular to an edge of each. Some hulls have many faces, are larger than
/// 2^254, or have edges shorter than 2^-240. For these, the candidates are the shortest separating
/// translation and normals of faces or triangles. Only the 16 shortest candidates are tested for
/// snags. If triangles touch, two edges count only if they are near enough to each other: at most
/// twice as far as the shortest translation along a face normal is long.
///
/// A translation snags if it tilts across a flat or reflex edge, towards the adjacent face. At a
/// vertex, the tilt counts only if a triangle there reaches farther along the translation than the
/// vertex. A translation also snags if it leads through a face of the hull that no triangle covers.
/// So it does past a reflex edge at which the triangles of a face end.
/// The shortest translation that does not snag is used. Exception: some translations tilt across
/// reflex edges only, and do not lead deeper into a solid. The shortest of these is used if it is
/// less than half as long, or if all translations snag. Without such a translation, the shortest
/// one that leads out of the solid is turned until it no longer snags. If none leads out, the
/// shortest translation is used as it is. contact_internal_edge is set unless the shortest
/// translation itself is used. `upper` is still minus the length of the shortest separating
/// translation. If the shortest translation does not snag, `lower` and `upper` are equal up to
/// rounding. Bodies may overlap by more than the size of a piece. Then a contact separates its two
/// pieces only, not the bodies: push by the deepest contact, and query again. Inside a solid, the
/// inner side of a wall may be near (contact_from_behind); such a contact should not push.
///
/// With Body::solid, a component that is proven to be inside the other model makes a contact of its
/// own (contact_deep). If any triangles of the two models touch, there are no deep contacts. A deep
/// contact names one piece of the component. It also names the piece of the other model that is
/// nearest to a vertex of the component. The translation moves the component out of hulls that
/// enclose the other model. These hulls are the parts of that model (`bake --structures hull
/// --parts`). Without parts, the only hull is that of the whole model or, without hulls, its
/// bounding box. A translation by -lower along `normal` frees the component. No translation shorter
/// than -upper frees it: -upper is the distance of one of its vertices from the other surface. A
/// deep contact counts in `found`. With options.most, other contacts get only the places that deep
/// contacts leave free. A model that is not balanced encloses nothing.
///
/// The manifold spans the area where two faces of the pieces are within the tolerance. Its points
/// are the corners of one face, clipped by the other. ManifoldPoint::distance is the distance of
/// the two faces there, along the normal. Without contact_overlap, it is at least -2e-5 of the
/// face's size: the faces may not be quite parallel. Points farther behind the other face are left
/// out. The normal of the clipping face may deviate from that of the contact by up to 0.03 radians.
/// This happens if nearly parallel faces are nearest where two of their edges cross. The deepest
/// point is first, then those that span the largest area.
///
/// The answer is the same on every processor. With Body::surface, a piece inside the hull of
/// another makes a contact only if their triangles are within the tolerance.
///
/// Reads body, degenerate and through of pair.options. The only structure beside the BVH is
/// Structure::pieces, which takes up to 1.15 times as long. Needs Ask::contacts of both models,
/// Ask::solid with Body::solid, and ask_of(pair.options.through). A deep contact reads hulls if the
/// models serve Ask::hulls. Takes the time of pairs_within(), plus up to 10 microseconds per
/// contact and 1 more with a manifold (tests/bench/results, contacts.csv). Body::solid adds the
/// time of containment(). Never allocates.
[[nodiscard]] CDPREP_API ContactsVerdict contacts(const Pair& pair, Workspace& workspace,
                                                  std::span<Contact> room,
                                                  const ContactOptions& options = {}) noexcept;

using ContactVisitor = Visitor<Contact>;

/// Calls `visit` once with every contact that contacts() finds without options.most and
/// options.cluster_angle. The order is the same: by pieces, then those of enclosed components.
/// Returns false if `visit` or options.work ended the search. Needs Ask::contacts of both models,
/// Ask::solid with Body::solid, and ask_of(pair.options.through).
CDPREP_API bool visit_contacts(const Pair& pair, Workspace& workspace, ContactVisitor visit,
                               const ContactOptions& options = {}) noexcept;

}  // namespace cdprep
