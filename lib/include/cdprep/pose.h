// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "cdprep/format/api.h"
#include "cdprep/format/geometry.h"
#include "cdprep/result.h"

namespace cdprep {

using format::Double3;

/// A rigid motion, checked on construction. It maps a point p to rotation * p + translation. For
/// example, `world_from_arm` maps points of the arm into the world.
class Pose {
public:
    /// The identity.
    constexpr Pose() noexcept = default;

    /// Makes a pose from twelve numbers: the rotation R row by row, then the translation T, in
    /// model units. Fails with bad_argument if a number is not finite or its absolute value exceeds
    /// format::kMaxCoordinate; the message names that number. Also fails if an entry of |R^T R - I|
    /// exceeds kRotationTolerance, or R mirrors.
    [[nodiscard]] CDPREP_API static Result<Pose> from_rows(const std::array<double, 12>& rows);

    /// Makes a pose from any quaternion w + xi + yj + zk except zero; its length does not matter.
    /// Fails with bad_argument if a number is not finite, or w, x, y and z are all zero. Also fails
    /// if a coordinate of the translation exceeds format::kMaxCoordinate in absolute value. Each
    /// entry of R is within kQuaternionError of the exact one.
    [[nodiscard]] CDPREP_API static Result<Pose> from_quaternion(double w, double x, double y,
                                                                 double z,
                                                                 const Double3& translation);

    /// Returns R row by row.
    [[nodiscard]] constexpr const std::array<double, 9>& rotation() const noexcept {
        return rotation_;
    }
    /// Returns T in model units.
    [[nodiscard]] constexpr const Double3& translation() const noexcept {
        return translation_;
    }

    /// The largest permitted entry of |R^T R - I|.
    static constexpr double kRotationTolerance = 1e-12;
    /// The largest error of an entry of R made from a quaternion (pose_test).
    static constexpr double kQuaternionError = 8 * 0x1p-53;

private:
    /// Does the same as from_rows(), but does not set the default floating-point environment first.
    [[nodiscard]] static Result<Pose> checked(const std::array<double, 12>& rows);

    std::array<double, 9> rotation_ = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    Double3 translation_ = {0, 0, 0};

    CDPREP_API friend Pose relative_pose(const Pose& world_from_a,
                                         const Pose& world_from_b) noexcept;
    friend Pose uncorrected_relative_pose(const Pose& world_from_a,
                                          const Pose& world_from_b) noexcept;
};

/// Returns a_from_b = world_from_a^-1 world_from_b. Computes R = Ra^T Rb and T = Ra^T (Tb - Ta) in
/// double, each sum from left to right. The relative rounding error is about 1e-16, which may
/// separate parts that touch. If the parts of one assembly must still touch, use
/// Placement::world(). If an entry of |R^T R - I| exceeds Pose::kRotationTolerance, R is replaced
/// by the nearest rotation. The translation is not checked: its coordinates may be up to four times
/// format::kMaxCoordinate.
[[nodiscard]] CDPREP_API Pose relative_pose(const Pose& world_from_a,
                                            const Pose& world_from_b) noexcept;

/// Returns a_from_c: the pose that moves by `b_from_c` first, then by `a_from_b`. Uses one fixed
/// formula in double. If an entry of |R^T R - I| exceeds 1e-13, R is replaced by the nearest
/// rotation. So chains of any length stay rigid. Fails with bad_argument if a coordinate of the
/// translation exceeds format::kMaxCoordinate in absolute value.
[[nodiscard]] CDPREP_API Result<Pose> composed_pose(const Pose& a_from_b, const Pose& b_from_c);

/// Returns the inverse pose: R^T and -(R^T T). Corrects the rotation, and fails, as composed_pose()
/// does.
[[nodiscard]] CDPREP_API Result<Pose> inverse_pose(const Pose& a_from_b);

/// The order of the sixteen numbers of a matrix.
enum class MatrixLayout : std::uint8_t {
    rows,     ///< row by row: the translation is in elements 3, 7 and 11
    columns,  ///< column by column: in elements 12, 13 and 14
};

/// The largest tolerance of nearest_pose(). Beyond it, the nearest rotation means little.
inline constexpr double kGreatestPoseTolerance = 0.25;

/// Returns the pose nearest to a 4 x 4 matrix, such as a transform of a game engine. M is the upper
/// left 3 x 3 part of the matrix. The pose's rotation R minimises the sum of the squared entries of
/// M - R. Entries of |R^T R - I| are at most 1e-15 (pose_test).
///
/// The matrix may differ from a rigid motion by `tolerance`, which must be 0 to
/// kGreatestPoseTolerance. This limit holds for every entry of |M^T M - I|. It also holds for the
/// deviation of each entry of the last row from 0 0 0 1. For matrices of floats, 1e-5 is a good
/// value.
///
/// Fails with bad_argument, and states the reason, if the matrix mirrors. Also fails if it scales,
/// shears or projects by more than the tolerance, or the tolerance is out of range. Also fails if a
/// number is not finite, or its absolute value exceeds format::kMaxCoordinate.
[[nodiscard]] CDPREP_API Result<Pose> nearest_pose(const std::array<double, 16>& matrix,
                                                   double tolerance,
                                                   MatrixLayout layout = MatrixLayout::rows);

/// Returns the point p moved by `pose`. Its coordinates are ((R00 x + R01 y) + R02 z) + T0 and so
/// on. They are computed in double without contraction (fused multiply-add). Queries are exact for
/// the points that this function returns (level E1 of GLOSSARY.md). Neither compiler options nor
/// the caller's floating-point environment changes these points.
[[nodiscard]] CDPREP_API Double3 transform_point(const Pose& pose, const Double3& p) noexcept;

/// The poses of two models, and which of the models move.
///
/// A query moves each vertex of a moved model once, by transform_point(), and answers exactly for
/// the resulting doubles. The choice of the moving model matters: rounding shifts moved vertices by
/// up to 5 u (|R||v| + |t|) per axis. Here u = 2^-53, and R, t and v are the rotation, translation
/// and vertex.
class Placement {
public:
    /// B moves into A's frame. A does not move.
    [[nodiscard]] static Placement b_moves(const Pose& a_from_b) noexcept {
        return {Pose(), a_from_b, false, true};
    }
    /// A moves into B's frame. B does not move. A query on (a, b) with a_moves(p) gives the pairs
    /// of the query on (b, a) with b_moves(p), swapped, bit for bit.
    [[nodiscard]] static Placement a_moves(const Pose& b_from_a) noexcept {
        return {b_from_a, Pose(), true, false};
    }
    /// B moves by the relative_pose() of two world poses.
    [[nodiscard]] static Placement relative(const Pose& world_from_a,
                                            const Pose& world_from_b) noexcept {
        return b_moves(relative_pose(world_from_a, world_from_b));
    }
    /// Both models move, each by its own world pose. If parts of an assembly have equal poses,
    /// their common vertices stay equal. So parts that touch still touch.
    [[nodiscard]] static Placement world(const Pose& world_from_a,
                                         const Pose& world_from_b) noexcept {
        return {world_from_a, world_from_b, true, true};
    }

    [[nodiscard]] const Pose& pose_a() const noexcept {
        return pose_a_;
    }  ///< the identity if A does not move
    [[nodiscard]] const Pose& pose_b() const noexcept {
        return pose_b_;
    }  ///< the identity if B does not move
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
