// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include "cdprep/format/float_environment.h"
#include "core/numbers.h"
#include "core/require.h"
#include "exact/exact_within.h"
#include "query/find_touching.h"
#include "query/nearest_to_shape.h"
#include "walk/shape_frame.h"

namespace cdprep {
namespace {

/// A capsule compared with the boxes of a model, in frame units. A box may touch it only if the
/// capsule's segment meets the box enlarged by the radius, and comes near enough to the box's
/// middle.
class CapsuleShape {
public:
    CapsuleShape(const MovedModel& model, const Capsule& capsule) noexcept
        : ends_{capsule.from, capsule.to}, radius_(capsule.radius) {
        const ShapeFrame frame(
            model, std::max(ShapeFrame::largest(capsule.from), ShapeFrame::largest(capsule.to)));
        const FrameVector to = frame.at(capsule.to);
        from_ = frame.at(capsule.from);
        const double radius = frame.scaled(capsule.radius);
        outer_ = (radius + frame.slack()) * (1 + kRounding);
        inner_ = (radius - frame.slack()) * (1 - kRounding);
        double squared = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            along_[i] = to[i] - from_[i];
            squared += along_[i] * along_[i];
            per_along_[i] = std::fabs(along_[i]) > kNoStep ? 1 / along_[i] : 0;
            // With NaN the places where the axis enters and leaves a box are NaN too, which proves
            // nothing. So is the distance of the box, below.
            if (!std::isfinite(along_[i])) per_along_[i] = kNaN;
        }
        per_square_ = squared > 0 ? 1 / squared : 0;
        if (!(is_squarable(from_) && is_squarable(to))) per_square_ = kNaN;
        is_none_ = !(radius_ >= 0);
    }

    [[nodiscard]] BoxVerdict judge(const format::BvhNode& node) const noexcept {
        BoxVerdict verdict;
        if (is_none_) return verdict;
        for (std::uint32_t j = 0; j < format::kBvhWidth; ++j) {
            double enter = 0;
            double leave = 1;
            FrameVector w{};
            double size = 0;
            double along = 0;
            for (std::size_t i = 0; i < 3; ++i) {
                const double lower = node.lower[i][j];
                const double upper = node.upper[i][j];
                const double to_lower = lower - outer_ - from_[i];
                const double to_upper = upper + outer_ - from_[i];
                if (per_along_[i] == 0) {
                    if (to_lower > 0 || to_upper < 0) leave = -1;
                } else {
                    const double a = to_lower * per_along_[i];
                    const double b = to_upper * per_along_[i];
                    enter = std::max(enter, std::min(a, b));
                    leave = std::min(leave, std::max(a, b));
                }
                w[i] = 0.5 * (lower + upper) - from_[i];
                size += (upper - lower) * (upper - lower);
                along += w[i] * along_[i];
            }
            const double t = std::min(std::max(along * per_square_, 0.0), 1.0);
            double squared = 0;
            for (std::size_t i = 0; i < 3; ++i) {
                const double from_axis = w[i] - t * along_[i];
                squared += from_axis * from_axis;
            }
            const double distance = std::sqrt(squared);
            const double half = 0.5 * std::sqrt(size);
            const bool apart = enter > leave || distance - half > outer_;
            verdict.near |= static_cast<unsigned>(!apart) << j;
            verdict.inside |= static_cast<unsigned>(distance + half <= inner_) << j;
        }
        return verdict;
    }

    [[nodiscard]] bool touches(const Corners& t) const noexcept {
        return is_within_exactly(ends_, t, radius_);
    }

private:
    /// Returns whether sums of squares and products of such coordinates, and of those of the model,
    /// are finite.
    static bool is_squarable(const FrameVector& p) noexcept {
        constexpr double kMost = 0x1p500;
        return std::fabs(p[0]) < kMost && std::fabs(p[1]) < kMost && std::fabs(p[2]) < kMost;
    }

    static constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    static constexpr double kRounding = 0x1p-45;
    static constexpr double kNoStep = 0x1p-200;  ///< far below the slack

    std::array<Double3, 2> ends_;
    double radius_;
    bool is_none_;
    FrameVector from_{};
    FrameVector along_{};
    FrameVector per_along_{};  ///< 1 / along; 0 for a zero component; NaN proves nothing
    double per_square_ = 0;
    double outer_;
    double inner_;
};

}  // namespace

template <>
struct AmongBoxesOf<Capsule> {
    using Type = CapsuleShape;
};

template struct TouchingShape<Capsule>;

std::optional<ShapeDistance> measure(const Model& model, const Capsule& capsule,
                                     Workspace& workspace, const ShapeOptions& options) noexcept {
    const format::FloatEnvironment environment;
    require(model, Ask::touch);
    if (!(capsule.radius >= 0) || !(options.max_distance >= 0)) return std::nullopt;
    const MovedModel moved = placed(model, options.world_from_model);
    const Corners segment = {capsule.from, capsule.to, capsule.to};
    std::optional<ShapeDistance> found;
    for_each_touching(model, capsule, workspace, {.world_from_model = options.world_from_model},
                      [&](std::uint32_t i) {
                          found = touching_at(moved, segment, i);
                          return false;
                      });
    if (found) return found;
    const double limit = std::nextafter(options.max_distance + capsule.radius, kInfinity);
    found = nearest_to_shape(moved, segment, limit, workspace.storage());
    if (!found) return std::nullopt;
    found->lower = std::max(0.0, std::nextafter(found->lower - capsule.radius, -kInfinity));
    found->upper = std::max(0.0, std::nextafter(found->upper - capsule.radius, kInfinity));
    if (found->lower > options.max_distance) return std::nullopt;
    return found;
}

}  // namespace cdprep
