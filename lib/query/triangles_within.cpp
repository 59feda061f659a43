// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "cdprep/format/float_environment.h"
#include "cdprep/pairs.h"
#include "core/require.h"
#include "exact/exact_within.h"
#include "walk/contact_pairs.h"
#include "walk/near_triangles.h"
#include "walk/smallest_pairs.h"
#include "walk/walked_trees.h"

// Both hierarchies are walked as for overlaps, with boxes widened by the tolerance. Two triangles
// within it are at most that far apart along any direction. Bounds in float separate most triangles
// of the leaves that are reached. The others are tested exactly.

namespace cdprep {
namespace {

/// A direction of a box test is unit up to 2^-20, and a sum with the tolerance rounds a few times
/// (BoxPlacement::tolerance).
constexpr double kBoxRounding = 1 + 0x1p-18;

/// A search for the triangles within a tolerance above 0.
template <class Trees>
class WithinSearch {
public:
    WithinSearch(const Model& a, const Model& b, const Placement& placement, double tolerance,
                 Workspace& workspace, const PairOptions& options) noexcept
        : a_(a),
          b_(b),
          moved_a_(moved_a(a, placement)),
          moved_b_(moved_b(b, placement)),
          options_(options),
          tolerance_(tolerance),
          placed_(place_boxes(a, b, placement)),
          scratch_(workspace.storage()),
          batch_(a, b, placed_, scratch_),
          trees_(a, b, scratch_) {}

    /// Calls `found(a, b, touch)`, tree order. Stops and returns false when `found` returns false.
    template <class Found>
    bool run(Found&& found) noexcept;

private:
    template <class Found>
    bool give_all(Found&& found) const noexcept;
    [[nodiscard]] bool is_skipped(std::uint32_t at_a, std::uint32_t at_b) const noexcept {
        return options_.degenerate == Degenerate::skip &&
               (is_marked_degenerate(a_, at_a) || is_marked_degenerate(b_, at_b));
    }
    /// Returns whether two triangles within the tolerance touch, or nothing if they are not within
    /// it. For pairs that may touch, the contact test comes first: it costs less than the distance
    /// test.
    [[nodiscard]] std::optional<Touch> find_touch(std::uint32_t at_a, std::uint32_t at_b,
                                                  const kernels::TriangleGap& gap) const noexcept {
        const bool are_apart = gap.lower > 0;
        if (gap.certain) {
            if (scratch_.counts != nullptr) ++scratch_.counts->by_kernel;
            return are_apart ? Touch::no : Touch::unknown;
        }
        const Corners a = moved_a_.corners(at_a);
        const Corners b = moved_b_.corners(at_b);
        if (!are_apart && in_contact(a, b, Overlap::closed, scratch_.counts)) return Touch::yes;
        if (scratch_.counts != nullptr) ++scratch_.counts->measured;
        return is_within_exactly(a, b, tolerance_) ? std::optional(Touch::no) : std::nullopt;
    }

