// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "cdprep/format/api.h"
#include "cdprep/motion.h"
#include "cdprep/pairs.h"

namespace cdprep {

/// The space through which a deforming model passes during a step: boxes around the path of each of
/// its triangles. Each vertex moves along a straight line, at constant speed. So a thin object is
/// found even if a triangle jumps over it in one step.
///
///     auto sweep = Sweep::in(memory, object.model());
///     for (...) {
///         sweep->begin();
///         object.refit(positions);
///         sweep->end();
///         if (may_touch(*sweep, blade, motion_of_blade, workspace)) { take smaller steps }
///     }
///
/// Lives in the caller's memory and allocates nothing. Copies share that memory. Queries about a
/// sweep may run on any number of threads at once. None may run from the call of begin() until
/// end() returns: the boxes then belong to no step.
class Sweep {
public:
    /// Returns the number of bytes that in() takes: 24 per vertex and about 4 per triangle.
    [[nodiscard]] CDPREP_API static std::size_t bytes(const Model& model) noexcept;

    /// Makes the sweep of a model that deforms in place, such as LiveModel::model(). The model must
    /// outlive the sweep. `memory` must start at a multiple of format::kSectionAlignment. Returns
    /// nothing if `memory` is too small or misaligned. Needs Ask::within and Ask::corners of the
    /// model. At first, nothing moves.
    [[nodiscard]] CDPREP_API static std::optional<Sweep> in(std::span<std::byte> memory,
                                                            const Model& model) noexcept;

    /// Begins a step: the positions of the model are those at time 0. Takes O(vertices) time.
    CDPREP_API void begin() noexcept;

    /// Ends the step: the positions of the model are those at time 1. A triangle that was appended
    /// within the step starts at its vertices' positions at time 0. Vertices without a position at
    /// time 0 start where the first vertex of the base was. If the base was empty, they start at
    /// the origin. A triangle that was removed within the step is left out. Takes O(n) time.
    CDPREP_API void end() noexcept;

    /// Returns whether queries may use the sweep. The step must have ended, and the model must be
    /// as it was then: neither moved, nor torn, nor rebuilt. LiveModel::image() counts as a change,
    /// too.
    [[nodiscard]] CDPREP_API bool is_current() const noexcept;

    [[nodiscard]] const Model& model() const noexcept {
        return *model_;
    }

    struct Storage;  ///< private to the library
    [[nodiscard]] const Storage& storage() const noexcept {
        return *storage_;
    }

private:
    Sweep(const Model& model, Storage& storage) noexcept : model_(&model), storage_(&storage) {}

    const Model* model_;
    Storage* storage_;
};

/// Returns whether the deforming model may touch B during the step of the sweep. The coordinates of
/// the deforming model are those of the world in which `motion` moves B.
///
/// `false` is certain: no triangle of one model touches a triangle of the other at any time of the
/// step. `true` means that the convex hull of a triangle's path, relative to B, comes near a
/// triangle of B. Whether and when the triangles touch is not known. may_touch() does not test
/// containment: collide() with Body::solid does. It does not test a model against itself, or two
/// models that both deform. Triangles that were removed during the step are left out. The hull
/// contains all places through which the triangle passes. So a step with less motion gives fewer
/// false alarms. If B turns by more than a quarter of a radian, the step is tested in up to 64
/// parts.
///
/// Requires sweep.is_current(). Needs Ask::within of B. Takes as long as within() with a tolerance
/// of half of B's motion. Each pair of triangles near each other takes about 1 us more for each
/// part. Never allocates.
[[nodiscard]] CDPREP_API bool may_touch(const Sweep& sweep, const Model& b, const Motion& motion,
                                        Workspace& workspace) noexcept;

/// Finds every pair of triangles that may touch during the step, by the test of may_touch().
/// Returns the number of pairs and stores the first of them in `room`, as overlaps() does. Triangle
/// `a` is of the deforming model.
///
/// Requires sweep.is_current(). Needs Ask::within of B.
[[nodiscard]] CDPREP_API std::size_t pairs_that_may_touch(const Sweep& sweep, const Model& b,
                                                          const Motion& motion,
                                                          Workspace& workspace,
                                                          std::span<TrianglePair> room) noexcept;

}  // namespace cdprep
