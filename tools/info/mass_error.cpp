// SPDX-License-Identifier: GPL-3.0-or-later
#include "info/mass_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/vectors.h"

namespace cdprep::convex {
namespace {

using mesh::largest_of;

using mesh::Double3;

constexpr double kUnit = 0x1p-53;  ///< the relative error of one operation

/// Sums over all triangles, about the centre of the box.
struct Sums {
    double count = 0;
    double reach = 0;          ///< no sum: the largest absolute coordinate
    double volume_6 = 0;       ///< of determinants, signed
    double determinants = 0;   ///< of their absolute values
    double permanents = 0;     ///< of the absolute values of their six products
    double areas_2 = 0;        ///< of twice the areas
    double area_products = 0;  ///< of the absolute values of the products of the normals
};

Double3 box_centre(const mesh::Mesh& mesh) {
    Double3 lower = mesh.positions.front();
    Double3 upper = lower;
    for (const Double3& p : mesh.positions) {
        lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
        upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
    }
    return {0.5 * lower.x + 0.5 * upper.x, 0.5 * lower.y + 0.5 * upper.y,
            0.5 * lower.z + 0.5 * upper.z};
}

/// Returns the sum of the absolute values of both products in each component of a cross product.
Double3 products_of(const Double3& u, const Double3& v) {
    return {std::fabs(u.y * v.z) + std::fabs(u.z * v.y),
            std::fabs(u.z * v.x) + std::fabs(u.x * v.z),
            std::fabs(u.x * v.y) + std::fabs(u.y * v.x)};
}

void add(Sums& sums, const Double3& a, const Double3& b, const Double3& c) {
    const Double3 normal = {b.y * c.z - b.z * c.y, b.z * c.x - b.x * c.z, b.x * c.y - b.y * c.x};
    const Double3 products = products_of(b, c);
    const double determinant = mesh::dot(a, normal);
    sums.count += 1;
    sums.reach = std::max({sums.reach, largest_of(a), largest_of(b), largest_of(c)});
    sums.volume_6 += determinant;
    sums.determinants += std::fabs(determinant);
    sums.permanents +=
        std::fabs(a.x) * products.x + std::fabs(a.y) * products.y + std::fabs(a.z) * products.z;
    const Double3 u = mesh::minus(b, a);
    const Double3 v = mesh::minus(c, a);
    const Double3 edges = products_of(u, v);
    sums.areas_2 += std::hypot(u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x);
    sums.area_products += edges.x + edges.y + edges.z;
}

Sums sums_of(const mesh::Mesh& mesh) {
    const Double3 origin = box_centre(mesh);
    Sums sums;
    for (const mesh::Triangle& triangle : mesh.triangles) {
        const auto corner = [&](std::size_t i) {
            return mesh::minus(mesh.positions[triangle.vertex[i]], origin);
        };
        add(sums, corner(0), corner(1), corner(2));
    }
    return sums;
}

}  // namespace

MassError find_mass_error(const mesh::Mesh& mesh) {
    if (mesh.triangles.empty()) return {};
    const Sums s = sums_of(mesh);
    // Corners relative to the origin are the same numbers in both results. A determinant then takes
    // at most 5 operations. The error of each is u times a part of the permanent. A sum of n terms
    // adds an error of n u times the sum of absolute values. Constants are rounded up.
    const double least = (s.count + 16) * 0x1p-1060;  // the error of operations that underflow
    const double terms = s.determinants + 16 * kUnit * s.permanents;
    const double volume_6 = kUnit * (10 * s.permanents + (s.count + 4) * terms) + least;
    // The sum of three corners is at most 3 reach, an entry of the second moments 12 reach^2.
    const double r = s.reach;
    const double first = 3 * r * (kUnit * (16 * s.permanents + (s.count + 8) * terms) + least);
    const double second =
        12 * r * r * (kUnit * (20 * s.permanents + (s.count + 12) * terms) + least);
    const double volume = std::fabs(s.volume_6 / 6);

    constexpr double kBoth = 4;  // 2 for two results, times 2 for terms of higher order
    MassError error;
    error.volume = kBoth * (volume_6 / 6 + 2 * kUnit * volume);
    // Relative to another point of the box, corners are at most 2 reach and a permanent 48 reach^3.
    // Determinants change by at most the shift times twice the area.
    const double any_terms = terms + 4 * r * s.areas_2;
    const double any_6 = kUnit * (480 * s.count * r * r * r + (s.count + 4) * any_terms) + least;
    error.volume_about_any = kBoth * (any_6 / 6 + kUnit * any_terms);
    error.area = kBoth * (kUnit * (10 * s.area_products + (s.count + 8) * s.areas_2) + least);
    error.centre = error.inertia = std::numeric_limits<double>::infinity();
    if (!(volume > 2 * error.volume)) return error;
    const double far = (3 * r * terms / 24) / volume;  // the largest coordinate of the centre
    const double centre = (first / 24 + far * error.volume) / (volume - error.volume);
    const double place = largest_of(box_centre(mesh)) + far;
    error.centre = kBoth * (centre + 4 * kUnit * far + 2 * kUnit * place);
    const double size = 12 * r * r * terms / 120 + volume * far * far;
    const double moment =
        second / 120 + far * far * error.volume + volume * centre * (2 * far + centre);
    error.inertia = kBoth * (4 * moment + 32 * kUnit * size + least);
    return error;
}

}  // namespace cdprep::convex
