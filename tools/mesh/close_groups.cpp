// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/close_groups.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "cdprep/advanced/disjoint_sets.h"
#include "mesh/point_table.h"

namespace cdprep::mesh {

using format::Double3;

namespace {

/// Finds the points that are at most `distance` apart, by cells of space.
///
/// A cell is 0.55 distances wide. So any two points of one cell are close (its diagonal is 0.953
/// distances). A close pair is at most two cells apart along each axis. No coordinate is more
/// than 2^45 cells from 0. So the rounding of x / width, at most 2^-8, cannot break either
/// claim. This limit requires wider cells for a distance of a few hundred ulp. Points of one cell
/// may then not be close, and all pairs are tested.
class CloseGroups {
public:
    CloseGroups(const std::vector<Double3>& points, double distance)
        : points_(points), distance_(distance), groups_(points.size()) {
        double largest = 0;
        for (const Double3& p : points) {
            largest = std::max({largest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
        }
        constexpr double kCellShare = 0.55;
        constexpr int kMostCellsExponent = 45;
        constexpr double kCellDiagonal = 1.75;  // sqrt(3), with a margin for rounding
        width_ = std::max(kCellShare * distance, std::ldexp(largest, -kMostCellsExponent));
        cells_are_close_ = kCellDiagonal * width_ <= distance;
        fill_cells();
    }

    /// Returns the lowest point of each point's group. Chains join.
    std::vector<std::uint32_t> find() {
        for (std::uint32_t cell = 0; cell < cells_.size(); ++cell) join_within(members(cell));
        for (std::uint32_t cell = 0; cell < cells_.size(); ++cell) join_neighbours(cell);
        std::vector<std::uint32_t> lowest(points_.size());
        for (std::uint32_t i = 0; i < lowest.size(); ++i) lowest[i] = groups_.root_of(i);
        return lowest;
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
                groups_.unite(cell.front(), cell[i]);
            } else {
                join_between(cell.subspan(i, 1), cell.first(i));
            }
        }
    }

    /// Visits each pair of cells once, from the earlier one in the order of x, y, z.
    void join_neighbours(std::uint32_t cell) {
        constexpr int kReach = 2;  // cells along an axis
        const Double3 place = cells_[cell];
        for (int dx = 0; dx <= kReach; ++dx) {
            for (int dy = dx == 0 ? 0 : -kReach; dy <= kReach; ++dy) {
                for (int dz = dx == 0 && dy == 0 ? 1 : -kReach; dz <= kReach; ++dz) {
                    const std::uint32_t other =
                        table_.find(cells_, {place.x + dx, place.y + dy, place.z + dz});
                    if (other != PointTable::kNone) join_between(members(cell), members(other));
                }
            }
        }
    }

    void join_between(Members a, Members b) {
        if (cells_are_close_ && groups_.root_of(a.front()) == groups_.root_of(b.front())) return;
        for (const std::uint32_t i : a) {
            for (const std::uint32_t j : b) {
                if (!(distance_between(points_[i], points_[j]) <= distance_)) continue;
                groups_.unite(i, j);
                if (cells_are_close_) return;  // then all points of both are joined
            }
        }
    }

    const std::vector<Double3>& points_;
    double distance_;
    double width_ = 0;
    bool cells_are_close_ = false;
    build::DisjointSets groups_;
    std::vector<Double3> cells_;  ///< whole numbers
    PointTable table_;            ///< of cells_
    std::vector<std::uint32_t> first_;
    std::vector<std::uint32_t> member_;
};

}  // namespace

double distance_between(const Double3& a, const Double3& b) {
    return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
}

std::vector<std::uint32_t> close_groups(const std::vector<Double3>& points, double distance) {
    return CloseGroups(points, distance).find();
}

}  // namespace cdprep::mesh
