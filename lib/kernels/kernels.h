// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "cdprep/format/api.h"
#include "cdprep/format/portable.h"

/// The innermost loops, once per instruction set.
///
/// A kernel takes raw arrays and returns plain numbers. It does not know Model, allocates nothing
/// and never fails. Its undecided cases may differ between instruction sets: one rounds a product
/// and a sum at once, another one after the other. So a kernel decides only with a proven margin,
/// and the answers of the queries are the same for every table.
///
/// A kernel source includes this header, the vendor's intrinsics, <cassert> and portable.h. It also
/// includes the bodies that all share (box_overlap.h, cells_met.h, leaf_contacts.h, ...), and what
/// some share (avx_rows.h, set_bits.h). The bodies are in an unnamed namespace. A compiler could
/// emit an inline function with external linkage with AVX2 inside, and the linker could keep that
/// copy for all callers.
namespace cdprep::kernels {

/// The relative placement of the boxes of two hierarchies. A box centre c of B lies at
/// rotation * (scale_b c) + shift in the frame of A's boxes, scaled by scale_a. One scale is 1, the
/// other at most 1.
struct BoxPlacement {
    float rotation[9];      ///< a_from_b, row by row
    float abs_rotation[9];  ///< its absolute values
    float shift[3];         ///< of B's frame origin, along A's axes
    float shift_in_b[3];    ///< the same vector along B's axes
    float scale_a;
    float scale_b;
    float slack;  ///< added to every sum of half extents; covers all rounding
    /// In pair units: boxes at most this far apart count as overlapping. Added once, however many
    /// slacks a test adds. Must be 0 where a test computes the distance of boxes. Must exceed the
    /// intended tolerance by 2^-18 of itself, because tests round it.
    float tolerance;
};

/// The boxes of one node: 48 floats, lower x, y, z, then upper x, y, z, eight each. Also, each or
/// null, its oriented boxes (96 floats, as format::OrientedNode) and its swept spheres (as
/// format::SweptNode).
struct NodeBoxes {
    const float* boxes;
    const float* oriented;
    const float* swept = nullptr;
};

/// The boxes of two nodes to test: bit sets, and, or null, the box around all of A's. That is a
/// pointer to its lower x in a node; the others follow at the strides of a node.
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

/// Returns the boxes of A that have a partner, as a bit set.
[[maybe_unused]] constexpr unsigned boxes_of_a(BoxPairs pairs) noexcept {
    pairs |= pairs >> 32;
    pairs |= pairs >> 16;
    pairs |= pairs >> 8;
    return static_cast<unsigned>(pairs & 0xff);
}

/// Returns the boxes of B that have a partner, as a bit set. Each non-zero byte leaves its highest
/// bit, and a product gathers those.
[[maybe_unused]] constexpr unsigned boxes_of_b(BoxPairs pairs) noexcept {
    constexpr BoxPairs kLow = 0x7f7f7f7f7f7f7f7f;
    const BoxPairs some = (((pairs & kLow) + kLow) | pairs) & ~kLow;
    return static_cast<unsigned>(((some >> 7) * 0x0102040810204080) >> 56);
}

}  // namespace

/// Half the sum of each box's edges, in pair units; decides which node to open next.
struct BoxSizes {
    alignas(32) float a[kLanes];
    alignas(32) float b[kLanes];
};

/// A number for each pair of boxes; set only for the pairs found.
struct BoxPairFloats {
    alignas(32) float value[kLanes][kLanes];  ///< [of B][of A], pair units
};

/// The overlap of each pair of boxes, and the bit of the deepest pair. Depths that differ by less
/// than 2^-17 of themselves may be confused.
struct BoxDepths : BoxPairFloats {
    unsigned deepest;  ///< among the pairs found, if there are any
};

/// A leaf is 78 floats: corners as in format::BvhLeaf, its origin, and the half extents of the box
/// around it.
inline constexpr std::size_t kLeafOrigin = 72;
inline constexpr std::size_t kLeafHalf = 75;

/// A leaf of A and a leaf of B.
struct LeafPair {
    const float* a;
    const float* b;
    std::uint32_t number_a;  ///< identifies the leaf among those of its model
    std::uint32_t number_b;
    std::uint8_t used_a;  ///< bit set of triangles
    std::uint8_t used_b;
};

