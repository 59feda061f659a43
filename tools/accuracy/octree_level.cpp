// SPDX-License-Identifier: GPL-3.0-or-later
#include "accuracy/octree_level.h"

#include <array>
#include <bit>
#include <cmath>

#include "accuracy/bounding_shapes.h"

namespace cdprep::study {
namespace {

using format::OctreeNode;

/// The cube of a node, decoded from its key.
struct Cube {
    Double3 centre;
    double half;
};

Cube cube_of(const format::OctreeGrid& grid, const OctreeNode& node) {
    const std::uint32_t level = format::level_of(node.key);
    std::array<std::uint32_t, 3> cell{};
    for (std::uint32_t i = 0; i < level; ++i) {
        const auto step = static_cast<std::uint32_t>((node.key >> (3 * i)) & 7);
        for (std::uint32_t axis = 0; axis < 3; ++axis) cell[axis] |= ((step >> axis) & 1) << i;
    }
    const double edge = std::ldexp(grid.step, static_cast<int>(format::kOctreeBits - level));
    return {{grid.origin.x + (cell[0] + 0.5) * edge, grid.origin.y + (cell[1] + 0.5) * edge,
             grid.origin.z + (cell[2] + 0.5) * edge},
            0.5 * edge};
}

double size_of(const format::OctreeGrid& grid) {
    const double edge = std::ldexp(grid.step, static_cast<int>(format::kOctreeBits));
    return std::fabs(grid.origin.x) + std::fabs(grid.origin.y) + std::fabs(grid.origin.z) +
           3 * edge;
}

/// Tests cubes of one grid against those of the other. All cubes of a grid have the same axes, so
/// the terms that depend only on the rotation are computed once.
class CubeTest {
public:
    CubeTest(const CellModel& a, const CellModel& b, const Pose& pose) : pose_(pose) {
        const auto& r = pose.rotation();
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j) {
                row_[i] += std::fabs(r[3 * i + j]);
                column_[j] += std::fabs(r[3 * i + j]);
            }
        }
        const Double3& t = pose.translation();
        slack_ = kSlack * (size_of(a.octree.grid) + size_of(b.octree.grid) + std::fabs(t.x) +
                           std::fabs(t.y) + std::fabs(t.z));
    }

    [[nodiscard]] bool may_meet(const Cube& a, const Cube& b) const {
        const Double3 at = transform_point(pose_, b.centre);
        const std::array<double, 3> d = {at.x - a.centre.x, at.y - a.centre.y, at.z - a.centre.z};
        const auto& r = pose_.rotation();
        for (std::size_t i = 0; i < 3; ++i) {
            if (std::fabs(d[i]) > a.half + row_[i] * b.half + slack_) return false;
        }
        for (std::size_t j = 0; j < 3; ++j) {
            const double along = d[0] * r[j] + d[1] * r[3 + j] + d[2] * r[6 + j];
            if (std::fabs(along) > b.half + column_[j] * a.half + slack_) return false;
        }
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j) {
                if (parts(a, b, d, i, j)) return false;
            }
        }
        return true;
    }

private:
    /// Returns whether the cross product of A's axis i and B's axis j separates the cubes.
    [[nodiscard]] bool parts(const Cube& a, const Cube& b, const std::array<double, 3>& d,
                             std::size_t i, std::size_t j) const {
        const auto& r = pose_.rotation();
        const std::size_t i1 = (i + 1) % 3;
        const std::size_t i2 = (i + 2) % 3;
        const std::size_t j1 = (j + 1) % 3;
        const std::size_t j2 = (j + 2) % 3;
        const double along = d[i2] * r[3 * i1 + j] - d[i1] * r[3 * i2 + j];
        const double of_a = std::fabs(r[3 * i1 + j]) + std::fabs(r[3 * i2 + j]);
        const double of_b = std::fabs(r[3 * i + j1]) + std::fabs(r[3 * i + j2]);
        return std::fabs(along) > a.half * of_a + b.half * of_b + slack_;
    }

    const Pose& pose_;
    std::array<double, 3> row_{};
    std::array<double, 3> column_{};
    double slack_;
};

bool is_inner(const OctreeNode& node) {
    return (node.count & format::kInnerNode) != 0;
}

std::uint32_t children_of(const OctreeNode& node) {
    return static_cast<std::uint32_t>(std::popcount(node.count & 0xffU));
}

}  // namespace

double CellModel::edge() const noexcept {
    return std::ldexp(octree.grid.step, static_cast<int>(format::kOctreeBits - octree.grid.level));
}

bool cells_may_meet(const CellModel& a, const CellModel& b, const Pose& a_from_b,
                    std::vector<std::uint64_t>& pending, std::uint64_t* visited) {
    if (a.octree.nodes.empty() || b.octree.nodes.empty()) return false;
    const CubeTest test(a, b, a_from_b);
    pending.assign(1, 0);
    while (!pending.empty()) {
        const std::uint64_t pair = pending.back();
        pending.pop_back();
        if (visited != nullptr) ++*visited;
        const OctreeNode& node_a = a.octree.nodes[pair >> 32];
        const OctreeNode& node_b = b.octree.nodes[pair & 0xffffffffU];
        const Cube cube_a = cube_of(a.octree.grid, node_a);
        const Cube cube_b = cube_of(b.octree.grid, node_b);
        if (!test.may_meet(cube_a, cube_b)) continue;
        if (!is_inner(node_a) && !is_inner(node_b)) return true;
        const bool opens_a = is_inner(node_a) && (!is_inner(node_b) || cube_a.half >= cube_b.half);
        const OctreeNode& opened = opens_a ? node_a : node_b;
        for (std::uint64_t i = 0; i < children_of(opened); ++i) {
            const std::uint64_t child = opened.first + i;
            pending.push_back(opens_a ? (child << 32 | (pair & 0xffffffffU))
                                      : ((pair >> 32) << 32 | child));
        }
    }
    return false;
}

}  // namespace cdprep::study
