// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <variant>

#include "cdprep/format/api.h"
#include "cdprep/model.h"
#include "cdprep/pairs.h"
#include "cdprep/pose.h"
#include "cdprep/visitor.h"
#include "cdprep/workspace.h"

namespace cdprep {

// Queries about one model and a point, a ray or a shape.

/// The point of a surface nearest to a given point.
struct ClosestPoint {
    Double3 point;           ///< on the surface up to rounding, model units
    double lower;            ///< the distance is at least this, model units
    double upper;            ///< and at most this: [lower, upper] contains the exact distance
    std::uint32_t triangle;  ///< source number
};

/// Returns the point of `model`'s surface nearest to `query`, or nothing if no point of the surface
/// is within `max_distance`.
///
/// The distance is to the surface, not to the solid: a point deep inside a balanced model is far
/// away. If several triangles are equally near in double, the result is on the one with the lowest
/// number.
///
/// `query` must be finite. `max_distance` is inclusive. It may be infinite, but not NaN. A negative
/// limit finds nothing. A point within `max_distance` is never missed. The `lower` of a result is
/// at most `max_distance`. The interval always contains the exact distance
/// (closest_point_laws_test). Its width is a few ulp of the distance to the triangle's farthest
/// corner, more for slivers.
///
/// Needs Ask::closest. Never allocates. Visits every node in the worst case, such as a point at the
/// centre of a sphere.
///
///     if (auto near = cdprep::closest_point(model, {0, 0, 2}, workspace)) {
///         std::cout << "triangle " << near->triangle << " at " << near->upper << '\n';
///     }
[[nodiscard]] CDPREP_API std::optional<ClosestPoint> closest_point(
    const Model& model, const Double3& query, Workspace& workspace,
    double max_distance = std::numeric_limits<double>::infinity()) noexcept;

/// The position of a point with respect to a solid.
struct Inclusion {
    Answer answer = Answer::no;  ///< unknown in the box of an unbalanced model, off its surface
    bool on_surface = false;     ///< p lies on a triangle; then `answer` is yes
    double winding = 0;          ///< as in Containment; 0 on the surface
};

/// Returns whether the point `p` is inside `model`, by its winding number, as in containment(). `p`
/// is in model units and must be finite.
///
/// `through` chooses the structure. The result is the same through each, bit for bit. The
/// tetra-tree reads the triangles of one cone; octrees read those of the cells along a ray.
/// Structure::pieces is treated as Structure::bvh. `through` has no effect on unbalanced models.
///
/// Exact if the model is balanced: each edge is used equally often in both directions. Needs
/// Ask::inside and ask_of(through). For octrees and tetra-trees, the workspace must be made with
/// cells(). The BVH takes O(log n + hits of a ray) time, a tetra-tree O(level + triangles in one
/// cone). An octree takes O(cells along the ray + their triangles). QueryCounts::ray_triangles
/// counts the triangles that these searches read. For a point in the box of an unbalanced model,
/// the query takes O(n) time and counts nothing. Never allocates.
[[nodiscard]] CDPREP_API Inclusion points_inside(const Model& model, const Double3& p,
                                                 Workspace& workspace,
                                                 Structure through = Structure::bvh) noexcept;

/// A half-line: origin + t * direction, t >= 0, in model coordinates. If the model moves, transform
/// the ray back into the model's frame.
struct Ray {
    Double3 origin;     ///< model units, finite
    Double3 direction;  ///< finite, not zero; any length
};

/// A point where a ray meets a surface.
struct RayHit {
    double t;                ///< in multiples of the direction's length, within 2^-40 of itself
    Double3 point;           ///< origin + t * direction with this t, rounded
    std::uint32_t triangle;  ///< source number

