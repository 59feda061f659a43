// SPDX-License-Identifier: MIT
// A leaf from the kernel has the bits of one that is made in double precision. So have the leaves
// of a tree that are made of floats.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "build/frame_map.h"
#include "build/make_leaves.h"
#include "cdprep/advanced/parallel_for.h"
#include "exact/triangle_contact.h"
#include "unit/lib/kernels/each_table.h"

namespace cdprep::kernels {
namespace {

using build::Frame;
using format::BvhLeaf;
using format::BvhNode;
using format::Double3;
using format::Float3;
using format::Triangle;

/// Eight triangles over a few vertices.
struct Mesh {
    std::vector<Float3> positions;
    std::array<Triangle, kLanes> triangles;
};

/// A leaf, the box around it and the triangles that are degenerate.
struct Made {
    BvhLeaf leaf;
    std::array<float, 6> box;
    unsigned degenerate;

    /// Distinguishes zeros of different sign.
    [[nodiscard]] std::array<std::uint32_t, 85> bits() const {
        std::array<std::uint32_t, 85> words{};
        std::memcpy(words.data(), &leaf, (kLeafHalf + 3) * sizeof(float));
        std::memcpy(&words[kLeafHalf + 3], box.data(), sizeof box);
        words.back() = degenerate;
        return words;
    }
};

/// What a random test has seen.
struct Seen {
    int rounds = 0;
    int proven = 0;  ///< triangles with an area that the kernel proves
    int flat = 0;    ///< degenerate ones
};

Made made_by(const Table& table, const Mesh& mesh, const Frame& frame, Seen& seen) {
    Made made{};
    std::array<float, kPaddedBox> box;
    const unsigned with_area =
        table.fill_leaf(build::leaf_map(frame), &mesh.positions[0].x,
                        mesh.triangles[0].vertex.data(), &made.leaf.corner[0][0][0], box.data());
    made.box = {box[0], box[1], box[2], box[4], box[5], box[6]};
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        std::array<Double3, 3> corner;
        for (std::size_t k = 0; k < 3; ++k) {
            corner[k] = build::as_double(mesh.positions[mesh.triangles[lane].vertex[k]]);
        }
        const bool is_flat = is_degenerate({corner[0], corner[1], corner[2]});
        const bool is_proven = (with_area >> lane & 1) != 0;
        EXPECT_FALSE(is_flat && is_proven) << "lane " << lane;
        made.degenerate |= static_cast<unsigned>(is_flat) << lane;
        seen.flat += is_flat ? 1 : 0;
        seen.proven += is_proven ? 1 : 0;
    }
    return made;
}

Made made_in_double(const Mesh& mesh, const Frame& frame) {
    std::vector<Double3> positions;
    for (const Float3& p : mesh.positions) positions.push_back(build::as_double(p));
    Made made{};
    BvhNode node{};
    std::uint64_t degenerate = 0;
    const build::LeafRoom room{frame, true, {&node, 1}, {&made.leaf, 1}, nullptr, {&degenerate, 1}};
    build::make_leaves(room, std::span<const Double3>(positions), mesh.triangles, serial_for);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        made.box[axis] = node.lower[axis][0];
        made.box[3 + axis] = node.upper[axis][0];
    }
    made.degenerate = static_cast<unsigned>(degenerate);
    return made;
}

/// The frame of a model of these vertices and others beside them.
Frame frame_of(const Mesh& mesh, std::mt19937& random) {
    std::vector<Float3> positions = mesh.positions;
    std::uniform_real_distribution<float> beside(0, 2);
    for (const Float3& p : mesh.positions) {
        positions.push_back({p.x * beside(random), p.y * beside(random), p.z * beside(random)});
        for (float* x : {&positions.back().x, &positions.back().y, &positions.back().z}) {
            if (std::isinf(*x)) *x = std::numeric_limits<float>::max();
        }
    }
    return build::frame_of(build::extent_of(std::span<const Float3>(positions), serial_for));
}

Mesh mesh_of(std::vector<Float3> positions, std::mt19937& random) {
    Mesh mesh{std::move(positions), {}};
    for (Triangle& t : mesh.triangles) {
        for (std::uint32_t& v : t.vertex) {
            v = static_cast<std::uint32_t>(random() % mesh.positions.size());
        }
    }
    return mesh;
}

/// Compares leaves of numbers that are drawn. Each table must prove `least_proven` of its triangles
/// to have an area.
void check_random(std::uint32_t seed, double least_proven, float (*draw)(std::mt19937&)) {
    constexpr int kRounds = 2000;
    for_each_table([&](const Table& table) {
        std::mt19937 random(seed);
        Seen seen;
        for (int round = 0; round < kRounds; ++round) {
            std::vector<Float3> positions(3 + random() % 22);
            for (Float3& p : positions) p = {draw(random), draw(random), draw(random)};
            const Mesh mesh = mesh_of(std::move(positions), random);
            const Frame frame = frame_of(mesh, random);
            if (!build::has_exact_leaves(true, frame)) continue;
            ASSERT_EQ(made_by(table, mesh, frame, seen).bits(), made_in_double(mesh, frame).bits())
                << "round " << round;
            ++seen.rounds;
        }
        EXPECT_GT(seen.rounds, kRounds / 2);
        EXPECT_GT(seen.flat, seen.rounds / 4);
        EXPECT_GT(seen.proven, least_proven * static_cast<int>(kLanes) * seen.rounds);
    });
}

