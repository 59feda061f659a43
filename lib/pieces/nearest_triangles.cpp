// SPDX-License-Identifier: MIT
#include "pieces/contact_steps.h"

#include <algorithm>

#include "core/triangle_facts.h"
#include "exact/triangle_distance.h"

namespace cdprep {
namespace {

Box3 around_both(const Box3& x, const Box3& y) {
    return {{std::min(x.lower.x, y.lower.x), std::min(x.lower.y, y.lower.y),
             std::min(x.lower.z, y.lower.z)},
            {std::max(x.upper.x, y.upper.x), std::max(x.upper.y, y.upper.y),
             std::max(x.upper.z, y.upper.z)}};
}

/// Returns whether the contents of two boxes are certainly farther apart than `distance`.
bool is_beyond(const Box3& x, const Box3& y, double distance) {
    return axis_gap(x, y) > distance * (1 + 0x1p-50);
}

Box3 box_of(const ContactSide& side) {
    Box3 box = box_around(side.model().corners(side.triangles()[0]));
    for (const std::uint32_t t : side.triangles()) {
        box = around_both(box, box_around(side.model().corners(t)));
    }
    return box;
}

}  // namespace

TreePair nearest_triangles(const ContactSide& a, const ContactSide& b, const TreePair& start,
                           Degenerate degenerate) noexcept {
    const auto is_left_out = [&](const ContactSide& side, std::uint32_t triangle) {
        return degenerate == Degenerate::skip &&
               is_marked_degenerate(*side.model().model, triangle);
    };
    TreePair best = start;
    double least =
        triangle_distance(a.model().corners(start.a), b.model().corners(start.b), false).upper;
    const Box3 around_b = box_of(b);
    for (const std::uint32_t i : a.triangles()) {
        const Corners at_a = a.model().corners(i);
        const Box3 box = box_around(at_a);
        if (is_beyond(box, around_b, least) || is_left_out(a, i)) continue;
        for (const std::uint32_t j : b.triangles()) {
            const Corners at_b = b.model().corners(j);
            if (is_beyond(box, box_around(at_b), least) || is_left_out(b, j)) continue;
            const double upper = triangle_distance(at_a, at_b, false).upper;
            const bool is_first = i != best.a ? i < best.a : j < best.b;
            if (upper < least || (upper == least && is_first)) least = upper, best = {i, j};
        }
    }
    return best;
}

}  // namespace cdprep
