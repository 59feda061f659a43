// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>

#include "cdprep/advanced/pair_front.h"
#include "cdprep/advanced/query_counts.h"
#include "cdprep/bounded_distance.h"
#include "cdprep/contacts.h"
#include "cdprep/format/geometry.h"
#include "cdprep/format/hull.h"
#include "cdprep/format/limits.h"
#include "cdprep/workspace.h"
#include "core/sort_pairs.h"
#include "kernels/kernels.h"

namespace cdprep {

/// The most entries that a depth-first walk of two hierarchies holds. Each step replaces one pair
/// by at most 64, and takes at least one side a level down.
inline constexpr std::size_t kMaxPendingPairs =
    std::size_t{2} * (format::kMaxBvhLevels + 1) * format::kBvhWidth * format::kBvhWidth;

/// A place of a tree with a bound that orders the walk: a distance or a ray's t.
struct BoundedPlace {
    double bound;
    std::uint32_t height;
    std::uint32_t index;
};

/// The most entries that an ordered walk of one hierarchy holds: seven siblings a level.
inline constexpr std::size_t kMaxBoundedPlaces =
    std::size_t{format::kMaxBvhLevels + 1} * format::kBvhWidth;

/// A pair of places with a lower bound of their distance, in pair units.
struct NearPair {
    float bound;
    std::uint64_t pair;  ///< PendingPair::packed()
};

/// The number of pairs of places that a search for the nearest keeps in order.
inline constexpr std::size_t kMaxFrontier = 8192;

/// A pair of places of a walk with the sizes of its boxes.
struct OpenedPair {
    std::uint64_t pair;  ///< PendingPair::packed()
    float size_a;        ///< half the sum of the edges, pair units
    float size_b;
};

/// The children of one step that are still to be visited, and their places. `base` is the pair of
/// places of box 0 of either node.
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

/// Leaves of pieces that are gathered for a walk, by number modulo kLeafPlaces.
struct GatheredLeaves {
    std::array<format::BvhLeaf, kernels::kLeafPlaces> leaf;
    std::array<std::uint32_t, kernels::kLeafPlaces> holds;     ///< number
    std::array<std::uint64_t, kernels::kLeafPlaces> walk{};    ///< the walk that put the leaf there
    std::array<std::uint64_t, kernels::kLeafPlaces> wanted{};  ///< stays until this batch's test
};

/// Numbers of the vertices of leaves, by leaf modulo kLeafPlaces.
struct GatheredNumbers {
    static constexpr std::uint32_t kNoLeaf = 0xffffffffU;

    /// [corner][lane]
    std::array<std::array<std::uint32_t, std::size_t{3} * format::kBvhWidth>, kernels::kLeafPlaces>
        numbers;
    std::array<std::uint32_t, kernels::kLeafPlaces> holds;  ///< leaf, or kNoLeaf
    std::uint64_t taken;                                    ///< places that this batch uses
};
static_assert(kernels::kLeafPlaces <= 64);

/// Each step takes at least one side a level down.
inline constexpr std::size_t kMaxOpenSteps = std::size_t{2} * (format::kMaxBvhLevels + 1);

/// Two pieces and two near triangles of theirs: the first that touch, or else the first.
struct NearPieces {
    std::uint64_t key;  ///< piece of A, then of B
    std::uint32_t a;    ///< tree order
    std::uint32_t b;
    bool touch;
};

/// The most pairs of pieces that one walk gathers; twice as many as it keeps.
inline constexpr std::size_t kMaxNearPieces = 4096;

/// The hull of a large piece as moved, for as long as a query asks about no other of its side.
struct PlacedHull {
    static constexpr std::uint32_t kNoPiece = 0xffffffffU;
    static constexpr std::size_t kMostBlocks = 128;
    /// A hull of n corners has at most 2 n - 4 facets.
    static constexpr std::size_t kMostFacets = 2 * kMostBlocks * format::kHullLanes;

