// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "cdprep/result.h"
#include "simulate/dynamics/rigid_bodies.h"

namespace cdprep::dynamics {

/// How a body resists.
struct BodyMass {
    double mass = 0;
    Double3 centre{};  ///< of mass, in model coordinates
    /// The rotation from the principal axes to those of the model, row by row.
    std::array<double, 9> model_from_axes = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    Double3 moments{};  ///< of inertia about the principal axes
    double radius = 0;  ///< no point of the model is farther from the centre
    /// The mass is spread as in the model's box: the file has no usable mass properties.
    bool is_box = false;
};

/// A symmetric matrix as a rotation of a diagonal one: matrix = axes diag(moments) axes^T.
struct PrincipalAxes {
    std::array<double, 9> axes;  ///< row by row; the columns are the axes, right-handed
    Double3 moments;
};

/// Returns the principal axes of an inertia tensor: xx, yy, zz, xy, yz, zx. Uses cyclic Jacobi
/// rotations (Golub and Van Loan 8.5). A diagonal tensor keeps its axes.
[[nodiscard]] PrincipalAxes principal_axes(const std::array<double, 6>& tensor) noexcept;

/// Returns the mass of a body, or why it has none.
[[nodiscard]] Result<BodyMass> mass_of(const RigidBody& body);

}  // namespace cdprep::dynamics
