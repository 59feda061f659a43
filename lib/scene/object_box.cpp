// SPDX-License-Identifier: MIT
#include "scene/object_box.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cdprep/advanced/model_views.h"
#include "cdprep/format/float_environment.h"
#include "core/numbers.h"
#include "core/require.h"

namespace cdprep {
namespace {

constexpr float kLargest = std::numeric_limits<float>::max();

/// The next float that is not above, or one below that. NaN gives -infinity: a box of which nothing
/// is known contains everything. Sums that overflow lead to NaN, and files opened unchecked.
float rounded_down(double x) noexcept {
    if (!(x >= -double{kLargest})) return -std::numeric_limits<float>::infinity();
    if (x > double{kLargest}) return kLargest;
    return std::nextafter(static_cast<float>(x), -std::numeric_limits<float>::infinity());
}
float rounded_up(double x) noexcept {
    return -rounded_down(-x);
}

}  // namespace

// Let u = 2^-53. The corners of the root box, its middle c and half h are off by less than 8 u m.
// Here m = |o| + |c| + h, and o is the origin of the frame. R c + t adds 4 u (|R| m + |t|), and
// the vertices that transform_point() computes as much. Each R deviates from a rotation by 1e-12
// at most. So the products of two of them, and of three for the directions of edges, deviate by
// 6e-12. 2^-37 covers all these, and the sums below, as that with the origin of a scene. Where
// numbers underflow, kLeast covers the rest.
constexpr double kSlack = 0x1p-37;
constexpr double kLeast = std::numeric_limits<double>::min();

namespace {

struct Extent {
    double middle;
    double half;
};

/// The extent of the root node along an axis, in the model's coordinates.
Extent root_extent(const Model& model, std::size_t axis) noexcept {
    const auto& root = model.bvh().nodes[0];
    const format::FileHeader& header = model.header();
    const std::array<double, 3> origin = {header.frame_origin.x, header.frame_origin.y,
                                          header.frame_origin.z};
    float lower = kLargest, upper = -kLargest;
    for (std::size_t box = 0; box < format::kBvhWidth; ++box) {
        if (root.lower[axis][box] > root.upper[axis][box]) continue;
        lower = std::min(lower, root.lower[axis][box]);
        upper = std::max(upper, root.upper[axis][box]);
    }
    const auto in_model = [&](double x) { return std::ldexp(x, -header.frame_exponent); };
    return {origin[axis] + in_model((double{lower} + upper) / 2),
            in_model((double{upper} - lower) / 2)};
}

}  // namespace

RootBox placed_box(const Model& model, const Pose& world_from_model, double reach) noexcept {
    RootBox root{};
    root.half = {-1, -1, -1};
    if (model.bvh().nodes.empty()) return root;
    const format::Double3& origin = model.header().frame_origin;
    const Double3& t = world_from_model.translation();
    root.axes = world_from_model.rotation();
    root.middle = {t.x, t.y, t.z};
    root.size = std::abs(t.x) + std::abs(t.y) + std::abs(t.z) + reach;
    root.size += std::abs(origin.x) + std::abs(origin.y) + std::abs(origin.z);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Extent extent = root_extent(model, axis);
        root.half[axis] = extent.half + reach;
        root.size += std::abs(extent.middle) + root.half[axis];
        for (std::size_t k = 0; k < 3; ++k) {
            root.middle[k] += root.axes[3 * k + axis] * extent.middle;
        }
    }
    for (double& half : root.half) half += kSlack * root.size + kLeast;
    return root;
}

Double3 middle_of(const Model& model) noexcept {
    if (model.bvh().nodes.empty()) return {};
    return {root_extent(model, 0).middle, root_extent(model, 1).middle,
            root_extent(model, 2).middle};
}

// The model stays in a ball about its middle. Its middle is computed with an error that the slack
// covers, as above.
RootBox swept_box(const RootBox& start, const RootBox& end) noexcept {
    if (start.half[0] < 0 || end.half[0] < 0) return end;
    const auto radius = [](const RootBox& box) {
        return std::hypot(box.half[0], box.half[1], box.half[2]);
    };
    const double most = std::max(radius(start), radius(end));
    RootBox swept{};
    swept.axes = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    swept.size = start.size + end.size + most;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double from = start.middle[axis], to = end.middle[axis];
        swept.middle[axis] = from / 2 + to / 2;
        swept.half[axis] = std::abs(to - from) / 2 + most;
    }
    for (double& half : swept.half) half += kSlack * swept.size + kLeast;
    return swept;
}

WorldBox box_around(const RootBox& root, const Double3& origin) noexcept {
    if (root.half[0] < 0) return {{1, 1, 1}, {-1, -1, -1}};
    const std::array<double, 3> from = {origin.x, origin.y, origin.z};
    WorldBox box{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        double wide = kSlack * (root.size + std::abs(from[axis]));
        for (std::size_t k = 0; k < 3; ++k)
            wide += std::abs(root.axes[3 * axis + k]) * root.half[k];
        const double middle = root.middle[axis] - from[axis];
        box.lower[axis] = rounded_down(middle - wide);
        box.upper[axis] = rounded_up(middle + wide);
    }
    return box;
}

bool boxes_may_meet(const RootBox& a, const RootBox& b) noexcept {
    const double slack = kSlack * (a.size + b.size) + kLeast;
    std::array<double, 9> turn{}, size{};  // [axis of A][axis of B]
    std::array<double, 3> way{};           // from A to B along A's axes
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            way[i] += a.axes[3 * k + i] * (b.middle[k] - a.middle[k]);
            for (std::size_t j = 0; j < 3; ++j) {
                turn[3 * i + j] += a.axes[3 * k + i] * b.axes[3 * k + j];
            }
        }
    }
    for (std::size_t i = 0; i < 9; ++i) size[i] = std::abs(turn[i]);
    for (std::size_t i = 0; i < 3; ++i) {
        double reach = a.half[i], along = 0, reach_of_b = b.half[i];
        for (std::size_t j = 0; j < 3; ++j) {
            reach += size[3 * i + j] * b.half[j];
            along += turn[3 * j + i] * way[j];
            reach_of_b += size[3 * j + i] * a.half[j];
        }
        if (std::abs(way[i]) > reach + slack || std::abs(along) > reach_of_b + slack) return false;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3;
        for (std::size_t j = 0; j < 3; ++j) {
            const std::size_t j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            const double along = way[i2] * turn[3 * i1 + j] - way[i1] * turn[3 * i2 + j];
            const double reach = a.half[i1] * size[3 * i2 + j] + a.half[i2] * size[3 * i1 + j] +
                                 b.half[j1] * size[3 * i + j2] + b.half[j2] * size[3 * i + j1];
            if (std::abs(along) > reach + slack) return false;
        }
    }
    return true;
}

RootBox root_box(const Model& model, const Pose& world_from_model, double reach) noexcept {
    if (!(reach >= 0 && reach <= std::numeric_limits<double>::max())) {
        stop_with("The reach of a box must be finite and at least 0.");
    }
    if (model.triangle_count() > 0 && model.bvh().nodes.empty()) {
        stop_with("The box of a model needs its BVH, but the sections of the BVH were not opened.");
    }
    const format::FloatEnvironment environment;
    return placed_box(model, world_from_model, reach);
}

WorldBox world_box(const RootBox& root, const Double3& origin) noexcept {
    const format::FloatEnvironment environment;
    return box_around(root, origin);
}

bool may_meet(const RootBox& a, const RootBox& b) noexcept {
    const format::FloatEnvironment environment;
    return boxes_may_meet(a, b);
}

}  // namespace cdprep
