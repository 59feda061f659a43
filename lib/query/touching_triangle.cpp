// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "cdprep/format/float_environment.h"
#include "core/require.h"
#include "exact/triangle_contact.h"
#include "query/find_touching.h"
#include "query/nearest_to_shape.h"
#include "walk/shape_frame.h"

namespace cdprep {
namespace {

/// A triangle compared with the boxes of a model, in frame units. A box may touch it only if it
/// meets the triangle's box and the triangle's plane.
class TriangleAmongBoxes {
public:
    TriangleAmongBoxes(const MovedModel& model, const TriangleShape& triangle) noexcept
        : corners_(triangle.corner), around_(box_around(triangle.corner)) {
        const ShapeFrame frame(model, std::max(ShapeFrame::largest(around_.lower),
                                               ShapeFrame::largest(around_.upper)));
        const std::array<FrameVector, 3> corner = {frame.at(corners_[0]), frame.at(corners_[1]),
                                                   frame.at(corners_[2])};
        FrameVector u{}, v{};
        for (std::size_t i = 0; i < 3; ++i) {
            u[i] = corner[1][i] - corner[0][i];
            v[i] = corner[2][i] - corner[0][i];
            lower_[i] = std::min({corner[0][i], corner[1][i], corner[2][i]}) - frame.slack();
            upper_[i] = std::max({corner[0][i], corner[1][i], corner[2][i]}) + frame.slack();
        }
        on_plane_ = corner[0];
        // Each edge is off by twice the slack, and the product of two edges inherits this error.
        double size = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
            normal_[i] = u[j] * v[k] - u[k] * v[j];
            size += std::fabs(u[i]) + std::fabs(v[i]);
        }
        normal_error_ = 8 * frame.slack() * (size + frame.slack());
        slack_ = frame.slack();
        // The product of three such numbers may leave the range: then the plane proves nothing.
        if (!(frame.slack() < kMostSlack)) normal_ = {};
    }

    [[nodiscard]] BoxVerdict judge(const format::BvhNode& node) const noexcept {
        BoxVerdict verdict;
        for (std::uint32_t j = 0; j < format::kBvhWidth; ++j) {
            bool apart = false;
            double height = 0;
            double reach = 0;
            double spread = 0;
            for (std::size_t i = 0; i < 3; ++i) {
                const double lower = node.lower[i][j];
                const double upper = node.upper[i][j];
                apart |= lower > upper_[i] || upper < lower_[i];
                const double from = 0.5 * (lower + upper) - on_plane_[i];
                const double half = 0.5 * (upper - lower) + slack_;
                height += normal_[i] * from;
                reach += std::fabs(normal_[i]) * half;
                spread += std::fabs(from) + half;
            }
            apart |= std::fabs(height) > reach + normal_error_ * spread;
            verdict.near |= static_cast<unsigned>(!apart) << j;
        }
        return verdict;
    }

    [[nodiscard]] bool touches(const Corners& t) const noexcept {
        return overlap(around_, box_around(t)) && triangles_touch(corners_, t);
    }

private:
    static constexpr double kMostSlack = 0x1p250;

    Corners corners_;
    Box3 around_;
    FrameVector on_plane_{};
    FrameVector normal_{};
    FrameVector lower_{}, upper_{};
    double normal_error_ = 0;  ///< of each component
    double slack_ = 0;
};

}  // namespace

template <>
struct AmongBoxesOf<TriangleShape> {
    using Type = TriangleAmongBoxes;
};

template struct TouchingShape<TriangleShape>;

std::optional<ShapeDistance> measure(const Model& model, const TriangleShape& triangle,
                                     Workspace& workspace, const ShapeOptions& options) noexcept {
    const format::FloatEnvironment environment;
    require(model, Ask::touch);
    if (!(options.max_distance >= 0)) return std::nullopt;
    const MovedModel moved = placed(model, options.world_from_model);
    std::optional<ShapeDistance> found;
    for_each_touching(model, triangle, workspace, {.world_from_model = options.world_from_model},
                      [&](std::uint32_t i) {
                          found = touching_at(moved, triangle.corner, i);
                          return false;
                      });
    if (found) return found;
    return nearest_to_shape(moved, triangle.corner, options.max_distance, workspace.storage());
}

}  // namespace cdprep
