// SPDX-License-Identifier: MIT
#include "walk/proven_gap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/uncorrected_relative_pose.h"
#include "exact/length_of.h"
#include "walk/box_placement.h"

// A gap that was proved in one pose holds in another, minus the way between the two. That is the
// longest way of any point of the moving model, relative to the other model. It is at most the way
// of a corner of a box around the model. The difference of a point's two places is affine in the
// point, and length is convex. In either pose, vertices are off their ideal places by
// double_slack() at most. This is subtracted when the gap is stored and when it is used, and once
// more for the roundings here. A pose that rotates A may shorten lengths by its tolerance.

namespace cdprep {
namespace {

constexpr double kTurnedLength = 1 - 4 * Pose::kRotationTolerance;
/// In model units. Below this, slacks and products might round to 0.
constexpr double kLeastGap = 0x1p-960;

Pose pose_between(const Placement& placement) noexcept {
    return placement.a_is_moved()
               ? uncorrected_relative_pose(placement.pose_a(), placement.pose_b())
               : placement.pose_b();
}

/// Returns an upper bound of the longest way of a point of the box from one pose to the other.
/// Bounds each component separately.
double longest_way(const PairCache& cache, const Pose& now) noexcept {
    const std::array<double, 9>& r0 = cache.a_from_b.rotation();
    const std::array<double, 9>& r1 = now.rotation();
    const Double3& t0 = cache.a_from_b.translation();
    const Double3& t1 = now.translation();
    const Double3& c = cache.middle;
    const Double3& h = cache.half;
    const std::array<double, 3> shift = {t1.x - t0.x, t1.y - t0.y, t1.z - t0.z};
    std::array<double, 3> most{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double x = r1[3 * i] - r0[3 * i];
        const double y = r1[3 * i + 1] - r0[3 * i + 1];
        const double z = r1[3 * i + 2] - r0[3 * i + 2];
        most[i] = std::fabs(x * c.x + y * c.y + z * c.z + shift[i]) + std::fabs(x) * h.x +
                  std::fabs(y) * h.y + std::fabs(z) * h.z;
    }
    return length_of(most[0], most[1], most[2]);
}

/// Stores the box around the whole model: the box around its root's boxes.
void note_box(const Model& model, PairCache& cache) noexcept {
    const format::FileHeader& head = model.header();
    const format::BvhNode& root = model.bvh().nodes[0];
    const std::uint32_t boxes = model.bvh().shape.used_boxes(model.bvh().shape.levels - 1, 0);
    std::array<double, 3> middle{};
    std::array<double, 3> half{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        float lower = root.lower[axis][0];
        float upper = root.upper[axis][0];
        for (std::uint32_t box = 1; box < boxes; ++box) {
            lower = std::min(lower, root.lower[axis][box]);
            upper = std::max(upper, root.upper[axis][box]);
        }
        const double from = lower;
        const double to = upper;
        middle[axis] = std::ldexp((from + to) / 2, -head.frame_exponent);
        half[axis] = std::ldexp((to - from) / 2, -head.frame_exponent);
    }
    const Double3& o = head.frame_origin;
    cache.middle = {o.x + middle[0], o.y + middle[1], o.z + middle[2]};
    cache.half = {half[0], half[1], half[2]};
}

bool is_of(const PairCache& cache, const Model& a, const Model& b) noexcept {
    return (cache.holds & held_place) != 0 && cache.models[0] == a.header().content_hash &&
           cache.models[1] == b.header().content_hash;
}

}  // namespace

double proven_gap(PairCache& cache, const Model& a, const Model& b,
                  const Placement& placement) noexcept {
    if (!is_of(cache, a, b)) return 0;
    ++cache.questions;
    if (!(cache.gap > 0) && cache.wait > 0) return 0;  // the step is not used either
    const double way = longest_way(cache, pose_between(placement));
    cache.step = way / cache.questions;
    return cache.gap > 0 ? cache.gap - way - 2 * double_slack(a, b, placement) : 0;
}

double gap_left(const PairCache& cache, const Model& a, const Model& b,
                const Placement& placement) noexcept {
    if (!is_of(cache, a, b)) return -std::numeric_limits<double>::infinity();
    return cache.gap - longest_way(cache, pose_between(placement)) -
           2 * double_slack(a, b, placement);
}

void remember_gap(PairCache& cache, const Model& a, const Model& b, const Placement& placement,
                  double gap) noexcept {
    if (!is_of(cache, a, b)) {
        note_box(b, cache);
        cache.models = {a.header().content_hash, b.header().content_hash};
        cache.holds |= held_place;
    }
    cache.a_from_b = pose_between(placement);
    cache.questions = 0;
    cache.gap = gap * kTurnedLength - double_slack(a, b, placement);
    if (!(cache.gap > kLeastGap)) cache.gap = 0;
}

}  // namespace cdprep
