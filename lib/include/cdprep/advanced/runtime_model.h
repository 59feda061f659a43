// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "cdprep/advanced/build_model.h"
#include "cdprep/advanced/parallel_for.h"
#include "cdprep/model.h"
#include "cdprep/result.h"

namespace cdprep::build {

/// A model whose vertices move: an object that deforms, refitted each frame and asked like any
/// other. It lives in memory of the caller, is made once, and then allocates nothing.
///
/// Triangles, the numbers of answers and the order of the hierarchy stay; positions, boxes,
/// leaves and marks of degenerate triangles follow each refit(). The model has no oriented
/// boxes, with which a refit would take three times as long, and no swept spheres, hulls,
/// pieces, octrees, bounds or mass. So it serves what needs none of these: collide, overlap,
/// distance, within, ray, closest, inside and touch.
///
/// Move-only; moving it does not move its model's bytes. Const members and questions about
/// model() may run on any number of threads at once, but not while refit() or image() runs.
///
///     const auto arrays = build::build_model(positions, triangles,
///                                            {.bounds = build::BvhBounds::aligned});
///     auto object = build::RuntimeModel::in(memory, arrays.value());
///     for (...) {
///         move(positions);
///         if (const auto fitted = object.value().refit(positions); !fitted) return fitted.error();
///         collide(object.value().model(), other, placement, workspace);
///     }
class RuntimeModel {
public:
    /// Returns how many bytes in() takes. Fails as it does.
    [[nodiscard]] static Result<std::size_t> bytes(const ModelArrays& base);
    [[nodiscard]] static Result<std::size_t> bytes(const Model& base);

    /// Makes a run-time model of arrays, or of a model that was baked, say. `memory` starts at
    /// a multiple of format::kSectionAlignment and stays where it is while the run-time model
    /// lives; `base` is not needed afterwards. Allocates.
    ///
    /// Fails with `bad_argument` when `memory` does not fit, and when a baked `base` lacks, or
    /// was opened without, one of the sections triangles, source_triangle, source_vertex,
    /// bvh_nodes, bvh_leaves and positions, or has vertices that a repair made.
    [[nodiscard]] static Result<RuntimeModel> in(std::span<std::byte> memory,
                                                 const ModelArrays& base);
    [[nodiscard]] static Result<RuntimeModel> in(std::span<std::byte> memory, const Model& base);

    /// What is asked. The same object after each refit(): spans and references into it stay
    /// valid.
    [[nodiscard]] const Model& model() const noexcept {
        return model_;
    }

    /// The least number of positions that refit() wants.
    [[nodiscard]] std::size_t position_count() const noexcept {
        return position_count_;
    }

    /// Moves all vertices. Positions have the numbers of the mesh that the base was made of,
    /// and are in model units.
    ///
    /// Answers are afterwards those of a model that was built anew from these positions. They
    /// do not depend on what the positions were, nor on `parallel_for`. Returns the
    /// surface_cost() of the hierarchy: when it has grown by half, build the model anew.
    ///
    /// Fails with `bad_argument`, and then changes nothing, when there are fewer positions
    /// than position_count(); when they are those of model(), which have another order; when
    /// one is NaN, infinite or beyond format::kMaxCoordinate, naming the first; and when they
    /// are doubles and the model keeps floats. Floats are taken by both kinds of models.
    ///
    /// A PairCache of this model stays valid: content_hash of the header follows the
    /// positions, and so an older cache only costs time. O(n). Allocates nothing unless it
    /// fails.
    [[nodiscard]] Result<double> refit(std::span<const format::Double3> positions,
                                       ParallelFor parallel_for = serial_for);
    [[nodiscard]] Result<double> refit(std::span<const format::Float3> positions,
                                       ParallelFor parallel_for = serial_for);

    /// Returns the bytes of the model, to keep or to send: after a refit() their checksums are
    /// out of date, as are the volumes of components, which no question reads. This brings
    /// both up to date, so that Model::open() takes a copy of the bytes. O(bytes); allocates.
    [[nodiscard]] std::span<const std::byte> image();

private:
    /// The sections that follow the positions.
    struct Moving {
        std::span<format::Float3> positions_f32;  ///< or
        std::span<format::Double3> positions_f64;
        std::span<format::BvhNode> nodes;
        std::span<format::BvhLeaf> leaves;
        std::span<std::uint64_t> degenerate_bits;
        std::span<format::Component> components;
    };

    static Result<RuntimeModel> in(std::span<std::byte> memory, const format::FileHeader& facts,
                                   const SectionList& sections);
    RuntimeModel(std::span<std::byte> image, Model model);

    template <class Position>
    Result<double> refit_to(std::span<const Position> positions, ParallelFor parallel_for);
    template <class Kept>
    double refit_over(std::span<const Kept> positions, ParallelFor parallel_for);
    void update_header(const Frame& frame, bool exact_leaves);

    std::span<std::byte> image_;
    Model model_;
    Moving moving_;
    std::size_t position_count_ = 0;
};

}  // namespace cdprep::build