    /// Compares by t, then by triangle.
    CDPREP_API friend bool operator<(const RayHit& a, const RayHit& b) noexcept;
};

struct RayOptions {
    /// The largest t of a hit, inclusive; it is compared with the rounded t. With a negative limit
    /// or NaN, nothing is hit. For a segment with exactly decided ends, use touches() with a
    /// Capsule of radius 0.
    double max_t = std::numeric_limits<double>::infinity();
};

/// Returns the first point where `ray` meets the surface, or nothing.
///
/// Each hit is decided exactly for the given origin and direction, by the signs of tetrahedron
/// volumes. A triangle includes its edges and vertices, so no ray passes between two triangles that
/// share an edge. Both sides of a triangle count. A ray in the plane of a triangle hits at the
/// point where the ray enters the triangle.
///
/// `t` and `point` are rounded. t is within 2^-40 of the exact value, relative to it, and usually
/// within a few ulp. This also holds for rays that graze a triangle, and for slivers. It does not
/// hold for a subnormal t, or where t |direction| is below 2^-1000 of the largest coordinate. The
/// rounded t decides the order of hits, and the hits that max_t excludes. So two hits may change
/// places if their exact t are as near each other. Among hits with equal t, the lowest source
/// number comes first. A model without triangles is never hit, and a zero direction hits nothing.
///
/// Needs Ask::ray. Takes O(log n) time for typical meshes. Never allocates.
[[nodiscard]] CDPREP_API std::optional<RayHit> cast_ray(const Model& model, const Ray& ray,
                                                        Workspace& workspace,
                                                        const RayOptions& options = {}) noexcept;

/// Returns whether `ray` hits any triangle, that is, whether cast_ray() would return a hit. Exact
/// if max_t is infinite. Stops at the first hit found, so it is faster than cast_ray(). Suffices
/// for shadows and lines of sight. Needs Ask::ray. Never allocates.
[[nodiscard]] CDPREP_API bool ray_hits(const Model& model, const Ray& ray, Workspace& workspace,
                                       const RayOptions& options = {}) noexcept;

/// Finds every triangle that `ray` hits, each once, at its first point on the ray.
///
/// Returns the number of hits. Sorts the hits by t, then by triangle, and stores as many of the
/// first ones as fit in `hits`. With an empty span, the function only counts. Hits are decided
/// exactly, as in cast_ray(). A ray through an edge or vertex hits all triangles there. Needs
/// Ask::ray. Takes O(log n) time for typical meshes, and time in proportion to the hits. Never
/// allocates.
[[nodiscard]] CDPREP_API std::size_t all_ray_hits(const Model& model, const Ray& ray,
                                                  Workspace& workspace, std::span<RayHit> hits,
                                                  const RayOptions& options = {}) noexcept;

using RayVisitor = Visitor<RayHit>;

/// Calls `visit` with every hit that all_ray_hits() finds, as the search finds it, in no particular
/// order. Returns false if `visit` ended the search. Needs Ask::ray. Takes as long as
/// all_ray_hits(). Never allocates.
CDPREP_API bool visit_ray_hits(const Model& model, const Ray& ray, Workspace& workspace,
                               RayVisitor visit, const RayOptions& options = {}) noexcept;

/// A solid box, aligned with the world axes. Limits may be infinite. With lower > upper on any
/// axis, or a NaN, it is not a box and touches nothing. With equal limits on one, two or three
/// axes, it is a rectangle, a segment or a point.
struct Box {
    Double3 lower;  ///< model units
    Double3 upper;  ///< inclusive
};

/// A solid ball.
struct Sphere {
    Double3 centre;  ///< model units, finite
    double radius;   ///< model units; negative or NaN touches nothing, 0 is a point
};

/// All points at most `radius` from a segment: a solid cylinder with round ends.
struct Capsule {
    Double3 from;   ///< an end of the segment, model units, finite
    Double3 to;     ///< the other end; if it equals `from`, the capsule is a sphere
    double radius;  ///< model units; negative or NaN touches nothing, 0 is the segment
};

/// One triangle, given by its corners, in model units, finite. Collinear or equal corners give the
/// segment or point that they span.
struct TriangleShape {
    std::array<Double3, 3> corner;
};

/// A shape in the world, closed and solid: touching counts, and a triangle inside the shape touches
/// it.
using Shape = std::variant<Box, Sphere, Capsule, TriangleShape>;

struct ShapeOptions {
    /// The pose of the model. Shapes are in world coordinates. transform_point() moves each vertex
    /// once, and the answer is exact for the resulting doubles. The identity moves nothing. For an
    /// answer that is exact for the stored vertices, give the shape in model coordinates.
    Pose world_from_model = {};
    Degenerate degenerate = Degenerate::keep;  ///< every query but shape_distance() reads it
    /// The largest distance that shape_distance() finds, inclusive; model units. With a negative
    /// limit or NaN, it finds nothing, not even a shape that touches. No other query reads the
    /// limit.
    double max_distance = std::numeric_limits<double>::infinity();
};

/// Returns whether `shape` has a point in common with a triangle of `model`. Stops at the first
/// such triangle found. The model is its surface: a shape deep inside a balanced model touches
/// nothing.
///
/// Exact, also for tangent spheres and capsules: signs of determinants and comparisons in integers
/// decide where double cannot. A triangle that lies in a face of the box touches it. A degenerate
/// triangle counts as its segment or point, unless it is skipped.
///
/// For an oriented box, use an axis-aligned box in the box's own frame. Pass box_from_model as
/// options.world_from_model. If two world poses are given, box_from_model is
/// relative_pose(world_from_box, world_from_model).
///
/// Needs Ask::touch. Takes O(log n) time for most hits and misses. Never allocates.
[[nodiscard]] CDPREP_API bool touches(const Model& model, const Shape& shape, Workspace& workspace,
                                      const ShapeOptions& options = {}) noexcept;

/// Finds every triangle of `model` that has a point in common with `shape`.
///
/// Returns the number of triangles. Stores their source numbers in `room`, sorted. If `room` is too
/// short, it receives the smallest ones. With an empty span, the function only counts. The answer
/// is as exact as that of touches(). Needs Ask::touch. Takes O(log n) time for most shapes, and
/// time in proportion to the triangles near the shape. Never allocates.
[[nodiscard]] CDPREP_API std::size_t touching_triangles(const Model& model, const Shape& shape,
                                                        Workspace& workspace,
                                                        std::span<std::uint32_t> room,
                                                        const ShapeOptions& options = {}) noexcept;

/// Receives the source number of a triangle.
using TriangleVisitor = Visitor<std::uint32_t>;

/// Calls `visit` once for each triangle that touching_triangles() finds, as the search finds it, in
/// no particular order. Returns false if `visit` ended the search. Needs Ask::touch. Takes as long
/// as touching_triangles(). Never allocates.
CDPREP_API bool visit_touching_triangles(const Model& model, const Shape& shape,
                                         Workspace& workspace, TriangleVisitor visit,
                                         const ShapeOptions& options = {}) noexcept;

/// The distance between a shape and a surface, and points where it is attained.
struct ShapeDistance {
    double lower;      ///< the distance is at least this, model units
    double upper;      ///< and at most this: [lower, upper] contains the exact distance
    Double3 on_model;  ///< on the surface as moved, up to rounding; nearest to the shape
    /// A point on the box or triangle, the centre of the sphere, or a point on the capsule's
    /// segment.
    Double3 on_shape;
    std::uint32_t triangle;  ///< the triangle with on_model; source number
};

/// Returns the distance of `shape` from the surface of `model`. The distance is exactly 0 if they
/// touch. Otherwise, for a sphere or capsule, it is the distance of the centre or segment minus the
/// radius. Returns nothing if the distance exceeds options.max_distance or the model has no
/// triangles. Also returns nothing for a shape that touches nothing, such as a sphere with a
/// negative radius.
///
/// The interval contains the exact distance to the surface whose vertices transform_point() moved.
/// Its width is at most 1e-12 d + 1e-15 c. Here d is the distance, and c the largest absolute
/// coordinate of the shape and the moved vertices. For spheres and capsules, this is the width for
/// the centre or segment. The subtraction of the radius adds at most 4 ulp of `upper`.
///
/// If the shape touches several triangles, any of them may be the result. Otherwise, among
/// triangles with equal `upper`, the result is the one with the lowest number. Among triangles that
/// are equally near in exact arithmetic, any may be the result, but always the same one.
///
/// Needs Ask::touch. Visits every triangle in the worst case. A box that does not touch the model
/// takes twelve searches: two triangles cover each of its six sides. Each search is limited to the
/// smallest distance found before. Never allocates.
[[nodiscard]] CDPREP_API std::optional<ShapeDistance> shape_distance(
    const Model& model, const Shape& shape, Workspace& workspace,
    const ShapeOptions& options = {}) noexcept;

}  // namespace cdprep
