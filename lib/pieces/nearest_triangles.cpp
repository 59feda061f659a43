// SPDX-License-Identifier: MIT
#include "pieces/contact_steps.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "core/triangle_facts.h"
#include "exact/triangle_distance.h"
#include "walk/contact_pairs.h"

namespace cdprep {
namespace {

/// Distances that differ by less than this share of them count as equal.
constexpr double kAsNear = 0x1p-41;
/// A generous estimate of the rounding error of a distance, as a share of it.
constexpr double kRounding = 0x1p-48;

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

bool is_left_out(const ContactSide& side, std::uint32_t triangle, Degenerate degenerate) {
    return degenerate == Degenerate::skip && is_marked_degenerate(*side.model().model, triangle);
}

Box3 box_of(const ContactSide& side) {
    Box3 box = box_around(side.corners_of(0));
    for (std::size_t i = 1; i < side.triangles().size(); ++i) {
        box = around_both(box, box_around(side.corners_of(i)));
    }
    return box;
}

/// The direction across the gap of two triangles. The difference of two other triangles' heights
/// along it is a lower bound of their distance.
class Gap {
public:
    explicit Gap(const TriangleDistance& nearest)
        : from_(nearest.on_a), way_(unit(nearest.on_b - nearest.on_a)) {}

    /// Returns a lower bound of the distance of a triangle of A and one of B.
    [[nodiscard]] double least_distance(const Corners& a, const Corners& b) const {
        double most = -std::numeric_limits<double>::infinity(), least = -most, size = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const Double3 p = a[i] - from_, q = b[i] - from_;
            most = std::max(most, dot(p, way_));
            least = std::min(least, dot(q, way_));
            size = std::max({size, largest_of(p), largest_of(q)});
        }
        // Each height is off by at most 15 u of the size. Products below the range of double round
        // by more.
        constexpr double kSubnormal = 0x1p-1070;
        return least - most - 0x1p-48 * size - kSubnormal;
    }

private:
    Double3 from_;
    Double3 way_;
};

}  // namespace

NearestTriangles nearest_triangles(const ContactSide& a, const ContactSide& b,
                                   const TreePair& start, Degenerate degenerate) noexcept {
    const TriangleDistance first =
        triangle_distance(a.model().corners(start.a), b.model().corners(start.b), false);
    double distance = first.upper, as_near = distance * (1 + kAsNear);
    double least = std::numeric_limits<double>::infinity();  // of pairs that are not measured
    Gap gap(first);
    std::optional<TreePair> best;
    // Most triangles of a large piece are far from all of a small one.
    const bool b_is_large = b.triangles().size() > a.triangles().size();
    const ContactSide &large = b_is_large ? b : a, &small = b_is_large ? a : b;
    const Box3 around_small = box_of(small);
    for (std::size_t i = 0; i < large.triangles().size(); ++i) {
        const std::uint32_t of_large = large.triangles()[i];
        const Corners at_large = large.corners_of(i);
        const Box3 box = box_around(at_large);
        if (is_beyond(box, around_small, as_near) || is_left_out(large, of_large, degenerate)) {
            continue;
        }
        for (std::size_t j = 0; j < small.triangles().size(); ++j) {
            const std::uint32_t of_small = small.triangles()[j];
            const Corners at_small = small.corners_of(j);
            if (is_beyond(box, box_around(at_small), as_near) ||
                is_left_out(small, of_small, degenerate)) {
                continue;
            }
            const Corners &at_a = b_is_large ? at_small : at_large,
                          &at_b = b_is_large ? at_large : at_small;
            const double bound = gap.least_distance(at_a, at_b);
            if (bound > as_near) continue;
            // The triangles around a corner or an edge are as near as the first of them.
            if (best && bound > distance * (1 - kAsNear)) {
                least = std::min(least, bound);
                continue;
            }
            const TriangleDistance found = triangle_distance(at_a, at_b, false);
            if (found.upper > as_near) continue;
            const bool is_first = !best || found.upper < distance * (1 - kAsNear);
            distance = std::min(distance, found.upper);
            as_near = distance * (1 + kAsNear);
            if (!is_first) continue;
            best = b_is_large ? TreePair{of_small, of_large} : TreePair{of_large, of_small};
            gap = Gap(found);
        }
    }
    return {best.value_or(start), std::min(least, distance * (1 - kRounding))};
}

std::optional<TreePair> touching_triangles(const ContactSide& a, const ContactSide& b,
                                           const ContactQuestion& question) noexcept {
    const Degenerate degenerate = question.degenerate;
    const Box3 around_b = box_of(b);
    for (std::size_t i = 0; i < a.triangles().size(); ++i) {
        const std::uint32_t of_a = a.triangles()[i];
        const Corners at_a = a.corners_of(i);
        const Box3 box = box_around(at_a);
        if (axis_gap(box, around_b) > 0 || is_left_out(a, of_a, degenerate)) continue;
        for (std::size_t j = 0; j < b.triangles().size(); ++j) {
            const std::uint32_t of_b = b.triangles()[j];
            const Corners at_b = b.corners_of(j);
            if (axis_gap(box, box_around(at_b)) > 0 || is_left_out(b, of_b, degenerate)) continue;
            if (in_contact(at_a, at_b, Overlap::closed, question.counts)) {
                return TreePair{of_a, of_b};
            }
        }
    }
    return std::nullopt;
}

}  // namespace cdprep
