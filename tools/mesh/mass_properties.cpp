// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/mass_properties.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "mesh/eigen_vector.h"

namespace cdprep::convex {
namespace {

Eigen::Vector3d box_centre(const mesh::Mesh& mesh) {
    Eigen::AlignedBox3d box;
    for (const mesh::Double3& p : mesh.positions) box.extend(vector_of(p));
    return 0.5 * box.min() + 0.5 * box.max();
}

/// Integrals over the tetrahedra between an origin and every triangle.
struct Integrals {
    double volume_6 = 0;                                   ///< six times the volume
    double area_2 = 0;                                     ///< twice the area
    Eigen::Vector3d first_24 = Eigen::Vector3d::Zero();    ///< 24 times integral of x
    Eigen::Matrix3d second_120 = Eigen::Matrix3d::Zero();  ///< 120 times integral of x x^T
};

/// Integrates over the tetrahedra (0, a, b, c). For determinant d and corner sum s, the integral
/// of x is d s / 24. The integral of x x^T is d (a a^T + b b^T + c c^T + s s^T) / 120.
Integrals integrate(const mesh::Mesh& mesh, const Eigen::Vector3d& origin) {
    Integrals sum;
    for (const mesh::Triangle& triangle : mesh.triangles) {
        const Eigen::Vector3d a = vector_of(mesh.positions[triangle.vertex[0]]) - origin;
        const Eigen::Vector3d b = vector_of(mesh.positions[triangle.vertex[1]]) - origin;
        const Eigen::Vector3d c = vector_of(mesh.positions[triangle.vertex[2]]) - origin;
        const double d = a.dot(b.cross(c));
        const Eigen::Vector3d s = a + b + c;
        sum.volume_6 += d;
        sum.area_2 += (b - a).cross(c - a).norm();
        sum.first_24 += d * s;
        sum.second_120 +=
            d * (a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose());
    }
    return sum;
}

}  // namespace

std::optional<format::MassProperties> find_mass_properties(const mesh::Mesh& mesh) {
    const Eigen::Vector3d origin = box_centre(mesh);
    const Integrals sum = integrate(mesh, origin);
    const double volume = sum.volume_6 / 6;
    if (volume == 0) return std::nullopt;
    const Eigen::Vector3d centre = sum.first_24 / 24 / volume;
    const Eigen::Matrix3d second = sum.second_120 / 120 - volume * centre * centre.transpose();
    const Eigen::Matrix3d inertia = second.trace() * Eigen::Matrix3d::Identity() - second;
    const Eigen::Vector3d place = origin + centre;
    if (!std::isfinite(volume) || !std::isfinite(sum.area_2) || !place.allFinite() ||
        !inertia.allFinite()) {
        return std::nullopt;
    }
    return format::MassProperties{
        volume,
        sum.area_2 / 2,
        {place.x(), place.y(), place.z()},
        {inertia(0, 0), inertia(1, 1), inertia(2, 2), inertia(0, 1), inertia(1, 2), inertia(2, 0)}};
}

PrincipalInertia principal_inertia(const std::array<double, 6>& inertia) {
    const auto& [xx, yy, zz, xy, yz, zx] = inertia;
    Eigen::Matrix3d tensor;
    tensor << xx, xy, zx, xy, yy, yz, zx, yz, zz;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(tensor);
    const Eigen::Vector3d& moments = solver.eigenvalues();
    Eigen::Matrix3d axes = solver.eigenvectors();
    axes.col(2) = axes.col(0).cross(axes.col(1));  // right-handed
    const Eigen::Quaterniond turn = Eigen::Quaterniond(axes).normalized();
    return {{moments.x(), moments.y(), moments.z()}, {turn.x(), turn.y(), turn.z(), turn.w()}};
}

}  // namespace cdprep::convex
