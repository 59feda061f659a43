// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "cdprep/advanced/build_model.h"
#include "cdprep/advanced/parallel_for.h"
#include "cdprep/format/api.h"
#include "cdprep/model.h"
#include "cdprep/result.h"

namespace cdprep {

/// The capacity of a live model that can tear.
struct LiveLimits {
    std::uint32_t triangles = 0;  ///< the maximum number; 0: the model cannot tear
    /// Triangles may use vertices with numbers less than this. 0: as many as position_count() at
    /// first, at least 1.
    std::uint32_t vertices = 0;
};

/// A triangle of a live model that can tear.
struct LiveTriangle {
    std::uint32_t number;                 ///< the number that answers use
    std::array<std::uint32_t, 3> vertex;  ///< numbers as in LiveModel::refit()

    friend bool operator<(const LiveTriangle& a, const LiveTriangle& b) noexcept {
        return a.number < b.number;
    }
};

/// A model whose vertices move and whose triangles come and go: an object that deforms and tears.
/// It is refitted each frame and queried like any other model. It lives in the caller's memory.
/// After construction, updates and queries allocate only on failure.
///
/// Each refit() updates positions, boxes, leaves and marks of degenerate triangles. The model has
/// no oriented boxes, because a refit with them would take three times as long. It has no swept
/// spheres, hulls, pieces, octrees, tetra-trees, mass properties or section `bounds`. It serves the
/// queries that need none of these: collide, overlap, distance, within, continuous, self, haptic,
/// ray, closest, inside and touch.
///
/// A model made with LiveLimits can tear: append() and remove() change its triangles. Once a
/// triangle was added or removed, model().is_torn() is true. The model then counts as unbalanced,
/// without winding numbers and components. So only boxes and surfaces decide about solids. Some
/// places of its tree order have no triangle. model().triangle_count() counts places, but is 0
/// without triangles. The triangle arrays of mesh() and source() have an element for each place.
///
/// A scene finds changes of an object's model itself if a LayerPair of the object's layer has
/// Ask::deform or Ask::tear. Otherwise, after a change, call set_pose() for each object that uses
/// the model. Caches stay valid: after a change, queries ignore the gaps proven before it.
///
/// Move-only; a move leaves the model's bytes in place. A live model that was moved from may only
/// be destroyed or assigned to. Const members, and queries about model(), may run on any number of
/// threads at once. None of these may run during a change or image().
///
///     const auto arrays = build::build_model(positions, triangles,
///                                            {.bounds = build::BvhBounds::aligned});
///     auto object = LiveModel::in(memory, arrays.value());
///     for (...) {
///         move(positions);
///         if (const auto fitted = object.value().refit(positions); !fitted) return fitted.error();
///         collide(object.value().model(), other, placement, workspace);
///     }
class LiveModel {
public:
    /// Returns the number of bytes that in() takes. Without limits, it is the size of the copied
    /// sections of the base, plus about 30 per triangle. With limits, it is 125 to 150 per triangle
    /// of the limit, for one vertex per two triangles. In both cases, up to 140 KB are added. Takes
    /// as much time and temporary memory as in(). Fails if in() rejects `base` or `limits`.
    [[nodiscard]] CDPREP_API static Result<std::size_t> bytes(const build::ModelArrays& base,
                                                              const LiveLimits& limits = {});
    [[nodiscard]] CDPREP_API static Result<std::size_t> bytes(const Model& base,
                                                              const LiveLimits& limits = {});

