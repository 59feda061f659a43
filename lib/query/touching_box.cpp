// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/moved_point.h"
#include "core/numbers.h"
#include "exact/triangle_box.h"
#include "query/find_touching.h"
#include "query/nearest_to_shape.h"
#include "walk/shape_frame.h"

namespace cdprep {
namespace {

Double3 at_least(const Double3& p, const Double3& limit) noexcept {
    return {std::max(p.x, limit.x), std::max(p.y, limit.y), std::max(p.z, limit.z)};
}
Double3 at_most(const Double3& p, const Double3& limit) noexcept {
    return {std::min(p.x, limit.x), std::min(p.y, limit.y), std::min(p.z, limit.z)};
}

/// Returns the box without its infinite parts, where no vertex can be.
Box3 finite(const Box& box) noexcept {
    constexpr double kFar = 8 * format::kMaxCoordinate;
    return {at_least(box.lower, {-kFar, -kFar, -kFar}), at_most(box.upper, {kFar, kFar, kFar})};
}

/// Returns the part of the box where the model may be: far limits would cost precision in the walk.
Box3 clipped(const Box3& box, const MovedModel& model) noexcept {
    const format::FileHeader& header = model.model->header();
    const Double3& o = header.frame_origin;
    const Pose pose = model.pose == nullptr ? Pose() : *model.pose;
    const Double3 middle = moved_point(pose, o);
    // A ball with radius sqrt 3 times the frame's size contains the model. The margin here is far
    // larger than all rounding.
    const double around =
        2 * std::ldexp(1.0, -header.frame_exponent) +
        0x1p-30 * (ShapeFrame::largest(o) + ShapeFrame::largest(pose.translation()));
    return {at_least(box.lower, {middle.x - around, middle.y - around, middle.z - around}),
            at_most(box.upper, {middle.x + around, middle.y + around, middle.z + around})};
}

/// Returns the part of the box that contains its points nearest to the model. Each limit is as near
/// to the model as possible without passing it or the other limit.
Box3 facing(const Box3& box, const MovedModel& model) noexcept {
    const Box3 all = {{-kInfinity, -kInfinity, -kInfinity}, {kInfinity, kInfinity, kInfinity}};
    const Box3 around = clipped(all, model);
    return {at_least(box.lower, at_most(around.lower, box.upper)),
            at_most(box.upper, at_least(around.upper, box.lower))};
}

/// Two triangles on each side of a box. The bits of a corner: 1 for the upper x, 2 for y, 4 for z.
constexpr std::array<std::array<unsigned, 3>, 12> kBoxFaces = {{{0, 2, 6},
                                                                {0, 6, 4},
                                                                {1, 5, 7},
                                                                {1, 7, 3},
                                                                {0, 4, 5},
                                                                {0, 5, 1},
                                                                {2, 3, 7},
                                                                {2, 7, 6},
                                                                {0, 1, 3},
                                                                {0, 3, 2},
                                                                {4, 6, 7},
                                                                {4, 7, 5}}};

Corners corners_of(const Box3& box, const std::array<unsigned, 3>& face) noexcept {
    Corners corners;
    for (std::size_t i = 0; i < 3; ++i) {
        const unsigned at = face[i];
        corners[i] = {(at & 1U ? box.upper : box.lower).x, (at & 2U ? box.upper : box.lower).y,
                      (at & 4U ? box.upper : box.lower).z};
    }
    return corners;
}

/// Returns the answer for a triangle, tree order, that touches the box. The witness is a corner
/// inside the box or, if there is none, a common point of the triangle and a side.
ShapeDistance touching_box_at(const MovedModel& model, const Box3& box,
                              std::uint32_t triangle) noexcept {
    const Corners corners = model.corners(triangle);
    for (const Double3& corner : corners) {
        if (holds(box, corner)) {
            return {0, 0, corner, corner, source_number(*model.model, triangle)};
        }
    }
    for (const auto& face : kBoxFaces) {
        const Corners side = corners_of(box, face);
        if (triangles_touch(side, corners)) return touching_at(model, side, triangle);
    }
    assert(false);  // a triangle that enters the box from outside crosses a side
    return {};
}

/// A box compared with the boxes of a model. All numbers for the walk are in frame units.
class BoxShape {
public:
    BoxShape(const MovedModel& model, const Box& box) noexcept
        : box_(finite(box)), is_turned_(model.pose != nullptr) {
        const Box3 part = clipped(box_, model);
        is_empty_ = !overlap(part, part);
        if (!is_empty_) place(model, part);
    }

    [[nodiscard]] BoxVerdict judge(const format::BvhNode& node) const noexcept {
        if (is_empty_) return {};
        const BoxVerdict along_model = judge_along_model(node);
        if (!is_turned_ || along_model.near == 0) return along_model;
        const BoxVerdict along_box = judge_along_box(node);
        return {along_model.near & along_box.near, along_box.inside};
    }

    [[nodiscard]] bool touches(const Corners& t) const noexcept {
        return triangle_touches_box(t, box_);
    }

private:
    void place(const MovedModel& model, const Box3& part) noexcept;
    [[nodiscard]] BoxVerdict judge_along_model(const format::BvhNode& node) const noexcept;
    [[nodiscard]] BoxVerdict judge_along_box(const format::BvhNode& node) const noexcept;

