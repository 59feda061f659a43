// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "cdprep/advanced/pair_front.h"
#include "pieces/farthest_below.h"
#include "walk/walked_trees.h"

// A front is a set of pairs of places, a cut through the tree of all pairs that a walk of both
// hierarchies could meet: every pair of leaves is below exactly one of them. Each has a plane
// between its two places. A plane goes with A, and what it proves of B's place in one pose it
// proves in every other, less what B has turned (weak_planes.h): so nothing depends on when it was
// set. A question looks at all planes at once; those that are too weak for it are set anew, or
// their pair is replaced by its children's.

namespace cdprep {

/// How a question to a front ended.
enum class FrontEnd : std::uint8_t {
    whole,  ///< every pair was looked at
    ended,  ///< who opens pairs wanted no more
    lost,   ///< the models have jumped, or are near in more places than there is room for: not
            ///< all was looked at, and it holds nothing any more
};

/// Whether it holds anything, of these models.
[[nodiscard]] bool is_of(const PairFront& front, const Model& a, const Model& b) noexcept;

/// Whether it is time to begin it. Counts the question.
[[nodiscard]] bool is_time_to_begin(PairFront& front) noexcept;

/// A front, for one question.
class Front {
public:
    /// `way` is a direction from A to B between near points, A's axes, of a length below 1, or
    /// 0, 0, 0; it may change meanwhile.
    Front(PairFront& kept, const Model& a, const Model& b, const PlacedBoxes& placed,
          const LeafBatch& leaves, const PieceTrees& trees, Workspace::Storage& scratch,
          const float* way) noexcept;

    /// Forgets all but the roots. Neither model is empty.
    void begin() noexcept;

    /// Calls open(pair) for places that may be as near as `limit`, pair units, which may shrink
    /// meanwhile, until it returns false. What is open stays so.
    template <class Open>
    FrontEnd open_near(const float& limit, Open&& open) noexcept;

private:
    /// Across a direction of a length below 1, and where it stands.
    struct Plane {
        Double3 direction{};                                    ///< from A to B, A's axes
        Double3 turned{};                                       ///< the same along B's axes
        Reached of_a;                                           ///< along it
        Reached of_b;                                           ///< against it
        double gap = -std::numeric_limits<double>::infinity();  ///< proved
    };
    struct Ball {
        Double3 middle;
        double reach;
    };
    enum Row : std::size_t { along = 0, along_b = 3, middle_b = 6, gap_at = 9, reach_b, far_a };

    [[nodiscard]] float& at(std::size_t row, std::uint32_t number) const noexcept {
        return kept_.row[row][number];
    }
    [[nodiscard]] Double3 turned_to_b(const Double3& d) const noexcept;
    [[nodiscard]] Double3 moved_to_a(const Double3& p) const noexcept;
    [[nodiscard]] Reached farthest_of_a(const TreePlace& place, const Double3& d) const noexcept;
    [[nodiscard]] Reached farthest_of_b(const TreePlace& place, const Double3& d) const noexcept;
    void set_gap(Plane& plane) const noexcept;
    [[nodiscard]] Plane plane_across(const PendingPair& pair, const Double3& d) const noexcept;
    [[nodiscard]] Plane plane_again(std::uint32_t number, const PendingPair& pair) const noexcept;
    [[nodiscard]] Ball ball_around_b(const TreePlace& place) const noexcept;
    void store(std::uint32_t number, const PendingPair& pair, const Plane& plane) const noexcept;

    /// The weak ones' numbers, in the workspace; begins anew what has grown too large.
    [[nodiscard]] std::size_t find_weak(float limit) noexcept;
    void lose() noexcept;
    [[nodiscard]] Plane part(std::uint32_t number, const PendingPair& pair,
                             float limit) const noexcept;
    [[nodiscard]] Plane search(const PendingPair& pair, const Plane& from,
                               float limit) const noexcept;
    /// Replaces a pair by its children's, of which some wait. False when there is no room.
    [[nodiscard]] bool split(std::uint32_t number, const PendingPair& pair, const Plane& plane,
                             float limit, std::size_t& waiting) noexcept;

    PairFront& kept_;
    const PlacedBoxes& placed_;
    const LeafBatch& leaves_;
    const PieceTrees& trees_;
    Workspace::Storage& scratch_;
    std::array<std::uint64_t, 2> models_;
    TreeSide a_;
    TreeSide b_;
    const float* way_;
    double slack_;
};

template <class Open>
FrontEnd Front::open_near(const float& limit, Open&& open) noexcept {
    std::size_t waiting = find_weak(limit);
    // Moving so many planes takes longer than setting them as the search goes.
    constexpr std::size_t kMostWeak = 128;
    if (waiting > kMostWeak && waiting > kept_.count / 2) {
        lose();
        return FrontEnd::lost;
    }
    while (waiting > 0) {
        const std::uint32_t number = scratch_.weak_planes[--waiting];
        assert(number < kept_.count);
        const PendingPair pair = PendingPair::unpacked(kept_.pair[number]);
        const Plane plane = part(number, pair, limit);
        if (plane.gap > double{limit}) {
            store(number, pair, plane);
            continue;
        }
        if (!is_down_at(pair.packed(), 0)) {
            if (split(number, pair, plane, limit, waiting)) continue;
            if (kept_.begun_with == 0) {
                lose();
                return FrontEnd::lost;
            }
        }
        if (!open(pair)) return FrontEnd::ended;
    }
    kept_.failures = 0;
    if (kept_.begun_with == 0) kept_.begun_with = kept_.count;
    return FrontEnd::whole;
}

}  // namespace cdprep
