// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "cdprep/format/hull.h"
#include "unit/lib/kernels/inputs.h"

/// Hashes of what the kernels of a table answer. Tables that round alike have the same.
namespace cdprep::kernels {

/// A hash of numbers, FNV-1a over words.
class BitHash {
public:
    template <class Number>
    void add(Number number) noexcept {
        std::uint64_t word = 0;
        std::memcpy(&word, &number, sizeof number);
        hash_ = (hash_ ^ word) * 0x100000001b3U;
        others_than_zero_ += word != 0 ? 1 : 0;
    }
    template <class Numbers>
    void add_all(const Numbers& numbers) noexcept {
        for (const auto number : numbers) add(number);
    }
    [[nodiscard]] std::uint64_t value() const noexcept {
        return hash_;
    }
    [[nodiscard]] std::size_t others_than_zero() const noexcept {
        return others_than_zero_;
    }

private:
    std::uint64_t hash_ = 0xcbf29ce484222325U;
    std::size_t others_than_zero_ = 0;
};

/// The answers of each kernel.
using Hashes = std::map<std::string, BitHash>;

/// Numbers and poses from whole numbers, so that no mathematical library decides their bits.
class Draws {
public:
    explicit Draws(std::uint32_t seed) : random_(seed) {}

    std::mt19937& random() {
        return random_;
    }
    /// Nearly from -1 to 1.
    double fraction() {
        return whole() / 1024;
    }
    float single() {
        return static_cast<float>(fraction());
    }
    /// From 0 to `most`, rounded.
    float size(float most) {
        return std::fabs(single()) * most;
    }
    Pose pose() {
        const std::array<double, 4> q = {whole() + 1001, whole(), whole(), whole()};
        const double x = fraction(), y = fraction(), z = fraction();
        const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
        return Pose::from_quaternion(q[0] / length, q[1] / length, q[2] / length, q[3] / length,
                                     {x, y, z})
            .value();
    }

private:
    double whole() {
        return static_cast<double>(static_cast<int>(random_() % 2001) - 1000);
    }

    std::mt19937 random_;
};

/// The boxes of a node with every bound around them.
struct BoundedNode {
    Node boxes;
    OrientedNode oriented{};
    std::array<SweptNode, 3> swept{};  ///< by format::SweptKind

