// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

/// The innermost loops, once per instruction set.
///
/// A kernel sees raw arrays and returns plain numbers. It knows nothing of
/// Model, allocates nothing and fails at nothing. What a kernel leaves open may
/// differ between instruction sets (one rounds a product and a sum at once,
/// another one after the other), so everything it settles is settled with a
/// proven margin: the answers of the queries are the same for every table.
///
/// A kernel source includes this header, the vendor's intrinsics, <cassert>, and the bodies
/// that all share (box_overlap.h, cells_met.h, leaf_contacts.h, ...). Those stand in an
/// unnamed namespace: an inline function with a name that the linker sees could be
/// emitted with AVX2 inside and then be the copy it keeps for everyone.
namespace cdprep::kernels {

/// How the boxes of two hierarchies stand to each other: a box centre c of B
/// lies at rotation * (scale_b c) + shift in the frame of A's boxes, scaled by
/// scale_a. One scale is 1, the other at most 1.
struct BoxPlacement {
    float rotation[9];      ///< a_from_b, row by row
    float abs_rotation[9];  ///< its absolute values
    float shift[3];         ///< of B's frame origin, along A's axes
    float shift_in_b[3];    ///< the same vector along B's axes
    float scale_a;
    float scale_b;
    float slack;  ///< added to every sum of half extents; covers all rounding
    /// Pair units: boxes that are no farther apart overlap still. Added once, however many slacks
    /// a test takes. It is to be 0 where a test finds how far boxes are apart, and larger by 2^-18
    /// of itself than what it stands for: tests round it.
    float tolerance;
};

/// The boxes of one node: 48 floats, lower x, y, z, then upper x, y, z, eight
/// each; and, or null, its oriented boxes: 96 floats, as format::OrientedNode; or its
/// swept spheres, as format::SweptNode.
struct NodeBoxes {
    const float* boxes;
    const float* oriented;
    const float* swept = nullptr;
};

/// What of two nodes is to be tested: bit sets of boxes, and, or null, the box
/// around all of A's: a pointer to its lower x in a node, the others at the
/// strides of a node.
struct BoxChoice {
    std::uint8_t of_a;
    std::uint8_t of_b;
    const float* around_a;
};

inline constexpr std::size_t kLanes = 8;        ///< boxes of a node, triangles of a leaf
inline constexpr std::size_t kLeafBatch = 32;   ///< leaf pairs that one call takes
inline constexpr std::size_t kLeafPlaces = 64;  ///< leaves of either model that stay placed

/// A set of pairs of boxes: bit 8 j + i for box i of A and box j of B.
using BoxPairs = std::uint64_t;

namespace {  // nothing here may be emitted for the linker to choose from

/// The boxes of A that have a partner, as a bit set.
[[maybe_unused]] constexpr unsigned boxes_of_a(BoxPairs pairs) noexcept {
    pairs |= pairs >> 32;
    pairs |= pairs >> 16;
    pairs |= pairs >> 8;
    return static_cast<unsigned>(pairs & 0xff);
}

/// The boxes of B that have a partner: each byte that is not 0 leaves its highest bit,
/// and a product gathers those.
[[maybe_unused]] constexpr unsigned boxes_of_b(BoxPairs pairs) noexcept {
    constexpr BoxPairs kLow = 0x7f7f7f7f7f7f7f7f;
    const BoxPairs some = (((pairs & kLow) + kLow) | pairs) & ~kLow;
    return static_cast<unsigned>(((some >> 7) * 0x0102040810204080) >> 56);
}

}  // namespace

/// Half the sum of each box's edges, pair units: which node to open next.
struct BoxSizes {
    alignas(32) float a[kLanes];
    alignas(32) float b[kLanes];
};

/// A number for each pair of boxes; set for those that were found alone.
struct BoxPairFloats {
    alignas(32) float value[kLanes][kLanes];  ///< [of B][of A], pair units
};

/// By how much each pair of boxes overlaps, and the bit of the one that does most; bits
/// of depths that differ by less than 2^-17 of themselves may stand for each other.
struct BoxDepths : BoxPairFloats {
    unsigned deepest;  ///< of the pairs that were found, where there are any
};

/// A leaf is 78 floats: corners as in format::BvhLeaf, its origin, and the half
/// extents of the box around it.
inline constexpr std::size_t kLeafOrigin = 72;
inline constexpr std::size_t kLeafHalf = 75;

/// A leaf of A and a leaf of B.
struct LeafPair {
    const float* a;
    const float* b;
    std::uint32_t number_a;  ///< tells leaves of one model apart
    std::uint32_t number_b;
    std::uint8_t used_a;  ///< bit set of triangles
    std::uint8_t used_b;
};

/// What stored coordinates of one model's leaves mean. A leaf's middle m is at
/// (origin - frame_origin) * scale in pair units; its corners at m plus
/// (corner - middle) * scale, middle being its origin or, for corners that are
/// stored without it, 0.
struct LeafFrame {
    double frame_origin[3];
    double scale;
    float box_scale;     ///< from half extents to pair units
    float takes_origin;  ///< 1 or 0: middle = takes_origin * origin
};

/// Where B's leaves lie among A's: rotation * b + shift, pair units.
struct LeafPlacement {
    LeafFrame a;
    LeafFrame b;
    double rotation[9];
    double shift[3];
    float corner_rotation[9];  ///< rotation times b.scale
    float error;  ///< how far corners may be off, relative to each other, before any rounding here
};

/// What a search for the nearest pair knows already.
struct Reach {
    float limit;    ///< pair units: nothing farther apart is of interest
    float certain;  ///< pair units: triangles nearer than this need no other proof
    /// Of a length below 1, from A to B along A's axes; the better it points along
    /// the shortest way, the more it rules out. 0, 0, 0 rules out nothing.
    float direction[3];
    float direction_in_b[3];  ///< the same along B's axes
};

/// How far two triangles are apart, at least.
struct TriangleGap {
    float lower;        ///< pair units
    std::uint8_t pair;  ///< index of the LeafPair
    std::uint8_t a;     ///< lane
    std::uint8_t b;     ///< lane
    bool certain;       ///< they are less than Reach::certain apart; else nobody knows
};

/// A pair of triangles that is not certainly disjoint.
struct TriangleContactLanes {
    std::uint8_t pair;  ///< index of the LeafPair
    std::uint8_t a;     ///< lane
    std::uint8_t b;     ///< lane
    bool certain;       ///< they cross; else the kernel cannot tell
};

/// A leaf along A's axes, around its own middle, as the tests of its triangles want
/// it: the same for all leaves of the other model.
struct PlacedLeaf {
    static constexpr std::size_t kRows = 20;
    alignas(64) float row[kRows][kLanes];
};

/// The leaves of one model that are placed already, by number modulo kLeafPlaces.
struct PlacedLeaves {
    PlacedLeaf leaf[kLeafPlaces];
    double middle[kLeafPlaces][3];          ///< pair units; of B's leaves alone
    std::uint64_t holds[kLeafPlaces] = {};  ///< the question, shifted by 32, and the number
};

/// What the leaf kernels work in and answer in. What has no initial value need not
/// have one.
struct LeafScratch {
    PlacedLeaves a;
    PlacedLeaves b;
    alignas(64) float shift[4][kLeafBatch];         ///< of A's corners to B's, and the error
    alignas(64) std::int32_t place[2][kLeafBatch];  ///< of A's and of B's leaf, in floats
    std::uint64_t question = 0;                     ///< begin() makes it a number of its own
    TriangleGap gap[kLeafBatch * kLanes * kLanes];
    std::uint16_t candidate[kLeafBatch * kLanes * kLanes + 2 * kLanes];  ///< stores reach beyond
    TriangleContactLanes found[kLeafBatch * kLanes * kLanes];

