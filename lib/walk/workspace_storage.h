// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>

#include "cdprep/advanced/pair_front.h"
#include "cdprep/advanced/query_counts.h"
#include "cdprep/format/geometry.h"
#include "cdprep/format/limits.h"
#include "cdprep/workspace.h"
#include "core/sort_pairs.h"
#include "kernels/kernels.h"

namespace cdprep {

/// Most entries a depth-first walk of two hierarchies holds: each step replaces
/// one pair by at most 64, and takes at least one side a level down.
inline constexpr std::size_t kMaxPendingPairs =
    std::size_t{2} * (format::kMaxBvhLevels + 1) * format::kBvhWidth * format::kBvhWidth;

/// A place of a tree with a bound that orders the walk: a distance or a ray's t.
struct BoundedPlace {
    double bound;
    std::uint32_t height;
    std::uint32_t index;
};

/// Most entries an ordered walk of one hierarchy holds: seven siblings a level.
inline constexpr std::size_t kMaxBoundedPlaces =
    std::size_t{format::kMaxBvhLevels + 1} * format::kBvhWidth;

/// A pair of places with a lower bound of their distance, pair units.
struct NearPair {
    float bound;
    std::uint64_t pair;  ///< PendingPair::packed()
};

/// Pairs of places that a search for the nearest keeps in order.
inline constexpr std::size_t kMaxFrontier = 8192;

/// A pair of places of a walk with the sizes of its boxes.
struct OpenedPair {
    std::uint64_t pair;  ///< PendingPair::packed()
    float size_a;        ///< half the sum of the edges, pair units
    float size_b;
};

/// Children of one step that are still to be looked at, and where they are: box 0
/// of either node stands for `base`.
struct OpenStep {
    std::uint64_t base;  ///< PendingPair::packed()
    kernels::BoxPairs pairs;
    kernels::BoxSizes sizes;

    [[nodiscard]] OpenedPair take(unsigned bit) noexcept {
        assert(bit < 64 && (pairs >> bit & 1) != 0);
        const std::uint64_t i = bit % format::kBvhWidth;
        const std::uint64_t j = bit / format::kBvhWidth;
        pairs &= ~(kernels::BoxPairs{1} << bit);
        return {base + (i << 32) + j, sizes.a[i], sizes.b[j]};
    }
};

/// Leaves of pieces that are put together for a walk, by number modulo kLeafPlaces.
struct GatheredLeaves {
    std::array<format::BvhLeaf, kernels::kLeafPlaces> leaf;
    std::array<std::uint32_t, kernels::kLeafPlaces> holds;     ///< number
    std::array<std::uint64_t, kernels::kLeafPlaces> walk{};    ///< that put it there
    std::array<std::uint64_t, kernels::kLeafPlaces> wanted{};  ///< until which batch is tested
};

/// A step takes at least one side a level down.
inline constexpr std::size_t kMaxOpenSteps = std::size_t{2} * (format::kMaxBvhLevels + 1);

/// Two pieces and two triangles of theirs that are near: the first that touch, or else the first.
struct NearPieces {
    std::uint64_t key;  ///< piece of A, then of B
    std::uint32_t a;    ///< tree order
    std::uint32_t b;
    bool touch;
};

/// Pairs of pieces that one walk gathers; twice as many as it keeps.
inline constexpr std::size_t kMaxNearPieces = 4096;

struct Workspace::Storage {
    // What begins cache lines stands first: nothing is lost between.
    kernels::LeafScratch leaf_scratch;
    GatheredLeaves gathered_a;
    GatheredLeaves gathered_b;
    std::uint64_t leaf_batch = 1;   ///< batches of leaves that were tested, and one
    std::uint64_t piece_walks = 0;  ///< that were begun
    std::array<OpenStep, kMaxOpenSteps> open_steps;
    std::array<std::uint64_t, kMaxPendingPairs> pending;
    std::array<NearPair, kMaxPendingPairs> near;
    std::array<std::uint64_t, kMaxFrontier> frontier;
    std::array<std::uint64_t, kMaxFrontier> frontier_pairs;
    std::array<std::uint64_t, kMaxFrontier> frontier_later;
    std::array<BoundedPlace, kMaxBoundedPlaces> bounded;
    std::array<kernels::LeafPair, kernels::kLeafBatch> leaf_pairs;
    SortScratch sort_scratch;
    std::array<NearPieces, kMaxNearPieces> near_pieces;
    std::array<std::uint16_t, kFrontRoom + 2 * kernels::kLanes> weak_planes;  ///< of a PairFront
    QueryCounts* counts = nullptr;        ///< or null: nobody asked
    const CellSearches* cells = nullptr;  ///< or null: none through octrees and tetra-trees
    void* cell_storage = nullptr;         ///< of cells
};

}  // namespace cdprep