/// The numbers of the vertices of two leaves of one tree: [corner][lane].
struct CornerNumbers {
    const std::uint32_t* a;
    const std::uint32_t* b;
};

/// The meaning of the stored coordinates of one model's leaves. A leaf's middle m is at
/// (origin - frame_origin) * scale in pair units. Its corners are at m plus
/// (corner - middle) * scale. Here middle is the leaf's origin or, for corners that are stored
/// relative to it, 0.
struct LeafFrame {
    double frame_origin[3];
    double scale;
    float box_scale;     ///< from half extents to pair units
    float takes_origin;  ///< 1 or 0: middle = takes_origin * origin
};

/// The map from B's leaves to A's: rotation * b + shift, in pair units.
struct LeafPlacement {
    LeafFrame a;
    LeafFrame b;
    double rotation[9];
    double shift[3];
    float corner_rotation[9];  ///< rotation times b.scale
    float error;               ///< largest relative error of corners before any rounding here
};

/// The prior knowledge of a search for the nearest pair.
struct Reach {
    float limit;    ///< pair units: nothing farther apart is of interest
    float certain;  ///< pair units: triangles nearer than this need no other proof
    /// From A to B along A's axes, shorter than 1. The better it points along the shortest way, the
    /// more it excludes. 0, 0, 0 excludes nothing.
    float direction[3];
    float direction_in_b[3];  ///< the same along B's axes
};

/// A lower bound of the distance of two triangles.
struct TriangleGap {
    float lower;        ///< pair units
    std::uint8_t pair;  ///< index of the LeafPair
    std::uint8_t a;     ///< lane
    std::uint8_t b;     ///< lane
    bool certain;       ///< proven to be less than Reach::certain apart; otherwise not known
};

/// A pair of triangles that is not certainly disjoint.
struct TriangleContactLanes {
    std::uint8_t pair;  ///< index of the LeafPair
    std::uint8_t a;     ///< lane
    std::uint8_t b;     ///< lane
    bool certain;       ///< they cross; otherwise the kernel cannot decide
};

/// A leaf along A's axes, relative to its own middle, as the tests of its triangles use it. The
/// same for all leaves of the other model.
struct PlacedLeaf {
    static constexpr std::size_t kRows = 20;
    alignas(64) float row[kRows][kLanes];
};

/// The leaves of one model that are already placed, by number modulo kLeafPlaces.
struct PlacedLeaves {
    PlacedLeaf leaf[kLeafPlaces];
    double middle[kLeafPlaces][3];          ///< pair units; for B's leaves only
    std::uint64_t holds[kLeafPlaces] = {};  ///< the query, shifted by 32, and the number
};

/// The working memory and the results of the leaf kernels. Members without an initial value require
/// none.
struct LeafScratch {
    PlacedLeaves a;
    PlacedLeaves b;
    alignas(64) float shift[4][kLeafBatch];         ///< from A's corners to B's, and the error
    alignas(64) std::int32_t place[2][kLeafBatch];  ///< of A's and of B's leaf, in floats
    std::uint64_t question = 0;                     ///< begin() gives each query its own number
    TriangleGap gap[kLeafBatch * kLanes * kLanes];
    std::uint16_t candidate[kLeafBatch * kLanes * kLanes + 2 * kLanes];  ///< room for full stores
    TriangleContactLanes found[kLeafBatch * kLanes * kLanes];

    /// Must be called before the first leaves of another placement or other models.
    void begin() noexcept {
        constexpr std::uint64_t kQuestions = std::uint64_t{1} << 32;
        if (++question < kQuestions) return;
        question = 1;
        for (std::uint64_t& number : a.holds) number = 0;
        for (std::uint64_t& number : b.holds) number = 0;
    }
};

/// The boxes of a node of B along A's axes, in pair units, for tests against many cells of A: eight
/// a row.
struct BoxesAmongCells {
    alignas(64) float lower[3][kLanes];  ///< along A's axes, with the slack
    alignas(64) float upper[3][kLanes];
    alignas(64) float axis[3][3][kLanes];  ///< of the oriented boxes; [axis][component]
    alignas(64) float middle[3][kLanes];   ///< their centres along those axes
    alignas(64) float half[3][kLanes];     ///< and half extents, with the slack
};

/// The planes that bound eight cells of A, two cells along each axis, in pair units. Cell i is
/// above the middle plane along x if bit 0 of i is set; bits 1 and 2 serve y and z.
struct OctantPlanes {
    float plane[3][3];  ///< [axis], rising
    float half;         ///< half the edge of a cell
};

