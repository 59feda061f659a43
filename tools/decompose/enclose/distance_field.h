// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "decompose/enclose/separated_points.h"
#include "decompose/enclose/solid.h"
#include "hull/convex_hull.h"

namespace cdprep::convex {

/// An estimate, from a field, of how far a hull sticks out.
struct Estimate {
    double distance = 0;  ///< from the solid, model units; negative inside
    Double3 at = {0, 0, 0};
    std::size_t samples = 0;  ///< taken; fine ones near many triangles count as several
};

/// The resolution of a query. Between two walls a coarse field is too low, by up to half a spacing.
/// Where that matters, `fine` uses a finer field, whose nodes are measured on first use.
enum class Detail : std::uint8_t { coarse, fine };

/// Distances from a solid on a grid, negative inside. They guide the search for parts. Values are
/// rounded and interpolated; results are measured afterwards.
class DistanceField {
public:
    static constexpr std::size_t kMostNodes = 8'000'000;  ///< 32 megabytes; larger spacings beyond

    /// Measures the field. Keeps a reference to `solid`. `spacing` and `beyond` are in model units.
    /// Outside the solid, distances are measured up to `beyond`; farther nodes get a lower bound.
    /// The grid is coarser if it would exceed `most_nodes` nodes, or if a node costs as much as
    /// several usual ones. The field is the same for any parallel_for.
    DistanceField(const Solid& solid, double spacing, double beyond, ParallelFor parallel_for,
                  std::size_t most_nodes = kMostNodes);

    [[nodiscard]] double spacing() const {
        return spacing_;
    }
    /// Returns the number of nodes measured one by one, not as a block. A node about equally near
    /// to very many triangles counts as several, because it costs that much.
    [[nodiscard]] std::size_t measured() const {
        return measured_;
    }
    /// Returns the distance interpolated from the nodes around p. p lies in the solid's box.
    [[nodiscard]] double at(const Double3& p) const;

    /// Returns the nodes that are farther from the solid than `distance`, by at most about a
    /// diagonal of spacings. A hull that reaches farther out passes between them. The nodes come in
    /// groups of neighbours.
    [[nodiscard]] PointGroups nodes_beyond(double distance) const;

    /// Returns the greatest distance on the hull's surface if it exceeds `least`, else `least`
    /// itself. Samples are about half a spacing apart, or farther where doubles are coarser. The
    /// same for any `run`.
    [[nodiscard]] Estimate estimate(const ConvexHull& hull, double least, Detail detail,
                                    ParallelFor run = serial_for) const;

private:
    struct Block {
        std::array<std::size_t, 3> first;
    };
    [[nodiscard]] Double3 node(std::size_t x, std::size_t y, std::size_t z) const;
    [[nodiscard]] std::size_t index(std::size_t x, std::size_t y, std::size_t z) const {
        return (z * count_[1] + y) * count_[0] + x;
    }
    [[nodiscard]] std::size_t find_weight() const;
    /// Returns the number of nodes that it measured, as measured() counts.
    std::size_t fill(const Block& block, double beyond);
    void sample(std::array<Double3, 3> corners, Detail detail, Estimate& most) const;
    [[nodiscard]] double fine_at(const Double3& p) const;
    [[nodiscard]] double fine_node(std::size_t x, std::size_t y, std::size_t z) const;

    const Solid* solid_;
    Double3 origin_{};
    double spacing_;
    std::size_t weight_ = 1;  ///< of a node: how many usual ones cost as much
    std::size_t measured_ = 0;
    std::array<std::size_t, 3> count_{};  ///< nodes along each axis
    std::vector<float> distance_;
    std::vector<std::uint32_t> nearest_;  ///< triangle to each node, or near it
    std::array<std::size_t, 3> fine_count_{};
    /// Unknown until its first use. Every thread finds the same value.
    std::unique_ptr<std::atomic<float>[]> fine_;
};

}  // namespace cdprep::convex