    /// To be called before the first leaves of another placement or other models.
    void begin() noexcept {
        constexpr std::uint64_t kQuestions = std::uint64_t{1} << 32;
        if (++question < kQuestions) return;
        question = 1;
        for (std::uint64_t& number : a.holds) number = 0;
        for (std::uint64_t& number : b.holds) number = 0;
    }
};

/// The boxes of a node of B along A's axes, pair units, as many cells of A want them: eight
/// a row.
struct BoxesAmongCells {
    alignas(64) float lower[3][kLanes];  ///< along A's axes, with the slack
    alignas(64) float upper[3][kLanes];
    alignas(64) float axis[3][3][kLanes];  ///< of the oriented boxes; [axis][component]
    alignas(64) float middle[3][kLanes];   ///< their centres along those axes
    alignas(64) float half[3][kLanes];     ///< and half extents, with the slack
};

/// The planes that bound eight cells of A, two along each axis, pair units. Cell i is above
/// the middle plane along x where bit 0 of i is set, along y bit 1, along z bit 2.
struct OctantPlanes {
    float plane[3][3];  ///< [axis], rising
    float half;         ///< half the edge of a cell
};

/// The tests of two nodes' boxes by what bounds their children.
struct BoundTests {
    /// As Table::overlapping_boxes: of swept spheres, what neither six face directions of
    /// the axis-aligned boxes separate nor the direction between nearest points.
    BoxPairs (*overlapping)(const BoxPlacement& placement, const NodeBoxes& a, const NodeBoxes& b,
                            const BoxChoice& choice, BoxSizes& sizes) noexcept;

