// SPDX-License-Identifier: MIT
#include "cdprep/points.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "cdprep/format/float_environment.h"
#include "core/moved_model.h"
#include "core/numbers.h"
#include "core/require.h"
#include "core/smallest.h"
#include "core/triangle_facts.h"
#include "exact/ray_triangle.h"
#include "walk/walk_model.h"
#include "walk/walk_ordered.h"

namespace cdprep {
namespace {

double largest(const Double3& p) noexcept {
    return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
}

/// Returns the power of two that makes the direction about as long as the coordinates are large.
/// The volumes that it spans with them then have the size that the filters expect.
int stretch_for(const Model& model, const Ray& ray) noexcept {
    const format::FileHeader& header = model.header();
    const double reach = std::max({largest(ray.origin), largest(header.frame_origin),
                                   std::ldexp(1.0, -header.frame_exponent)});
    return std::ilogb(std::min(reach, format::kMaxCoordinate)) -
           std::ilogb(largest(ray.direction)) + 1;
}

HalfLine half_line(const Ray& ray, int stretch) noexcept {
    const auto scaled = [](const Double3& d, int exponent) {
        return Double3{std::ldexp(d.x, exponent), std::ldexp(d.y, exponent),
                       std::ldexp(d.z, exponent)};
    };
    const Double3 step = scaled(ray.direction, stretch);
    const bool is_exact = scaled(step, -stretch) == ray.direction;
    if (is_exact) return {ray.origin, step, step, 0};
    return {ray.origin, ray.direction, step, stretch};
}

/// Returns a lower bound of the parameter where a half-line enters a box, or infinity. All numbers
/// are in the frame. The boxes are widened by 2^-45 of the largest coordinate involved, which
/// covers every rounding. A component of the step that moves less than that across the whole model
/// counts as 0. The bound is 2^-40 of itself lower, as the place of a hit may be. It is 0 if a
/// number is too large for the frame.
class BoxEntry {
public:
    BoxEntry(const format::FileHeader& header, const HalfLine& ray) noexcept {
        const std::array<double, 3> o = {ray.origin.x, ray.origin.y, ray.origin.z};
        const std::array<double, 3> d = {ray.step.x, ray.step.y, ray.step.z};
        const std::array<double, 3> f = {header.frame_origin.x, header.frame_origin.y,
                                         header.frame_origin.z};
        constexpr double kNoStep = 0x1p-200;
        double reach = 1;
        bool in_range = true;
        for (std::size_t i = 0; i < 3; ++i) {
            origin_[i] = std::ldexp(o[i] - f[i], header.frame_exponent);
            const double step = std::ldexp(d[i], header.frame_exponent);
            per_step_[i] = std::fabs(step) > kNoStep ? 1 / step : 0;
            in_range &= std::isfinite(step);
            reach = std::max(
                {reach, std::fabs(origin_[i]), std::ldexp(std::fabs(f[i]), header.frame_exponent)});
        }
        slack_ = 0x1p-45 * reach;
        if (in_range && std::isfinite(slack_)) return;
        origin_ = per_step_ = {};
        slack_ = std::numeric_limits<double>::max();
    }

    double operator()(const format::BvhNode& node, std::uint32_t box) const noexcept {
        double enter = 0;
        double leave = kInfinity;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double lower = node.lower[axis][box] - slack_ - origin_[axis];
            const double upper = node.upper[axis][box] + slack_ - origin_[axis];
            if (per_step_[axis] == 0) {
                if (lower > 0 || upper < 0) leave = -1;
                continue;
            }
            const double a = lower * per_step_[axis];
            const double b = upper * per_step_[axis];
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        constexpr double kWider = 1 + 0x1p-40;
        if (enter > leave * kWider) return kInfinity;
        return enter / kWider;
    }

private:
    std::array<double, 3> origin_{};
    std::array<double, 3> per_step_{};  ///< 1 / step; 0 for a zero component
    double slack_ = 0;
};

/// A ray against a model's triangles.
class RayQuery {
public:
    RayQuery(const Model& model, const Ray& ray, const RayOptions& options) noexcept
        : model_(model), still_(model, nullptr) {
        if (model.triangle_count() == 0 || largest(ray.direction) == 0) return;
        if (!(options.max_t >= 0)) return;
        stretch_ = stretch_for(model, ray);
        line_ = half_line(ray, stretch_);
        // Finite, so that missed boxes, which return infinity, are beyond it.
        limit_ = std::min(std::ldexp(options.max_t, -stretch_), std::numeric_limits<double>::max());
    }

