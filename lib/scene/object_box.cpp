// SPDX-License-Identifier: MIT
#include "scene/object_box.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cdprep/advanced/model_views.h"
#include "core/numbers.h"

namespace cdprep {
namespace {

constexpr float kLargest = std::numeric_limits<float>::max();

/// The next float that is not above, or one below that.
float rounded_down(double x) noexcept {
    if (x < -double{kLargest}) return -std::numeric_limits<float>::infinity();
    if (x > double{kLargest}) return kLargest;
    return std::nextafter(static_cast<float>(x), -std::numeric_limits<float>::infinity());
}
float rounded_up(double x) noexcept {
    return -rounded_down(-x);
}

}  // namespace

// Let u = 2^-53. The corners of the root box, its middle c and half h are off by less than 8 u of
// m = |o| + |c| + h, where o is the origin of the frame. R c + t adds 4 u (|R| m + |t|), and the
// vertices that transform_point() computes as much. 32 u covers these, and the sums below.
WorldBox object_box(const Model& model, const Pose& world_from_model, double reach) noexcept {
    const auto& nodes = model.bvh().nodes;
    if (nodes.empty()) return {{1, 1, 1}, {-1, -1, -1}};
    const format::FileHeader& header = model.header();
    const std::array<double, 3> origin = {header.frame_origin.x, header.frame_origin.y,
                                          header.frame_origin.z};
    std::array<double, 3> middle{}, half{}, most{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        float lower = kLargest, upper = -kLargest;
        for (std::size_t box = 0; box < format::kBvhWidth; ++box) {
            const format::BvhNode& root = nodes[0];
            if (root.lower[axis][box] > root.upper[axis][box]) continue;
            lower = std::min(lower, root.lower[axis][box]);
            upper = std::max(upper, root.upper[axis][box]);
        }
        const auto in_model = [&](double x) { return std::ldexp(x, -header.frame_exponent); };
        middle[axis] = origin[axis] + in_model((double{lower} + upper) / 2);
        half[axis] = in_model((double{upper} - lower) / 2);
        most[axis] = std::abs(origin[axis]) + std::abs(middle[axis]) + half[axis];
    }
    const auto& r = world_from_model.rotation();
    const Double3& t = world_from_model.translation();
    const std::array<double, 3> shift = {t.x, t.y, t.z};
    WorldBox box{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        double at = shift[axis], wide = 0, size = std::abs(shift[axis]) + reach;
        for (std::size_t k = 0; k < 3; ++k) {
            at += r[3 * axis + k] * middle[k];
            wide += std::abs(r[3 * axis + k]) * half[k];
            size += std::abs(r[3 * axis + k]) * most[k];
        }
        wide += reach + 32 * kUnit * size;
        box.lower[axis] = rounded_down(at - wide);
        box.upper[axis] = rounded_up(at + wide);
    }
    return box;
}

}  // namespace cdprep
