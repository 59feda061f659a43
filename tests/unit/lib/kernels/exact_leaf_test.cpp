// SPDX-License-Identifier: MIT
// A leaf from the kernel has the bits of one that is made in double precision.
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

Made made_by(const Table& table, const Mesh& mesh, const Frame& frame) {
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

void check_random(std::mt19937& random, float (*draw)(std::mt19937&)) {
    for (int round = 0; round < 2000; ++round) {
        std::vector<Float3> positions(3 + random() % 22);
        for (Float3& p : positions) p = {draw(random), draw(random), draw(random)};
        const Mesh mesh = mesh_of(std::move(positions), random);
        const Frame frame = frame_of(mesh, random);
        if (!build::has_exact_leaves(true, frame)) continue;
        const auto expected = made_in_double(mesh, frame).bits();
        for_each_table([&](const Table& table) {
            ASSERT_EQ(made_by(table, mesh, frame).bits(), expected) << "round " << round;
        });
        if (::testing::Test::HasFatalFailure()) return;
    }
}

TEST(ExactLeaf, HasTheBitsOfOneMadeInDouble) {
    std::mt19937 random(31);
    check_random(random,
                 [](std::mt19937& r) { return std::uniform_real_distribution<float>(-3, 5)(r); });
}

TEST(ExactLeaf, OfNumbersFarFromZero) {
    std::mt19937 random(32);
    check_random(random, [](std::mt19937& r) {
        return 1e6F + std::uniform_real_distribution<float>(0, 1)(r);
    });
}

TEST(ExactLeaf, OfZerosWithBothSignsAndOfFewNumbers) {
    std::mt19937 random(33);
    check_random(random, [](std::mt19937& r) {
        return std::array{0.0F, -0.0F, 1.0F, -1.0F, 0x1p-126F, -0x1p-149F}[r() % 6];
    });
}

TEST(ExactLeaf, OfNumbersOfAllSizes) {
    std::mt19937 random(34);
    check_random(random, [](std::mt19937& r) {
        const auto x = std::bit_cast<float>(static_cast<std::uint32_t>(r()));
        return std::isfinite(x) ? std::ldexp(x, -28) : 0.0F;
    });
}

TEST(ExactLeaf, OfThinTriangles) {
    std::mt19937 random(35);
    check_random(random, [](std::mt19937& r) {
        return static_cast<float>(r() % 4) + std::ldexp(static_cast<float>(r() % 3), -22);
    });
}

}  // namespace
}  // namespace cdprep::kernels
