// SPDX-License-Identifier: MIT
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>

#include "cdprep/advanced/pair_cache.h"
#include "cdprep/advanced/structure.h"
#include "cdprep/format/api.h"
#include "cdprep/model.h"
#include "cdprep/pose.h"
#include "cdprep/visitor.h"
#include "cdprep/workspace.h"

namespace cdprep {

struct PairFront;

/// An answer that may be unknown: an unbalanced mesh, for example, has no defined inside.
enum class Answer : std::uint8_t { no, yes, unknown };

/// The point set that represents a model.
enum class Body : std::uint8_t {
    surface,  ///< its triangles only
    solid,    ///< its triangles and what they enclose
};

/// The kind of common points that makes two triangles overlap.
enum class Overlap : std::uint8_t {
    closed,  ///< any common point: touching counts
    proper,  ///< the triangles cross, or share area in one plane
};

/// The treatment of triangles with collinear corners.
enum class Degenerate : std::uint8_t {
    keep,  ///< they count as the segment or point that they are
    skip,  ///< they are ignored
};

/// The options of a query about two models. Each query states which of them it reads.
struct PairOptions {
    Body body = Body::surface;
    Overlap overlap = Overlap::closed;
    Degenerate degenerate = Degenerate::keep;
    /// The structure of both files through which the query is computed. It changes speed, the order
    /// of visits, and which of several valid results distance() returns. It changes no other
    /// answer. A query that does not support the structure uses the BVH.
    Structure through = Structure::bvh;
};

/// Two models and their placement: the subject of a query. The models must outlive it.
///
///     cdprep::Workspace workspace;
///     cdprep::Pair pair{*arm, *part, cdprep::Placement::b_moves(*pose)};
///     bool hit = collide(pair, workspace).hit == cdprep::Answer::yes;
struct Pair {
    std::reference_wrapper<const Model> a;
    std::reference_wrapper<const Model> b;
    Placement placement;
    PairOptions options = {};
    PairCache* cache = nullptr;  ///< results of earlier queries on this pair, or null
    /// Separating planes from earlier queries, or null (pair_front.h). distance() and within() use
    /// them with Structure::pieces. distance() uses them only if `cache` is not null.
    PairFront* front = nullptr;
};

/// The containment of a component of one model in the other.
struct Containment {
    Answer answer = Answer::no;
    /// The winding number that decided: an integer if `answer` is yes, and 0 if it is no. If
    /// `answer` is unknown, it is the generalised winding number, solid angle / 4 pi, up to
    /// rounding. It is 0 if the model that may be inside is torn (Model::is_torn()), or if the
    /// tested vertices are on the other surface.
    double winding = 0;
    bool a_inside_b = false;  ///< unless `answer` is no: true for A in B, false for B in A
};

/// The result of collide().
struct Collision {
    /// yes: triangles of the two models overlap, by the rules of PairOptions. Also yes with
    /// Body::solid, if a component of one model is proven inside the other. unknown: no triangles
    /// overlap, and `containment` is unknown.
    Answer hit = Answer::no;
    /// Computed only with Body::solid, if no triangles overlap. Otherwise containment.answer is no.
    Containment containment;
};

/// Returns whether two models collide. Stops at the first pair of triangles that overlap.
///
/// With Body::surface, nested surfaces that do not touch do not collide. With Body::solid, models
/// also collide if a nonzero winding number proves that a component of one is inside the other. See
/// containment() for unbalanced models. The answer is as exact as that of overlaps().
///
/// With Overlap::proper, triangles may touch without an overlap. If a vertex that containment()
/// would test then lies on the other surface, all vertices are tested. `unknown` means: the other
/// model is unbalanced, or every vertex of a component may lie on that model's surface. It is also
/// the answer if the model that may be inside is torn (Model::is_torn()).
///
/// Reads all options. Needs Ask::collide of both models, Ask::solid with Body::solid, and
/// ask_of(options.through). Takes O(log n) time for most poses. With a cache, the surfaces are
/// tested in O(1) time if the last hit recurs or a proven gap remains. Queries through octrees and
/// tetra-trees use no cache. If no triangles overlap, Body::solid adds the time of containment(),
/// or of testing all vertices. Never allocates.
[[nodiscard]] CDPREP_API Collision collide(const Pair& pair, Workspace& workspace) noexcept;

/// Returns whether some component of one model lies inside the other. The surfaces of the two
/// models must not touch.
///
/// Inside means a winding number other than 0. Nested shells of opposite orientation cancel, and an
/// inverted component counts as solid. If the other model is unbalanced and its box does not
/// exclude a component, the component gives `unknown`. The generalised winding number is then
/// stored, but does not decide. A torn model (Model::is_torn()) gives `unknown` if its box meets
/// that of the other model. The result is `yes` if a component gives `yes`. Otherwise, it is
/// `unknown` if anything gives `unknown`.
///
/// One vertex of each component is tested, except of torn models. If this vertex is outside the
/// other model's box, the component is outside, even if that model is unbalanced. This test decides
/// most cases. Exact for balanced models, by a ray with symbolic perturbation (Feito and Torres
/// 1997). Reads no options. Needs Ask::solid of both models. Takes O(log n + hits of the ray) time
/// per component, or O(n) against an unbalanced model. Never allocates.
[[nodiscard]] CDPREP_API Containment containment(const Pair& pair, Workspace& workspace) noexcept;

/// One triangle of each model, in source numbers.
struct TrianglePair {
    std::uint32_t a;
    std::uint32_t b;
    friend auto operator<=>(const TrianglePair&, const TrianglePair&) = default;
};

/// Finds every pair of triangles, one of each model, that overlap. With Overlap::closed, these are
/// the pairs with a common point.
///
/// Returns the number of pairs. Stores the first of them in `room`, in the order of (a, b). If
/// `room` is too short, it receives the smallest pairs, and the result is still the number of all
/// pairs. With an empty `room`, the function only counts. The order costs a sort of the stored
/// pairs.
///
/// Exact: the answer is that of exact arithmetic on the moved vertices, as transform_point() rounds
/// them. The answer is the same on every machine and in every floating-point environment of the
/// caller. An empty model overlaps nothing.
///
/// Reads options.overlap, degenerate and through. Needs Ask::overlap and ask_of(options.through) of
/// both models. Takes O(log n + pairs) time for typical meshes, O(n m) in the worst case. Here n
/// and m are the models' numbers of triangles. Through the BVH, a cache saves time while the models
/// stay apart: a query then takes as long as collide(). A query through octrees or tetra-trees uses
/// about 20 KiB of stack. Never allocates.
[[nodiscard]] CDPREP_API std::size_t overlaps(const Pair& pair, Workspace& workspace,
                                              std::span<TrianglePair> room) noexcept;

using PairVisitor = Visitor<TrianglePair>;

/// Calls `visit` once for each pair that overlaps() finds, as the search finds it. Stores and sorts
/// nothing. The order is the same for equal input on equal processors, otherwise unspecified.
/// Returns false if `visit` ended the search. Reads options.overlap and degenerate. Needs
/// Ask::overlap of both models.
///
///     std::size_t count = 0;
///     const auto visit = [&](const cdprep::TrianglePair&) { return ++count < 1000; };
///     cdprep::visit_overlaps(pair, workspace, visit);
CDPREP_API bool visit_overlaps(const Pair& pair, Workspace& workspace, PairVisitor visit) noexcept;

/// Marks the triangles of each model that overlap any triangle of the other, and returns the number
/// of pairs. The mark of source triangle i is bit i % 64 of element i / 64. Clears `bits_a` and
/// `bits_b` first. An array for a model needs Model::triangle_number_bound() / 64 elements, rounded
/// up. A shorter array is cleared, but gets no marks. This function is faster than overlaps() if
/// many pairs share few triangles. Reads options.overlap and degenerate. Needs Ask::overlap of both
/// models.
CDPREP_API std::size_t mark_overlaps(const Pair& pair, Workspace& workspace,
                                     std::span<std::uint64_t> bits_a,
                                     std::span<std::uint64_t> bits_b) noexcept;

/// Two triangles that overlap, and their common segment.
struct Crossing {
    TrianglePair pair;
    /// True if both triangles lie in one plane, or one of them has no area. Then no segment is
    /// given; in one plane, they may share an area.
    bool is_flat;
    Double3 from;  ///< an end of the common segment; 0 if `is_flat`
    Double3 to;    ///< the other end; equal to `from` if the triangles touch in a point
};

/// Finds every pair that overlaps() finds, with the common segment of its two triangles. Returns
/// the number of pairs and stores the first of them in `room`, as overlaps() does.
///
/// Coordinates are those of the placement, such as A's frame with Placement::b_moves(). The edges
/// on which a segment ends are determined exactly, for the vertices as transform_point() moves
/// them. Each coordinate is then rounded once. The result is the nearest double, except near the
/// midpoint between two doubles. Here "near" means within 2^-45 units in the last place
/// (crossing_segments_laws_test). Triangles that share an edge get bit-identical segment ends on
/// it, except near such a midpoint. Subnormal coordinates may be off by one unit in the last place.
///
/// Reads options.overlap and degenerate. Needs Ask::overlap of both models. Takes a few
/// microseconds more per pair than overlaps(), and about 20 KiB of stack. Never allocates.
[[nodiscard]] CDPREP_API std::size_t crossings(const Pair& pair, Workspace& workspace,
                                               std::span<Crossing> room) noexcept;

/// Calls `visit` once for each crossing that crossings() finds, as the search finds it. The order
/// is that of visit_overlaps(). Returns false if `visit` ended the search. Reads options.overlap
/// and degenerate. Needs Ask::overlap of both models.
CDPREP_API bool visit_crossings(const Pair& pair, Workspace& workspace,
                                Visitor<Crossing> visit) noexcept;

/// The limits of a distance query. The search ends when the interval meets either permitted error.
/// With both 0, the interval has the width that distance() states. An error that is negative or NaN
/// counts as 0.
struct DistanceOptions {
    double relative_error = 0;  ///< upper may exceed lower by this share of lower
    double absolute_error = 0;  ///< or upper may exceed lower by this, model units
    /// The largest distance to find, inclusive; model units.
    double max_distance = std::numeric_limits<double>::infinity();
};

/// The distance between two surfaces, and points where it is attained within the permitted errors.
struct Distance {
    double lower;              ///< the distance is at least this, model units
    double upper;              ///< and at most this: [lower, upper] contains the exact distance
    Double3 witness_a;         ///< on A as moved, up to rounding; nearest to B
    Double3 witness_b;         ///< on B as moved, up to rounding; nearest to A
    std::uint32_t triangle_a;  ///< the triangle with witness_a; source number
    std::uint32_t triangle_b;  ///< the triangle with witness_b; source number
};

/// Returns the distance between two surfaces. Returns nothing if the distance exceeds
/// options.max_distance, if max_distance is NaN, or if a model is empty.
///
/// The distance is 0 exactly if the surfaces touch or, with Body::solid, a component of one is
/// proven inside the other. If the surfaces touch, both witnesses are one common point. For
/// contained solids, the witnesses are the surfaces' nearest points. Otherwise the witnesses are
/// `upper` apart, up to rounding.
///
/// If the surfaces are apart and no errors are permitted, the result is a pair of triangles with
/// the least `upper`. If there are several, it is the first in the order of (triangle_a,
/// triangle_b). Pairs that are equally near in exact arithmetic may differ in the last bits of
/// `upper`. Any of these pairs may be the result, but always the same one. If the surfaces touch,
/// the result is a pair that touches. The instruction set and the structure determine which one.
/// With permitted errors, the result may be any pair and interval within them. The cache, the
/// front, the structure and the instruction set may determine which one.
///
/// The interval contains the exact distance between the surfaces whose vertices transform_point()
/// moved. Without permitted errors, its width is at most 1e-12 d + 1e-15 c
/// (triangle_distance_laws_test). Here d is the distance, and c the largest absolute coordinate of
/// the moved vertices. With permitted errors, the width is at most the larger of this bound and the
/// permitted error.
///
/// Reads pair.options.body and through. Any structure but Structure::pieces means the BVH. Needs
/// Ask::distance of both models, Ask::solid with Body::solid, and ask_of(options.through). Takes
/// O(log n) time for typical meshes. Visits every triangle in the worst case, such as concentric
/// spheres. Never allocates.
[[nodiscard]] CDPREP_API std::optional<Distance> distance(
    const Pair& pair, Workspace& workspace, const DistanceOptions& options = {}) noexcept;

/// Returns whether two surfaces are at most `tolerance` apart, in model units; inclusive. A
/// tolerance of 0 tests whether they touch. Returns false for a negative tolerance or NaN, and if a
/// model is empty.
///
/// Exact for the moved vertices, as transform_point() rounds them. A tolerance equal to the exact
/// distance gives true, and the next smaller double gives false. Stops at the first pair of
/// triangles that is near enough.
///
/// Reads options.through. Any structure but Structure::pieces means the BVH. Needs Ask::within and
/// ask_of(options.through) of both models. Takes as long as distance(), or less if the distance
/// differs clearly from `tolerance`.
[[nodiscard]] CDPREP_API bool within(const Pair& pair, double tolerance,
                                     Workspace& workspace) noexcept;

/// Finds every pair of triangles that are at most `tolerance` apart, in model units; inclusive.
///
/// Returns the number of pairs. Stores the first of them in `room`, as overlaps() does. A tolerance
/// of 0 gives the pairs of overlaps() with Overlap::closed; an infinite one gives all pairs. A
/// negative tolerance, a NaN or an empty model gives none.
///
/// Exact for the moved vertices, as transform_point() rounds them. A degenerate triangle counts as
/// its segment or point, unless it is skipped.
///
/// Reads options.degenerate and through. Any structure but Structure::pieces means the BVH. Needs
/// Ask::within and ask_of(options.through) of both models. Takes O(log n + pairs) time for typical
/// meshes and tolerances that are small compared with them. Takes O(n m) in the worst case. Never
/// allocates.
[[nodiscard]] CDPREP_API std::size_t pairs_within(const Pair& pair, double tolerance,
                                                  Workspace& workspace,
                                                  std::span<TrianglePair> room) noexcept;

/// Calls `visit` once for each pair that pairs_within() finds, as the search finds it. The order is
/// that of visit_overlaps(). Returns false if `visit` ended the search. Reads the same options as
/// pairs_within(). Needs Ask::within and ask_of(options.through) of both models.
///
///     std::vector<bool> is_near(pair.a.get().triangle_number_bound());
///     const auto visit = [&](const cdprep::TrianglePair& found) {
///         is_near[found.a] = true;
///         return true;
///     };
///     cdprep::visit_pairs_within(pair, 0.25, workspace, visit);
CDPREP_API bool visit_pairs_within(const Pair& pair, double tolerance, Workspace& workspace,
                                   PairVisitor visit) noexcept;

}  // namespace cdprep