    explicit BoundedNode(Draws& draws) : boxes(random_node(draws.random())) {
        for (std::size_t box = 0; box < kLanes; ++box) {
            const Pose pose = draws.pose();
            for (std::size_t i = 0; i < 3; ++i) {
                const float place = draws.single();
                oriented[48 + 8 * i + box] = place;
                oriented[72 + 8 * i + box] = draws.size(0.5F);
                for (std::size_t k = 0; k < 2; ++k) {
                    const auto axis = static_cast<float>(pose.rotation()[3 * k + i]);
                    oriented[24 * k + 8 * i + box] = axis;
                    for (SweptNode& node : swept) node[32 * (k + 1) + 8 * i + box] = axis;
                }
                for (SweptNode& node : swept) node[8 * i + box] = place / 2;
            }
            for (std::size_t kind = 0; kind < swept.size(); ++kind) {
                swept[kind][24 + box] = draws.size(0.5F);
                for (std::size_t k = 0; k < kind; ++k) {
                    swept[kind][32 * (k + 1) + 24 + box] = draws.size(0.5F);
                }
            }
        }
    }
};

inline void add_pairs(BoxPairs found, const BoxPairFloats& values, BitHash& hash) {
    hash.add(found);
    for (std::size_t j = 0; j < kLanes; ++j) {
        for (std::size_t i = 0; i < kLanes; ++i) {
            if (has(found, i, j)) hash.add(values.value[j][i]);
        }
    }
}

inline void ask_bounds(const std::string& name, const BoundTests& tests,
                       const BoxPlacement& placement, const NodeBoxes& a, const NodeBoxes& b,
                       const BoxChoice& choice, Hashes& hashes) {
    BoxSizes sizes{};
    BoxDepths depths{};
    BoxPairFloats gaps{};
    BitHash& overlapping = hashes["overlapping " + name];
    const BoxPairs found = tests.overlapping(placement, a, b, choice, sizes);
    overlapping.add(found);
    if (found != 0) overlapping.add_all(sizes.a);
    if (found != 0) overlapping.add_all(sizes.b);
    BitHash& deep = hashes["depths of " + name];
    const BoxPairs overlap = tests.depths(placement, a, b, choice, sizes, depths);
    add_pairs(overlap, depths, deep);
    if (overlap != 0) deep.add(depths.deepest);
    const Reach reach{1, 0.1F, {0.6F, 0, 0.8F}, {0, 0.6F, 0.8F}};
    add_pairs(tests.near(placement, a, b, choice, reach, gaps), gaps, hashes["near " + name]);
}

inline void ask_boxes(const Table& table, Draws& draws, Hashes& hashes) {
    const BoxPlacement placement = placement_of(draws.pose(), 1e-5F);
    const BoundedNode a(draws), b(draws);
    const BoundTests boxes = {table.overlapping_boxes, table.overlap_depths, table.near_boxes,
                              false};
    const auto one = static_cast<std::uint8_t>(1U << draws.random()() % kLanes);
    for (const BoxChoice& choice :
         {BoxChoice{0xff, 0xff, nullptr}, BoxChoice{0xff, one, nullptr}}) {
        ask_bounds("boxes", boxes, placement, {a.boxes.data(), nullptr}, {b.boxes.data(), nullptr},
                   choice, hashes);
        ask_bounds("boxes", boxes, placement, {a.boxes.data(), a.oriented.data()},
                   {b.boxes.data(), b.oriented.data()}, choice, hashes);
        for (std::size_t kind = 0; kind < a.swept.size(); ++kind) {
            ask_bounds("swept " + std::to_string(kind), table.swept[kind], placement,
                       {a.boxes.data(), nullptr, a.swept[kind].data()},
                       {b.boxes.data(), nullptr, b.swept[kind].data()}, choice, hashes);
        }
    }
}

inline void ask_leaves(const Table& table, Draws& draws, LeafScratch& scratch, Hashes& hashes) {
    const LeafPlacement placement = leaf_placement(draws.pose());
    const bool is_coarse = draws.random()() % 2 == 0;
    const Leaf a = random_leaf(draws.random(), is_coarse);
    const Leaf b = random_leaf(draws.random(), is_coarse);
    const std::array<LeafPair, 2> pairs = {LeafPair{a.data(), b.data(), 0, 0, 0xff, 0xff},
                                           {b.data(), a.data(), 1, 1, 0xff, 0xff}};
    const auto add_contacts = [&](std::size_t count, BitHash& hash) {
        hash.add(count);
        for (std::size_t i = 0; i < count; ++i) {
            const TriangleContactLanes& found = scratch.found[i];
            hash.add_all(std::array<unsigned, 4>{found.pair, found.a, found.b, found.certain});
        }
    };
    const auto add_gaps = [&](std::size_t count, bool is_proven, BitHash& hash) {
        hash.add(count);
        for (std::size_t i = 0; i < count; ++i) {
            const TriangleGap& gap = scratch.gap[i];
            hash.add(gap.lower);
            hash.add_all(std::array<unsigned, 3>{gap.pair, gap.a, gap.b});
            if (is_proven) hash.add(gap.certain);
        }
    };
    scratch.begin();
    add_contacts(table.find_contacts(placement, pairs.data(), pairs.size(), scratch),
                 hashes["find_contacts"]);
    const Reach reach{0.5F, 0.1F, {0, 0, 0}, {0, 0, 0}};
    add_gaps(table.near_triangles(placement, pairs[0], reach, scratch), false,
             hashes["near_triangles"]);
    add_gaps(table.triangles_within(placement, pairs.data(), pairs.size(), reach, scratch), true,
             hashes["triangles_within"]);
    // Of one tree: two leaves, and one of them against itself.
    const std::array<LeafPair, 2> own = {LeafPair{a.data(), b.data(), 0, 1, 0xff, 0xff},
                                         {a.data(), a.data(), 0, 0, 0xff, 0xff}};
    std::array<std::uint32_t, 48> corners;
    for (std::uint32_t& number : corners) number = draws.random()() % 60;
    const std::array<CornerNumbers, 2> numbers = {CornerNumbers{&corners[0], &corners[24]},
                                                  {&corners[0], &corners[0]}};
    scratch.begin();
    add_contacts(table.find_own_contacts(leaf_placement(Pose()), own.data(), own.size(),
                                         numbers.data(), scratch),
                 hashes["find_own_contacts"]);
}

inline void ask_cells(const Table& table, Draws& draws, Hashes& hashes) {
    const BoxPlacement placement = placement_of(draws.pose(), 1e-5F);
    const BoundedNode b(draws);
    OctantPlanes cells{};
    cells.half = std::ldexp(0.5F, -static_cast<int>(draws.random()() % 4));
    for (auto& planes : cells.plane) {
        planes[0] = draws.single() - cells.half;
        for (std::size_t k = 1; k < 3; ++k) planes[k] = planes[k - 1] + 2 * cells.half;
    }
    for (const float* oriented : {static_cast<const float*>(nullptr), b.oriented.data()}) {
        BoxesAmongCells placed{};
        table.place_among_cells(placement, {b.boxes.data(), oriented}, placed);
        BitHash& places = hashes["place_among_cells"];
        for (const auto* rows : {&placed.lower, &placed.upper, &placed.axis[0], &placed.axis[1],
                                 &placed.axis[2], &placed.middle, &placed.half}) {
            for (const auto& row : *rows) places.add_all(row);
        }
        std::array<std::uint8_t, kLanes> met{};
        table.cells_met(placed, cells, 0xff, met.data());
        hashes["cells_met"].add_all(met);
    }
}

inline void ask_points(const Table& table, Draws& draws, Hashes& hashes) {
    std::array<format::HullBlock, 5> blocks;
    for (format::HullBlock& block : blocks) {
        for (auto& row : block.at) {
            for (double& x : row) {
                x = draws.fraction();
                x += x * draws.fraction() / 4;
            }
        }
    }
    blocks.back() = blocks.front();  // of points as far as each other, the lowest counts
    const Pose pose = draws.pose();
    const Double3& t = pose.translation();
    MovedDirection from{{}, {t.x, t.y, t.z}, {}, {}};
    std::copy_n(pose.rotation().data(), 9, from.rotation);
    for (std::size_t i = 0; i < 3; ++i) {
        from.origin[i] = draws.fraction();
        from.direction[i] = draws.fraction();
    }
    const double* first = blocks[0].at[0].data();
    hashes["farthest"].add(table.farthest(first, blocks.size(), from.direction));
    const FarthestPoint moved = table.farthest_moved(first, blocks.size(), from);
    BitHash& hash = hashes["farthest_moved"];
    hash.add(moved.number);
    hash.add(moved.value);
    hash.add(moved.bound);
}

inline void ask_ways(const Table& table, Draws& draws, Hashes& hashes) {
    std::array<double, 3 * kLanes> normals;
    std::array<double, 15> points;
    const auto number = [&] {  // whose products are rounded
        const double x = draws.fraction();
        return x + x * draws.fraction() / 4;
    };
    for (double& x : normals) x = number();
    for (double& x : points) x = number();
    std::array<double, kLanes> reaches;
    table.reaches(normals.data(), 1, points.data(), points.size() / 3, reaches.data());
    hashes["reaches"].add_all(reaches);
    EdgeLanes edges;
    OneEdge edge;
    for (std::size_t i = 0; i < 3; ++i) {
        for (auto* vector : {edge.along, edge.left, edge.right}) vector[i] = number();
        for (auto* rows : {edges.along, edges.left, edges.right}) {
            for (double& x : rows[i]) x = number();
        }
    }
    edge.length = std::fabs(number());
    for (double& length : edges.length) length = std::fabs(number());
    std::uint8_t across = 0;
    table.edges_across(&edges, 1, edge, 0.75, &across);
    hashes["edges_across"].add(across);
}

inline void ask_planes(const Table& table, Draws& draws, Hashes& hashes) {
    constexpr std::size_t kStride = 48, kCount = 43;
    const Pose pose = draws.pose();
    const auto& r = pose.rotation();
    std::vector<float> rows(11 * kStride, 0.0F);
    for (std::size_t plane = 0; plane < kCount; ++plane) {
        const Pose turned = draws.pose();
        const auto& n = turned.rotation();  // its first row
        for (std::size_t i = 0; i < 3; ++i) {
            const double along_b = r[i] * n[0] + r[3 + i] * n[1] + r[6 + i] * n[2];
            rows[i * kStride + plane] = static_cast<float>(n[i] * (1 - 0x1p-20));
            rows[(3 + i) * kStride + plane] =
                static_cast<float>(along_b * (1 - 0x1p-20)) + draws.single() / 64;
            rows[(6 + i) * kStride + plane] = draws.single();
        }
        rows[9 * kStride + plane] = draws.single();
        rows[10 * kStride + plane] = draws.size(1);
    }
    std::array<std::uint16_t, kStride + 16> numbers;
    const std::size_t count = table.weak_planes(placement_of(pose, 1e-5F), {rows.data(), kStride},
                                                kCount, 0.125F, numbers.data());
    hashes["weak_planes"].add(count);
    for (std::size_t i = 0; i < count; ++i) hashes["weak_planes"].add(numbers[i]);
}

/// Boxes in the world, a tree over them, and larger boxes around most of them.
struct WorldBoxes {
    static constexpr std::size_t kCount = kLanes * kLanes;
    std::array<float, kCount * kPaddedBox> padded{}, around{};
    std::array<float, kLanes * kBoxNode> low{};
    std::array<float, kBoxNode> high{};

