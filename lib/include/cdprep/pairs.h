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
#include "cdprep/model.h"
#include "cdprep/pose.h"
#include "cdprep/visitor.h"
#include "cdprep/workspace.h"

namespace cdprep {

struct PairFront;

/// An answer that may not be known: of an open mesh, for example, no inside is defined.
enum class Answer : std::uint8_t { no, yes, unknown };

/// The point set that a model is.
enum class Body : std::uint8_t {
    surface,  ///< its triangles alone
    solid,    ///< its triangles and what they enclose
};

/// The kind of common points that make two triangles overlap.
enum class Overlap : std::uint8_t {
    closed,  ///< any common point: touching counts
    proper,  ///< the triangles cross, or share area in one plane
};

/// The treatment of triangles with collinear corners.
enum class Degenerate : std::uint8_t {
    keep,  ///< they answer as the segment or point that they are
    skip,  ///< they never answer
};

/// Options of a question about two models. Each question says which it reads.
struct PairOptions {
    Body body = Body::surface;
    Overlap overlap = Overlap::closed;
    Degenerate degenerate = Degenerate::keep;
    /// The structure of both files that finds the answer. It changes speed only. A question that
    /// has no search through it uses the BVH.
    Structure through = Structure::bvh;
};

/// Two models, which outlive it, and their placement: the subject of a question.
///
///     cdprep::Workspace workspace;
///     cdprep::Pair pair{*arm, *part, cdprep::Placement::b_moves(*pose)};
///     bool hit = collide(pair, workspace).hit == cdprep::Answer::yes;
struct Pair {
    std::reference_wrapper<const Model> a;
    std::reference_wrapper<const Model> b;
    Placement placement;
    PairOptions options = {};
    PairCache* cache = nullptr;  ///< results of earlier questions about this pair, or null
    /// The same, for distances through Structure::pieces (pair_front.h); or null.
    PairFront* front = nullptr;
};

/// The containment of a part of one model in the other.
struct Containment {
    Answer answer = Answer::no;
    /// The deciding winding number: an integer when exact; the generalised one
    /// (solid angle / 4 pi) when `answer` is unknown; 0 when `answer` is no.
    double winding = 0;
    bool a_inside_b = false;  ///< which way, when `answer` is not no
};

/// The answer of collide().
struct Collision {
    /// yes: the surfaces touch or, with Body::solid, one model is proved inside the other.
    /// unknown: the surfaces do not touch, and `containment` is unknown.
    Answer hit = Answer::no;
    /// Set with Body::solid when the surfaces do not touch; otherwise its answer is no.
    Containment containment;
};

/// Returns whether two models collide. Stops at the first pair of triangles found.
///
/// With Body::surface, nested surfaces that do not touch do not collide. With Body::solid they
/// do when a nonzero winding number proves it; see containment() for open models. As exact as
/// overlaps().
///
/// Reads all options. Needs Ask::collide of both models; Body::solid also Ask::solid, and
/// options.through its ask_of(). Takes O(log n) time for most poses. With a cache, a repeated hit
/// or a motion below the proven gap takes O(1). Never allocates.
[[nodiscard]] Collision collide(const Pair& pair, Workspace& workspace) noexcept;

/// Returns whether some component of one model lies inside the other, for two models whose
/// surfaces do not touch.
///
/// Inside means a winding number other than 0: nested shells of opposite orientation cancel, an
/// inverted component counts as solid. A component inside the other model's open surface gives
/// `unknown` with the generalised winding number, unless another component answers `yes`. The
/// answer about an open model is `unknown` whatever that number is.
///
/// Boxes decide most cases: a component whose vertex lies outside the other model's box is
/// outside, open or not. Exact for balanced models: a ray with symbolic perturbation (Feito and
/// Torres 1997). Reads no options. Needs Ask::solid of both models. Takes O(components (log n +
/// hits)) time; O(n) per component against an open model. Never allocates.
[[nodiscard]] Containment containment(const Pair& pair, Workspace& workspace) noexcept;

/// One triangle of each model, in the numbering of the imported files.
struct TrianglePair {
    std::uint32_t a;
    std::uint32_t b;
    friend auto operator<=>(const TrianglePair&, const TrianglePair&) = default;
};

/// Finds every pair of triangles of the two models that have a point in common.
///
/// Returns the number of pairs and stores the first of them, in the order of (a, b), in `room`.
/// If `room` is too short, it holds the smallest pairs, and the result is still the true number;
/// an empty span counts. The order costs a sort of the stored pairs.
///
/// Exact: the answer is that of exact arithmetic on the vertices as transform_point() moves them,
/// the same on every machine and in every floating-point environment of the caller. An empty
/// model overlaps nothing.
///
/// Reads options.overlap, degenerate and through. Needs Ask::overlap of both models, and
/// options.through its ask_of(). Takes O(log n + pairs) time for compact surfaces, O(n m) in the
/// worst case; with a cache, a pose in which nothing touches costs as much as collide(). Through
/// octrees and tetra-trees it takes some 20 KiB of stack. Never allocates.
[[nodiscard]] std::size_t overlaps(const Pair& pair, Workspace& workspace,
                                   std::span<TrianglePair> room) noexcept;

using PairVisitor = Visitor<TrianglePair>;

/// Calls `visit` with every pair that overlaps() finds, each once, as it is found. Stores and
/// sorts nothing. The order is the same for equal input on equal processors, otherwise
/// unspecified. Returns false if `visit` ended the search. Reads options.overlap and degenerate.
/// Needs Ask::overlap of both models.
///
///     std::size_t count = 0;
///     const auto visit = [&](const cdprep::TrianglePair&) { return ++count < 1000; };
///     cdprep::visit_overlaps(pair, workspace, visit);
bool visit_overlaps(const Pair& pair, Workspace& workspace, PairVisitor visit) noexcept;

/// Marks the triangles of either model that overlap any triangle of the other: bit i % 64 of
/// element i / 64 for source triangle i. Clears `bits_a` and `bits_b` first. Each must have an
/// element for every 64 triangles of its model; otherwise nothing is marked in it. Returns the
/// number of pairs. Faster than overlaps() where many pairs share few triangles. Reads
/// options.overlap and degenerate. Needs Ask::overlap of both models.
std::size_t mark_overlaps(const Pair& pair, Workspace& workspace, std::span<std::uint64_t> bits_a,
                          std::span<std::uint64_t> bits_b) noexcept;

/// Two triangles that overlap, and the segment in which they meet.
struct Crossing {
    TrianglePair pair;
    /// The triangles lie in one plane, or one has no area: they may share an area, and no
    /// segment is given.
    bool is_flat;
    Double3 from;  ///< an end of the common segment; 0 when `is_flat`
    Double3 to;    ///< the other end; equal to `from` where the triangles touch in a point
};

/// Finds every pair that overlaps() finds, and the segment in which its two triangles meet.
/// Returns the number of pairs and stores the first of them in `room`, as overlaps() does.
///
/// Coordinates are those of the placement: A's frame where B moves. The edges that end a segment
/// are chosen exactly, for the vertices as transform_point() moves them. Each coordinate is then
/// rounded once: to the nearest double, unless it lies within 2^-45 units in the last place of
/// the middle between two (crossing_segments_laws_test). Neighbours that share an edge therefore
/// share the end on it, bit for bit, except for those ties. Subnormal coordinates may be off by
/// one unit.
///
/// Reads options.overlap and degenerate. Needs Ask::overlap of both models. Costs some
/// microseconds more per pair than overlaps(). Never allocates; takes some 20 KiB of stack.
[[nodiscard]] std::size_t crossings(const Pair& pair, Workspace& workspace,
                                    std::span<Crossing> room) noexcept;

/// Calls `visit` with everything that crossings() finds, each once, as it is found, in the order
/// of visit_overlaps(). Returns false if `visit` ended the search. Reads options.overlap and
/// degenerate. Needs Ask::overlap of both models.
bool visit_crossings(const Pair& pair, Workspace& workspace, Visitor<Crossing> visit) noexcept;

/// Limits of a distance. Either permitted error ends the search; 0 asks for all that double can
/// tell.
struct DistanceOptions {
    double relative_error = 0;  ///< upper may exceed lower by this share of lower
    double absolute_error = 0;  ///< or by this, model units
    /// Nothing farther is found; inclusive.
    double max_distance = std::numeric_limits<double>::infinity();
};

/// The distance of two surfaces, and the points where it is attained.
struct Distance {
    double lower;              ///< the distance is at least this, model units
    double upper;              ///< and at most this: [lower, upper] holds the exact one
    Double3 witness_a;         ///< on A as moved, up to rounding; nearest to B
    Double3 witness_b;         ///< on B as moved, up to rounding; `upper` from witness_a
    std::uint32_t triangle_a;  ///< that witness_a lies on; source numbering
    std::uint32_t triangle_b;  ///< that witness_b lies on; source numbering
};

/// Returns the distance of two surfaces, or nothing when it exceeds options.max_distance or a
/// model is empty.
///
/// The distance is 0 exactly if the surfaces touch or, with Body::solid, one model is proved
/// inside the other. Witnesses of touching surfaces are a common point; those of contained
/// solids are the surfaces' nearest points. Of pairs of triangles with equal `upper` the one with
/// the lowest numbers answers. Of pairs that are equally near in exact numbers, whose `upper` may
/// differ in the last bits, any may answer, and always the same. Through Structure::pieces,
/// another pair of touching triangles may answer.
///
/// The interval holds the distance between the vertices as transform_point() moves them. Without
/// permitted errors its width is at most 1e-12 of the distance plus 1e-15 of the largest
/// coordinate (triangle_distance_laws_test); with them at most that or as permitted.
///
/// Reads pair.options.body and, of options.through, Structure::pieces. Needs Ask::distance of
/// both models; Body::solid also Ask::solid, and options.through its ask_of(). Takes O(log n)
/// time for compact surfaces; visits every triangle in the worst case, such as concentric
/// spheres. Never allocates.
[[nodiscard]] std::optional<Distance> distance(const Pair& pair, Workspace& workspace,
                                               const DistanceOptions& options = {}) noexcept;

/// Returns whether two surfaces are at most `tolerance` apart, model units; inclusive, and 0 asks
/// whether they touch. False for a negative tolerance or NaN, and when a model is empty.
///
/// Exact for the vertices as transform_point() moves them: a distance equal to the tolerance to
/// the last bit is within it, and one step less is not. Stops at the first pair of triangles that
/// is near enough.
///
/// Reads, of options.through, Structure::pieces. Needs Ask::within of both models, and
/// options.through its ask_of(). Costs as distance(), less where the answer is clear.
[[nodiscard]] bool within(const Pair& pair, double tolerance, Workspace& workspace) noexcept;

/// Finds every pair of triangles that are at most `tolerance` apart, model units; inclusive.
///
/// Returns the number of pairs and stores the first of them in `room`, in the order and with the
/// meaning of overlaps(). A tolerance of 0 gives the pairs of overlaps() with Overlap::closed, an
/// infinite one all pairs; a negative one or NaN gives none, and an empty model has none.
///
/// Exact for the vertices as transform_point() moves them. Degenerate triangles are as far away
/// as the segment or point that they are, unless they are skipped.
///
/// Reads options.degenerate and, of options.through, Structure::pieces. Needs Ask::within of both
/// models, and options.through its ask_of(). Takes O(log n + pairs) time for compact surfaces and
/// tolerances that are small against them, O(n m) in the worst case. Never allocates.
[[nodiscard]] std::size_t pairs_within(const Pair& pair, double tolerance, Workspace& workspace,
                                       std::span<TrianglePair> room) noexcept;

/// Calls `visit` with every pair that pairs_within() finds, each once, as it is found, in the
/// order of visit_overlaps(). Returns false if `visit` ended the search. Reads what pairs_within()
/// reads. Needs Ask::within of both models, and options.through its ask_of().
///
///     std::vector<bool> is_near(pair.a.get().triangle_count());
///     const auto visit = [&](const cdprep::TrianglePair& found) {
///         is_near[found.a] = true;
///         return true;
///     };
///     cdprep::visit_pairs_within(pair, 0.25, workspace, visit);
bool visit_pairs_within(const Pair& pair, double tolerance, Workspace& workspace,
                        PairVisitor visit) noexcept;

}  // namespace cdprep
