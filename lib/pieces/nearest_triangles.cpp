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
    // Most triangles of a large piece are far from all of a small one.
    const bool b_is_large = b.triangles().size() > a.triangles().size();
    const ContactSide &large = b_is_large ? b : a, &small = b_is_large ? a : b;
    const Box3 around_small = box_of(small);
    for (const std::uint32_t of_large : large.triangles()) {
        const Corners at_large = large.model().corners(of_large);
        const Box3 box = box_around(at_large);
        if (is_beyond(box, around_small, least) || is_left_out(large, of_large)) continue;
        for (const std::uint32_t of_small : small.triangles()) {
            const Corners at_small = small.model().corners(of_small);
            if (is_beyond(box, box_around(at_small), least) || is_left_out(small, of_small)) {
                continue;
            }
            const TreePair pair =
                b_is_large ? TreePair{of_small, of_large} : TreePair{of_large, of_small};
            const double upper = triangle_distance(b_is_large ? at_small : at_large,
                                                   b_is_large ? at_large : at_small, false)
                                     .upper;
            const bool is_first = pair.a != best.a ? pair.a < best.a : pair.b < best.b;
            if (upper < least || (upper == least && is_first)) least = upper, best = pair;
        }
    }
    return best;
}

}  // namespace cdprep
