// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "cdprep/advanced/build_model.h"
#include "cdprep/advanced/parallel_for.h"
#include "cdprep/model.h"
#include "cdprep/result.h"

namespace cdprep {

/// A model whose vertices move, such as an object that deforms. It is refitted each frame and
/// queried like any other. It lives in the caller's memory, is made once, and then allocates
/// nothing.
///
/// Triangles, source numbers and the order of the BVH never change. Each refit() updates positions,
/// boxes, leaves and marks of degenerate triangles. The model has no oriented boxes, because a
/// refit with them would take three times as long. It has no swept spheres, hulls, pieces, octrees,
/// bounds or mass. It serves the queries that need none of these: collide, overlap, distance,
/// within, ray, closest, inside and touch.
///
/// Move-only; a move leaves the model's bytes in place. Const members, and queries about model(),
/// may run on any number of threads at once. They must not run during refit() or image().
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
    /// Returns the number of bytes that in() takes: those of the base's sections, and about 30 per
    /// triangle. Fails if in() rejects `base`.
    [[nodiscard]] static Result<std::size_t> bytes(const build::ModelArrays& base);
    [[nodiscard]] static Result<std::size_t> bytes(const Model& base);

    /// Makes a live model of arrays or of another model, such as a baked one. `memory` must start
    /// at a multiple of format::kSectionAlignment and stay in place while the live model lives.
    /// `base` is not used afterwards. Allocates.
    ///
    /// Fails with `bad_argument` if `memory` is too small or misaligned. Also fails if a baked
    /// `base` has vertices that a repair made. Fails if it lacks, or was opened without, one of
    /// these sections: triangles, source_triangle, source_vertex, bvh_nodes, bvh_leaves and
    /// positions.
    [[nodiscard]] static Result<LiveModel> in(std::span<std::byte> memory,
                                              const build::ModelArrays& base);
    [[nodiscard]] static Result<LiveModel> in(std::span<std::byte> memory, const Model& base);

    LiveModel(LiveModel&&) noexcept;
    LiveModel& operator=(LiveModel&&) noexcept;
    ~LiveModel();

    /// Returns the model to query. It is the same object after each refit(): spans and references
    /// into it stay valid.
    [[nodiscard]] const Model& model() const noexcept;

    /// Returns the number of positions: that of the mesh from which the base was made, without
    /// unused vertices at its end.
    [[nodiscard]] std::size_t position_count() const noexcept;

    /// Moves all vertices. `positions` are numbered as in the mesh from which the base was made,
    /// and are in model units. Positions that no triangle uses, and those of vertices that the bake
    /// merged into others, have no effect.
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
    /// positions, so a cache from before the refit only costs time. Takes O(n) time. Allocates only
    /// on failure.
    Result<Done> refit(std::span<const format::Double3> positions,
                       ParallelFor parallel_for = serial_for);
    Result<Done> refit(std::span<const format::Float3> positions,
                       ParallelFor parallel_for = serial_for);

    /// Moves some vertices: positions[i] is that of vertex number vertices[i]. If a vertex is
    /// listed twice, the last position counts. The model is then the same, byte for byte, as after
    /// a refit of all vertices to the same positions.
    ///
    /// Fails as above, and if a number is not less than position_count(), or there are more or
    /// fewer positions than numbers. Takes O(m log n) time for m triangles at these vertices. Takes
    /// O(n) if a vertex leaves the frame of the boxes: a cube of at least twice the model's size
    /// when the frame was chosen. Also takes O(n) if the model has become much smaller than it.
    Result<Done> refit(std::span<const std::uint32_t> vertices,
                       std::span<const format::Double3> positions,
                       ParallelFor parallel_for = serial_for);
    Result<Done> refit(std::span<const std::uint32_t> vertices,
                       std::span<const format::Float3> positions,
                       ParallelFor parallel_for = serial_for);

    /// Returns build::surface_cost() of the BVH. When it has grown by half, build a new model.
    /// Takes O(n) time.
    [[nodiscard]] double surface_cost() const noexcept;

    /// Returns the bytes of the model, to store or to send. After a refit(), checksums and the
    /// volumes of components are out of date; no query reads them. This function updates both, so
    /// that Model::open() accepts a copy of the bytes. The bytes depend only on the base and the
    /// positions. Takes O(bytes) time. Allocates.
    [[nodiscard]] std::span<const std::byte> image();

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
