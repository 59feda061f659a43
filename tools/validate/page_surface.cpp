// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/page_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace cdprep::report {
namespace {

using Float3 = std::array<float, 3>;

constexpr double kFarthest = 1099511627776.0;  // 2^40 page units: floats can still multiply
constexpr int kFinestGrid = 256;               // cells along an axis

bool is_finite(const mesh::Double3& point) noexcept {
    return std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z);
}

std::array<double, 3> axes_of(const mesh::Double3& point) noexcept {
    return {point.x, point.y, point.z};
}

struct Box {
    std::array<double, 3> lower, upper;
};

std::optional<Box> box_of(std::span<const mesh::Double3> positions,
                          std::span<const mesh::Triangle> triangles) {
    constexpr double kNone = std::numeric_limits<double>::infinity();
    Box box{{kNone, kNone, kNone}, {-kNone, -kNone, -kNone}};
    for (const mesh::Triangle& triangle : triangles) {
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

/// The cells of a cube around the box; each cell is marked or not.
class Grid {
public:
    explicit Grid(int cells)
        : cells_(cells), marked_(static_cast<std::size_t>(cells) * cells * cells) {}

    /// Marks the cell of the point and the cells around it.
    void mark(const Float3& point) {
        const std::array<int, 3> at = cell_of(point);
        for (int x = at[0] - 1; x <= at[0] + 1; ++x) {
            for (int y = at[1] - 1; y <= at[1] + 1; ++y) {
                for (int z = at[2] - 1; z <= at[2] + 1; ++z) mark_cell(x, y, z);
            }
        }
    }

    [[nodiscard]] bool is_marked(const Float3& point) const {
        const std::array<int, 3> at = cell_of(point);
        return marked_[place(at[0], at[1], at[2])];
    }

    [[nodiscard]] std::array<int, 3> cell_of(const Float3& point) const {
        std::array<int, 3> at{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float scaled =
                (std::clamp(point[axis], -1.0F, 1.0F) + 1.0F) * 0.5F * static_cast<float>(cells_);
            at[axis] = std::min(static_cast<int>(scaled), cells_ - 1);
        }
        return at;
    }

    [[nodiscard]] std::size_t place(int x, int y, int z) const {
        const auto cells = static_cast<std::size_t>(cells_);
        return (static_cast<std::size_t>(x) * cells + static_cast<std::size_t>(y)) * cells +
               static_cast<std::size_t>(z);
    }

private:
    void mark_cell(int x, int y, int z) {
        const auto inside = [this](int at) { return at >= 0 && at < cells_; };
        if (inside(x) && inside(y) && inside(z)) marked_[place(x, y, z)] = true;
    }

    int cells_;
    std::vector<bool> marked_;
};

/// The parts that findings name; these are drawn first.
struct Named {
    std::vector<bool> triangles;
    std::vector<Float3> spots;  ///< page units
};

Named name_places(std::span<const mesh::Double3> positions,
                  std::span<const mesh::Triangle> triangles, const PageFrame& frame,
                  std::span<const mesh::Finding> findings) {
    Named named{std::vector<bool>(triangles.size()), {}};
    for (const mesh::Finding& finding : findings) {
        for (const mesh::Place& place : finding.places) {
            for (const std::uint32_t triangle : place.triangles) {
                if (triangle < triangles.size()) named.triangles[triangle] = true;
            }
            for (const std::uint32_t vertex : place.vertices) {
                if (vertex < positions.size() && is_finite(positions[vertex])) {
                    named.spots.push_back(frame.from_model(positions[vertex]));
                }
            }
            if (is_finite(place.position)) named.spots.push_back(frame.from_model(place.position));
        }
    }
    return named;
}

/// Returns the triangles that are named or have a corner in a marked cell, at most limit + 1.
std::vector<std::uint32_t> gather(std::span<const mesh::Double3> positions,
                                  std::span<const mesh::Triangle> triangles, const PageFrame& frame,
                                  const Named& named, const Grid* grid, std::size_t limit) {
    std::vector<std::uint32_t> chosen;
    for (std::size_t i = 0; i < triangles.size() && chosen.size() <= limit; ++i) {
        if (!is_drawable(positions, triangles[i])) continue;
        const auto is_near = [&](std::uint32_t vertex) {
            return grid != nullptr && grid->is_marked(frame.from_model(positions[vertex]));
        };
        if (named.triangles[i] || std::ranges::any_of(triangles[i].vertex, is_near)) {
            chosen.push_back(static_cast<std::uint32_t>(i));
        }
    }
    return chosen;
}

std::vector<std::uint32_t> all_drawable(std::span<const mesh::Double3> positions,
                                        std::span<const mesh::Triangle> triangles) {
    std::vector<std::uint32_t> chosen;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        if (is_drawable(positions, triangles[i])) chosen.push_back(static_cast<std::uint32_t>(i));
    }
    return chosen;
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

std::array<float, 3> PageFrame::from_model(const mesh::Double3& point) const noexcept {
    const std::array<double, 3> at = axes_of(point);
    const std::array<double, 3> middle = axes_of(centre);
    std::array<float, 3> moved{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double scaled = std::ldexp(at[axis] - middle[axis], -exponent);
        moved[axis] = static_cast<float>(std::clamp(scaled, -kFarthest, kFarthest));
    }
    return moved;
}

bool is_drawable(std::span<const mesh::Double3> positions,
                 const mesh::Triangle& triangle) noexcept {
    return std::ranges::all_of(triangle.vertex, [&](std::uint32_t vertex) {
        return vertex < positions.size() && is_finite(positions[vertex]);
    });
}

std::optional<PageFrame> find_page_frame(std::span<const mesh::Double3> positions,
                                         std::span<const mesh::Triangle> triangles) {
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

DrawnTriangles draw_triangles(std::span<const mesh::Double3> positions,
                              std::span<const mesh::Triangle> triangles, const PageFrame& frame,
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

std::vector<std::uint32_t> choose_triangles(std::span<const mesh::Double3> positions,
                                            std::span<const mesh::Triangle> triangles,
                                            const PageFrame& frame,
                                            std::span<const mesh::Finding> findings,
                                            std::size_t limit) {
    if (triangles.size() <= limit) return all_drawable(positions, triangles);
    const Named named = name_places(positions, triangles, frame, findings);
    for (int cells = 8; cells <= kFinestGrid; cells *= 2) {
        Grid grid(cells);
        for (const Float3& spot : named.spots) grid.mark(spot);
        std::vector<std::uint32_t> chosen =
            gather(positions, triangles, frame, named, &grid, limit);
        if (chosen.size() <= limit) return chosen;
    }
    std::vector<std::uint32_t> chosen = gather(positions, triangles, frame, named, nullptr, limit);
    chosen.resize(std::min(chosen.size(), limit));
    return chosen;
}

DrawnTriangles coarse_triangles(std::span<const mesh::Double3> positions,
                                std::span<const mesh::Triangle> triangles, const PageFrame& frame,
                                std::span<const std::uint32_t> left_out, std::uint32_t cells) {
    const Grid grid(static_cast<int>(cells));
    Vertices vertices;
    std::vector<std::array<std::uint32_t, 3>> kept;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        if (!left_out.empty() && left_out.front() == i) {
            left_out = left_out.subspan(1);
            continue;
        }
        const mesh::Triangle& triangle = triangles[i];
        if (!is_drawable(positions, triangle)) continue;
        std::array<std::uint64_t, 3> cell{};
        std::array<Float3, 3> point{};
        for (std::size_t k = 0; k < 3; ++k) {
            point[k] = frame.from_model(positions[triangle.vertex[k]]);
            const std::array<int, 3> at = grid.cell_of(point[k]);
            cell[k] = grid.place(at[0], at[1], at[2]);
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

}  // namespace cdprep::report