    /// The same, and depths as Table::overlap_depths has them: with swept spheres, of the
    /// axis-aligned boxes.
    BoxPairs (*depths)(const BoxPlacement& placement, const NodeBoxes& a, const NodeBoxes& b,
                       const BoxChoice& choice, BoxSizes& sizes, BoxDepths& depths) noexcept;

    /// As Table::near_boxes.
    BoxPairs (*near)(const BoxPlacement& placement, const NodeBoxes& a, const NodeBoxes& b,
                     const BoxChoice& choice, const Reach& reach, BoxPairFloats& gaps) noexcept;
};

/// The motion that points are tested under: they move to rotation * p + translation, as
/// cdprep::transform_point() does, and are then so far along `direction` from `origin`.
struct MovedDirection {
    double rotation[9];
    double translation[3];
    double origin[3];
    double direction[3];
};

/// The point that is farthest along a direction; of several the lowest number.
struct FarthestPoint {
    std::uint32_t number;
    double value;  ///< how far it is, rounded
    double bound;  ///< no point is farther: rounding included, underflow not
};

/// Planes between places: rows of numbers, `stride` from row to row, which is a multiple of
/// sixteen. Of each plane: 0 to 2 its direction n from A to B, at most 1 long, A's axes; 3 to 5
/// what B's axes saw of it when it was set; 6 to 8 a middle of B's place; 9 the gap along n, but
/// for B's shift; 10 how far B's place reaches from its middle. Pair units.
struct PlaneRows {
    const float* first;
    std::size_t stride;
};

/// One instruction set's kernels.
struct Table {
    const char* name;  ///< "scalar", "avx2", "avx512": shown in tests and benchmarks

    /// Finds the pairs of chosen boxes that none of their face directions separates:
    /// six of the axis-aligned boxes and, when both nodes have them, six of the
    /// oriented ones. Sets `sizes` when there are any.
    BoxPairs (*overlapping_boxes)(const BoxPlacement& placement, const NodeBoxes& a,
                                  const NodeBoxes& b, const BoxChoice& choice,
                                  BoxSizes& sizes) noexcept;

    /// The same; and by how much each pair overlaps along the direction where it
    /// overlaps least, of the oriented boxes when both nodes have them.
    BoxPairs (*overlap_depths)(const BoxPlacement& placement, const NodeBoxes& a,
                               const NodeBoxes& b, const BoxChoice& choice, BoxSizes& sizes,
                               BoxDepths& depths) noexcept;

