// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/surface/face_planes.h"
#include "cdprep/advanced/parallel_for.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cdprep/exact/predicates.h"
#include "mesh/vectors.h"

namespace cdprep::convex {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kUnit = 0x1p-53;  ///< u below

// Error bound. Let u = 2^-53. A component of the normal is a difference of two products of two
// differences. Its error is (1 + u)^4 - 1 < 4.1u of each product. Let m be the sum of the products'
// sizes: the error is at most 4.1u m. A term of the height multiplies it by a difference, which
// adds (1 + u)^2. The error becomes 6.2u m E, where E is the mesh's extent along the axis. No
// difference exceeds E by more than u. Three sums add 3.1u. In all this is less than 10u sum(m E),
// or 12u with the roundings of this sum itself.
constexpr double kHeightDoubt = 12 * kUnit;
constexpr double kNormalDoubt = 5 * kUnit;
// An underflow adds an error of 2^-1074. Times an extent of at most kMostExtent, a few times, it
// stays below kLeastDoubt. A component of a normal is at most twice the square of the extent, and
// the squared length of the normal at most 12 times its fourth power: nothing overflows.
constexpr double kMostExtent = 1e75;
constexpr double kLeastDoubt = 1e-210;
// A normal has the length of twice an area, in squared model units. The square of this length is
// far above the least normal double, 2.2e-308. So smaller components may underflow without harm.
constexpr double kLeastLength = 1e-150;

/// Returns, for each component of a cross product, the sum of the sizes of its products.
Double3 cross_sizes(const Double3& a, const Double3& b) {
    const auto sum = [](double p, double q) { return std::fabs(p) + std::fabs(q); };
    return {sum(a.y * b.z, a.z * b.y), sum(a.z * b.x, a.x * b.z), sum(a.x * b.y, a.y * b.x)};
}

Double3 extent_of(const mesh::Mesh& mesh) {
    Double3 low = {0, 0, 0}, high = {0, 0, 0};
    if (!mesh.positions.empty()) low = high = mesh.positions.front();
    for (const Double3& p : mesh.positions) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    return mesh::minus(high, low);
}

}  // namespace

FacePlanes::FacePlanes(const mesh::Mesh& mesh, double tolerance, ParallelFor parallel_for)
    : mesh_(mesh), tolerance_(tolerance), planes_(mesh.triangles.size()) {
    const Double3 extent = extent_of(mesh);
    constexpr std::size_t kAtATime = 1 << 14;  // triangles per task: changes no result
    for_chunks(planes_.size(), kAtATime, parallel_for, [&](std::size_t first, std::size_t last) {
        for (std::size_t t = first; t < last; ++t) {
            planes_[t] = plane_of(static_cast<std::uint32_t>(t), extent);
        }
    });
}

FacePlanes::Plane FacePlanes::plane_of(std::uint32_t triangle, const Double3& extent) const {
    const auto& v = mesh_.triangles[triangle].vertex;
    const Double3 a = mesh_.positions[v[0]];
    const Double3 ab = mesh::minus(mesh_.positions[v[1]], a);
    const Double3 ac = mesh::minus(mesh_.positions[v[2]], a);
    const Double3 sizes = cross_sizes(ab, ac);
    Plane plane{mesh::cross(ab, ac), a, 0, 0};
    plane.doubt = kHeightDoubt * mesh::dot(sizes, extent) + kLeastDoubt;
    const bool bounded = std::max({extent.x, extent.y, extent.z}) <= kMostExtent;
    if (!bounded) plane = {{0, 0, 0}, {0, 0, 0}, kInfinity, 0};
    if (bounded && tolerance_ > 0) {
        plane.reach = tolerance_ * least_length(triangle) * (1 - 4 * kUnit);
    }
    plane.reach -= plane.doubt;
    return plane;
}

double FacePlanes::least_length(std::uint32_t triangle) const {
    const auto& v = mesh_.triangles[triangle].vertex;
    const Double3 a = mesh_.positions[v[0]];
    const Double3 ab = mesh::minus(mesh_.positions[v[1]], a);
    const Double3 ac = mesh::minus(mesh_.positions[v[2]], a);
    const Double3 normal = mesh::cross(ab, ac), sizes = cross_sizes(ab, ac);
    const double length = std::sqrt(mesh::dot(normal, normal));
    const double doubt = kNormalDoubt * (sizes.x + sizes.y + sizes.z) + kLeastDoubt;
    // Squares below the range of double would be lost: then nothing is known.
    return length > kLeastLength ? std::max(0.0, length * (1 - 6 * kUnit) - doubt) : 0;
}

bool FacePlanes::admits_exactly(std::uint32_t triangle, std::uint32_t vertex) const {
    const auto& v = mesh_.triangles[triangle].vertex;
    return exact::orient3d(mesh_.positions[v[0]], mesh_.positions[v[1]], mesh_.positions[v[2]],
                           mesh_.positions[vertex]) >= 0;
}

void FacePlanes::gather(std::span<const std::uint32_t> vertices, Points& points) const {
    points.vertex.assign(vertices.begin(), vertices.end());
    points.x.resize(vertices.size());
    points.y.resize(vertices.size());
    points.z.resize(vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const Double3& p = mesh_.positions[vertices[i]];
        points.x[i] = p.x;
        points.y[i] = p.y;
        points.z[i] = p.z;
    }
}

bool FacePlanes::admits_all(std::uint32_t triangle, const Points& points) const {
    const Plane plane = planes_[triangle];
    const double *x = points.x.data(), *y = points.y.data(), *z = points.z.data();
    constexpr std::size_t kAtATime = 16;  // without a branch, so that SIMD lanes are used
    for (std::size_t first = 0; first < points.vertex.size(); first += kAtATime) {
        const std::size_t last = std::min(first + kAtATime, points.vertex.size());
        std::uint64_t doubtful = 0;
        for (std::size_t i = first; i < last; ++i) {
            const double height = plane.normal.x * (x[i] - plane.at.x) +
                                  plane.normal.y * (y[i] - plane.at.y) +
                                  plane.normal.z * (z[i] - plane.at.z);
            doubtful += height <= plane.reach ? 0U : 1U;
        }
        if (doubtful == 0) continue;
        for (std::size_t i = first; i < last; ++i) {
            if (!admits(triangle, points.vertex[i])) return false;
        }
    }
    return true;
}

double FacePlanes::height_bound(std::uint32_t triangle, const Points& points) const {
    const Plane& plane = planes_[triangle];
    const auto& own = mesh_.triangles[triangle].vertex;
    double most = 0;
    bool any = false;
    for (const std::uint32_t vertex : points.vertex) {
        const double height = raw_height(plane, mesh_.positions[vertex]);
        if (height < -plane.doubt || std::find(own.begin(), own.end(), vertex) != own.end()) {
            continue;
        }
        if (height <= plane.doubt && admits_exactly(triangle, vertex)) continue;
        any = true;
        most = std::max(most, height);
    }
    if (!any) return 0;
    const double length = least_length(triangle);
    if (length == 0) return kInfinity;
    return std::nextafter((most + plane.doubt) / length * (1 + 4 * kUnit), kInfinity);
}

}  // namespace cdprep::convex
