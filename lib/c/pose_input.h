// SPDX-License-Identifier: MIT
#pragma once

#include "c/input.h"
#include "cdprep/c/pairs.h"
#include "cdprep/pose.h"

namespace cdprep::c {

inline constexpr cdprep_pose kIdentity = {{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}};

[[nodiscard]] bool is_identity(const cdprep_pose& pose) noexcept;

[[nodiscard]] cdprep_pose stored(const Pose& pose) noexcept;

/// Reads a pose whose numbers were checked. Refuses one that is not rigid.
int read_rigid(Call& call, const Name& name, const cdprep_pose& given, Pose& pose);

/// Reads a pose that is an argument of its own: checks its numbers, then that it is rigid.
int read_pose(Call& call, const Name& name, const cdprep_pose* given, Pose& pose);

/// Reads a pose that was computed. Refuses one that is too far away, or is not rigid.
int read_relative(Call& call, const Name& name, const cdprep_pose& computed, Pose& pose);

/// Reads two world poses; `moving` is one of CDPREP_MOVE_. Refuses models that are too far apart.
int read_placement(Call& call, const Name& name, std::uint32_t moving, const cdprep_pose& pose_a,
                   const cdprep_pose& pose_b, Placement& placement);

}  // namespace cdprep::c
