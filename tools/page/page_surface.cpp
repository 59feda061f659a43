// SPDX-License-Identifier: GPL-3.0-or-later
#include "page/page_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <unordered_map>

namespace cdprep::report {
namespace {

using Float3 = std::array<float, 3>;

constexpr double kFarthest = 1099511627776.0;  // 2^40 page units: floats can still multiply

bool is_finite(const format::Double3& point) noexcept {
    return std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z);
}

std::array<double, 3> axes_of(const format::Double3& point) noexcept {
    return {point.x, point.y, point.z};
}

struct Box {
    std::array<double, 3> lower, upper;
};

std::optional<Box> box_of(std::span<const format::Double3> positions,
                          std::span<const format::Triangle> triangles) {
    constexpr double kNone = std::numeric_limits<double>::infinity();
    Box box{{kNone, kNone, kNone}, {-kNone, -kNone, -kNone}};
    for (const format::Triangle& triangle : triangles) {
        if (!is_drawable(positions, triangle)) continue;
        for (const std::uint32_t vertex : triangle.vertex) {
            const std::array<double, 3> point = axes_of(positions[vertex]);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                box.lower[axis] = std::min(box.lower[axis], point[axis]);
                box.upper[axis] = std::max(box.upper[axis], point[axis]);
            }
        }
    }
    if (box.lower[0] > box.upper[0]) return std::nullopt;
    return box;
}

/// The drawn vertices in order of first use, with their numbers.
class Vertices {
public:
    [[nodiscard]] std::uint32_t number(std::uint64_t key, const Float3& point) {
        const auto next = static_cast<std::uint32_t>(numbers_.size());
        const auto [entry, is_new] = numbers_.try_emplace(key, next);
        if (is_new) drawn_.insert(drawn_.end(), point.begin(), point.end());
        return entry->second;
    }
    [[nodiscard]] std::vector<float> take() {
        return std::move(drawn_);
    }

private:
    std::unordered_map<std::uint64_t, std::uint32_t> numbers_;
    std::vector<float> drawn_;
};

}  // namespace

std::array<float, 3> PageFrame::from_model(const format::Double3& point) const noexcept {
    const std::array<double, 3> at = axes_of(point);
    const std::array<double, 3> middle = axes_of(centre);
    std::array<float, 3> moved{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double scaled = std::ldexp(at[axis] - middle[axis], -exponent);
        moved[axis] = static_cast<float>(std::clamp(scaled, -kFarthest, kFarthest));
    }
    return moved;
}

std::array<int, 3> PageGrid::cell_of(const std::array<float, 3>& point) const noexcept {
    std::array<int, 3> at{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float scaled =
            (std::clamp(point[axis], -1.0F, 1.0F) + 1.0F) * 0.5F * static_cast<float>(cells_);
        at[axis] = std::min(static_cast<int>(scaled), cells_ - 1);
    }
    return at;
}

std::size_t PageGrid::number(int x, int y, int z) const noexcept {
    const auto cells = static_cast<std::size_t>(cells_);
    return (static_cast<std::size_t>(x) * cells + static_cast<std::size_t>(y)) * cells +
           static_cast<std::size_t>(z);
}

bool is_drawable(std::span<const format::Double3> positions,
                 const format::Triangle& triangle) noexcept {
    return std::ranges::all_of(triangle.vertex, [&](std::uint32_t vertex) {
        return vertex < positions.size() && is_finite(positions[vertex]);
    });
}

std::optional<PageFrame> find_page_frame(std::span<const format::Double3> positions,
                                         std::span<const format::Triangle> triangles) {
    const std::optional<Box> box = box_of(positions, triangles);
    if (!box) return std::nullopt;
    std::array<double, 3> centre{};
    std::array<double, 3> half{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        // Halves first: the sum of two doubles may be infinite.
        centre[axis] = box->lower[axis] / 2 + box->upper[axis] / 2;
        half[axis] = std::max(box->upper[axis] - centre[axis], centre[axis] - box->lower[axis]);
    }
    PageFrame frame{{centre[0], centre[1], centre[2]}, 0, {}};
    // A mesh that is a single point has exponent 0: it has no size to scale by.
    const double longest = *std::ranges::max_element(half);
    if (longest > 0) std::frexp(longest, &frame.exponent);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        frame.half_box[axis] = static_cast<float>(std::ldexp(half[axis], -frame.exponent));
    }
    return frame;
}

DrawnTriangles draw_triangles(std::span<const format::Double3> positions,
                              std::span<const format::Triangle> triangles, const PageFrame& frame,
                              std::span<const std::uint32_t> chosen) {
    constexpr auto kUnused = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> number(positions.size(), kUnused);
    DrawnTriangles drawn;
    drawn.indices.reserve(chosen.size() * 3);
    for (const std::uint32_t triangle : chosen) {
        for (const std::uint32_t vertex : triangles[triangle].vertex) {
            if (number[vertex] == kUnused) {
                number[vertex] = static_cast<std::uint32_t>(drawn.positions.size() / 3);
                const Float3 point = frame.from_model(positions[vertex]);
                drawn.positions.insert(drawn.positions.end(), point.begin(), point.end());
            }
            drawn.indices.push_back(number[vertex]);
        }
    }
    return drawn;
}

DrawnTriangles coarse_triangles(std::span<const format::Double3> positions,
                                std::span<const format::Triangle> triangles, const PageFrame& frame,
                                std::span<const std::uint32_t> left_out, std::uint32_t cells) {
    const PageGrid grid(static_cast<int>(cells));
    Vertices vertices;
    std::vector<std::array<std::uint32_t, 3>> kept;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        if (!left_out.empty() && left_out.front() == i) {
            left_out = left_out.subspan(1);
            continue;
        }
        const format::Triangle& triangle = triangles[i];
        if (!is_drawable(positions, triangle)) continue;
        std::array<std::uint64_t, 3> cell{};
        std::array<Float3, 3> point{};
        for (std::size_t k = 0; k < 3; ++k) {
            point[k] = frame.from_model(positions[triangle.vertex[k]]);
            const std::array<int, 3> at = grid.cell_of(point[k]);
            cell[k] = grid.number(at[0], at[1], at[2]);
        }
        if (cell[0] == cell[1] || cell[1] == cell[2] || cell[2] == cell[0]) continue;
        std::array<std::uint32_t, 3> corners{};
        for (std::size_t k = 0; k < 3; ++k) corners[k] = vertices.number(cell[k], point[k]);
        // The lowest corner first, so that equal triangles of equal winding compare equal.
        std::rotate(corners.begin(), std::ranges::min_element(corners), corners.end());
        kept.push_back(corners);
    }
    std::ranges::sort(kept);
    kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
    DrawnTriangles drawn{vertices.take(), {}};
    for (const auto& corners : kept) {
        drawn.indices.insert(drawn.indices.end(), corners.begin(), corners.end());
    }
    return drawn;
}

std::vector<std::size_t> share_triangles(std::span<const std::size_t> sizes,
                                         std::size_t triangles) {
    std::vector<std::size_t> by_size(sizes.size());
    std::iota(by_size.begin(), by_size.end(), 0);
    std::ranges::stable_sort(by_size, {}, [&](std::size_t i) { return sizes[i]; });
    std::vector<std::size_t> shares(sizes.size());
    for (std::size_t k = 0; k < by_size.size(); ++k) {
        const std::size_t even = triangles / (by_size.size() - k);
        shares[by_size[k]] = std::min(even, sizes[by_size[k]]);
        triangles -= shares[by_size[k]];
    }
    return shares;
}

}  // namespace cdprep::report
