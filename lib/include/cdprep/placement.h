// SPDX-License-Identifier: MIT
#pragma once

#include "cdprep/pose.h"

namespace cdprep {

/// How two models stand to each other, and which vertices move.
///
/// A query moves every vertex that moves once, by transform_point(), and then answers
/// exactly for the resulting doubles. So it matters who moves: rounding shifts
/// the moved vertices by up to 5 u (|R||v| + |t|) per axis, u = 2^-53.
class Placement {
public:
    /// B moves into A's frame, A stays as it is.
    [[nodiscard]] static Placement b_moves(const Pose& a_from_b) noexcept {
        return {Pose(), a_from_b, false, true};
    }
    /// A moves into B's frame. A query of (b, a) by b_moves(p) and one of (a, b)
    /// by a_moves(p) give the same pairs, swapped, bit for bit.
    [[nodiscard]] static Placement a_moves(const Pose& b_from_a) noexcept {
        return {b_from_a, Pose(), true, false};
    }
    /// Two world poses, through relative_pose(): B moves.
    [[nodiscard]] static Placement relative(const Pose& world_from_a,
                                            const Pose& world_from_b) noexcept {
        return b_moves(relative_pose(world_from_a, world_from_b));
    }
    /// Two world poses; both move, each by its own. Parts of one assembly that
    /// share vertices and a pose still share them: touching stays touching.
    [[nodiscard]] static Placement world(const Pose& world_from_a,
                                         const Pose& world_from_b) noexcept {
        return {world_from_a, world_from_b, true, true};
    }

    [[nodiscard]] const Pose& pose_a() const noexcept {
        return pose_a_;
    }  ///< identity: A stays
    [[nodiscard]] const Pose& pose_b() const noexcept {
        return pose_b_;
    }  ///< identity: B stays
    [[nodiscard]] bool a_is_moved() const noexcept {
        return a_is_moved_;
    }
    [[nodiscard]] bool b_is_moved() const noexcept {
        return b_is_moved_;
    }

private:
    Placement(const Pose& pose_a, const Pose& pose_b, bool a, bool b) noexcept
        : pose_a_(pose_a), pose_b_(pose_b), a_is_moved_(a), b_is_moved_(b) {}
    Pose pose_a_;
    Pose pose_b_;
    bool a_is_moved_;
    bool b_is_moved_;
};

}  // namespace cdprep