/// The tests of two nodes' boxes by the bounds of their children.
struct BoundTests {
    /// As Table::overlapping_boxes. With swept spheres, tests the six face directions of the
    /// axis-aligned boxes and the directions of the spheres. Returns the pairs that none of these
    /// separates. The directions of the spheres are that between nearest points and, for
    /// rectangles, the face directions. If B has one chosen box, tests only those of the spheres.
    BoxPairs (*overlapping)(const BoxPlacement& placement, const NodeBoxes& a, const NodeBoxes& b,
                            const BoxChoice& choice, BoxSizes& sizes) noexcept;

    /// As above, with depths as in Table::overlap_depths. With swept spheres, the depths are those
    /// of the axis-aligned boxes.
    BoxPairs (*depths)(const BoxPlacement& placement, const NodeBoxes& a, const NodeBoxes& b,
                       const BoxChoice& choice, BoxSizes& sizes, BoxDepths& depths) noexcept;

    /// As Table::near_boxes.
    BoxPairs (*near)(const BoxPlacement& placement, const NodeBoxes& a, const NodeBoxes& b,
                     const BoxChoice& choice, const Reach& reach, BoxPairFloats& gaps) noexcept;

    bool reads_swept;  ///< NodeBoxes::swept must be there
};

/// The motion of points under test. They move to rotation * p + translation, as
/// cdprep::transform_point() does; their value is the position along `direction` from `origin`.
struct MovedDirection {
    double rotation[9];
    double translation[3];
    double origin[3];
    double direction[3];
};

/// The point that is farthest along a direction; of several, the lowest number.
struct FarthestPoint {
    std::uint32_t number;
    double value;  ///< its position along the direction, rounded
    double bound;  ///< no point is farther: covers rounding, not underflow
};

/// Planes between places: rows of numbers, `stride` from row to row, which is a multiple of
/// sixteen. Rows 0 to 2 hold a plane's direction n from A to B, at most 1 long, along A's axes.
/// Rows 3 to 5 hold that direction along B's axes when the plane was set. Rows 6 to 8 hold a middle
/// of B's place. Row 9 holds the gap along n without B's shift. Row 10 holds the reach of B's place
/// from its middle. Pair units.
struct PlaneRows {
    const float* first;
    std::size_t stride;
};

/// An edge of a convex polytope. `left` and `right` lead from its start to a corner of each
/// adjacent face.
struct OneEdge {
    double along[3];
    double left[3];
    double right[3];
    double length;
};
/// Eight of them, by lanes.
struct EdgeLanes {
    double along[3][kLanes];
    double left[3][kLanes];
    double right[3][kLanes];
    double length[kLanes];
};

/// A box in world coordinates is padded to eight floats: lower x, y, z, 0, upper x, y, z, 0.
/// Eight boxes of a tree are a node of 48: lower x, y, z, upper x, y, z, eight each. An absent box
/// has lower > upper along each axis and meets none.
inline constexpr std::size_t kPaddedBox = 8;
inline constexpr std::size_t kPaddedUpper = 4;
inline constexpr float kFarthest = static_cast<float>(format::kInfinity);
/// The padded box that meets no other one.
inline constexpr float kAbsentBox[kPaddedBox] = {kFarthest,  kFarthest,  kFarthest,  0,
                                                 -kFarthest, -kFarthest, -kFarthest, 0};

/// The map from model coordinates to those of a tree's frame: (x - origin) scale[0] scale[1].
struct LeafMap {
    double origin[kPaddedBox];  ///< x, y, z, 0, and the same again
    double scale[2];
    double back[2];  ///< their inverses, whose product inverts the map of a difference
};

/// Boxes as a caller gives them, and what is kept of them. Arrays by the number of the box.
struct BoxStore {
    const float* given;     ///< lower x, y, z, upper x, y, z; none is NaN
    float* boxes;           ///< padded
    float* previous;        ///< padded: those in `boxes` before
    const float* around;    ///< padded: larger boxes
    std::uint8_t* escaped;  ///< 1: a box is not inside its larger box
};
inline constexpr std::size_t kBoxNode = 6 * kLanes;
inline constexpr unsigned kMostBoxLevels = 11;  ///< for 2^32 boxes

