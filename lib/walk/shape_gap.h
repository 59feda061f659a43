// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "core/numbers.h"
#include "exact/vectors.h"
#include "walk/shape_frame.h"

namespace cdprep {

/// Lower bounds of the distance from a triangle, segment or point to the boxes and triangles of a
/// nearest search. There are three. One is the gap between the boxes around both. One is the gap
/// along the direction from the shape to the middle of the other. Once a near place is known, the
/// third is the gap along the direction to it. A gap along any vector of length at most 1 bounds
/// the distance.
class ShapeGap {
public:
    ShapeGap(const MovedModel& model, const Corners& shape) noexcept
        : frame_(model, reach_of(shape)),
          is_point_(shape[0] == shape[1] && shape[1] == shape[2]),
          shape_(shape),
          around_(box_around(shape)) {
        for (std::size_t k = 0; k < 3; ++k) corner_[k] = frame_.at(shape[k]);
        for (std::size_t i = 0; i < 3; ++i) {
            lower_[i] = std::min({corner_[0][i], corner_[1][i], corner_[2][i]});
            upper_[i] = std::max({corner_[0][i], corner_[1][i], corner_[2][i]});
        }
        for (const Double3& p : shape) {
            for (const double x : relative(p)) size_ = std::max(size_, std::fabs(x));
        }
    }

    /// Sets two near places, in the world: most others are farther apart along this direction.
    void point(const Double3& on_shape, const Double3& on_model) noexcept {
        const Double3 way = {on_model.x - on_shape.x, on_model.y - on_shape.y,
                             on_model.z - on_shape.z};
        world_way_ = shortened({way.x, way.y, way.z});
        world_most_ =
            most_of(world_way_, {relative(shape_[0]), relative(shape_[1]), relative(shape_[2])});
        const FrameVector from = frame_.at(on_shape);
        const FrameVector to = frame_.at(on_model);
        way_ = shortened(minus(to, from));
        most_ = most_of(way_, corner_);
    }

    /// Returns a limit in the units of box bounds: frame units, rounded up.
    [[nodiscard]] double in_frame(double limit) const noexcept {
        return std::nextafter(frame_.scaled(limit), kInfinity);
    }

    /// Returns the bound for a box of the model, in frame units.
    double operator()(const format::BvhNode& node, std::uint32_t box) const noexcept {
        double squared = 0;
        double along = -most_;
        FrameVector middle{};
        for (std::size_t i = 0; i < 3; ++i) {
            const double lower = node.lower[i][box];
            const double upper = node.upper[i][box];
            squared += square(std::max(std::max(lower - upper_[i], lower_[i] - upper), 0.0));
            along += way_[i] > 0 ? way_[i] * lower : way_[i] * upper;
            middle[i] = 0.5 * (lower + upper);
        }
        if (!is_point_) along = std::max(along, gap_towards(middle, node, box));
        // Too far away for squares or for the frame: no bound.
        if (!(squared < kLargestSquare)) return 0;
        const double gap = std::max(std::sqrt(squared) * (1 - kRounding), along);
        return std::max(gap - 2 * frame_.slack(), 0.0);
    }

    /// Returns the bound for a triangle of the model, as moved, in model units. Let M be the
    /// largest coordinate relative to the shape: a gap along the direction is off by less than
    /// 32 u M.
    [[nodiscard]] double operator()(const Corners& t) const noexcept {
        const double boxes = gap_of_boxes(box_around(t));
        double least = kFar;
        double size = size_;
        for (const Double3& p : t) {
            const FrameVector at = relative(p);
            least = std::min(least, dot(world_way_, at));
            size = std::max({size, std::fabs(at[0]), std::fabs(at[1]), std::fabs(at[2])});
        }
        double along = least - world_most_;
        if (!is_point_) along = std::max(along, gap_towards(t));
        return size < kFar ? std::max(boxes, along - kRounding * size) : 0;
    }

private:
    static constexpr double kLargestSquare = 0x1p1000;
    static constexpr double kFar = 0x1p1020;
    static constexpr double kRounding = 0x1p-45;

