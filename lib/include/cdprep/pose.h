// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "cdprep/format/geometry.h"
#include "cdprep/result.h"

namespace cdprep {

using format::Double3;

/// A rigid motion, proved to be one when it was made: a point p goes to
/// rotation * p + translation. `world_from_arm` is a pose that maps points of
/// the arm into the world.
class Pose {
public:
    /// The identity.
    constexpr Pose() noexcept = default;

    /// Takes R row by row, then T, in model units. Fails with bad_argument, and
    /// says which number is wrong, when one is not finite or beyond
    /// format::kMaxCoordinate, when an entry of |R^T R - I| exceeds
    /// kRotationTolerance, or when R mirrors.
    [[nodiscard]] static Result<Pose> from_rows(const std::array<double, 12>& rows);

    /// Takes any quaternion w + xi + yj + zk but zero; its length does not
    /// matter. Fails with bad_argument when a number is not finite, all four are
    /// zero, or the translation is beyond format::kMaxCoordinate. Each entry of R
    /// is within kQuaternionError of the exact one.
    [[nodiscard]] static Result<Pose> from_quaternion(double w, double x, double y, double z,
                                                      const Double3& translation);

    /// R row by row.
    [[nodiscard]] constexpr const std::array<double, 9>& rotation() const noexcept {
        return rotation_;
    }
    /// Model units.
    [[nodiscard]] constexpr const Double3& translation() const noexcept {
        return translation_;
    }

    /// Largest permitted entry of |R^T R - I|.
    static constexpr double kRotationTolerance = 1e-12;
    /// Largest error of an entry of R made from a quaternion (pose_test).
    static constexpr double kQuaternionError = 8 * 0x1p-53;

private:
    /// from_rows() in the floating-point environment of the thread.
    [[nodiscard]] static Result<Pose> checked(const std::array<double, 12>& rows);

    std::array<double, 9> rotation_ = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    Double3 translation_ = {0, 0, 0};

    friend Pose relative_pose(const Pose& world_from_a, const Pose& world_from_b) noexcept;
};

/// Returns a_from_b = world_from_a^-1 world_from_b by one fixed formula, in
/// double: R = Ra^T Rb, T = Ra^T (Tb - Ta), each sum from left to right. It
/// carries rounding of about 1e-16 relative; where parts of one turned assembly
/// must still touch, use Placement::world.
[[nodiscard]] Pose relative_pose(const Pose& world_from_a, const Pose& world_from_b) noexcept;

/// Returns the pose that moves by `b_from_c` first and then by `a_from_b`, by one fixed formula in
/// double. A rotation that has drifted by more than 1e-13 is replaced by the nearest one, so that
/// chains of any length stay rigid. Fails with bad_argument when the translation exceeds
/// format::kMaxCoordinate.
[[nodiscard]] Result<Pose> composed_pose(const Pose& a_from_b, const Pose& b_from_c);

/// Returns the pose that moves back, likewise: R^T and -(R^T T).
[[nodiscard]] Result<Pose> inverse_pose(const Pose& a_from_b);

/// How the sixteen numbers of a matrix follow each other.
enum class MatrixLayout : std::uint8_t {
    rows,     ///< row by row: the translation is in elements 3, 7 and 11
    columns,  ///< column by column: in elements 12, 13 and 14
};

/// Largest tolerance of nearest_pose(): beyond, the nearest rotation means little.
inline constexpr double kGreatestPoseTolerance = 0.25;

/// Returns the pose that is nearest to a 4 x 4 matrix, such as one of an engine: the rotation R for
/// which the sum of squares of M - R is least, with |R^T R - I| at most 1e-15 (pose_test).
///
/// The matrix may differ from a rigid motion by `tolerance`, 0 to kGreatestPoseTolerance, in every
/// entry of |M^T M - I| and of its last row 0 0 0 1; for matrices of floats 1e-5 is a good value.
/// Fails with bad_argument, and says which, when it scales, shears, mirrors or projects by more
/// than that, when a number is not finite or beyond format::kMaxCoordinate, or when the tolerance
/// is not in its range.
[[nodiscard]] Result<Pose> nearest_pose(const std::array<double, 16>& matrix, double tolerance,
                                        MatrixLayout layout = MatrixLayout::rows);

/// Moves one point: ((R00 x + R01 y) + R02 z) + T0 and so on, in double without
/// contraction. This is *the* formula: an exact query answers for the points
/// that it returns (level E1 of exactness). Neither the compiler's options nor the
/// floating-point environment of the caller change it.
[[nodiscard]] Double3 transform_point(const Pose& pose, const Double3& p) noexcept;

}  // namespace cdprep
