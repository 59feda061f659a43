// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "cdprep/parallel_for.h"
#include "mesh/mesh.h"
#include "mesh/point_tree.h"

namespace cdprep::convex {

using format::Double3;
using format::Triangle;
using Corners = std::array<Double3, 3>;

/// Triangles in boxes within boxes, for very many questions about points while pieces are
/// searched: the nearest triangle, and those along a ray.
class TriangleTree {
public:
    /// Copies the corners. O(n log n). The same for any parallel_for.
    TriangleTree(std::span<const Double3> positions, std::span<const Triangle> triangles,
                 ParallelFor parallel_for);

    struct Nearest {
        std::uint32_t triangle;  ///< number in the span
        double distance;         ///< rounded; the true one to some 1e-12 of the model
    };

    /// The triangle nearest to p, as far as double can tell. There is at least one.
    /// `hint` is the number of a triangle that may be near, or any other number.
    [[nodiscard]] Nearest nearest(
        const Double3& p, std::uint32_t hint = std::numeric_limits<std::uint32_t>::max()) const;

    /// Calls visit(number) for every triangle whose box meets the ray from p along +x.
    template <class Visit>
    void along_x(const Double3& p, const Visit& visit) const {
        visit_boxes(
            [&p](const mesh::Box& box) {
                return box.upper.x >= p.x && box.lower.y <= p.y && p.y <= box.upper.y &&
                       box.lower.z <= p.z && p.z <= box.upper.z;
            },
            visit);
    }

    /// Calls visit(number) for every triangle whose box meets this one.
    template <class Visit>
    void in_box(const mesh::Box& wanted, const Visit& visit) const {
        visit_boxes(
            [&wanted](const mesh::Box& box) {
                return box.lower.x <= wanted.upper.x && wanted.lower.x <= box.upper.x &&
                       box.lower.y <= wanted.upper.y && wanted.lower.y <= box.upper.y &&
                       box.lower.z <= wanted.upper.z && wanted.lower.z <= box.upper.z;
            },
            visit);
    }

    [[nodiscard]] const Corners& corners(std::uint32_t triangle) const {
        return corners_[place_[triangle]];
    }
    [[nodiscard]] std::size_t size() const {
        return order_.size();
    }
    [[nodiscard]] const mesh::Box& box() const {
        return boxes_.front();
    }

private:
    /// Node i has the children 2i + 1 and 2i + 2; the last level are leaves.
    [[nodiscard]] std::size_t leaf_begin(std::size_t leaf) const {
        return order_.size() * leaf / leaf_count_;
    }
    void split_level(std::size_t level, std::span<const Double3> middles, ParallelFor parallel_for);
    void sort_leaves(ParallelFor parallel_for);
    void fill_boxes(ParallelFor parallel_for);

    template <class Meets, class Visit>
    void visit_boxes(const Meets& meets, const Visit& visit) const {
        std::array<std::size_t, 64> stack;
        std::size_t depth = 0;
        stack[depth++] = 0;
        while (depth > 0) {
            const std::size_t node = stack[--depth];
            if (!meets(boxes_[node])) continue;
            if (node + 1 < leaf_count_) {
                stack[depth++] = 2 * node + 2;
                stack[depth++] = 2 * node + 1;
                continue;
            }
            const std::size_t leaf = node + 1 - leaf_count_;
            for (std::size_t i = leaf_begin(leaf); i < leaf_begin(leaf + 1); ++i) {
                mesh::Box box;
                for (const Double3& corner : corners_[i]) box.add(corner);
                if (meets(box)) visit(order_[i]);
            }
        }
    }

    std::size_t leaf_count_ = 1;  ///< a power of two
    std::vector<std::uint32_t> order_;
    std::vector<std::uint32_t> place_;  ///< of each triangle in the order
    std::vector<Corners> corners_;      ///< in the order
    std::vector<mesh::Box> boxes_;
};

}  // namespace cdprep::convex