    /// Makes a live model from arrays or from another model, such as a baked one. `memory` must
    /// start at a multiple of format::kSectionAlignment and stay in place while the live model
    /// lives. `base` must not lie in it, and is not used afterwards. Allocates. Takes O(n) time;
    /// with limits, O(n log n) time. With limits, triangles are spread evenly over all places. So a
    /// limit far above the number of triangles makes queries slower.
    ///
    /// Fails with `bad_argument` if `memory` is too small or misaligned. Also fails if `base` is a
    /// Model that can tear or has vertices that a repair made. Fails if two vertices or two
    /// triangles of this Model have the same number. Fails if the Model lacks, or was opened
    /// without, one of these sections: triangles, source_triangle, source_vertex, bvh_nodes,
    /// bvh_leaves and positions. Without the section components, the live model does not serve
    /// Ask::solid. Fails if limits are lower than the counts of the base, or only vertices are
    /// limited. Also fails if the model would have more than 1,431,655,764 places, or
    /// limits.vertices exceeds format::kMaxVertices. With limits, at least a ninth of the places
    /// stays free.
    [[nodiscard]] CDPREP_API static Result<LiveModel> in(std::span<std::byte> memory,
                                                         const build::ModelArrays& base,
                                                         const LiveLimits& limits = {});
    [[nodiscard]] CDPREP_API static Result<LiveModel> in(std::span<std::byte> memory,
                                                         const Model& base,
                                                         const LiveLimits& limits = {});

    CDPREP_API LiveModel(LiveModel&&) noexcept;
    CDPREP_API LiveModel& operator=(LiveModel&&) noexcept;
    CDPREP_API ~LiveModel();

    /// Returns the model to query. It is the same object after each refit(): spans and references
    /// into it stay valid.
    [[nodiscard]] CDPREP_API const Model& model() const noexcept;

    /// Returns one more than the largest number of a vertex with a position. At first, it is the
    /// vertex count of the mesh from which the base was made, without unused vertices at its end.
    [[nodiscard]] CDPREP_API std::size_t position_count() const noexcept;

    /// Moves all vertices. `positions` are numbered as in the mesh from which the base was made,
    /// and are in model units. Positions of vertices that no triangle uses, or that the bake merged
    /// into others, do not change answers. In a model that can tear, triangles of a later append()
    /// may use them.
    ///
    /// Query results are then those of a new model built from these positions. They do not depend
    /// on `parallel_for`.
    ///
    /// Fails with `bad_argument`, and then changes nothing, if there are fewer positions than
    /// position_count(). Also fails if they are the positions of model(), which have another order.
    /// Fails and names the first bad position if one is NaN, infinite or beyond
    /// format::kMaxCoordinate. Fails if they are doubles and the model keeps floats; both kinds of
    /// models accept floats.
    ///
    /// A PairCache of this model stays valid. The content_hash of the header changes with the
    /// positions, so gaps proven before the refit are ignored. Takes O(n) time. Allocates only on
    /// failure.
    CDPREP_API Result<Done> refit(std::span<const format::Double3> positions,
                                  ParallelFor parallel_for = serial_for);
    CDPREP_API Result<Done> refit(std::span<const format::Float3> positions,
                                  ParallelFor parallel_for = serial_for);

    /// Moves some vertices: positions[i] is that of vertex number vertices[i]. If a vertex is
    /// listed twice, the last position counts. The model is then the same, byte for byte, as after
    /// a refit of all vertices to the same positions.
    ///
    /// In a model that can tear, a vertex that no triangle uses may get its first position.
    ///
    /// Fails with `bad_argument`, and then changes nothing, if `vertices` and `positions` differ in
    /// length. Also fails if a number in `vertices` is not less than position_count() or, in a
    /// model that can tear, LiveLimits::vertices. Fails if a refit of all vertices would reject one
    /// of the positions.
    ///
    /// Takes O(m log n) time for m triangles at these vertices, of n in all. Also reads one bit per
    /// leaf. Takes O(n) in three cases:
    /// - A vertex of a triangle leaves the cube of the frame. When chosen, this cube was two to
    ///   four times the model's size.
    /// - The model has become much smaller than this cube.
    /// - The first coordinate that is not a float appears, or the last one disappears.
    CDPREP_API Result<Done> refit(std::span<const std::uint32_t> vertices,
                                  std::span<const format::Double3> positions,
                                  ParallelFor parallel_for = serial_for);
    CDPREP_API Result<Done> refit(std::span<const std::uint32_t> vertices,
                                  std::span<const format::Float3> positions,
                                  ParallelFor parallel_for = serial_for);