    Box3 box_;
    bool is_turned_;
    bool is_empty_;
    std::array<FrameVector, 3> axis_{};  ///< of the box, along the model's axes
    FrameVector centre_{};
    FrameVector half_{};  ///< along axis_
    double slack_ = 0;
    FrameVector lower_{}, upper_{};              ///< of the box along the model's axes, widened
    FrameVector inner_lower_{}, inner_upper_{};  ///< narrowed; used only without a pose
};

void BoxShape::place(const MovedModel& model, const Box3& part) noexcept {
    const ShapeFrame frame(
        model, std::max(ShapeFrame::largest(part.lower), ShapeFrame::largest(part.upper)));
    slack_ = frame.slack();
    const auto middle = [](double a, double b) { return 0.5 * a + 0.5 * b; };
    centre_ = frame.at({middle(part.lower.x, part.upper.x), middle(part.lower.y, part.upper.y),
                        middle(part.lower.z, part.upper.z)});
    half_ = {frame.scaled(middle(part.upper.x, -part.lower.x)),
             frame.scaled(middle(part.upper.y, -part.lower.y)),
             frame.scaled(middle(part.upper.z, -part.lower.z))};
    const std::array<double, 9> r = is_turned_ ? model.pose->rotation() : Pose().rotation();
    for (std::size_t k = 0; k < 3; ++k) axis_[k] = {r[3 * k], r[3 * k + 1], r[3 * k + 2]};
    for (std::size_t i = 0; i < 3; ++i) {
        const double reach = std::fabs(axis_[0][i]) * half_[0] + std::fabs(axis_[1][i]) * half_[1] +
                             std::fabs(axis_[2][i]) * half_[2];
        lower_[i] = centre_[i] - reach - slack_;
        upper_[i] = centre_[i] + reach + slack_;
        inner_lower_[i] = centre_[i] - reach + slack_;
        inner_upper_[i] = centre_[i] + reach - slack_;
    }
}

BoxVerdict BoxShape::judge_along_model(const format::BvhNode& node) const noexcept {
    BoxVerdict verdict;
    for (std::uint32_t j = 0; j < format::kBvhWidth; ++j) {
        bool apart = false;
        bool inside = !is_turned_;
        for (std::size_t i = 0; i < 3; ++i) {
            const double lower = node.lower[i][j];
            const double upper = node.upper[i][j];
            apart |= lower > upper_[i] || upper < lower_[i];
            inside &= lower >= inner_lower_[i] && upper <= inner_upper_[i];
        }
        verdict.near |= static_cast<unsigned>(!apart) << j;
        verdict.inside |= static_cast<unsigned>(inside) << j;
    }
    return verdict;
}

BoxVerdict BoxShape::judge_along_box(const format::BvhNode& node) const noexcept {
    BoxVerdict verdict;
    for (std::uint32_t j = 0; j < format::kBvhWidth; ++j) {
        FrameVector from{}, half{};
        for (std::size_t i = 0; i < 3; ++i) {
            const double lower = node.lower[i][j];
            const double upper = node.upper[i][j];
            from[i] = 0.5 * (lower + upper) - centre_[i];
            half[i] = 0.5 * (upper - lower);
        }
        bool apart = false;
        bool inside = true;
        for (std::size_t k = 0; k < 3; ++k) {
            const FrameVector& a = axis_[k];
            const double at = std::fabs(a[0] * from[0] + a[1] * from[1] + a[2] * from[2]);
            const double reach =
                std::fabs(a[0]) * half[0] + std::fabs(a[1]) * half[1] + std::fabs(a[2]) * half[2];
            apart |= at - reach > half_[k] + 2 * slack_;
            inside &= at + reach <= half_[k] - 2 * slack_;
        }
        verdict.near |= static_cast<unsigned>(!apart) << j;
        verdict.inside |= static_cast<unsigned>(inside) << j;
    }
    return verdict;
}

}  // namespace

template <>
struct AmongBoxesOf<Box> {
    using Type = BoxShape;
};

template struct TouchingShape<Box>;

std::optional<ShapeDistance> measure(const Model& model, const Box& box, Workspace& workspace,
                                     const ShapeOptions& options) noexcept {
    const format::FloatEnvironment environment;
    require(model, Ask::touch);
    const Box3 whole = finite(box);
    if (!overlap(whole, whole) || !(options.max_distance >= 0)) return std::nullopt;
    const MovedModel moved = placed(model, options.world_from_model);
    const Box3 part = facing(whole, moved);
    std::optional<ShapeDistance> best;
    for_each_touching(model, box, workspace, {.world_from_model = options.world_from_model},
                      [&](std::uint32_t i) {
                          best = touching_box_at(moved, part, i);
                          return false;
                      });
    if (best) return best;
    double lower = kInfinity;
    for (const auto& face : kBoxFaces) {
        const double limit = best ? best->upper : options.max_distance;
        const auto found =
            nearest_to_shape(moved, corners_of(part, face), limit, workspace.storage());
        if (!found) continue;
        lower = std::min(lower, found->lower);
        const bool precedes = !best || found->upper < best->upper ||
                              (found->upper == best->upper && found->triangle < best->triangle);
        if (precedes) best = found;
    }
    if (best) best->lower = lower;
    return best;
}

}  // namespace cdprep
