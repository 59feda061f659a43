// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose/enclose/windings.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "crossings/self_intersections.h"
#include "mesh/component_numbers.h"
#include "mesh/half_edges.h"
#include "mesh/nesting.h"
#include "mesh/point_tree.h"
#include "mesh/vectors.h"

namespace cdprep::convex {
namespace {

using mesh::Double3;
using mesh::HalfEdge;
using mesh::kNone;

constexpr double kUnit = 0x1p-53;         ///< u below
constexpr double kKnown = 1000;           ///< volumes over their error: a mass in three digits
constexpr double kUnderflow = 0x1p-1060;  ///< the error of operations that underflow
constexpr std::uint64_t kMeetings = 1U << 16U;  ///< found before the search ends; one would do

/// Six times a volume, summed over triangles about one origin.
struct VolumeSum {
    double sum = 0;
    double sizes = 0;  ///< of all products
    double count = 0;

    void add(const Double3& origin, const mesh::Mesh& mesh, const mesh::Triangle& triangle) {
        const Double3 a = mesh::minus(mesh.positions[triangle.vertex[0]], origin);
        const Double3 b = mesh::minus(mesh.positions[triangle.vertex[1]], origin);
        const Double3 c = mesh::minus(mesh.positions[triangle.vertex[2]], origin);
        sum += mesh::dot(a, mesh::cross(b, c));
        sizes += std::fabs(a.x) * (std::fabs(b.y * c.z) + std::fabs(b.z * c.y)) +
                 std::fabs(a.y) * (std::fabs(b.z * c.x) + std::fabs(b.x * c.z)) +
                 std::fabs(a.z) * (std::fabs(b.x * c.y) + std::fabs(b.y * c.x));
        count += 1;
    }
    /// A term takes 9 operations with relative errors of u, three of them differences. The sum adds
    /// u of all sizes for each term. Twice that covers terms of higher order.
    [[nodiscard]] double error() const {
        return 2 * kUnit * (count + 16) * sizes + (count + 16) * kUnderflow;
    }
    /// Returns -1 or 1; 0 if rounding decides, or if numbers leave the range of double.
    [[nodiscard]] int sign() const {
        if (!(std::fabs(sum) > error())) return 0;
        return sum > 0 ? 1 : -1;
    }
};

/// Returns the sign of each component's volume.
std::vector<int> signs_of(const mesh::Mesh& mesh, const mesh::ComponentNumbers& components) {
    std::vector<VolumeSum> sums(components.count);
    std::vector<Double3> origin(components.count);
    for (const mesh::Triangle& triangle : mesh.triangles) {
        const std::uint32_t component = components.of_vertex[triangle.vertex[0]];
        VolumeSum& sum = sums[component];
        if (sum.count == 0) origin[component] = mesh.positions[triangle.vertex[0]];
        sum.add(origin[component], mesh, triangle);
    }
    std::vector<int> signs(sums.size());
    std::transform(sums.begin(), sums.end(), signs.begin(),
                   [](const VolumeSum& sum) { return sum.sign(); });
    return signs;
}

/// Returns true if every edge joins two triangles of one winding, and the triangles around each
/// vertex form one fan. Triangles that repeat a corner do not count.
bool is_closed_manifold(const mesh::Mesh& mesh) {
    if (mesh.triangles.size() > mesh::kMostMeshTriangles) return false;
    const mesh::EdgeUses edges = mesh::find_edge_uses(mesh.triangles, mesh.positions.size());
    const std::vector<HalfEdge> twins = mesh::find_twins(mesh.triangles, edges);
    const std::vector<std::uint32_t> fans = mesh::find_fans(twins);
    std::vector<std::uint32_t> fan_of(mesh.positions.size(), kNone);
    for (HalfEdge h = 0; h < twins.size(); ++h) {
        if (mesh::repeats_corner(mesh.triangles[h / 3])) continue;
        std::uint32_t& fan = fan_of[mesh::start_of(mesh.triangles, h)];
        if (fan == kNone) fan = fans[h];
        if (twins[h] == kNone || fan != fans[h]) return false;
    }
    return true;
}

bool meets_itself(const mesh::Mesh& mesh, ParallelFor parallel_for) {
    mesh::SearchOptions how;
    how.limits = {kMeetings, mesh::default_steps(mesh.triangles.size())};
    how.parallel_for = parallel_for;
    bool is_found = false;
    const bool is_complete = mesh::search_self_intersections(
        mesh, how, [&](std::span<const mesh::TriangleMeeting>) { is_found = true; });
    return is_found || !is_complete;
}

}  // namespace

Windings find_windings(const mesh::Mesh& mesh, ParallelFor parallel_for) {
    const mesh::ComponentNumbers components = mesh::number_components(mesh);
    const std::vector<int> signs = signs_of(mesh, components);
    std::vector<int> outside(components.count, 0);
    const std::vector<bool> all_balanced(components.count, true);
    for (const mesh::Nested& nested : mesh::find_nested(mesh, components, all_balanced)) {
        outside[nested.inner] += nested.winding;
    }
    // Without crossings, the numbers around a component are those on its two sides.
    int least = 0, most = 0;
    bool is_known = true;
    for (std::size_t i = 0; i < components.count; ++i) {
        least = std::min({least, outside[i], outside[i] + signs[i]});
        most = std::max({most, outside[i], outside[i] + signs[i]});
        is_known = is_known && signs[i] != 0;
    }
    if (least < 0 && most > 0) return Windings::opposed;
    const bool is_simple = is_known && most - least == 1 && is_closed_manifold(mesh) &&
                           !meets_itself(mesh, parallel_for);
    return is_simple ? Windings::simple : Windings::unknown;
}

bool has_known_volume(const mesh::Mesh& mesh) {
    mesh::Box box;
    for (const Double3& p : mesh.positions) box.add(p);
    const Double3 centre = mesh::middle_of(box.lower, box.upper);
    VolumeSum sum;
    for (const mesh::Triangle& triangle : mesh.triangles) sum.add(centre, mesh, triangle);
    return std::fabs(sum.sum) > kKnown * sum.error();
}

}  // namespace cdprep::convex
