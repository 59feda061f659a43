// SPDX-License-Identifier: MIT
#include <algorithm>

#include "exact/exact_within.h"
#include "query/find_touching.h"
#include "walk/shape_frame.h"

namespace cdprep {
namespace {

double square(double x) noexcept {
    return x * x;
}

/// A ball compared with the boxes of a model, in frame units.
class SphereShape {
public:
    SphereShape(const MovedModel& model, const Sphere& sphere) noexcept : sphere_(sphere) {
        const ShapeFrame frame(model, ShapeFrame::largest(sphere.centre));
        centre_ = frame.at(sphere.centre);
        const double radius = frame.scaled(sphere.radius);
        const double outer = (radius + frame.slack()) * (1 + kRounding);
        const double inner = (radius - frame.slack()) * (1 - kRounding);
        outer_squared_ = sphere.radius >= 0 ? square(outer) : -1;
        inner_squared_ = inner > 0 && inner < kLargestToHold ? square(inner) : -1;
    }

    [[nodiscard]] BoxVerdict judge(const format::BvhNode& node) const noexcept {
        BoxVerdict verdict;
        for (std::uint32_t j = 0; j < format::kBvhWidth; ++j) {
            double near = 0;
            double far = 0;
            for (std::size_t i = 0; i < 3; ++i) {
                const double below = node.lower[i][j] - centre_[i];
                const double above = centre_[i] - node.upper[i][j];
                near += square(std::max(std::max(below, above), 0.0));
                far += square(std::min(below, above));
            }
            verdict.near |= static_cast<unsigned>(!(near > outer_squared_)) << j;
            verdict.inside |= static_cast<unsigned>(far <= inner_squared_) << j;
        }
        return verdict;
    }

    [[nodiscard]] bool touches(const Corners& t) const noexcept {
        return is_within_exactly({&sphere_.centre, 1}, t, sphere_.radius);
    }

private:
    static constexpr double kRounding = 0x1p-45;     ///< of sums of squares and other operations
    static constexpr double kLargestToHold = 1e150;  ///< squares stay finite

    Sphere sphere_;
    FrameVector centre_{};
    double outer_squared_;
    double inner_squared_;
};

}  // namespace

template <>
struct AmongBoxesOf<Sphere> {
    using Type = SphereShape;
};

template struct TouchingShape<Sphere>;

std::optional<ShapeDistance> measure(const Model& model, const Sphere& sphere, Workspace& workspace,
                                     const ShapeOptions& options) noexcept {
    return measure(model, Capsule{sphere.centre, sphere.centre, sphere.radius}, workspace, options);
}

}  // namespace cdprep
