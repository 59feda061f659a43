// SPDX-License-Identifier: MIT
#include "c/pose_input.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <iterator>

#include "cdprep/format/float_environment.h"

namespace cdprep::c {
namespace {

bool is_too_far(const Pose& pose) noexcept {
    const Double3& t = pose.translation();
    return !(std::fabs(t.x) <= format::kMaxCoordinate && std::fabs(t.y) <= format::kMaxCoordinate &&
             std::fabs(t.z) <= format::kMaxCoordinate);
}

}  // namespace

bool is_identity(const cdprep_pose& pose) noexcept {
    // Twelve doubles without padding: one call is faster than twelve comparisons.
    return std::memcmp(&pose, &kIdentity, sizeof pose) == 0;  // NOLINT(bugprone-*)
}

cdprep_pose stored(const Pose& pose) noexcept {
    cdprep_pose to{};
    std::copy(pose.rotation().begin(), pose.rotation().end(), std::begin(to.rows));
    to.rows[9] = pose.translation().x;
    to.rows[10] = pose.translation().y;
    to.rows[11] = pose.translation().z;
    return to;
}

int read_rigid(Call& call, const Name& name, const cdprep_pose& given, Pose& pose) {
    if (is_identity(given)) {
        pose = Pose();
        return CDPREP_OK;
    }
    const format::FloatEnvironment environment;
    std::array<double, 12> rows{};
    std::copy(std::begin(given.rows), std::end(given.rows), rows.begin());
    const Result<Pose> made = Pose::from_rows(rows);
    if (!made) return call.refuse_with(CDPREP_WHY_NOT_RIGID, name, made.error().message);
    pose = made.value();
    return CDPREP_OK;
}

int read_pose(Call& call, const Name& name, const cdprep_pose* given, Pose& pose) {
    if (const int code = check_numbers(call, name.of("rows"), Holds::number, given->rows, 12)) {
        return code;
    }
    return read_rigid(call, name, *given, pose);
}

int read_relative(Call& call, const Name& name, const cdprep_pose& computed, Pose& pose) {
    {
        const format::FloatEnvironment environment;
        if (std::any_of(computed.rows + 9, computed.rows + 12,
                        [](double t) { return !(std::fabs(t) <= format::kMaxCoordinate); })) {
            return call.refuse(CDPREP_WHY_OUT_OF_RANGE, name, "is more than 2^1000 away.");
        }
    }
    return read_rigid(call, name, computed, pose);
}

int read_placement(Call& call, const Name& name, std::uint32_t moving, const cdprep_pose& pose_a,
                   const cdprep_pose& pose_b, Placement& placement) {
    assert(moving <= CDPREP_MOVE_BOTH);
    Pose a, b;
    if (const int code = read_rigid(call, name.of("pose_a"), pose_a, a)) return code;
    if (const int code = read_rigid(call, name.of("pose_b"), pose_b, b)) return code;
    if (moving == CDPREP_MOVE_BOTH) {
        placement = Placement::world(a, b);
        return CDPREP_OK;
    }
    const format::FloatEnvironment environment;
    const bool moves_b = moving == CDPREP_MOVE_B;
    // If a model is at the identity, the other's pose is used unchanged, to the last bit.
    const bool is_relative = !is_identity(moves_b ? pose_a : pose_b);
    Pose relative = moves_b ? b : a;
    if (is_relative) relative = moves_b ? relative_pose(a, b) : relative_pose(b, a);
    if (is_too_far(relative)) {
        return call.refuse(CDPREP_WHY_OUT_OF_RANGE, name.of("pose_b"),
                           "is more than 2^1000 away from pose_a.");
    }
    placement = moves_b ? Placement::b_moves(relative) : Placement::a_moves(relative);
    return CDPREP_OK;
}

}  // namespace cdprep::c