    /// Adds triangles, whose vertices are numbered as in refit(). Returns the number of the first
    /// triangle; the others get the next numbers. Answers name a triangle by its number, which is
    /// never reused.
    ///
    /// Fails with `bad_argument`, and then changes nothing, if the model cannot tear or would have
    /// more triangles than LiveLimits::triangles. Also fails if a vertex does not exist or has no
    /// position. Fails if triangle numbers would reach 2^31 - 1, or `triangles` lie in the memory
    /// of model(). Takes O(m log n) time for m triangles, and reads one bit per leaf. In addition,
    /// full subtrees are redistributed: each at most once, and at most 4,096 triangles at a time.
    /// Takes O(n) more if a vertex lies outside the frame of the boxes. Allocates only on failure.
    CDPREP_API Result<std::uint32_t> append(std::span<const format::Triangle> triangles);

    /// Removes triangles by their numbers. A number that is listed twice counts once. Fails with
    /// `bad_argument`, and then changes nothing, if the model cannot tear or lacks one of the
    /// triangles. Also fails if `numbers` lie in the memory of model(). Takes O(m log n) time for m
    /// numbers, and reads one bit per leaf. Allocates only on failure.
    CDPREP_API Result<Done> remove(std::span<const std::uint32_t> numbers);

    /// Returns the number of triangles.
    [[nodiscard]] CDPREP_API std::uint32_t triangle_count() const noexcept;

    /// Returns the index of the triangle with this number in the mesh() and source() views of
    /// model(). Returns nothing if there is no such triangle, or if the model cannot tear. Takes
    /// O(1) time.
    [[nodiscard]] CDPREP_API std::optional<std::uint32_t> place_of(
        std::uint32_t number) const noexcept;

    /// Stores the triangles of a model that can tear, in ascending order of their numbers. If
    /// `room` is too small, it gets the triangles with the smallest numbers. Returns the number of
    /// all triangles; 0 for a model that cannot tear. Takes O(n log n) time.
    CDPREP_API std::size_t triangles(std::span<LiveTriangle> room) const noexcept;

    /// Rebuilds subtrees whose boxes have grown, so that queries stay fast. A call rebuilds up to
    /// `most_triangles` triangles and returns how many it rebuilt. It rebuilds whole subtrees of up
    /// to 4,096 triangles, so a smaller budget may do nothing for a larger model. The subtree whose
    /// surface cost has grown most since it was built comes first. Rebuilding begins when the cost
    /// of a subtree has grown by more than 40 %. It continues in later calls until no cost has
    /// grown by more than 20 %.
    ///
    /// Answers stay the same, but caches start anew. Within a step of a Sweep, rebuild() must come
    /// before Sweep::end(). A rebuild does not help if triangles that were far apart have come near
    /// each other: then surface_cost() stays high. Build a new model in this case. Takes O(nodes)
    /// time, and about 100 ns for each triangle rebuilt. Never allocates.
    CDPREP_API std::uint32_t rebuild(std::uint32_t most_triangles) noexcept;

    /// Returns build::surface_cost() of the BVH. When it has grown by half in spite of rebuild(),
    /// build a new model. Takes O(n) time.
    [[nodiscard]] CDPREP_API double surface_cost() const noexcept;

    /// Returns the bytes of the model, to save or to send. After a refit(), checksums and the
    /// volumes of components are out of date; no query reads them. This function updates both, so
    /// that Model::open() accepts a copy of the bytes. The bytes depend only on the base, the
    /// positions and the order that rebuild() made. Caches, sweeps and windows treat the call as a
    /// change of the model. So they ignore gaps proven before, and a Sweep needs a new step. Takes
    /// O(bytes) time. Allocates.
    ///
    /// Fails with `bad_argument` if the model can tear: build a model of its triangles() instead.
    [[nodiscard]] CDPREP_API Result<std::span<const std::byte>> image();

private:
    struct State;
    explicit LiveModel(std::unique_ptr<State> state) noexcept;
    template <class Position>
    Result<Done> refit_all(std::span<const Position> positions, ParallelFor parallel_for);
    template <class Position>
    Result<Done> refit_some(std::span<const std::uint32_t> vertices,
                            std::span<const Position> positions, ParallelFor parallel_for);

    std::unique_ptr<State> state_;
};

}  // namespace cdprep
