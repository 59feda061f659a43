// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/weld.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

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

/// Finds points by equal coordinates in a list that the caller keeps: open
/// addressing over indices.
class PointTable {
public:
    PointTable() = default;
    explicit PointTable(std::size_t most) : slots_(std::bit_ceil(2 * most + 16), kNone) {}

    /// Returns the index of the equal point among those added, or kNone.
    [[nodiscard]] std::uint32_t find(const std::vector<Double3>& points, const Double3& p) const {
        return slots_[slot_of(points, p)];
    }

    /// Returns the index of the equal point among those added, or adds `index`.
    std::uint32_t find_or_add(const std::vector<Double3>& points, const Double3& p,
                              std::uint32_t index) {
        std::uint32_t& slot = slots_[slot_of(points, p)];
        if (slot == kNone) slot = index;
        return slot;
    }

private:
    [[nodiscard]] std::size_t slot_of(const std::vector<Double3>& points, const Double3& p) const {
        std::size_t slot = hash_of(p) & (slots_.size() - 1);
        while (slots_[slot] != kNone && points[slots_[slot]] != p) {
            slot = (slot + 1) & (slots_.size() - 1);
        }
        return slot;
    }

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

/// Finds the points that are at most `distance` apart, by cells of space.
///
/// A cell is 0.55 distances wide. So any two points of one cell are close (its
/// diagonal is 0.953 distances), and a close pair is never more than two cells
/// apart along an axis. No coordinate is more than 2^45 cells from 0, so the
/// rounding of x / width, at most 2^-8, cannot break either. Where that needs
/// wider cells (a distance of a few hundred ulp), points of one cell need not be
/// close, and all pairs are looked at.
class CloseGroups {
public:
    CloseGroups(const std::vector<Double3>& points, double distance)
        : points_(points), distance_(distance), parent_(points.size()) {
        std::iota(parent_.begin(), parent_.end(), 0U);
        double largest = 0;
        for (const Double3& p : points) {
            largest = std::max({largest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
        }
        constexpr double kCellShare = 0.55;
        constexpr int kMostCellsExponent = 45;
        constexpr double kCellDiagonal = 1.75;  // sqrt(3), and room for rounding
        width_ = std::max(kCellShare * distance, std::ldexp(largest, -kMostCellsExponent));
        cells_are_close_ = kCellDiagonal * width_ <= distance;
        fill_cells();
    }

    /// Returns the lowest point of each point's group. Chains join.
    std::vector<std::uint32_t> find() {
        for (std::uint32_t cell = 0; cell < cells_.size(); ++cell) join_within(members(cell));
        for (std::uint32_t cell = 0; cell < cells_.size(); ++cell) join_neighbours(cell);
        for (std::uint32_t i = 0; i < parent_.size(); ++i) parent_[i] = root_of(parent_, i);
        return std::move(parent_);
    }

private:
    using Members = std::span<const std::uint32_t>;

    [[nodiscard]] Double3 cell_of(const Double3& p) const {
        return {std::floor(p.x / width_), std::floor(p.y / width_), std::floor(p.z / width_)};
    }

    void fill_cells() {
        std::vector<std::uint32_t> cell_number(points_.size());
        table_ = PointTable(points_.size());
        for (std::size_t i = 0; i < points_.size(); ++i) {
            const Double3 cell = cell_of(points_[i]);
            const auto next = static_cast<std::uint32_t>(cells_.size());
            cell_number[i] = table_.find_or_add(cells_, cell, next);
            if (cell_number[i] == next) cells_.push_back(cell);
        }
        first_.assign(cells_.size() + 1, 0);
        for (const std::uint32_t cell : cell_number) ++first_[cell + 1];
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
        member_.resize(points_.size());
        for (std::uint32_t i = 0; i < points_.size(); ++i) member_[next[cell_number[i]]++] = i;
    }

    [[nodiscard]] Members members(std::uint32_t cell) const {
        return Members(member_).subspan(first_[cell], first_[cell + 1] - first_[cell]);
    }

    void join_within(Members cell) {
        for (std::size_t i = 1; i < cell.size(); ++i) {
            if (cells_are_close_) {
                unite(parent_, cell.front(), cell[i]);
            } else {
                join_between(cell.subspan(i, 1), cell.first(i));
            }
        }
    }

    /// Each pair of cells once: the later of the two in the order of x, y, z.
    void join_neighbours(std::uint32_t cell) {
        constexpr int kReach = 2;  // cells along an axis
        const Double3 place = cells_[cell];
        for (int dx = 0; dx <= kReach; ++dx) {
            for (int dy = dx == 0 ? 0 : -kReach; dy <= kReach; ++dy) {
                for (int dz = dx == 0 && dy == 0 ? 1 : -kReach; dz <= kReach; ++dz) {
                    const std::uint32_t other =
                        table_.find(cells_, {place.x + dx, place.y + dy, place.z + dz});
                    if (other != kNone) join_between(members(cell), members(other));
                }
            }
        }
    }

    void join_between(Members a, Members b) {
        if (cells_are_close_ && root_of(parent_, a.front()) == root_of(parent_, b.front())) return;
        for (const std::uint32_t i : a) {
            for (const std::uint32_t j : b) {
                if (!(distance_between(points_[i], points_[j]) <= distance_)) continue;
                unite(parent_, i, j);
                if (cells_are_close_) return;  // then everything in both is joined
            }
        }
    }

    const std::vector<Double3>& points_;
    double distance_;
    double width_ = 0;
    bool cells_are_close_ = false;
    std::vector<std::uint32_t> parent_;
    std::vector<Double3> cells_;  ///< whole numbers
    PointTable table_;            ///< of cells_
    std::vector<std::uint32_t> first_;
    std::vector<std::uint32_t> member_;
};

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
    PointTable table(soup.positions.size());
    for (std::uint32_t i = 0; i < soup.positions.size(); ++i) {
        if (!used[i]) {
            ++report.unused_vertices;
            continue;
        }
        const auto next = static_cast<std::uint32_t>(mesh.positions.size());
        renamed[i] = table.find_or_add(mesh.positions, soup.positions[i], next);
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
        keep_representatives(welded.mesh,
                             CloseGroups(welded.mesh.positions, options.distance).find());
        welded.report.merged_vertices += before - welded.mesh.positions.size();
    }
    for (const Triangle& triangle : welded.mesh.triangles) {
        if (repeats_corner(triangle)) ++welded.report.collapsed_triangles;
    }
    return welded;
}

}  // namespace cdprep::mesh
