// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/flat_star.h"

#include <algorithm>
#include <cmath>

// Take any direction d. A triangle of the star, seen along d, is a sector of the plane
// between two rays. When all turn counter-clockwise, det(d, from, to) > 0, and each ray
// but the first and the last ends one sector and begins another, then how often a point
// of the plane is covered changes at the first ray and at the last alone: it is enough
// to count for one ray. The sectors that pass a ray r, or arrive at it, are those with
// det(d, r, from) < 0 <= det(d, r, to). A fan that closes is simple when one does; an
// open one when none does for its first ray. Cones whose sectors are apart meet in the
// vertex alone, and neighbours only above their common ray: in their common edge.
//
// All signs must be certain. Let u = 2^-53, d as computed (any will do), p and q the
// largest components of two ways. Ways are rounded differences (u). A component of a
// normal is at most 2 p q and off by 10 u p q; the products with d and their sums add
// 3 u of the terms: below 20 u p q (|dx| + |dy| + |dz|) in all. The same bound holds
// for det(d, r, s) = d . (r x s). Underflow moves a product by 2^-1075, which d, at most
// 1e103, cannot carry beyond 1e-220.

namespace cdprep::mesh {
namespace {

constexpr double kOff = 32 * 0x1p-53;
constexpr double kLargestWay = 1e50;
constexpr double kLeastBound = 1e-200;
constexpr std::size_t kMostSectors = 64;

double largest(const Double3& p) {
    return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
}
Double3 less(const Double3& p, const Double3& q) {
    return {p.x - q.x, p.y - q.y, p.z - q.z};
}
Double3 cross(const Double3& p, const Double3& q) {
    return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}
double dot(const Double3& p, const Double3& q) {
    return p.x * q.x + p.y * q.y + p.z * q.z;
}

/// Where the direction that the star is seen along comes from.
struct Seen {
    Double3 along;
    double size;  ///< sum of its components' sizes

    /// The sign of along . normal, or 0 where rounding may hide it.
    [[nodiscard]] int sign(const Double3& normal, double product) const {
        const double bound = kOff * size * product;
        if (!(bound > kLeastBound)) return 0;
        const double value = dot(along, normal);
        return (value > bound) - (value < -bound);
    }
};

/// Fills the sectors; false where numbers are too large for the bounds.
bool fill(const Mesh& mesh, std::uint32_t vertex, std::span<const std::uint32_t> star,
          std::vector<Sector>& sectors) {
    sectors.clear();
    const Double3& at = mesh.positions[vertex];
    double most = 0;
    for (const std::uint32_t triangle : star) {
        const auto& v = mesh.triangles[triangle].vertex;
        const std::size_t corner = v[0] == vertex ? 0 : v[1] == vertex ? 1 : 2;
        Sector& s = sectors.emplace_back();
        s.from = v[(corner + 1) % 3];
        s.to = v[(corner + 2) % 3];
        s.way_from = less(mesh.positions[s.from], at);
        s.way_to = less(mesh.positions[s.to], at);
        s.normal = cross(s.way_from, s.way_to);
        const double far_from = largest(s.way_from), far_to = largest(s.way_to);
        s.size = far_from * far_to;
        most = std::max({most, far_from, far_to});
    }
    return most < kLargestWay;
}

Seen mean_direction(const std::vector<Sector>& sectors) {
    Double3 sum{0, 0, 0};
    for (const Sector& s : sectors) {
        sum = {sum.x + s.normal.x, sum.y + s.normal.y, sum.z + s.normal.z};
    }
    return {sum, std::fabs(sum.x) + std::fabs(sum.y) + std::fabs(sum.z)};
}

/// How the sectors hang together.
struct Fan {
    bool simple;           ///< each ray begins one sector at most, and ends one
    std::size_t starts;    ///< rays that end none
    std::size_t starting;  ///< a sector that begins at such a ray, or the first
};

Fan find_fan(const std::vector<Sector>& sectors) {
    Fan fan{true, 0, 0};
    for (std::size_t i = 0; i < sectors.size(); ++i) {
        bool continues = false;
        for (std::size_t j = 0; j < sectors.size(); ++j) {
            continues |= sectors[j].to == sectors[i].from;
            if (j >= i) continue;
            const bool again = sectors[j].to == sectors[i].to || sectors[j].from == sectors[i].from;
            fan.simple &= !again;
        }
        if (continues) continue;
        ++fan.starts;
        fan.starting = i;
    }
    return fan;
}

/// How many sectors pass the ray that the sector begins with, or arrive at it; nothing
/// certain: more than there are.
std::size_t passing(const std::vector<Sector>& sectors, const Sector& starting, const Seen& seen) {
    const Double3& ray = starting.way_from;
    const double far = largest(ray);
    std::size_t count = 0;
    for (const Sector& s : sectors) {
        const int from = s.from == starting.from
                             ? 1
                             : seen.sign(cross(ray, s.way_from), far * largest(s.way_from));
        if (from == 0) return sectors.size() + 1;
        if (from > 0) continue;
        const int to =
            s.to == starting.from ? 1 : seen.sign(cross(ray, s.way_to), far * largest(s.way_to));
        if (to == 0) return sectors.size() + 1;
        if (to > 0) ++count;
    }
    return count;
}

}  // namespace

bool lies_side_by_side(const Mesh& mesh, std::uint32_t vertex, std::span<const std::uint32_t> star,
                       StarScratch& scratch) {
    if (star.size() > kMostSectors) return false;
    std::vector<Sector>& sectors = scratch.sectors;
    if (star.size() < 2) return true;
    if (!fill(mesh, vertex, star, sectors)) return false;
    const Seen seen = mean_direction(sectors);
    for (const Sector& s : sectors) {
        if (seen.sign(s.normal, s.size) <= 0) return false;
    }
    const Fan fan = find_fan(sectors);
    if (!fan.simple || fan.starts > 1) return false;
    return passing(sectors, sectors[fan.starting], seen) == 1 - fan.starts;
}

}  // namespace cdprep::mesh
