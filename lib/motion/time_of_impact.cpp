// SPDX-License-Identifier: MIT
#include "cdprep/time_of_impact.h"

#include <algorithm>
#include <limits>

#include "cdprep/format/float_environment.h"
#include "core/numbers.h"
#include "core/require.h"
#include "exact/length_of.h"
#include "exact/vectors.h"
#include "motion/moving_body.h"
#include "query/nearest_search.h"

// Let d be the distance at time t. Let no point move faster than m, relative to the other model.
// Then nothing touches before t + d / m. That is the plain step.
//
// A close step is longer. It looks at all pairs of triangles that are nearer than a reach. The
// others stay apart for reach / m. A pair with a gap s along a unit vector n closes along n. Its
// corners close at a speed of s1 at time t. Turning changes this speed by c2 at most in a unit of
// time. So the pair stays apart while s > s1 h + c2 h^2 / 2.
//
// Vertices of a query are off the ideal path by MovingBody::deviation(). So a margin of twice the
// deviations of both bodies is taken off each gap. All roundings here are much smaller.

namespace cdprep {
namespace {

/// A time that a proof gives is shortened by this, for the roundings of its computation.
constexpr double kShortened = 1 - 0x1p-30;
/// The distance of a plain step may be this much too small.
constexpr double kRelativeError = 0.0625;
/// A close step is given up beyond so many pairs of triangles.
constexpr std::uint32_t kMostClosePairs = 128;
/// An interval with a time of contact is narrowed by so many steps.
constexpr std::uint32_t kMostNarrowings = 32;

class ImpactSearch {
public:
    ImpactSearch(const MovingPair& pair, Workspace& workspace,
                 const ImpactOptions& options) noexcept
        : pair_(pair),
          workspace_(workspace),
          options_(options),
          body_a_(pair.a, pair.motion_a),
          body_b_(pair.b, pair.motion_b),
          margin_(2 * (body_a_.deviation() + body_b_.deviation())),
          tolerance_(options.tolerance > 8 * margin_ ? options.tolerance : 8 * margin_),
          speed_(std::max(greatest_speed(body_a_, body_b_), std::numeric_limits<double>::min())),
          triangle_size_(std::min(body_a_.triangle_size(), body_b_.triangle_size())) {}

    [[nodiscard]] Impact run() noexcept;

private:
    [[nodiscard]] Placement placement_at(double time) const noexcept {
        return Placement::world(pair_.motion_a.at(time), pair_.motion_b.at(time));
    }
    /// Returns the distance at time_, or nothing if no contact can follow.
    [[nodiscard]] std::optional<Distance> measure(Body body) noexcept;
    [[nodiscard]] bool touch_at(double time) noexcept;
    /// Returns a time after time_ at which nothing has touched yet.
    [[nodiscard]] double advance(const Distance& found) noexcept;
    [[nodiscard]] double close_step(const Distance& found) noexcept;
    [[nodiscard]] double time_apart_of(const TriangleDistance& found, const Corners& a,
                                       const Corners& b) const noexcept;
    /// Looks for a time of contact after a time, soon ones first.
    void look_ahead(double after) noexcept;
    /// Looks for one between time_ and upper_.
    void halve() noexcept;
    [[nodiscard]] Impact ended(ImpactKind kind) noexcept;

