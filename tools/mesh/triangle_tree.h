// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "cdprep/advanced/parallel_for.h"
#include "mesh/mesh.h"
#include "mesh/point_tree.h"

namespace cdprep::convex {

using format::Double3;
using format::Triangle;
using Corners = std::array<Double3, 3>;

/// A BVH of triangles for very many point queries during the search for parts: the nearest
/// triangle, and the triangles along a ray.
///
/// Each node has eight boxes, stored by coordinate as floats. The coordinates are scaled so that
/// all lie between -1 and 1. The boxes are enlarged by more than the rounding of boxes and query
/// points, so that nothing is missed.
class TriangleTree {
public:
    /// Copies the corners. O(n log n). The result is the same for any parallel_for. Sixth powers
    /// of the sides of triangles must be within the range of double.
    TriangleTree(std::span<const Double3> positions, std::span<const Triangle> triangles,
                 ParallelFor parallel_for);

    struct Nearest {
        std::uint32_t triangle;  ///< number in the span
        double distance;         ///< rounded; true to some 1e-12 of the model
        std::uint32_t looks;     ///< tested nodes and triangles; many if many are as near

        /// Returns the cost in units of a usual query; mostly 1.
        [[nodiscard]] std::size_t weight() const {
            return looks <= kUsualLooks ? 1 : looks / kLooksOfQuestion;
        }

    private:
        static constexpr std::uint32_t kUsualLooks = 256;
        static constexpr std::uint32_t kLooksOfQuestion = 64;
    };

    /// Returns the triangle nearest to p, up to rounding in double. There must be at least one
    /// triangle. `hint` is the number of a triangle that may be near, or any other number. It
    /// affects the time, and the choice among triangles at equal distance.
    [[nodiscard]] Nearest nearest(
        const Double3& p, std::uint32_t hint = std::numeric_limits<std::uint32_t>::max()) const;

    /// Calls visit(number) for every triangle whose box meets the ray from p along +x.
    template <class Visit>
    void along_x(const Double3& p, const Visit& visit) const {
        in_box({p, {std::numeric_limits<double>::infinity(), p.y, p.z}}, visit);
    }

    /// Calls visit(number) for every triangle whose box meets this one.
    template <class Visit>
    void in_box(const mesh::Box& wanted, const Visit& visit) const {
        const FloatBox box = to_floats(wanted);
        std::array<Place, kMostWaiting> stack;
        std::size_t depth = 0;
        stack[depth++] = {top_level(), 0};
        while (depth > 0) {
            const Place at = stack[--depth];
            unsigned met = which_meet(node(at), box);
            for (; met != 0; met &= met - 1) {
                const auto k = static_cast<std::size_t>(std::countr_zero(met));
                if (at.level > 0) {
                    stack[depth++] = below(at, k);
                    continue;
                }
                const std::size_t i = leaf_begin(at.index) + k;
                mesh::Box of_triangle;
                for (const Double3& corner : corners_[i]) of_triangle.add(corner);
                if (of_triangle.meets(wanted)) visit(order_[i]);
            }
        }
    }

    [[nodiscard]] const Corners& corners(std::uint32_t triangle) const {
        return corners_[place_[triangle]];
    }
    [[nodiscard]] std::size_t size() const {
        return order_.size();
    }
    [[nodiscard]] const mesh::Box& box() const {
        return box_;
    }

private:
    static constexpr std::size_t kWidth = 8;
    static constexpr std::size_t kMostWaiting = 11 * (kWidth - 1) + 1;  ///< 2^33 triangles

    /// Eight boxes, stored by coordinate; nothing meets an empty one.
    struct Lanes {
        alignas(32) std::array<std::array<float, kWidth>, 3> lower, upper;
    };
    struct FloatBox {
        std::array<float, 3> lower, upper;
    };
    /// A node. On level 0 its boxes are those of the triangles of a leaf. On other levels they
    /// are those of nodes on the level below; node i has those from 8 i on.
    struct Place {
        std::uint32_t level;
        std::uint32_t index;
    };
    static Place below(const Place& at, std::size_t k) {
        return {at.level - 1, static_cast<std::uint32_t>(kWidth * at.index + k)};
    }
    [[nodiscard]] const Lanes& node(const Place& at) const {
        return nodes_[first_of_level_[at.level] + at.index];
    }
    [[nodiscard]] std::uint32_t top_level() const {
        return static_cast<std::uint32_t>(first_of_level_.size() - 2);
    }
    [[nodiscard]] std::size_t leaf_begin(std::size_t leaf) const {
        return order_.size() * leaf / leaf_count_;
    }
    [[nodiscard]] FloatBox to_floats(const mesh::Box& box) const;
    static unsigned which_meet(const Lanes& lanes, const FloatBox& box);
    void split_level(std::size_t level, std::span<const Double3> middles, ParallelFor parallel_for);
    void sort_leaves(ParallelFor parallel_for);
    void choose_unit(std::span<const Double3> positions, std::span<const Triangle> triangles);
    void fill_boxes(ParallelFor parallel_for);

    std::size_t leaf_count_ = 1;  ///< a power of two
    std::vector<std::uint32_t> order_;
    std::vector<std::uint32_t> place_;  ///< position of each triangle in the order
    std::vector<Corners> corners_;      ///< in the order
    mesh::Box box_;
    Double3 centre_{};  ///< of the box; the floats are (p - centre) * scale
    double scale_ = 1;  ///< a power of two
    std::vector<Lanes> nodes_;
    std::vector<std::size_t> first_of_level_;  ///< first node of each level; then their number
};

}  // namespace cdprep::convex