TEST(ExactLeaf, HasTheBitsOfOneMadeInDouble) {
    check_random(31, 0.6,
                 [](std::mt19937& r) { return std::uniform_real_distribution<float>(-3, 5)(r); });
}

TEST(ExactLeaf, OfNumbersFarFromZero) {
    check_random(32, 0.6, [](std::mt19937& r) {
        return 1e6F + std::uniform_real_distribution<float>(0, 1)(r);
    });
}

TEST(ExactLeaf, OfZerosWithBothSignsAndOfFewNumbers) {
    check_random(33, 0.1, [](std::mt19937& r) {
        return std::array{0.0F, -0.0F, 1.0F, -1.0F, 0x1p-126F, -0x1p-149F}[r() % 6];
    });
}

TEST(ExactLeaf, OfNumbersOfAllSizes) {
    check_random(34, 0.05, [](std::mt19937& r) {
        const auto x = std::bit_cast<float>(static_cast<std::uint32_t>(r()));
        return std::isfinite(x) ? std::ldexp(x, -28) : 0.0F;
    });
}

TEST(ExactLeaf, OfThinTriangles) {
    check_random(35, 0.3, [](std::mt19937& r) {
        return static_cast<float>(r() % 4) + std::ldexp(static_cast<float>(r() % 3), -22);
    });
}

/// All that make_leaves() writes.
struct Leaves {
    std::vector<BvhNode> nodes;
    std::vector<BvhLeaf> leaves;
    std::vector<std::uint64_t> degenerate;

    template <class Position>
    Leaves(const std::vector<Position>& positions, const std::vector<Triangle>& triangles,
           const Frame& frame, const std::uint8_t* lanes, bool marks)
        : nodes(format::bvh_shape(static_cast<std::uint32_t>(triangles.size())).node_count),
          leaves((triangles.size() + kLanes - 1) / kLanes),
          degenerate(marks ? (triangles.size() + 63) / 64 : 0) {
        const build::LeafRoom room{frame, true, nodes, leaves, lanes, degenerate};
        build::make_leaves(room, std::span<const Position>(positions), triangles, serial_for);
    }
    [[nodiscard]] bool has_bits_of(const Leaves& other) const {
        return std::memcmp(nodes.data(), other.nodes.data(), nodes.size() * sizeof(BvhNode)) == 0 &&
               std::memcmp(leaves.data(), other.leaves.data(), leaves.size() * sizeof(BvhLeaf)) ==
                   0 &&
               degenerate == other.degenerate;
    }
};

// Some leaves are full, some have places without a triangle, and some have none. The last one has
// fewer places.
TEST(ExactLeaf, TreesOfFloatsAreThoseOfDoubles) {
    std::mt19937 random(36);
    std::uniform_int_distribution<int> coordinate(-5, 5);
    const auto draw = [&] { return static_cast<float>(coordinate(random)) / 3; };
    for (int round = 0; round < 300; ++round) {
        std::vector<Float3> positions(40);
        for (Float3& p : positions) p = {draw(), draw(), draw()};
        std::vector<Triangle> triangles(1 + random() % 200);
        for (Triangle& t : triangles) {
            for (std::uint32_t& v : t.vertex) v = static_cast<std::uint32_t>(random() % 40);
        }
        std::vector<Double3> doubles;
        for (const Float3& p : positions) doubles.push_back(build::as_double(p));
        std::vector<std::uint8_t> lanes((triangles.size() + kLanes - 1) / kLanes, 0xff);
        for (std::uint8_t& some : lanes) {
            if (random() % 3 == 0) some = static_cast<std::uint8_t>(random() % 4 * random());
        }
        lanes.back() &=
            static_cast<std::uint8_t>((1U << ((triangles.size() - 1) % kLanes + 1)) - 1);
        const Frame frame =
            build::frame_of(build::extent_of(std::span<const Float3>(positions), serial_for));
        const std::uint8_t* const some = round % 2 == 0 ? lanes.data() : nullptr;
        const bool marks = round % 3 != 0;
        const Leaves of_floats(positions, triangles, frame, some, marks);
        const Leaves of_doubles(doubles, triangles, frame, some, marks);
        ASSERT_TRUE(of_floats.has_bits_of(of_doubles)) << "round " << round;
    }
}

}  // namespace
}  // namespace cdprep::kernels
