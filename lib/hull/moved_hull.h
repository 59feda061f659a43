// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "cdprep/advanced/convex_points.h"
#include "cdprep/pose.h"
#include "core/moved_point.h"
#include "exact/vectors.h"
#include "hull/hull_points.h"
#include "kernels/kernels.h"

namespace cdprep {

/// A hull in one query: its points after moving, each rounded by transform_point(). The answers
/// refer to those points.
class MovedHull {
public:
    MovedHull(const ConvexPoints& points, const Pose* pose) noexcept;

    [[nodiscard]] std::uint32_t count() const noexcept {
        return points_->count;
    }
    [[nodiscard]] Double3 point(std::uint32_t number) const noexcept {
        const Double3 p = hull_point(*points_, number);
        return pose_ == nullptr ? p : moved_point(*pose_, p);
    }

    /// Returns the point that is farthest along a direction, up to rounding. Hill climbing begins
    /// at `near`, a point's number.
    [[nodiscard]] std::uint32_t farthest(const Double3& direction,
                                         std::uint32_t near) const noexcept;

    /// The same where `near` may be far away: begins at the stored start for the direction if that
    /// is better.
    [[nodiscard]] std::uint32_t farthest_anew(const Double3& direction,
                                              std::uint32_t near) const noexcept;

    /// Returns the farthest point along a direction, and its reach from `origin`. The result's
    /// bound holds for every point; it includes rounding, but not underflow. `farthest` is the
    /// result of farthest(); if it was wrong, another point is returned.
    [[nodiscard]] kernels::FarthestPoint proven(const Double3& direction, const Double3& origin,
                                                std::uint32_t farthest) const noexcept;

    /// The same, by testing every point.
    [[nodiscard]] kernels::FarthestPoint proven_by_all(const Double3& direction,
                                                       const Double3& origin) const noexcept;

    /// Returns a bound of how far any point is from `origin` along a direction. It is less sharp
    /// than that of proven_by_all(), by some rounding errors of the hull's size, and takes less
    /// time. Includes rounding, but not underflow.
    [[nodiscard]] double bound_along(const Double3& direction,
                                     const Double3& origin) const noexcept;

    /// Calls visit(number, point) for every point.
    template <class Visit>
    void each_point(Visit&& visit) const noexcept {
        for (std::uint32_t i = 0; i < count(); ++i) visit(i, point(i));
    }

private:
    [[nodiscard]] bool can_climb() const noexcept {
        return !points_->neighbour_begins.empty();
    }
    [[nodiscard]] std::span<const std::uint32_t> neighbours(std::uint32_t number) const noexcept {
        const std::uint32_t begin = points_->neighbour_begins[number];
        return points_->neighbours.subspan(begin, points_->neighbour_begins[number + 1] - begin);
    }
    [[nodiscard]] std::uint32_t scan(const Double3& local) const noexcept;
    [[nodiscard]] std::uint32_t scan_corners(const Double3& local) const noexcept;
    [[nodiscard]] kernels::FarthestPoint proven_by_corners(const Double3& direction,
                                                           const Double3& origin) const noexcept;
    [[nodiscard]] std::uint32_t climb(const Double3& local, std::uint32_t from) const noexcept;
    [[nodiscard]] double slack(const Double3& direction) const noexcept;

    const ConvexPoints* points_;
    const Pose* pose_;  ///< null: the hull is not moved
};

/// The two hulls of a query.
struct TwoHulls {
    MovedHull a;
    MovedHull b;

    TwoHulls(const MovedHull& of_a, const MovedHull& of_b) noexcept : a(of_a), b(of_b) {}
    TwoHulls(const ConvexPoints& of_a, const ConvexPoints& of_b,
             const Placement& placement) noexcept
        : a(of_a, placement.a_is_moved() ? &placement.pose_a() : nullptr),
          b(of_b, placement.b_is_moved() ? &placement.pose_b() : nullptr) {}
};

}  // namespace cdprep