    explicit WorldBoxes(Draws& draws) {
        for (std::size_t box = 0; box < kCount; ++box) {
            const std::size_t node = box / kLanes, lane = box % kLanes;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const float lower = draws.single(), upper = lower + draws.size(1);
                const std::size_t at = axis * kLanes + lane, to = axis * kLanes + node;
                padded[box * kPaddedBox + axis] = low[node * kBoxNode + at] = lower;
                padded[box * kPaddedBox + kPaddedUpper + axis] =
                    low[node * kBoxNode + 3 * kLanes + at] = upper;
                around[box * kPaddedBox + axis] = lower - draws.single() - 0.75F;
                around[box * kPaddedBox + kPaddedUpper + axis] = upper + draws.single() + 0.75F;
                high[to] = lane == 0 ? lower : std::min(high[to], lower);
                float& most = high[3 * kLanes + to];
                most = lane == 0 ? upper : std::max(most, upper);
            }
        }
    }
};

inline void ask_world(const Table& table, Draws& draws, Hashes& hashes) {
    const WorldBoxes boxes(draws);
    const BoxTree tree{{boxes.low.data(), boxes.high.data()}, 2};
    std::array<std::uint32_t, WorldBoxes::kCount> numbers;
    const auto add_numbers = [&](std::size_t count, BitHash& hash) {
        hash.add(count);
        for (std::size_t i = 0; i < count; ++i) hash.add(numbers[i]);
    };
    const float* asked = &boxes.padded[draws.random()() % WorldBoxes::kCount * kPaddedBox];
    add_numbers(table.met_boxes(tree, asked, 0, draws.random()() % 8, numbers.data()),
                hashes["met_boxes"]);
    std::vector<float> given, stored(boxes.around.begin(), boxes.around.end());
    std::vector<float> previous(stored.size());
    for (std::size_t i = 0; i < boxes.padded.size(); ++i) {
        if (i % kPaddedUpper != 3) given.push_back(boxes.padded[i]);
    }
    std::vector<std::uint8_t> escaped(WorldBoxes::kCount);
    std::array<std::uint32_t, WorldBoxes::kCount + 1> left;
    const std::size_t left_count = table.store_boxes(
        {given.data(), stored.data(), previous.data(), boxes.around.data(), escaped.data()},
        nullptr, WorldBoxes::kCount, left.data());
    hashes["store_boxes"].add(left_count);
    for (std::size_t i = 0; i < left_count; ++i) hashes["store_boxes"].add(left[i]);
    for (const float number : stored) hashes["store_boxes"].add(number);
    hashes["meeting_boxes"].add(
        table.meeting_boxes(boxes.low.data(), &boxes.low[kBoxNode], &boxes.high[1]));
    std::array<std::uint32_t, WorldBoxes::kCount> pairs;
    for (std::uint32_t& number : pairs) number = draws.random()() % WorldBoxes::kCount;
    const std::size_t count =
        table.meeting_pairs(boxes.padded.data(), pairs.data(), pairs.size() / 2, numbers.data());
    add_numbers(2 * count, hashes["meeting_pairs"]);
}