    static double square(double x) noexcept {
        return x * x;
    }
    static double reach_of(const Corners& shape) noexcept {
        return std::max({ShapeFrame::largest(shape[0]), ShapeFrame::largest(shape[1]),
                         ShapeFrame::largest(shape[2])});
    }
    static double most_of(const FrameVector& way,
                          const std::array<FrameVector, 3>& corner) noexcept {
        return std::max({dot(way, corner[0]), dot(way, corner[1]), dot(way, corner[2])});
    }
    /// Returns the direction with a length slightly below 1, so that no rounding makes it longer;
    /// 0 if it has no direction.
    static FrameVector shortened(const FrameVector& way) noexcept {
        const double scale = (1 - 0x1p-30) / std::sqrt(dot(way, way));
        if (!(scale < 0x1p400 && scale > 0x1p-400)) return {};
        return {scale * way[0], scale * way[1], scale * way[2]};
    }
    [[nodiscard]] FrameVector relative(const Double3& p) const noexcept {
        return {p.x - shape_[0].x, p.y - shape_[0].y, p.z - shape_[0].z};
    }
    [[nodiscard]] double gap_of_boxes(const Box3& t) const noexcept {
        const auto gap = [](double from, double to, double t_from, double t_to) {
            return square(std::max(std::max(from - t_to, t_from - to), 0.0));
        };
        const double squared = gap(around_.lower.x, around_.upper.x, t.lower.x, t.upper.x) +
                               gap(around_.lower.y, around_.upper.y, t.lower.y, t.upper.y) +
                               gap(around_.lower.z, around_.upper.z, t.lower.z, t.upper.z);
        const bool keeps_digits = squared > 0x1p-900 && squared < kLargestSquare;
        return keeps_digits ? std::sqrt(squared) * (1 - kRounding) : 0;
    }

    /// Returns a point of the shape near p: the nearest up to rounding (Ericson 2005, 5.1.5).
    static FrameVector nearest_on(const std::array<FrameVector, 3>& corner,
                                  const FrameVector& p) noexcept;

    /// Returns the gap along the direction to the middle of a box, in frame units.
    [[nodiscard]] double gap_towards(const FrameVector& middle, const format::BvhNode& node,
                                     std::uint32_t box) const noexcept {
        const FrameVector from = nearest_on(corner_, middle);
        const FrameVector way = shortened(minus(middle, from));
        double least = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            least += way[i] * (way[i] > 0 ? node.lower[i][box] : node.upper[i][box]);
        }
        return least - most_of(way, corner_);
    }
    /// Returns the gap along the direction to the middle of a triangle, in the world.
    [[nodiscard]] double gap_towards(const Corners& t) const noexcept {
        const std::array<FrameVector, 3> at = {relative(t[0]), relative(t[1]), relative(t[2])};
        const std::array<FrameVector, 3> shape = {relative(shape_[0]), relative(shape_[1]),
                                                  relative(shape_[2])};
        FrameVector middle{};
        for (std::size_t i = 0; i < 3; ++i) {
            middle[i] = (at[0][i] + at[1][i] + at[2][i]) * (1.0 / 3);
        }
        const FrameVector from = nearest_on(shape, middle);
        const FrameVector way = shortened(minus(middle, from));
        return std::min({dot(way, at[0]), dot(way, at[1]), dot(way, at[2])}) - most_of(way, shape);
    }

    ShapeFrame frame_;
    bool is_point_;
    Corners shape_;
    Box3 around_;
    std::array<FrameVector, 3> corner_{};
    FrameVector lower_{}, upper_{};
    FrameVector way_{};
    double most_ = 0;
    FrameVector world_way_{};
    double world_most_ = 0;
    double size_ = 0;  ///< of the shape, relative to its first corner
};

inline FrameVector ShapeGap::nearest_on(const std::array<FrameVector, 3>& corner,
                                        const FrameVector& p) noexcept {
    const auto& [a, b, c] = corner;
    const auto between = [](const FrameVector& x, const FrameVector& y, double s) {
        return FrameVector{x[0] + s * (y[0] - x[0]), x[1] + s * (y[1] - x[1]),
                           x[2] + s * (y[2] - x[2])};
    };
    const FrameVector ab = minus(b, a), ac = minus(c, a);
    const FrameVector ap = minus(p, a), bp = minus(p, b), cp = minus(p, c);
    const double d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return a;
    const double d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return b;
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 > d3) return between(a, b, d1 / (d1 - d3));
    const double d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return c;
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0 && d2 > d6) return between(a, c, d2 / (d2 - d6));
    const double va = d3 * d6 - d5 * d4;
    const double up = d4 - d3, down = d5 - d6;
    if (va <= 0 && up >= 0 && down >= 0 && up + down > 0) return between(b, c, up / (up + down));
    const double v = vb / (va + vb + vc), w = vc / (va + vb + vc);
    return {a[0] + v * ab[0] + w * ac[0], a[1] + v * ab[1] + w * ac[1],
            a[2] + v * ab[2] + w * ac[2]};
}

}  // namespace cdprep
