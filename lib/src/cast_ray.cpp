// SPDX-License-Identifier: MIT
#include "cdprep/cast_ray.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "contact_pairs.h"
#include "ray_triangle.h"
#include "walk_ordered.h"

namespace cdprep {
namespace {

double largest(const Double3& p) noexcept {
    return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
}

/// The power of two that makes the direction about as long as the coordinates
/// are large, so that adding it to the origin keeps its digits.
int stretch_for(const Model& model, const Ray& ray) noexcept {
    const format::FileHeader& header = model.header();
    const double reach = std::max({largest(ray.origin), largest(header.frame_origin),
                                   std::ldexp(1.0, -header.frame_exponent)});
    return std::ilogb(reach) - std::ilogb(largest(ray.direction)) + 1;
}

/// Where a half-line enters boxes: a lower bound of its parameter, or infinity.
/// Everything is taken into the frame; the boxes are widened by 2^-45 of the
/// largest coordinate that takes part, which covers every rounding.
class BoxEntry {
public:
    BoxEntry(const format::FileHeader& header, const HalfLine& ray) noexcept {
        const std::array<double, 3> o = {ray.origin.x, ray.origin.y, ray.origin.z};
        const std::array<double, 3> p = {ray.through.x, ray.through.y, ray.through.z};
        const std::array<double, 3> f = {header.frame_origin.x, header.frame_origin.y,
                                         header.frame_origin.z};
        double reach = 1;
        for (std::size_t i = 0; i < 3; ++i) {
            origin_[i] = std::ldexp(o[i] - f[i], header.frame_exponent);
            step_[i] = std::ldexp(p[i] - o[i], header.frame_exponent);
            reach = std::max(
                {reach, std::fabs(origin_[i]), std::ldexp(std::fabs(f[i]), header.frame_exponent)});
        }
        slack_ = 0x1p-45 * reach;
    }

    double operator()(const format::BvhNode& node, std::uint32_t box) const noexcept {
        double enter = 0;
        double leave = std::numeric_limits<double>::infinity();
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double lower = node.lower[axis][box] - slack_;
            const double upper = node.upper[axis][box] + slack_;
            if (step_[axis] == 0) {
                if (origin_[axis] < lower || origin_[axis] > upper) leave = -1;
                continue;
            }
            const double a = (lower - origin_[axis]) / step_[axis];
            const double b = (upper - origin_[axis]) / step_[axis];
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        constexpr double kWider = 1 + 0x1p-40;
        if (enter > leave * kWider) return std::numeric_limits<double>::infinity();
        return enter / kWider;
    }

private:
    std::array<double, 3> origin_{};
    std::array<double, 3> step_{};
    double slack_ = 0;
};

}  // namespace

std::optional<RayHit> cast_ray(const Model& model, const Ray& ray, Workspace& workspace,
                               const RayOptions& options) noexcept {
    if (model.triangle_count() == 0 || largest(ray.direction) == 0) return std::nullopt;
    const int stretch = stretch_for(model, ray);
    const Double3 d = {std::ldexp(ray.direction.x, stretch), std::ldexp(ray.direction.y, stretch),
                       std::ldexp(ray.direction.z, stretch)};
    const HalfLine line = {ray.origin,
                           {ray.origin.x + d.x, ray.origin.y + d.y, ray.origin.z + d.z}};
    const double limit = std::ldexp(options.max_t, -stretch);
    const MovedModel still(model, nullptr);
    std::optional<RayHit> best;
    double best_t = limit;
    const auto look_at_leaf = [&](std::uint32_t leaf) {
        const std::uint32_t first = leaf * format::kBvhWidth;
        const std::uint32_t last = std::min(first + format::kBvhWidth, model.triangle_count());
        for (std::uint32_t i = first; i < last; ++i) {
            const std::optional<double> t = ray_triangle(line, still.corners(i));
            if (!t || *t > best_t) continue;
            const std::uint32_t source = source_number(model, i);
            if (best && *t == best_t && source > best->triangle) continue;
            best = RayHit{std::ldexp(*t, stretch), source, {}};
            best_t = *t;
        }
        return best_t;
    };
    walk_ordered(model, workspace.storage(), limit, BoxEntry(model.header(), line), look_at_leaf);
    if (best) {
        best->point = {ray.origin.x + best_t * d.x, ray.origin.y + best_t * d.y,
                       ray.origin.z + best_t * d.z};
    }
    return best;
}

}  // namespace cdprep