    /// Finds the pairs of chosen boxes that may be at most reach.limit apart, and a
    /// lower bound of their distance: the length of the gaps along three directions at
    /// right angles, the best of A's, B's and those of the oriented boxes, and the gap
    /// along reach.direction.
    BoxPairs (*near_boxes)(const BoxPlacement& placement, const NodeBoxes& a, const NodeBoxes& b,
                           const BoxChoice& choice, const Reach& reach,
                           BoxPairFloats& gaps) noexcept;

    /// Finds the pairs of triangles of one pair of leaves that may be at most
    /// reach.limit apart. Returns their number; they stand in scratch.gap. A pair
    /// that touches has a lower bound of 0.
    std::size_t (*near_triangles)(const LeafPlacement& placement, const LeafPair& pair,
                                  const Reach& reach, LeafScratch& scratch) noexcept;

    /// The same among at most kLeafBatch pairs of leaves; and which of them are less than
    /// reach.certain apart for certain.
    std::size_t (*triangles_within)(const LeafPlacement& placement, const LeafPair* pairs,
                                    std::size_t count, const Reach& reach,
                                    LeafScratch& scratch) noexcept;

    /// Finds the pairs of triangles, among at most kLeafBatch pairs of leaves,
    /// that cross or whose contact rounding may hide. Returns their number; they
    /// stand in scratch.found.
    std::size_t (*find_contacts)(const LeafPlacement& placement, const LeafPair* pairs,
                                 std::size_t count, LeafScratch& scratch) noexcept;

    /// The same for leaves of one tree against each other, of triangles without a common
    /// vertex; of a leaf against itself those with a < b. `corners` has the numbers of the
    /// triangles' vertices, [leaf][corner][lane]; LeafPair has the numbers of leaves.
    std::size_t (*find_own_contacts)(const LeafPlacement& placement, const LeafPair* pairs,
                                     std::size_t count, const std::uint32_t* corners,
                                     LeafScratch& scratch) noexcept;

    /// Works out for a node of B what cells_met() wants of it. The slack is to cover the
    /// rounding of both.
    void (*place_among_cells)(const BoxPlacement& placement, const NodeBoxes& b,
                              BoxesAmongCells& placed) noexcept;

    /// Finds for each of eight cells which of B's boxes among `of_b`, a bit set, neither A's
    /// axes nor the box's own separate from it.
    void (*cells_met)(const BoxesAmongCells& b, const OctantPlanes& cells, unsigned of_b,
                      std::uint8_t* met) noexcept;

    /// The tests of nodes that both have swept spheres, by format::SweptKind.
    BoundTests swept[3];

    /// The number of the point that is farthest along a direction, as far as double can
    /// tell; of several the lowest. `count` blocks, at least one, as format::HullBlock; no
    /// number is beyond double's range on the way. The same for every table, as is the next.
    std::uint32_t (*farthest)(const double* blocks, std::size_t count,
                              const double* direction) noexcept;

    /// The same of points as they are moved, and a proven bound.
    FarthestPoint (*farthest_moved)(const double* blocks, std::size_t count,
                                    const MovedDirection& from) noexcept;

    /// Finds the first `count` planes that no longer have a gap of more than `limit`, pair
    /// units, for certain. Returns how many there are; their numbers, rising, stand in `numbers`,
    /// beyond which sixteen more may be written.
    std::size_t (*weak_planes)(const BoxPlacement& placement, const PlaneRows& planes,
                               std::size_t count, float limit, std::uint16_t* numbers) noexcept;
};

extern const Table kScalar;  ///< the reference, for any processor
#ifdef CDPREP_HAVE_AVX2
extern const Table kAvx2;    ///< call through it only if available() lists it
extern const Table kAvx512;  ///< likewise
#endif

/// The tables that this processor can run, the reference first.
struct Available {
    const Table* table[3];
    std::size_t count;
};
[[nodiscard]] Available available() noexcept;

/// The table that queries use: the last available one, or the one that the
/// environment variable CDPREP_KERNELS names when the process first asks.
[[nodiscard]] const Table& active() noexcept;

}  // namespace cdprep::kernels
