// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/choose_triangles.h"

#include <algorithm>
#include <array>

#include "mesh/vectors.h"

namespace cdprep::report {
namespace {

using Float3 = std::array<float, 3>;

constexpr int kFinestGrid = 256;  // cells along an axis

/// A grid whose cells are marked or not.
class MarkedGrid {
public:
    explicit MarkedGrid(int cells)
        : grid_(cells), marked_(static_cast<std::size_t>(cells) * cells * cells) {}

    /// Marks the cell of the point and the cells around it.
    void mark(const Float3& point) {
        const std::array<int, 3> at = grid_.cell_of(point);
        for (int x = at[0] - 1; x <= at[0] + 1; ++x) {
            for (int y = at[1] - 1; y <= at[1] + 1; ++y) {
                for (int z = at[2] - 1; z <= at[2] + 1; ++z) mark_cell(x, y, z);
            }
        }
    }

    [[nodiscard]] bool is_marked(const Float3& point) const {
        const std::array<int, 3> at = grid_.cell_of(point);
        return marked_[grid_.number(at[0], at[1], at[2])];
    }

private:
    void mark_cell(int x, int y, int z) {
        const auto inside = [this](int at) { return at >= 0 && at < grid_.cells(); };
        if (inside(x) && inside(y) && inside(z)) marked_[grid_.number(x, y, z)] = true;
    }

    PageGrid grid_;
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
                if (vertex < positions.size() && mesh::is_finite(positions[vertex])) {
                    named.spots.push_back(frame.from_model(positions[vertex]));
                }
            }
            if (mesh::is_finite(place.position))
                named.spots.push_back(frame.from_model(place.position));
        }
    }
    return named;
}

/// Returns the triangles that are named or have a corner in a marked cell, at most limit + 1.
std::vector<std::uint32_t> gather(std::span<const mesh::Double3> positions,
                                  std::span<const mesh::Triangle> triangles, const PageFrame& frame,
                                  const Named& named, const MarkedGrid* grid, std::size_t limit) {
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

}  // namespace

std::vector<std::uint32_t> choose_triangles(std::span<const mesh::Double3> positions,
                                            std::span<const mesh::Triangle> triangles,
                                            const PageFrame& frame,
                                            std::span<const mesh::Finding> findings,
                                            std::size_t limit) {
    if (triangles.size() <= limit) return all_drawable(positions, triangles);
    const Named named = name_places(positions, triangles, frame, findings);
    for (int cells = 8; cells <= kFinestGrid; cells *= 2) {
        MarkedGrid grid(cells);
        for (const Float3& spot : named.spots) grid.mark(spot);
        std::vector<std::uint32_t> chosen =
            gather(positions, triangles, frame, named, &grid, limit);
        if (chosen.size() <= limit) return chosen;
    }
    std::vector<std::uint32_t> chosen = gather(positions, triangles, frame, named, nullptr, limit);
    chosen.resize(std::min(chosen.size(), limit));
    return chosen;
}

}  // namespace cdprep::report
