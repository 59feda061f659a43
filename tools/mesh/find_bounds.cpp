// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/find_bounds.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "mesh/eigen_vector.h"

namespace cdprep::convex {
namespace {

mesh::Double3 double3(const Eigen::Vector3d& v) {
    return {v.x(), v.y(), v.z()};
}

Eigen::AlignedBox3d box_of(const mesh::Mesh& mesh) {
    Eigen::AlignedBox3d box;
    for (const mesh::Double3& p : mesh.positions) box.extend(vector_of(p));
    return box;
}

/// Scales the mesh to about unit size around 0, by a power of two. No square then overflows or
/// underflows.
struct Normalization {
    Eigen::Vector3d centre;
    int exponent;

    [[nodiscard]] Eigen::Vector3d operator()(const mesh::Double3& p) const {
        const Eigen::Vector3d d = vector_of(p) - centre;
        return {std::ldexp(d.x(), exponent), std::ldexp(d.y(), exponent),
                std::ldexp(d.z(), exponent)};
    }
};

Normalization normalization_for(const Eigen::AlignedBox3d& box) {
    const Eigen::Vector3d centre = 0.5 * box.min() + 0.5 * box.max();
    const double size = (box.max() - centre).maxCoeff();
    return {centre, size > 0 ? -std::ilogb(size) : 0};
}

/// Returns the axes of the area-weighted covariance as columns, right-handed.
Eigen::Matrix3d principal_axes(const mesh::Mesh& mesh, const Normalization& normalized) {
    double area = 0;
    Eigen::Vector3d first = Eigen::Vector3d::Zero();
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
    for (const mesh::Triangle& triangle : mesh.triangles) {
        const Eigen::Vector3d a = normalized(mesh.positions[triangle.vertex[0]]);
        const Eigen::Vector3d b = normalized(mesh.positions[triangle.vertex[1]]);
        const Eigen::Vector3d c = normalized(mesh.positions[triangle.vertex[2]]);
        const double weight = (b - a).cross(c - a).norm();
        const Eigen::Vector3d s = a + b + c;
        area += weight;
        first += weight * s / 3;
        second += weight / 12 *
                  (a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose());
    }
    if (!(area > 0)) return Eigen::Matrix3d::Identity();
    const Eigen::Matrix3d covariance = second - first * first.transpose() / area;
    Eigen::Matrix3d axes =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors();
    axes.col(2) = axes.col(0).cross(axes.col(1));
    return axes;
}

/// Returns the box along the axes, in normalized coordinates.
Eigen::AlignedBox3d box_along(const mesh::Mesh& mesh, const Normalization& normalized,
                              const Eigen::Matrix3d& axes) {
    Eigen::AlignedBox3d box;
    for (const mesh::Double3& p : mesh.positions) {
        box.extend(axes.transpose() * normalized(p));
    }
    return box;
}

/// Sets the oriented box from a box along the axes. All coordinates are at most 4, and the axes
/// have length 1 up to a few ulp. So 2^-46 covers each projection and the way back.
void set_oriented(format::Bounds& bounds, const Normalization& normalized,
                  const Eigen::Matrix3d& axes, const Eigen::AlignedBox3d& box) {
    constexpr double kSlack = 0x1p-46;
    const Eigen::Vector3d half = 0.5 * (box.max() - box.min()).array() + kSlack;
    const Eigen::Vector3d middle = axes * (0.5 * (box.min() + box.max()));
    const auto back = [&](double x) { return std::ldexp(x, -normalized.exponent); };
    bounds.oriented_centre = {normalized.centre.x() + back(middle.x()),
                              normalized.centre.y() + back(middle.y()),
                              normalized.centre.z() + back(middle.z())};
    for (int i = 0; i < 3; ++i) bounds.axis[static_cast<std::size_t>(i)] = double3(axes.col(i));
    // The centre was rounded at the size of the coordinates, or to a multiple of the smallest
    // double.
    const double rounding = 0x1p-50 * normalized.centre.cwiseAbs().maxCoeff() +
                            8 * std::numeric_limits<double>::denorm_min();
    bounds.half_extent = {back(half.x()) + rounding, back(half.y()) + rounding,
                          back(half.z()) + rounding};
}

/// Sets the axis-aligned box as the oriented box.
void set_aligned(format::Bounds& bounds) {
    const Eigen::Vector3d lower = vector_of(bounds.lower);
    const Eigen::Vector3d upper = vector_of(bounds.upper);
    const Eigen::Vector3d centre = 0.5 * lower + 0.5 * upper;
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const Eigen::Vector3d half = (upper - centre).cwiseMax(centre - lower);
    bounds.oriented_centre = double3(centre);
    bounds.axis = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    bounds.half_extent = {std::nextafter(half.x(), kInfinity), std::nextafter(half.y(), kInfinity),
                          std::nextafter(half.z(), kInfinity)};
}

}  // namespace

format::Bounds find_bounds(const mesh::Mesh& mesh) {
    format::Bounds bounds{};
    if (mesh.positions.empty()) {
        bounds.axis = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
        return bounds;
    }
    const Eigen::AlignedBox3d box = box_of(mesh);
    bounds.lower = double3(box.min());
    bounds.upper = double3(box.max());
    const Normalization normalized = normalization_for(box);
    const Eigen::Matrix3d axes = principal_axes(mesh, normalized);
    const Eigen::AlignedBox3d turned = box_along(mesh, normalized, axes);
    const Eigen::AlignedBox3d aligned = box_along(mesh, normalized, Eigen::Matrix3d::Identity());
    if (turned.sizes().prod() < aligned.sizes().prod()) {
        set_oriented(bounds, normalized, axes, turned);
    } else {
        set_aligned(bounds);
    }
    return bounds;
}

}  // namespace cdprep::convex
