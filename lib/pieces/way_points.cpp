// SPDX-License-Identifier: MIT
#include "pieces/way_points.h"

#include <algorithm>
#include <array>
#include <limits>

#include "hull/gjk.h"
#include "hull/hull_points.h"

namespace cdprep {
namespace {

/// The corners of a piece that are farthest along a direction, and their shadows on a plane across
/// it.
class FarCorners {
public:
    FarCorners(const ContactSide& side, const Double3& direction, const Double3& origin) noexcept {
        const std::uint32_t all = side.points().count;
        double most = -std::numeric_limits<double>::infinity(), least = -most;
        for (std::uint32_t i = 0; i < all; ++i) {
            const double height = dot(direction, side.corner(i) - origin);
            most = std::max(most, height);
            least = std::min(least, height);
        }
        for (std::uint32_t i = 0; i < all && count_ < at_.size(); ++i) {
            const Double3 p = side.corner(i) - origin;
            const double height = dot(direction, p);
            if (height < most - ContactSide::kLevel * (most - least)) continue;
            at_[count_] = side.corner(i);
            put(count_++, p - height * direction);
        }
        for (std::size_t i = count_; i % format::kHullLanes != 0; ++i) put(i, last_);
        points_.blocks =
            std::span(block_).first((count_ + format::kHullLanes - 1) / format::kHullLanes);
        points_.count = static_cast<std::uint32_t>(count_);
    }
    FarCorners(const FarCorners&) = delete;  // points_ refers to block_
    FarCorners& operator=(const FarCorners&) = delete;
    ~FarCorners() = default;

    [[nodiscard]] std::size_t count() const noexcept {
        return count_;
    }
    [[nodiscard]] const Double3& at(std::size_t i) const noexcept {
        return at_[i];
    }
    [[nodiscard]] MovedHull shadow() const noexcept {
        return {points_, nullptr};
    }

private:
    void put(std::size_t i, const Double3& p) noexcept {
        set_hull_point(block_, i, p);
        last_ = p;
    }

    /// Corners beyond these are left out: the hull of the rest is a part of the face.
    static constexpr std::size_t kMost = 4 * format::kHullLanes;

    std::array<format::HullBlock, kMost / format::kHullLanes> block_;
    std::size_t count_ = 0;
    Double3 last_{};
    ConvexPoints points_;
    std::array<Double3, kMost> at_;
};

}  // namespace

WayPoints way_points(const ContactSide& a, const ContactSide& b,
                     const Double3& direction) noexcept {
    const Double3 origin = a.corner(0);
    const FarCorners of_a(a, direction, origin), of_b(b, -direction, origin);
    if (of_a.count() == 1 && of_b.count() == 1) return {of_a.at(0), of_b.at(0)};
    // Flat hulls that meet have no certain verdict, and none is needed: the points are rounded.
    const NearestSimplex nearest = gjk(of_a.shadow(), of_b.shadow(), {}, nullptr, nullptr).simplex;
    WayPoints points{};
    for (std::size_t i = 0; i < nearest.count; ++i) {
        points.on_a = points.on_a + nearest.weight[i] * of_a.at(nearest.corner[i].a);
        points.on_b = points.on_b + nearest.weight[i] * of_b.at(nearest.corner[i].b);
    }
    return points;
}

}  // namespace cdprep
