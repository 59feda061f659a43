// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include "cdprep/format/geometry.h"

namespace cdprep::mesh {

using format::Double3;

/// A closed axis-aligned box; initially empty.
struct Box {
    static constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Double3 lower{kInfinity, kInfinity, kInfinity};
    Double3 upper{-kInfinity, -kInfinity, -kInfinity};

    void add(const Double3& p) {
        lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
        upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
    }
    [[nodiscard]] bool contains(const Double3& p) const {
        return lower.x <= p.x && p.x <= upper.x && lower.y <= p.y && p.y <= upper.y &&
               lower.z <= p.z && p.z <= upper.z;
    }
    [[nodiscard]] bool meets(const Box& other) const {
        return lower.x <= other.upper.x && other.lower.x <= upper.x && lower.y <= other.upper.y &&
               other.lower.y <= upper.y && lower.z <= other.upper.z && other.lower.z <= upper.z;
    }
    [[nodiscard]] double diagonal() const {
        return std::hypot(upper.x - lower.x, upper.y - lower.y, upper.z - lower.z);
    }
};

/// A hierarchy of boxes around points, halved along the longest axis.
class PointTree {
public:
    /// Takes ownership of the points.
    explicit PointTree(std::vector<Double3> points)
        : points_(std::move(points)), order_(points_.size()) {
        std::iota(order_.begin(), order_.end(), 0U);
        if (!points_.empty()) build(0, static_cast<std::uint32_t>(points_.size()));
    }

    [[nodiscard]] const Double3& point(std::uint32_t number) const {
        return points_[number];
    }

    /// Calls visit(number) for the points of all leaf boxes that enter(box) accepts. It tests
    /// boxes from the top, and skips all boxes below a rejected one. The order is unspecified.
    template <class Enter, class Visit>
    void visit(const Enter& enter, const Visit& visit) const {
        for (std::uint32_t i = 0; i < nodes_.size();) {
            const Node& node = nodes_[i];
            if (!enter(node.box)) {
                i = node.next;
                continue;
            }
            for (std::uint32_t k = node.first; k < node.last; ++k) visit(order_[k]);
            ++i;
        }
    }

private:
    /// The nodes are in depth-first order.
    struct Node {
        Box box;
        std::uint32_t next;   ///< after all nodes below
        std::uint32_t first;  ///< of its points if it is a leaf; otherwise first == last
        std::uint32_t last;
    };

    void build(std::uint32_t first, std::uint32_t last) {
        constexpr std::uint32_t kLowest = 8;
        const std::size_t number = nodes_.size();
        nodes_.emplace_back();
        Box box;
        for (std::uint32_t i = first; i < last; ++i) box.add(points_[order_[i]]);
        const bool lowest = last - first <= kLowest;
        if (!lowest) {
            const std::uint32_t middle = first + (last - first) / 2;
            halve(box, std::span(order_).subspan(first, last - first), middle - first);
            build(first, middle);
            build(middle, last);
        }
        nodes_[number] = {box, static_cast<std::uint32_t>(nodes_.size()), first,
                          lowest ? last : first};
    }

    void halve(const Box& box, std::span<std::uint32_t> numbers, std::size_t middle) const {
        const double x = box.upper.x - box.lower.x;
        const double y = box.upper.y - box.lower.y;
        const double z = box.upper.z - box.lower.z;
        double Double3::*axis = &Double3::z;
        if (y >= z) axis = &Double3::y;
        if (x >= y && x >= z) axis = &Double3::x;
        std::nth_element(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(middle),
                         numbers.end(), [this, axis](std::uint32_t a, std::uint32_t b) {
                             return points_[a].*axis < points_[b].*axis;
                         });
    }

    std::vector<Double3> points_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

}  // namespace cdprep::mesh