    const MovingPair& pair_;
    Workspace& workspace_;
    const ImpactOptions& options_;
    MovingBody body_a_;
    MovingBody body_b_;
    double margin_;     ///< model units
    double tolerance_;  ///< model units
    double speed_;      ///< model units per step: no point is faster
    double triangle_size_;
    PairCache cache_;
    double time_ = 0;  ///< at all times before, the surfaces are apart
    double upper_ = kInfinity;
    double close_reach_ = kInfinity;  ///< a close step of at least this has had too many pairs
    std::uint32_t steps_ = 0;
};

std::optional<Distance> ImpactSearch::measure(Body body) noexcept {
    ++steps_;
    const Pair now = {pair_.a, pair_.b, placement_at(time_), {.body = body}, &cache_};
    const double end = std::min(1.0, upper_);
    return distance(now, workspace_,
                    {.relative_error = kRelativeError,
                     .max_distance = (speed_ * (end - time_) + margin_) / kShortened});
}

bool ImpactSearch::touch_at(double time) noexcept {
    return any_contact(pair_.a, pair_.b, placement_at(time), workspace_, {}, nullptr);
}

double ImpactSearch::time_apart_of(const TriangleDistance& found, const Corners& a,
                                   const Corners& b) const noexcept {
    const double plain = (found.lower - margin_) / speed_;
    const Double3 way = found.on_b - found.on_a;
    const double length = length_of(way);
    if (!(length > 0)) return plain;
    const Double3 n = {way.x / length, way.y / length, way.z / length};
    const Extent in_a = body_a_.extent(a, n, time_);
    const Extent in_b = body_b_.extent(b, n, time_);
    const double gap = in_b.lowest - in_a.highest - margin_;
    return std::max(plain, time_apart(gap, in_a.fastest - in_b.slowest, in_a.bend + in_b.bend));
}

double ImpactSearch::close_step(const Distance& found) noexcept {
    const double reach = std::max(2 * found.upper, triangle_size_ / 2);
    if (reach >= close_reach_) return 0;
    const Placement placement = placement_at(time_);
    const MovedModel in_a = moved_a(pair_.a, placement);
    const MovedModel in_b = moved_b(pair_.b, placement);
    NearestSearch<TriangleTrees> search(pair_.a, pair_.b, placement, workspace_);
    search.point(found.witness_a, found.witness_b);
    double apart = (reach - margin_) / speed_;
    std::uint32_t pairs = 0;
    search.run(reach, Limit::good, [&](const TreePair& at) {
        if (++pairs > kMostClosePairs) return -1.0;
        const TriangleDistance gap = search.measure(at, false);
        apart = std::min(apart, time_apart_of(gap, in_a.corners(at.a), in_b.corners(at.b)));
        // Farther pairs stay apart for this time without a look.
        return std::clamp(apart * speed_ + margin_, 0.0, reach);
    });
    if (pairs <= kMostClosePairs) return apart;
    close_reach_ = reach;
    return 0;
}

double ImpactSearch::advance(const Distance& found) noexcept {
    const double plain = time_ + std::max(0.0, found.lower - margin_) / speed_ * kShortened;
    const bool is_close = found.upper < 4 * triangle_size_;
    if (plain >= std::min(1.0, upper_) || !is_close) return plain;
    return std::max(plain, time_ + close_step(found) * kShortened);
}

void ImpactSearch::look_ahead(double after) noexcept {
    constexpr double kGrowth = 8;
    double step = std::max(tolerance_ / speed_, 0x1p-52);  // not 0, whatever underflows
    double time = after;
    while (time < 1 && upper_ == kInfinity) {
        time = std::min(1.0, after + step);
        if (touch_at(time)) upper_ = time;
        step *= kGrowth;
    }
}

void ImpactSearch::halve() noexcept {
    const double middle = time_ + (upper_ - time_) / 2;
    if (touch_at(middle)) upper_ = middle;
}

Impact ImpactSearch::ended(ImpactKind kind) noexcept {
    if (kind == ImpactKind::none) return {kind, 1, kInfinity, steps_, std::nullopt};
    Impact impact = {kind, time_, upper_, steps_, std::nullopt};
    if (upper_ > 0) {
        impact.nearest = distance({pair_.a, pair_.b, placement_at(time_), {}, &cache_}, workspace_);
    }
    return impact;
}

Impact ImpactSearch::run() noexcept {
    std::uint32_t narrowings = 0;
    for (Body body = pair_.body; steps_ < options_.most_steps; body = Body::surface) {
        const std::optional<Distance> found = measure(body);
        if (!found) return ended(upper_ == kInfinity ? ImpactKind::none : ImpactKind::touching);
        if (found->upper == 0) {
            upper_ = time_;
            return ended(ImpactKind::touching);
        }
        const double next = advance(*found);
        if (next >= std::min(1.0, upper_)) {
            return ended(upper_ == kInfinity ? ImpactKind::none : ImpactKind::touching);
        }
        const bool is_stuck = (next - time_) * speed_ <= margin_;
        const bool is_near = is_stuck || found->upper <= tolerance_;
        if (is_near && upper_ == kInfinity) look_ahead(next);
        if (is_near && upper_ == kInfinity) return ended(ImpactKind::near);
        time_ = next;
        if (upper_ == kInfinity) continue;
        halve();
        if ((upper_ - time_) * speed_ <= tolerance_ || ++narrowings == kMostNarrowings) {
            return ended(ImpactKind::touching);
        }
    }
    return ended(ImpactKind::unfinished);
}

}  // namespace

Impact time_of_impact(const MovingPair& pair, Workspace& workspace,
                      const ImpactOptions& options) noexcept {
    const format::FloatEnvironment environment;
    const Model &a = pair.a, &b = pair.b;
    require(a, b, Ask::distance | (pair.body == Body::solid ? Ask::solid : Ask::nothing));
    if (a.triangle_count() == 0 || b.triangle_count() == 0) return {};
    return ImpactSearch(pair, workspace, options).run();
}

}  // namespace cdprep
