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

// A front is a set of pairs of places: a cut through the tree of all pairs that a walk of both
// hierarchies could meet. Every pair of leaves is below exactly one of them. Each pair has a plane
// between its two places. A plane is fixed to A. What it proves of B's place in one pose it proves
// in every other pose, minus a bound for B's rotation since (weak_planes.h). So nothing depends on
// when it was set. A query tests all planes at once. A plane that is too weak is computed again, or
// its pair is replaced by the pairs of its children.

namespace cdprep {

/// The way in which a query to a front ended.
enum class FrontEnd : std::uint8_t {
    whole,  ///< every pair was tested
    ended,  ///< open() returned false
    lost,   ///< the models have jumped, or are near in more places than there is room for. Not all
            ///< pairs were tested, and the front is now empty
};

/// Returns whether the front is not empty and belongs to these models.
[[nodiscard]] bool is_of(const PairFront& front, const Model& a, const Model& b) noexcept;

/// Returns whether it is time to begin the front. Counts the query.
[[nodiscard]] bool is_time_to_begin(PairFront& front) noexcept;

/// A front during one query.
class Front {
public:
    /// `way` is a direction from A to B between near points, along A's axes, of a length below 1,
    /// or 0, 0, 0. It may change during the query.
    Front(PairFront& kept, const Model& a, const Model& b, const PlacedBoxes& placed,
          const LeafBatch& leaves, const PieceTrees& trees, Workspace::Storage& scratch,
          const float* way) noexcept;

    /// Forgets all pairs but the roots. Neither model is empty.
    void begin() noexcept;

    /// Calls open(pair) for places that may be as near as `limit`, in pair units, until it returns
    /// false. `limit` may shrink meanwhile. An opened pair keeps its plane.
    template <class Open>
    FrontEnd open_near(const float& limit, Open&& open) noexcept;

private:
    /// A plane across a direction of a length below 1, and its position.
    struct Plane {
        Double3 direction{};                                    ///< from A to B, A's axes
        Double3 turned{};                                       ///< the same along B's axes
        Reached of_a;                                           ///< along it
        Reached of_b;                                           ///< against it
        double gap = -std::numeric_limits<double>::infinity();  ///< proven
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

    /// Returns the number of weak planes and stores their numbers in the workspace. Restarts the
    /// front if it has grown too large.
    [[nodiscard]] std::size_t find_weak(float limit) noexcept;
    void lose() noexcept;
    [[nodiscard]] Plane part(std::uint32_t number, const PendingPair& pair,
                             float limit) const noexcept;
    [[nodiscard]] Plane search(const PendingPair& pair, const Plane& from,
                               float limit) const noexcept;
    /// Replaces a pair by the pairs of its children, and queues the weak ones. Returns false when
    /// there is no room.
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
    // Updating more planes than this takes longer than setting them during a search.
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
