// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/weld.h"

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <unordered_map>

namespace cdprep::mesh {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

std::uint64_t mixed(std::uint64_t hash, std::uint64_t word) {
    constexpr std::uint64_t kMultiplier = 0x9e3779b97f4a7c15;  // 2^64 / golden ratio, odd
    hash = (hash ^ word) * kMultiplier;
    return hash ^ (hash >> 29);
}

std::uint64_t hash_of(const Double3& p) {
    // Adding 0.0 turns -0.0 into 0.0, so that equal numbers hash alike.
    std::uint64_t hash = mixed(1, std::bit_cast<std::uint64_t>(p.x + 0.0));
    hash = mixed(hash, std::bit_cast<std::uint64_t>(p.y + 0.0));
    return mixed(hash, std::bit_cast<std::uint64_t>(p.z + 0.0));
}

/// Finds points by equal coordinates: open addressing over indices.
class PointTable {
public:
    PointTable(const std::vector<Double3>& points, std::size_t most)
        : points_(points), slots_(std::bit_ceil(2 * most + 16), kNone) {}

    /// Returns the index of an equal point among those added, or adds `index`.
    std::uint32_t find_or_add(const Double3& p, std::uint32_t index) {
        std::size_t slot = hash_of(p) & (slots_.size() - 1);
        while (slots_[slot] != kNone) {
            if (points_[slots_[slot]] == p) return slots_[slot];
            slot = (slot + 1) & (slots_.size() - 1);
        }
        slots_[slot] = index;
        return index;
    }

private:
    const std::vector<Double3>& points_;
    std::vector<std::uint32_t> slots_;
};

std::vector<bool> used_vertices(const TriangleSoup& soup) {
    std::vector<bool> used(soup.positions.size(), false);
    for (const Triangle& triangle : soup.triangles) {
        for (const std::uint32_t vertex : triangle.vertex) used[vertex] = true;
    }
    return used;
}

std::uint32_t root_of(std::vector<std::uint32_t>& parent, std::uint32_t vertex) {
    while (parent[vertex] != vertex) vertex = parent[vertex] = parent[parent[vertex]];
    return vertex;
}

/// The lower number becomes the root.
void unite(std::vector<std::uint32_t>& parent, std::uint32_t a, std::uint32_t b) {
    a = root_of(parent, a);
    b = root_of(parent, b);
    parent[std::max(a, b)] = std::min(a, b);
}

double distance_between(const Double3& a, const Double3& b) {
    return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
}

/// Joins all points of `mesh` that are at most `distance` apart, chains too.
/// Cells as wide as the distance: only the 27 around a point can hold a partner.
std::vector<std::uint32_t> close_groups(const std::vector<Double3>& points, double distance) {
    std::vector<std::uint32_t> parent(points.size());
    std::iota(parent.begin(), parent.end(), 0U);
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells;
    const auto cell_of = [distance](const Double3& p, int dx, int dy, int dz) {
        return hash_of({std::floor(p.x / distance) + dx, std::floor(p.y / distance) + dy,
                        std::floor(p.z / distance) + dz});
    };
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        for (int neighbour = 0; neighbour < 27; ++neighbour) {
            const auto cell = cells.find(
                cell_of(points[i], neighbour % 3 - 1, neighbour / 3 % 3 - 1, neighbour / 9 - 1));
            if (cell == cells.end()) continue;
            for (const std::uint32_t other : cell->second) {
                if (distance_between(points[i], points[other]) <= distance) {
                    unite(parent, i, other);
                }
            }
        }
        cells[cell_of(points[i], 0, 0, 0)].push_back(i);
    }
    for (std::uint32_t i = 0; i < points.size(); ++i) parent[i] = root_of(parent, i);
    return parent;
}

/// Renames every vertex to its representative; those keep their order.
void keep_representatives(Mesh& mesh, const std::vector<std::uint32_t>& representative) {
    std::vector<std::uint32_t> renamed(mesh.positions.size(), kNone);
    std::uint32_t next = 0;
    for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) {
        if (representative[i] != i) continue;
        mesh.positions[next] = mesh.positions[i];
        mesh.source_vertex[next] = mesh.source_vertex[i];
        renamed[i] = next++;
    }
    mesh.positions.resize(next);
    mesh.source_vertex.resize(next);
    for (Triangle& triangle : mesh.triangles) {
        for (std::uint32_t& vertex : triangle.vertex) vertex = renamed[representative[vertex]];
    }
}

bool repeats_corner(const Triangle& t) {
    return t.vertex[0] == t.vertex[1] || t.vertex[1] == t.vertex[2] || t.vertex[2] == t.vertex[0];
}

/// Joins equal points and leaves out unused ones.
Mesh weld_equal(const TriangleSoup& soup, WeldReport& report) {
    const std::vector<bool> used = used_vertices(soup);
    std::vector<std::uint32_t> renamed(soup.positions.size(), kNone);
    Mesh mesh;
    mesh.single_precision = soup.single_precision;
    mesh.positions.reserve(soup.positions.size());
    PointTable table(mesh.positions, soup.positions.size());
    for (std::uint32_t i = 0; i < soup.positions.size(); ++i) {
        if (!used[i]) {
            ++report.unused_vertices;
            continue;
        }
        const auto next = static_cast<std::uint32_t>(mesh.positions.size());
        renamed[i] = table.find_or_add(soup.positions[i], next);
        if (renamed[i] != next) {
            ++report.merged_vertices;
            continue;
        }
        mesh.positions.push_back(soup.positions[i]);
        mesh.source_vertex.push_back(i);
    }
    mesh.triangles = soup.triangles;
    for (Triangle& triangle : mesh.triangles) {
        for (std::uint32_t& vertex : triangle.vertex) vertex = renamed[vertex];
    }
    return mesh;
}

}  // namespace

Welded weld(const TriangleSoup& soup, const WeldOptions& options) {
    Welded welded;
    welded.mesh = weld_equal(soup, welded.report);
    if (options.distance > 0) {
        const std::size_t before = welded.mesh.positions.size();
        keep_representatives(welded.mesh, close_groups(welded.mesh.positions, options.distance));
        welded.report.merged_vertices += before - welded.mesh.positions.size();
    }
    for (const Triangle& triangle : welded.mesh.triangles) {
        if (repeats_corner(triangle)) ++welded.report.collapsed_triangles;
    }
    return welded;
}

}  // namespace cdprep::mesh
