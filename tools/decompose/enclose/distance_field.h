// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "hull/convex_hull.h"
#include "decompose/enclose/separated_points.h"
#include "decompose/enclose/solid.h"

namespace cdprep::convex {

/// Where a hull sticks out, as a field tells it.
struct Estimate {
    double distance = 0;  ///< from the solid, model units; negative inside
    Double3 at = {0, 0, 0};
    std::size_t samples = 0;  ///< looked at; fine ones among many triangles count as several
};

/// Between two walls a field is too low, by up to half a spacing. A finer one, whose nodes
/// are measured when they are first asked for, is asked where that matters.
enum class Detail : std::uint8_t { coarse, fine };

/// Distances from a solid on a grid, negative inside: what the search for pieces goes by.
/// Rounded and interpolated; results are measured afterwards.
class DistanceField {
public:
    static constexpr std::size_t kMostNodes = 8'000'000;

    /// Keeps a reference to `solid`. `spacing` and `beyond` are model units: up to `beyond`
    /// outside, distances are measured, what is farther is only known to be. The grid is coarser
    /// where there would be more than `most_nodes`, and where each takes as much as several
    /// mostly do. The same for any parallel_for.
    DistanceField(const Solid& solid, double spacing, double beyond, ParallelFor parallel_for,
                  std::size_t most_nodes = kMostNodes);

    [[nodiscard]] double spacing() const {
        return spacing_;
    }
    /// How many nodes were measured one by one, not as a block. One that is about as near to
    /// very many triangles counts as several: for all that it took to look at them.
    [[nodiscard]] std::size_t measured() const {
        return measured_;
    }
    /// Between the nodes around p; p lies in the solid's box.
    [[nodiscard]] double at(const Double3& p) const;

    /// The nodes that are farther from the solid than `distance`, and not farther than that
    /// and about a diagonal of spacings: a hull that reaches farther out passes among them.
    /// In groups of neighbours.
    [[nodiscard]] PointGroups nodes_beyond(double distance) const;

    /// The greatest distance on the hull's surface, where it is more than `least`; else
    /// `least` itself. By samples about half a spacing apart. The same for any `run`.
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
    /// Returns how many nodes it measured, as measured() counts.
    std::size_t fill(const Block& block, double beyond);
    void sample(std::array<Double3, 3> corners, Detail detail, Estimate& most) const;
    [[nodiscard]] double fine_at(const Double3& p) const;
    [[nodiscard]] double fine_node(std::size_t x, std::size_t y, std::size_t z) const;

    const Solid* solid_;
    Double3 origin_{};
    double spacing_;
    std::size_t weight_ = 1;  ///< of a node: as many as mostly take that long
    std::size_t measured_ = 0;
    std::array<std::size_t, 3> count_{};  ///< nodes along each axis
    std::vector<float> distance_;
    std::vector<std::uint32_t> nearest_;  ///< to each node, or near it
    std::array<std::size_t, 3> fine_count_{};
    /// Unknown until it is asked for; whoever asks finds the same.
    std::unique_ptr<std::atomic<float>[]> fine_;
};

}  // namespace cdprep::convex