/// A tree of world boxes without links. Node i of level 0 holds the boxes 8 i to 8 i + 7. Lane j of
/// node i of another level is the box around node 8 i + j of the level below. Lanes without one are
/// absent. The last level has one node.
struct BoxTree {
    const float* level[kMostBoxLevels];
    unsigned levels;
};

/// One instruction set's kernels.
struct Table {
    const char* name;  ///< "scalar", "avx2", "neon" and so on: shown in tests

    /// Returns the pairs of chosen boxes that none of their face directions separates. These
    /// directions are six of the axis-aligned boxes and, if both nodes have oriented boxes, six of
    /// those. If B has one chosen box and both have oriented boxes, tests only those. Sets `sizes`
    /// if there are any.
    BoxPairs (*overlapping_boxes)(const BoxPlacement& placement, const NodeBoxes& a,
                                  const NodeBoxes& b, const BoxChoice& choice,
                                  BoxSizes& sizes) noexcept;

    /// As above; also computes the overlap of each pair along the direction of least overlap. Uses
    /// the oriented boxes if both nodes have them.
    BoxPairs (*overlap_depths)(const BoxPlacement& placement, const NodeBoxes& a,
                               const NodeBoxes& b, const BoxChoice& choice, BoxSizes& sizes,
                               BoxDepths& depths) noexcept;

    /// Returns the pairs of chosen boxes that may be at most reach.limit apart, and a lower bound
    /// of their distance. The bound is the greatest of several. One is the gap along
    /// reach.direction. Each of the others is the length of the gaps along three directions at
    /// right angles. These directions are A's, B's and those of the oriented boxes.
    BoxPairs (*near_boxes)(const BoxPlacement& placement, const NodeBoxes& a, const NodeBoxes& b,
                           const BoxChoice& choice, const Reach& reach,
                           BoxPairFloats& gaps) noexcept;

    /// Finds the pairs of triangles of one pair of leaves that may be at most reach.limit apart.
    /// Returns their number and stores them in scratch.gap. The lower bound of a pair that touches
    /// is 0.
    std::size_t (*near_triangles)(const LeafPlacement& placement, const LeafPair& pair,
                                  const Reach& reach, LeafScratch& scratch) noexcept;

    /// As above, for at most kLeafBatch pairs of leaves. Also marks the pairs that are certainly
    /// less than reach.certain apart.
    std::size_t (*triangles_within)(const LeafPlacement& placement, const LeafPair* pairs,
                                    std::size_t count, const Reach& reach,
                                    LeafScratch& scratch) noexcept;

    /// Finds the pairs of triangles, among at most kLeafBatch pairs of leaves, that cross or whose
    /// contact rounding may hide. Returns their number and stores them in scratch.found.
    std::size_t (*find_contacts)(const LeafPlacement& placement, const LeafPair* pairs,
                                 std::size_t count, LeafScratch& scratch) noexcept;

    /// As above, for leaves of one tree against each other and triangles without a common vertex.
    /// For a leaf against itself, finds pairs with a < b. `corners` has an element for each pair.
    std::size_t (*find_own_contacts)(const LeafPlacement& placement, const LeafPair* pairs,
                                     std::size_t count, const CornerNumbers* corners,
                                     LeafScratch& scratch) noexcept;

    /// Prepares a node of B for cells_met(). The slack must cover the rounding of both functions.
    void (*place_among_cells)(const BoxPlacement& placement, const NodeBoxes& b,
                              BoxesAmongCells& placed) noexcept;

    /// Finds, for each of eight cells, the boxes of B among `of_b` that neither A's axes nor the
    /// box's own axes separate from it. `of_b` and the eight results are bit sets.
    void (*cells_met)(const BoxesAmongCells& b, const OctantPlanes& cells, unsigned of_b,
                      std::uint8_t* met) noexcept;

    /// The tests of nodes that both have swept spheres, by format::SweptKind.
    BoundTests swept[3];

    /// Returns the number of the point that is farthest along a direction, as computed in double;
    /// of several, the lowest. Takes `count` blocks, at least one, as format::HullBlock. No
    /// intermediate number may exceed the range of double. This and the next are the same for every
    /// table.
    std::uint32_t (*farthest)(const double* blocks, std::size_t count,
                              const double* direction) noexcept;

