// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "cdprep/containment.h"
#include "cdprep/overlapping_triangles.h"
#include "cdprep/pair_cache.h"

namespace cdprep {

/// What a model stands for in a question.
enum class Body : std::uint8_t {
    surface,  ///< its triangles alone
    solid,    ///< its triangles and what they enclose
};

struct CollideOptions {
    Body body = Body::surface;
    Overlap overlap = Overlap::closed;
    Degenerate degenerate = Degenerate::keep;
};

struct Collision {
    bool hit = false;  ///< surfaces touch, or (solid) one proved inside the other
    /// Body::solid only, and asked only when the surfaces do not touch; otherwise
    /// `no`. `unknown` leaves `hit` false.
    Containment containment;
};

/// Returns whether two models collide; stops at the first pair found.
///
/// With Body::surface two nested surfaces that do not touch do not collide. With
/// Body::solid they do, when a winding number other than 0 proves it: see
/// find_containment() for open models. As exact as overlapping_triangles().
///
/// Needs Ask::collide of both models; Body::solid also Ask::solid.
/// Costs O(log n) for most hits and misses; with a cache O(1) while the pair of
/// triangles that touched last still does, or while the models have moved less than
/// the gap that was proved. Never allocates. `cache` may be null.
[[nodiscard]] Collision collide(const Model& a, const Model& b, const Placement& placement,
                                Workspace& workspace, const CollideOptions& options = {},
                                PairCache* cache = nullptr) noexcept;

}  // namespace cdprep