inline void ask_leaf(const Table& table, Draws& draws, Hashes& hashes) {
    std::array<float, 3 * 24> positions;
    for (float& x : positions) x = draws.single();
    std::array<std::uint32_t, 3 * kLanes> vertices;
    for (std::uint32_t& vertex : vertices) vertex = draws.random()() % 24;
    LeafMap map{{}, {0.5, 0.5}, {2, 2}};
    for (std::size_t i = 0; i < 3; ++i) {
        map.origin[i] = map.origin[kPaddedUpper + i] = draws.fraction() / 8;
    }
    std::array<float, kLeafHalf + 3> leaf;
    std::array<float, kPaddedBox> box;
    hashes["fill_leaf"].add(
        table.fill_leaf(map, positions.data(), vertices.data(), leaf.data(), box.data()));
    hashes["fill_leaf"].add_all(leaf);
    hashes["fill_leaf"].add_all(box);
}

/// The name of a table and the marks of its three kinds of swept spheres are no kernels.
inline constexpr std::size_t kKernels = sizeof(Table) / sizeof(void*) - 1 - 3;

/// Asks every kernel of a table a thousand times.
inline Hashes hashes_of(const Table& table) {
    Draws draws(8), leaf_draws(9), way_draws(10);
    Hashes hashes;
    const auto scratch = std::make_unique<LeafScratch>();
    for (int round = 0; round < 1000; ++round) {
        ask_boxes(table, draws, hashes);
        ask_leaves(table, draws, *scratch, hashes);
        ask_cells(table, draws, hashes);
        ask_points(table, draws, hashes);
        ask_planes(table, draws, hashes);
        ask_world(table, draws, hashes);
        ask_leaf(table, leaf_draws, hashes);
        ask_ways(table, way_draws, hashes);
    }
    return hashes;
}

/// Fewer numbers than this that are not 0 prove nothing about a kernel.
inline constexpr std::size_t kLeastAnswers = 900;

}  // namespace cdprep::kernels
