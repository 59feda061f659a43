// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>

#include "cdprep/pose.h"
#include "kernels/kernels.h"

/// What tests give to kernels: nodes, leaves and placements.
namespace cdprep::kernels {

using Node = std::array<float, 48>;
using OrientedNode = std::array<float, 96>;
using SweptNode = std::array<float, 96>;

inline Node random_node(std::mt19937& random) {
    std::uniform_real_distribution<float> place(-1, 1);
    std::uniform_real_distribution<float> size(0, 1);
    Node node;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t box = 0; box < kLanes; ++box) {
            const float lower = place(random);
            node[8 * axis + box] = lower;
            node[24 + 8 * axis + box] = lower + size(random);
        }
    }
    return node;
}

inline BoxPlacement placement_of(const Pose& pose, float slack) {
    BoxPlacement p{};
    const auto& r = pose.rotation();
    const std::array<double, 3> t = {pose.translation().x, pose.translation().y,
                                     pose.translation().z};
    for (std::size_t i = 0; i < 9; ++i) {
        p.rotation[i] = static_cast<float>(r[i]);
        p.abs_rotation[i] = std::fabs(p.rotation[i]);
    }
    for (std::size_t i = 0; i < 3; ++i) {
        p.shift[i] = static_cast<float>(t[i]);
        p.shift_in_b[i] = static_cast<float>(r[i] * t[0] + r[3 + i] * t[1] + r[6 + i] * t[2]);
    }
    p.scale_a = p.scale_b = 1;
    p.slack = slack;
    return p;
}

/// Whether a set of pairs has that of box i of A and box j of B.
inline bool has(BoxPairs pairs, std::size_t i, std::size_t j) {
    return ((pairs >> (kLanes * j + i)) & 1) != 0;
}

/// As LeafPair has it.
using Leaf = std::array<float, 78>;

/// Triangles with corners near the origin; coarse ones touch and share planes.
inline Leaf random_leaf(std::mt19937& random, bool coarse) {
    std::uniform_real_distribution<float> fine(-1, 1);
    Leaf leaf{};
    for (std::size_t i = 0; i < kLeafOrigin; ++i) {
        leaf[i] =
            coarse ? static_cast<float>(static_cast<int>(random() % 5) - 2) / 2 : fine(random);
    }
    for (std::size_t i = kLeafHalf; i < leaf.size(); ++i) leaf[i] = 1;
    return leaf;
}

inline LeafPair pair_of(const Leaf& a, const Leaf& b) {
    return {a.data(), b.data(), 0, 0, 0xff, 0xff};
}

/// Corners stored with the origin taken off, at (0, 0, 0).
inline LeafPlacement leaf_placement(const Pose& pose) {
    LeafPlacement placement{};
    placement.a = placement.b = {{0, 0, 0}, 1, 1, 0};
    for (std::size_t i = 0; i < 9; ++i) {
        placement.rotation[i] = pose.rotation()[i];
        placement.corner_rotation[i] = static_cast<float>(pose.rotation()[i]);
    }
    placement.shift[0] = pose.translation().x;
    placement.shift[1] = pose.translation().y;
    placement.shift[2] = pose.translation().z;
    placement.error = 1e-15F;
    return placement;
}

}  // namespace cdprep::kernels
