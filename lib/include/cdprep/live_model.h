// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
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
    /// Returns the number of bytes that in() takes. Fails if in() rejects `base`.
    [[nodiscard]] static Result<std::size_t> bytes(const build::ModelArrays& base);
    [[nodiscard]] static Result<std::size_t> bytes(const Model& base);

    /// Makes a live model of arrays or of another model, such as a baked one. `memory` must
    /// start at a multiple of format::kSectionAlignment and stay in place while the live model
    /// lives. `base` is not used afterwards. Allocates.
    ///
    /// Fails with `bad_argument` if `memory` is too small or misaligned. Also fails if a baked
    /// `base` has vertices that a repair made. Fails if it lacks, or was opened without, one of
    /// these sections: triangles, source_triangle, source_vertex, bvh_nodes, bvh_leaves and
    /// positions.
    [[nodiscard]] static Result<LiveModel> in(std::span<std::byte> memory,
                                                 const build::ModelArrays& base);
    [[nodiscard]] static Result<LiveModel> in(std::span<std::byte> memory, const Model& base);

    /// Returns the model to query. It is the same object after each refit(): spans and references
    /// into it stay valid.
    [[nodiscard]] const Model& model() const noexcept {
        return model_;
    }

    /// Returns the least number of positions that refit() accepts.
    [[nodiscard]] std::size_t position_count() const noexcept {
        return position_count_;
    }

    /// Moves all vertices. `positions` are numbered as in the mesh from which the base was made,
    /// and are in model units. Returns the surface_cost() of the BVH. When it has grown by half,
    /// build a new model.
    ///
    /// Query results are then those of a new model built from these positions. They depend neither
    /// on the old positions nor on `parallel_for`.
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
    [[nodiscard]] Result<double> refit(std::span<const format::Double3> positions,
                                       ParallelFor parallel_for = serial_for);
    [[nodiscard]] Result<double> refit(std::span<const format::Float3> positions,
                                       ParallelFor parallel_for = serial_for);

    /// Returns the bytes of the model, to store or to send. After a refit(), checksums and the
    /// volumes of components are out of date; no query reads them. This function updates both, so
    /// that Model::open() accepts a copy of the bytes. Takes O(bytes) time. Allocates.
    [[nodiscard]] std::span<const std::byte> image();

private:
    /// The positions, and the sections that depend on them.
    struct Moving {
        std::span<format::Float3> positions_f32;  ///< empty if the model keeps doubles
        std::span<format::Double3> positions_f64;
        std::span<format::BvhNode> nodes;
        std::span<format::BvhLeaf> leaves;
        std::span<std::uint64_t> degenerate_bits;
        std::span<format::Component> components;
    };

    static Result<LiveModel> in(std::span<std::byte> memory, const format::FileHeader& facts,
                                   const build::SectionList& sections);
    LiveModel(std::span<std::byte> image, Model model);

    template <class Position>
    Result<double> refit_to(std::span<const Position> positions, ParallelFor parallel_for);
    template <class Kept>
    double refit_over(std::span<const Kept> positions, ParallelFor parallel_for);
    void update_header(const build::Frame& frame, bool exact_leaves);

    std::span<std::byte> image_;
    Model model_;
    Moving moving_;
    std::size_t position_count_ = 0;
};

}  // namespace cdprep