    const Model& a_;
    const Model& b_;
    MovedModel moved_a_;
    MovedModel moved_b_;
    PairOptions options_;
    double tolerance_;
    PlacedBoxes placed_;
    Workspace::Storage& scratch_;
    LeafBatch batch_;
    Trees trees_;
    kernels::Reach reach_{};
};

template <class Trees>
template <class Found>
bool WithinSearch<Trees>::run(Found&& found) noexcept {
    const Tree& a = trees_.a;
    const Tree& b = trees_.b;
    if (a.triangles == 0 || b.triangles == 0) return true;
    const Outlook place = outlook(placed_, tolerance_);
    if (place == Outlook::none) return true;
    if (place == Outlook::all) return give_all(found);
    const double scaled = std::ldexp(tolerance_, placed_.exponent);
    reach_.limit = float_reach(scaled * kBoxRounding);
    reach_.certain = static_cast<float>(std::min(scaled, kMostReach) / kBoxRounding);
    placed_.placement.tolerance = reach_.limit;
    const auto decide = [&](std::uint32_t at_a, std::uint32_t at_b,
                            const kernels::TriangleGap& gap) {
        at_a = trees_.triangle_a(at_a);
        at_b = trees_.triangle_b(at_b);
        if (is_skipped(at_a, at_b)) return true;
        const std::optional<Touch> touch = find_touch(at_a, at_b, gap);
        return !touch || static_cast<bool>(found(at_a, at_b, *touch));
    };
    const auto add = [&](const LeafView& in_a, const LeafView& in_b) {
        batch_.add(in_a, in_b);
        return !batch_.full() || batch_.flush_within(reach_, decide);
    };
    const bool whole = walk_pairs_from<Search::all>(
        roots(a, b), 0, a, b, placed_, scratch_, [&](const PendingPair& pair) {
            return trees_.each_pair(batch_, pair.a.index, pair.b.index, add);
        });
    return whole && batch_.flush_within(reach_, decide);
}

template <class Trees>
template <class Found>
bool WithinSearch<Trees>::give_all(Found&& found) const noexcept {
    return each_triangle(a_, 0, a_.triangle_count(), [&](std::uint32_t i) {
        return each_triangle(b_, 0, b_.triangle_count(), [&](std::uint32_t j) {
            return is_skipped(i, j) || static_cast<bool>(found(i, j, Touch::unknown));
        });
    });
}

template <class Trees, class Found>
bool for_each_within_by(const Model& a, const Model& b, const Placement& placement,
                        double tolerance, Workspace& workspace, const PairOptions& options,
                        Found&& found) noexcept {
    if (!(tolerance >= 0)) return true;
    if (tolerance == 0) {
        return for_each_contact<Search::all, Trees>(
            a, b, placement, workspace, {.degenerate = options.degenerate},
            [&](std::uint32_t at_a, std::uint32_t at_b) { return found(at_a, at_b, Touch::yes); });
    }
    return WithinSearch<Trees>(a, b, placement, tolerance, workspace, options).run(found);
}

template <class Found>
bool for_each_within(Structure structure, const Model& a, const Model& b,
                     const Placement& placement, double tolerance, Workspace& workspace,
                     const PairOptions& options, Found&& found) noexcept {
    if (structure == Structure::pieces) {
        return for_each_within_by<PieceTrees>(a, b, placement, tolerance, workspace, options,
                                              found);
    }
    return for_each_within_by<TriangleTrees>(a, b, placement, tolerance, workspace, options, found);
}

}  // namespace

bool visit_near_triangles(Structure structure, const Model& a, const Model& b,
                          const Placement& placement, double tolerance, Workspace& workspace,
                          Visitor<NearTriangles> visit, const PairOptions& options) noexcept {
    return for_each_within(structure, a, b, placement, tolerance, workspace, options,
                           [&](std::uint32_t at_a, std::uint32_t at_b, Touch touch) {
                               return visit({at_a, at_b, touch});
                           });
}

std::size_t pairs_within(const Pair& pair, double tolerance, Workspace& workspace,
                         std::span<TrianglePair> room) noexcept {
    const format::FloatEnvironment environment;
    const Model &a = pair.a, &b = pair.b;
    require(a, b, Ask::within | ask_of(pair.options.through));
    return keep_smallest_pairs(a, b, workspace, room, [&](auto&& found) {
        for_each_within(
            pair.options.through, a, b, pair.placement, tolerance, workspace, pair.options,
            [&](std::uint32_t at_a, std::uint32_t at_b, Touch) { return found(at_a, at_b); });
    });
}

bool visit_pairs_within(const Pair& pair, double tolerance, Workspace& workspace,
                        PairVisitor visit) noexcept {
    format::FloatEnvironment environment;
    const Model &a = pair.a, &b = pair.b;
    require(a, b, Ask::within | ask_of(pair.options.through));
    const auto hand_on = [&](const NearTriangles& near) {
        const TrianglePair found = {source_number(a, near.a), source_number(b, near.b)};
        return environment.outside([&] { return visit(found); });
    };
    return visit_near_triangles(pair.options.through, a, b, pair.placement, tolerance, workspace,
                                hand_on, pair.options);
}

}  // namespace cdprep
