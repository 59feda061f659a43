// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "cdprep/collide.h"
#include "cdprep/model.h"
#include "cdprep/pair_cache.h"
#include "cdprep/placement.h"
#include "cdprep/workspace.h"

namespace cdprep {

/// How near is near enough. Either permitted error suffices to end the search; 0
/// asks for all that double can tell.
struct DistanceOptions {
    double relative_error = 0;  ///< upper may exceed lower by this share of lower
    double absolute_error = 0;  ///< or by this, model units
    /// Beyond, nothing is of interest; inclusive.
    double max_distance = std::numeric_limits<double>::infinity();
    /// Body::solid: a model proved inside the other is 0 from it (find_containment()).
    Body body = Body::surface;
};

/// The distance of two surfaces, and where it is taken.
struct Distance {
    double lower;              ///< the distance is at least this, model units
    double upper;              ///< and at most this: [lower, upper] holds the exact one
    Double3 witness_a;         ///< on A as moved, up to rounding; nearest to B
    Double3 witness_b;         ///< on B as moved, up to rounding; `upper` from witness_a
    std::uint32_t triangle_a;  ///< that witness_a lies on; source numbering
    std::uint32_t triangle_b;  ///< likewise
};

/// Returns how far two surfaces are apart, or nothing when that is more than
/// `max_distance` or a model is empty.
///
/// The distance is 0 exactly if the surfaces touch, with a common point as witness, or if, with
/// Body::solid, one model is proved inside the other. Its witnesses are then the surfaces' nearest
/// points. Of pairs of triangles with equal `upper` the one with the lowest numbers answers; of
/// pairs that are equally near in exact numbers, whose `upper` may differ in the last bits, any
/// may, and always the same. With Body::surface a small model inside a large one is as far away as
/// its walls are.
///
/// The interval holds the distance between the vertices as `placement` moves them
/// (level E1). Without permitted errors it is at most 1e-12 of the distance plus
/// 1e-15 of the largest coordinate wide (triangle_distance_laws_test); with them
/// at most that wide or as permitted.
///
/// Needs Ask::distance of both models; Body::solid also Ask::solid. Never allocates. Costs
/// O(log n) for compact surfaces; every triangle in the worst case, such as concentric spheres.
/// `cache` may be null.
[[nodiscard]] std::optional<Distance> distance(const Model& a, const Model& b,
                                               const Placement& placement, Workspace& workspace,
                                               const DistanceOptions& options = {},
                                               PairCache* cache = nullptr) noexcept;

/// Returns whether two surfaces are at most `tolerance` apart: the tolerance
/// belongs to it, and 0 asks whether they touch. False for a negative tolerance or
/// NaN, and when a model is empty.
///
/// Exact for the vertices as `placement` moves them: a distance that is equal to the
/// tolerance to the last bit is within it, and one step less is not. Stops at the
/// first pair of triangles that is near enough; triangles_within() finds all of them.
/// Needs Ask::within of both models. Costs as distance(), less where the answer is clear.
[[nodiscard]] bool is_within(const Model& a, const Model& b, const Placement& placement,
                             double tolerance, Workspace& workspace,
                             PairCache* cache = nullptr) noexcept;

}  // namespace cdprep
