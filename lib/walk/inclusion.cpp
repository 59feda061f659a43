// SPDX-License-Identifier: MIT
#include "walk/inclusion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/moved_point.h"
#include "core/triangle_facts.h"
#include "exact/triangle_contact.h"
#include "exact/winding.h"
#include "walk/walk_model.h"

// The ray from q runs along +x: its origin o is q moved back along x alone. So a box is of interest
// if its y and z ranges contain q's and it does not end before q in x. The symbolic perturbation of
// o rotates the ray by less than any positive angle. So only triangles that touch the closed ray
// can count, and these lie in boxes that touch it.

namespace cdprep {
namespace {

/// The boxes of a moved model, in the query's coordinates.
class MovedBoxes {
public:
    explicit MovedBoxes(const MovedModel& model) noexcept
        : header_(model.model->header()), pose_(model.pose == nullptr ? Pose() : *model.pose) {
        const Double3& o = header_.frame_origin;
        const Double3& t = pose_.translation();
        const double reach = std::max({std::fabs(o.x), std::fabs(o.y), std::fabs(o.z)}) +
                             std::ldexp(1.0, -header_.frame_exponent);
        const double shift = std::max({std::fabs(t.x), std::fabs(t.y), std::fabs(t.z)});
        // 5 u (3 reach + shift) for the vertices, as much for the boxes, and a margin: see
        // box_placement.cpp.
        reach_ = reach + shift;
        slack_ = 0x1p-47 * (3 * reach + shift) + kSubnormal;
    }

    /// Returns about the largest |coordinate|; never 0.
    [[nodiscard]] double reach() const noexcept {
        return reach_;
    }

    [[nodiscard]] Box3 box(const format::BvhNode& node, std::uint32_t index) const noexcept {
        std::array<double, 3> centre{};
        std::array<double, 3> half{};
        const std::array<double, 3> origin = {header_.frame_origin.x, header_.frame_origin.y,
                                              header_.frame_origin.z};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double lower = node.lower[axis][index];
            const double upper = node.upper[axis][index];
            centre[axis] = scaled(0.5 * (lower + upper), -header_.frame_exponent) + origin[axis];
            half[axis] = scaled(0.5 * (upper - lower), -header_.frame_exponent);
        }
        const Double3 c = moved_point(pose_, {centre[0], centre[1], centre[2]});
        const std::array<double, 9>& r = pose_.rotation();
        const auto reach = [&](std::size_t row) {
            return std::fabs(r[row]) * half[0] + std::fabs(r[row + 1]) * half[1] +
                   std::fabs(r[row + 2]) * half[2] + slack_;
        };
        const Double3 h = {reach(0), reach(3), reach(6)};
        return {{c.x - h.x, c.y - h.y, c.z - h.z}, {c.x + h.x, c.y + h.y, c.z + h.z}};
    }

private:
    static constexpr double kSubnormal = 0x1p-1070;  ///< scaling back may round

    const format::FileHeader& header_;
    Pose pose_;
    double reach_ = 0;
    double slack_ = 0;
};

bool ray_meets(const Double3& q, const Box3& box) noexcept {
    return q.x <= box.upper.x && box.lower.y <= q.y && q.y <= box.upper.y && box.lower.z <= q.z &&
           q.z <= box.upper.z;
}

/// Returns the exact winding number of a balanced surface around q.
Inclusion exact_inclusion(const MovedModel& model, const Double3& q,
                          Workspace::Storage& scratch) noexcept {
    const MovedBoxes boxes(model);
    const Double3 o = before_along_x(q, boxes.reach());
    long winding = 0;
    const auto add_leaf = [&](std::uint32_t leaf) {
        return each_in_leaf(*model.model, leaf, [&](std::uint32_t i) {
            if (scratch.counts != nullptr) ++scratch.counts->ray_triangles;
            const Corners corners = model.corners(i);
            if (!ray_meets(q, box_around(corners))) return true;
            const WindingTerm term = winding_term(o, q, corners);
            winding += term.crossings;
            return !term.on_surface;
        });
    };
    const bool off_surface = walk_model(
        *model.model, scratch,
        [&](const format::BvhNode& node, std::uint32_t box) {
            return ray_meets(q, boxes.box(node, box));
        },
        add_leaf);
    if (!off_surface) return {Answer::yes, true, 0};
    return {winding != 0 ? Answer::yes : Answer::no, false, static_cast<double>(winding)};
}

/// Returns the generalised winding number, summed over all triangles.
Inclusion generalised_inclusion(const MovedModel& model, const Double3& q) noexcept {
    double angle = 0;
    const bool off_surface =
        each_triangle(*model.model, 0, model.model->triangle_count(), [&](std::uint32_t i) {
            const Corners corners = model.corners(i);
            angle += solid_angle(q, corners);
            return !triangles_touch({q, q, q}, corners);
        });
    if (!off_surface) return {Answer::yes, true, 0};
    return {Answer::unknown, false, angle / (4 * std::numbers::pi)};
}

}  // namespace

Box3 box_around(const MovedModel& model) noexcept {
    const MovedBoxes boxes(model);
    const Model& m = *model.model;
    Box3 all = boxes.box(m.bvh().nodes[0], 0);
    for (std::uint32_t i = 1; i < m.bvh().shape.used_boxes(m.bvh().shape.levels - 1, 0); ++i) {
        const Box3 box = boxes.box(m.bvh().nodes[0], i);
        all.lower = {std::min(all.lower.x, box.lower.x), std::min(all.lower.y, box.lower.y),
                     std::min(all.lower.z, box.lower.z)};
        all.upper = {std::max(all.upper.x, box.upper.x), std::max(all.upper.y, box.upper.y),
                     std::max(all.upper.z, box.upper.z)};
    }
    return all;
}

Inclusion inclusion(const MovedModel& model, const Double3& q,
                    Workspace::Storage& scratch) noexcept {
    // Outside the box around it, q is outside the model, balanced or not.
    if (model.model->triangle_count() == 0 || !holds(box_around(model), q)) return {};
    return model.model->is_balanced() ? exact_inclusion(model, q, scratch)
                                      : generalised_inclusion(model, q);
}

}  // namespace cdprep