    /// In lengths of the step; negative if nothing can be hit.
    [[nodiscard]] double limit() const noexcept {
        return limit_;
    }
    [[nodiscard]] BoxEntry boxes() const noexcept {
        return {model_.header(), line_};
    }
    [[nodiscard]] std::optional<double> meet(std::uint32_t triangle) const noexcept {
        return ray_triangle(line_, still_.corners(triangle));
    }
    [[nodiscard]] RayHit hit(double t, std::uint32_t source) const noexcept {
        assert(t >= 0);
        const Double3& o = line_.origin;
        const Double3& d = line_.step;
        return {std::ldexp(t, stretch_), {o.x + t * d.x, o.y + t * d.y, o.z + t * d.z}, source};
    }

private:
    const Model& model_;
    MovedModel still_;
    HalfLine line_{};
    double limit_ = -1;
    int stretch_ = 0;
};

/// Calls found(t, triangle) for every triangle hit, t in lengths of the step and triangle in tree
/// order. Stops and returns false when `found` returns false.
template <class Found>
bool for_each_hit(const Model& model, const RayQuery& query, Workspace& workspace,
                  Found&& found) noexcept {
    if (query.limit() < 0) return true;
    const BoxEntry entry = query.boxes();
    const auto judge = [&](const format::BvhNode& node) {
        BoxVerdict verdict;
        for (std::uint32_t box = 0; box < format::kBvhWidth; ++box) {
            verdict.near |= static_cast<unsigned>(entry(node, box) <= query.limit()) << box;
        }
        return verdict;
    };
    const auto look_at = [&](const TriangleRun& run) {
        assert(run.first <= run.last && run.last <= model.triangle_count());
        return each_triangle(model, run.first, run.last, [&](std::uint32_t i) {
            const std::optional<double> t = query.meet(i);
            return !t || *t > query.limit() || found(*t, i);
        });
    };
    return walk_nodes(model, workspace.storage(), judge, look_at, look_at);
}

}  // namespace

bool operator<(const RayHit& a, const RayHit& b) noexcept {
    const format::FloatEnvironment environment;
    return a.t != b.t ? a.t < b.t : a.triangle < b.triangle;
}

std::optional<RayHit> cast_ray(const Model& model, const Ray& ray, Workspace& workspace,
                               const RayOptions& options) noexcept {
    const format::FloatEnvironment environment;
    require(model, Ask::ray);
    const RayQuery query(model, ray, options);
    if (query.limit() < 0) return std::nullopt;
    double best_t = query.limit();
    std::optional<std::uint32_t> best;
    const auto look_at_leaf = [&](std::uint32_t leaf) {
        each_in_leaf(model, leaf, [&](std::uint32_t i) {
            const std::optional<double> t = query.meet(i);
            if (!t || *t > best_t) return true;
            const std::uint32_t source = source_number(model, i);
            if (best && *t == best_t && source > *best) return true;
            best = source;
            best_t = *t;
            return true;
        });
        return best_t;
    };
    walk_ordered(model, workspace.storage(), best_t, query.boxes(), look_at_leaf);
    if (!best) return std::nullopt;
    return query.hit(best_t, *best);
}

bool ray_hits(const Model& model, const Ray& ray, Workspace& workspace,
              const RayOptions& options) noexcept {
    const format::FloatEnvironment environment;
    require(model, Ask::ray);
    const RayQuery query(model, ray, options);
    return !for_each_hit(model, query, workspace, [](double, std::uint32_t) { return false; });
}

std::size_t all_ray_hits(const Model& model, const Ray& ray, Workspace& workspace,
                         std::span<RayHit> hits, const RayOptions& options) noexcept {
    const format::FloatEnvironment environment;
    require(model, Ask::ray);
    const RayQuery query(model, ray, options);
    Smallest<RayHit> smallest(hits);
    for_each_hit(model, query, workspace, [&](double t, std::uint32_t i) {
        smallest.add(query.hit(t, source_number(model, i)));
        return true;
    });
    const std::span<RayHit> kept = smallest.kept();
    std::sort(kept.begin(), kept.end());
    return smallest.count();
}

bool visit_ray_hits(const Model& model, const Ray& ray, Workspace& workspace, RayVisitor visit,
                    const RayOptions& options) noexcept {
    format::FloatEnvironment environment;
    require(model, Ask::ray);
    const RayQuery query(model, ray, options);
    return for_each_hit(model, query, workspace, [&](double t, std::uint32_t i) {
        const RayHit hit = query.hit(t, source_number(model, i));
        return environment.outside([&] { return visit(hit); });
    });
}

}  // namespace cdprep