    std::uint32_t piece = kNoPiece;
    bool has_normals = false;
    /// Triangles cover all faces, and rounding turns no face's normal by much. Known with the
    /// normals.
    bool has_sure_faces = false;
    Double3 reach;  ///< the largest |x|, |y|, |z| of the corners
    std::array<format::HullBlock, kMostBlocks> blocks;
    /// x, y, z of the normals of covered faces, rounded: for the first facet of a face. 0 for other
    /// facets.
    std::array<std::array<float, kMostFacets>, 3> normals;
};

/// A pair of pieces whose contact may be listed.
struct ContactCandidate {
    /// How closely a depth is known. A bound is at least the depth.
    enum class Known : std::uint8_t {
        roughly,   ///< a bound that costs little
        by_faces,  ///< a bound by all faces of both hulls
        exactly,   ///< the contact was computed
    };

    double depth;  ///< minus Contact::upper, or a bound
    Known known;
    /// Its place in Storage::computed_contacts, or kNoSlot.
    std::uint32_t slot;
    Double3 at;  ///< a corner of a triangle there
    NearPieces near;
    double squared_gap;  ///< to the nearest one that was chosen
};

/// The most contacts among which a list is chosen: the deepest.
inline constexpr std::size_t kMaxContactCandidates = 1024;
/// The number of computed contacts that are kept until a list is complete; others are computed
/// again.
inline constexpr std::size_t kMaxComputedContacts = 64;
inline constexpr std::uint32_t kNoSlot = 0xffffffffU;

/// Returns the work that counts stand for, as DistanceBudget::work counts it.
inline std::uint64_t work_of(const QueryCounts& counts) noexcept {
    return counts.node_pairs + kWorkOfLeaves * counts.leaf_pairs +
           kWorkOfTriangles * (counts.measured + counts.by_filter + counts.by_corner) +
           kWorkOfExact * (counts.measured_again + counts.by_exact);
}

struct Workspace::Storage {
    // Members aligned to cache lines come first, so no padding is lost between them.
    kernels::LeafScratch leaf_scratch;
    GatheredLeaves gathered_a;
    GatheredLeaves gathered_b;
    std::uint64_t leaf_batch = 1;   ///< the number of tested leaf batches, plus one
    std::uint64_t piece_walks = 0;  ///< the number of walks begun
    std::array<OpenStep, kMaxOpenSteps> open_steps;
    std::array<std::uint64_t, kMaxPendingPairs> pending;
    std::array<NearPair, kMaxPendingPairs> near;
    std::array<std::uint64_t, kMaxFrontier> frontier;
    std::array<std::uint64_t, kMaxFrontier> frontier_pairs;
    std::array<std::uint64_t, kMaxFrontier> frontier_later;
    std::array<BoundedPlace, kMaxBoundedPlaces> bounded;
    std::array<kernels::LeafPair, kernels::kLeafBatch> leaf_pairs;
    std::array<kernels::CornerNumbers, kernels::kLeafBatch> corner_numbers;  ///< of leaf_pairs
    std::array<GatheredNumbers, 2> gathered_numbers;
    SortScratch sort_scratch;
    std::array<NearPieces, kMaxNearPieces> near_pieces;
    std::array<PlacedHull, 2> placed_hulls;  ///< of A and B
    std::array<ContactCandidate, kMaxContactCandidates> contact_candidates;
    std::array<Contact, kMaxComputedContacts> computed_contacts;
    std::array<Contact, kMostListedContacts> listed_contacts;
    std::array<std::uint16_t, kFrontRoom + 2 * kernels::kLanes> weak_planes;  ///< for a PairFront
    QueryCounts* counts = nullptr;         ///< or null: no counts are wanted
    std::uint64_t most_work = UINT64_MAX;  ///< of `counts`
    const CellSearches* cells = nullptr;   ///< or null: no searches through octrees and tetra-trees
    void* cell_storage = nullptr;          ///< scratch of cells

    /// Returns whether a search must end, because it has done the work that it may do.
    [[nodiscard]] bool is_out_of_work() const noexcept {
        return counts != nullptr && work_of(*counts) >= most_work;
    }
};

}  // namespace cdprep