    /// As above for points as they are moved, with a proven bound.
    FarthestPoint (*farthest_moved)(const double* blocks, std::size_t count,
                                    const MovedDirection& from) noexcept;

    /// Computes how far points reach along directions: the largest scalar product of each. Takes
    /// `blocks` blocks of eight directions, as format::HullBlock, and at least one point, three
    /// numbers each. Stores eight numbers a block. This and the next are the same for every table.
    void (*reaches)(const double* directions, std::size_t blocks, const double* points,
                    std::size_t count, double* reaches) noexcept;

    /// Sets the bits of the edges that may, with `edge`, span a face of the difference of both
    /// polytopes. Clears a bit only if one corner of the adjacent faces is certainly above the
    /// plane of both edges, and another one below. A height is certain if it exceeds
    /// error_of_height times the product of both lengths. Heights of the other edge's corners are
    /// negated. Stores one byte for each block.
    void (*edges_across)(const EdgeLanes* edges, std::size_t blocks, const OneEdge& edge,
                         double error_of_height, std::uint8_t* across) noexcept;

    /// Finds, among the first `count` planes, those without a certain gap of more than `limit`,
    /// pair units. Returns their number; stores their numbers, rising, in `numbers`. May write
    /// sixteen more beyond them.
    std::size_t (*weak_planes)(const BoxPlacement& placement, const PlaneRows& planes,
                               std::size_t count, float limit, std::uint16_t* numbers) noexcept;

    /// Finds the boxes of one level of a tree that a padded box meets, from the number `first` on.
    /// Box 8 i + j is lane j of node i. Returns how many; stores their numbers, rising. This and
    /// the next three are the same for every table.
    std::size_t (*met_boxes)(const BoxTree& tree, const float* box, unsigned level,
                             std::uint32_t first, std::uint32_t* numbers) noexcept;

    /// Returns the boxes of two nodes that meet: bit 8 i + j for box i of A and box j of B.
    /// `around_b` is the lane of a node with the box around B's.
    BoxPairs (*meeting_boxes)(const float* a, const float* b, const float* around_b) noexcept;

    /// Copies the pairs of numbers whose padded boxes meet, in their order. Returns how many.
    /// `kept` has room for all, and may be `pairs`.
    std::size_t (*meeting_pairs)(const float* boxes, const std::uint32_t* pairs, std::size_t count,
                                 std::uint32_t* kept) noexcept;

    /// Stores the boxes with the given numbers, or the first `count` if `numbers` is null. Infinite
    /// coordinates become the largest float, or they would meet those of absent boxes. A box with
    /// lower > upper along an axis becomes kAbsentBox, which is inside every box. Returns how many
    /// escaped that had not before, and stores their numbers in the order of `numbers`. `escaped`
    /// has room for one more than all boxes.
    std::size_t (*store_boxes)(const BoxStore& store, const std::uint32_t* numbers,
                               std::size_t count, std::uint32_t* escaped) noexcept;

    /// Fills a leaf with eight triangles in model coordinates: 78 floats. `vertices` has three
    /// numbers a triangle; vertex v is at positions + 3 v. Stores the box around them in the frame,
    /// padded. All that is stored is the same for every table. Returns, as a bit set, the triangles
    /// whose corners are proven not to be collinear. Requires rounding to nearest, without
    /// flushing.
    unsigned (*fill_leaf)(const LeafMap& map, const float* positions, const std::uint32_t* vertices,
                          float* leaf, float* box) noexcept;
};

extern const Table kScalar;  ///< the reference, for any processor; WebAssembly leaves it out
#ifdef CDPREP_HAVE_AVX2
extern const Table kAvx2;    ///< call through it only if available() lists it
extern const Table kAvx512;  ///< likewise
#endif
#ifdef CDPREP_HAVE_NEON
extern const Table kNeon;  ///< which every ARM64 processor can run
#endif
#ifdef CDPREP_HAVE_SIMD128
extern const Table kSimd128;  ///< the only one of WebAssembly, where each byte is downloaded
#endif

/// The tables that this processor can run, the reference first.
struct Available {
    const Table* table[3];
    std::size_t count;
};
[[nodiscard]] Available available() noexcept;

/// Returns the table that queries use. It is the one that the environment variable CDPREP_KERNELS
/// names at the first call of the process. Otherwise it is the last available one.
[[nodiscard]] CDPREP_API const Table& active() noexcept;

}  // namespace cdprep::kernels
