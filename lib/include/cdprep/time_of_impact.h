// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>

#include "cdprep/format/api.h"
#include "cdprep/motion.h"
#include "cdprep/pairs.h"

namespace cdprep {

/// Two models that move during a step. The models must outlive the MovingPair.
struct MovingPair {
    std::reference_wrapper<const Model> a;
    std::reference_wrapper<const Model> b;
    Motion motion_a = {};
    Motion motion_b = {};
    Body body = Body::surface;
};

struct ImpactOptions {
    /// The search ends when no point moves farther than this between `lower` and `upper`, relative
    /// to the other model. It also ends after narrowing [lower, upper] 32 times. Otherwise it ends
    /// when the surfaces are this near, and no time of contact is found. Model units.
    ///
    /// NaN and negative numbers count as 0. A tolerance close to rounding errors is raised to about
    /// 2^-37 of the largest coordinate. It is raised further for many turns, and for poses whose
    /// matrix is not quite a rotation.
    double tolerance = 0;
    /// The search ends after this many distance queries, not counting the one for Impact::nearest.
    std::uint32_t most_steps = 256;
};

/// The result that the search for an impact has proved.
enum class ImpactKind : std::uint8_t {
    none,        ///< the surfaces do not touch during the step
    touching,    ///< they touch first at a time in [lower, upper]
    near,        ///< they are within the tolerance at `lower`; a contact may follow or not
    unfinished,  ///< ImpactOptions::most_steps ended the search; a contact may follow `lower`
};

/// The result of time_of_impact().
struct Impact {
    ImpactKind kind = ImpactKind::none;
    /// The surfaces are apart at all earlier times. 1 if the kind is `none`.
    double lower = 1;
    /// The surfaces touch at this time. Infinity if no such time was found.
    double upper = std::numeric_limits<double>::infinity();
    std::uint32_t steps = 0;  ///< distance queries of the search, not counting that for `nearest`
    /// The nearest points at `lower`, in world coordinates. They give the direction of the contact.
    /// Nothing if the kind is `none`, or the models touch at time 0.
    std::optional<Distance> nearest;
};

/// Returns when two moving models first touch: an interval of time that holds the first contact.
///
/// The models are placed by Placement::world(), with the poses of Motion::at(). At each time before
/// `lower` that is a double, they are apart. At `upper` they touch, and collide() finds this. So no
/// contact is missed, however fast or thin a model is. If they touch at time 0, both bounds are 0.
/// With Body::solid, a model inside the other also touches it at time 0.
///
/// If the search ends at the tolerance without a contact, the kind is `near`. The models may then
/// pass each other closely, or touch later. A solver should treat this as an impact at `lower`. An
/// empty model touches nothing.
///
/// Conservative advancement (Mirtich 1996): no point moves faster than a bound, so a distance gives
/// a time without contact. Where the surfaces are close, each pair of triangles has a bound of its
/// own, along the direction between them. The method C2A does the same for boxes (Tang, Kim and
/// Manocha 2009).
///
/// Needs Ask::distance of both models, and Ask::solid with Body::solid. Each step of the search
/// takes one distance query, with a PairCache of its own. One more query finds the nearest points.
/// Near a contact, the search also takes some collide() queries. A pair that passes without coming
/// near takes 2 or 3 steps; an impact takes about 10. Never allocates.
[[nodiscard]] CDPREP_API Impact time_of_impact(const MovingPair& pair, Workspace& workspace,
                                               const ImpactOptions& options = {}) noexcept;

}  // namespace cdprep
