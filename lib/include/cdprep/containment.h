// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "cdprep/model.h"
#include "cdprep/placement.h"
#include "cdprep/workspace.h"

namespace cdprep {

enum class Answer : std::uint8_t { no, yes, unknown };

/// Whether a part of one model lies inside the other.
struct Containment {
    Answer answer = Answer::no;
    /// The deciding winding number: an integer when exact; the generalised one
    /// (solid angle / 4 pi) when `answer` is unknown; 0 when `answer` is no.
    double winding = 0;
    bool a_inside_b = false;  ///< which way, when `answer` is not no
};

/// Returns whether some component of one model lies inside the other, for two
/// models whose surfaces do not touch in `placement`.
///
/// Inside means a winding number other than 0: nested shells of opposite
/// orientation cancel, an inverted component counts as solid. A component inside
/// another model's *open* surface gives `unknown` with the generalised winding
/// number, unless another component answers `yes`. Where the generalised
/// winding number's magnitude is below 1/2 the answer about an open model is
/// `unknown` all the same: nothing is guessed.
///
/// Boxes decide most cases: a component whose vertex lies outside the other
/// model's box is outside, open or not. Exact for closed models (symbolic
/// perturbation of a ray; Feito and Torres). Needs Ask::solid of both models. Costs
/// O(components (log n + hits)); O(n) per component against an open model. Never
/// allocates.
[[nodiscard]] Containment find_containment(const Model& a, const Model& b,
                                           const Placement& placement,
                                           Workspace& workspace) noexcept;

/// Where a point is with respect to a solid.
struct Inclusion {
    Answer answer = Answer::no;  ///< unknown when the model is not closed and p is not on it
    bool on_surface = false;     ///< p lies on a triangle; then `answer` is yes
    double winding = 0;          ///< as in Containment; 0 on the surface
};

/// Returns whether `p` (model units, finite) is inside `model`. Same exactness
/// and costs as find_containment(). Needs Ask::inside.
[[nodiscard]] Inclusion points_inside(const Model& model, const Double3& p,
                                      Workspace& workspace) noexcept;

}  // namespace cdprep
