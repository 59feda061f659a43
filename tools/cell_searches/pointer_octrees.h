// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cdprep/cells/octree_search.h"
#include "cdprep/points.h"

namespace cdprep::study::search {

/// The first corner of a node's cell, in finest cells, and its level.
struct NodeCell {
    std::array<std::uint32_t, 3> first{};
    std::uint32_t level = 0;

    [[nodiscard]] std::uint32_t steps() const {
        return 1U << (format::kOctreeBits - level);
    }
};

/// Returns the corner of the finest cell that is `ahead` steps along each axis, by the planes of
/// format::OctreeGrid.
inline Double3 corner_of(const format::OctreeGrid& grid, const NodeCell& cell,
                         std::uint32_t ahead) {
    const auto plane = [&](double origin, std::uint32_t i) {
        return origin + static_cast<double>(i + ahead) * grid.step;
    };
    return {plane(grid.origin.x, cell.first[0]), plane(grid.origin.y, cell.first[1]),
            plane(grid.origin.z, cell.first[2])};
}

inline NodeCell cell_of(std::uint64_t key) {
    NodeCell cell{.level = format::level_of(key)};
    const std::uint64_t code = format::code_of(key);
    for (std::uint32_t bit = 0; bit < format::kOctreeBits; ++bit) {
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
            cell.first[axis] |= static_cast<std::uint32_t>((code >> (3 * bit + axis)) & 1U) << bit;
        }
    }
    return cell;
}

/// The end of a search in a tree of pointers: the product's number of the node.
struct Ending {
    std::uint32_t number = 0;
    bool is_leaf = false;
};

/// A textbook octree, made from the product's so that the leaves are the same. Nodes point to their
/// children; null marks an empty child. All nodes are in one block of memory, depth first, which is
/// best for a descent. Node has `children` and `ending`.
template <class Node>
class PointerOctree {
public:
    /// fill(node, cell) sets the other members of a node.
    template <class Fill>
    PointerOctree(const std::vector<format::OctreeNode>& nodes, Fill fill) : pool_(nodes.size()) {
        add(nodes, 0, fill);
    }

    [[nodiscard]] const Node& root() const {
        return pool_.front();
    }
    [[nodiscard]] const std::vector<Node>& pool() const {
        return pool_;
    }

private:
    template <class Fill>
    Node* add(const std::vector<format::OctreeNode>& nodes, std::uint32_t number, Fill& fill) {
        Node* const made = &pool_[used_++];
        fill(*made, cell_of(nodes[number].key));
        made->ending = {number, is_leaf(nodes[number])};
        if (made->ending.is_leaf) return made;
        std::uint32_t child = nodes[number].first;
        for (std::size_t i = 0; i < 8; ++i) {
            if ((nodes[number].count >> i) & 1U) made->children[i] = add(nodes, child++, fill);
        }
        return made;
    }

    std::vector<Node> pool_;
    std::size_t used_ = 0;
};

/// H0: a node has its box, and a search tests its children's boxes one after the other.
struct BoxNode {
    Box box{};
    std::array<BoxNode*, 8> children{};
    Ending ending;
};

inline bool holds_half_open(const Box& box, const Double3& p) {
    return p.x >= box.lower.x && p.x < box.upper.x && p.y >= box.lower.y && p.y < box.upper.y &&
           p.z >= box.lower.z && p.z < box.upper.z;
}

inline PointerOctree<BoxNode> box_octree(const format::OctreeGrid& grid,
                                         const std::vector<format::OctreeNode>& nodes) {
    return {nodes, [&](BoxNode& node, const NodeCell& cell) {
                node.box = {corner_of(grid, cell, 0), corner_of(grid, cell, cell.steps())};
            }};
}

inline std::uint32_t find_by_boxes(const BoxNode& node, const Double3& p) {
    if (node.ending.is_leaf) return node.ending.number;
    for (const BoxNode* child : node.children) {
        if (child != nullptr && holds_half_open(child->box, p)) return find_by_boxes(*child, p);
    }
    return kNoNode;
}

/// H1: a node has the point where its children meet, and a search compares with it.
struct CentreNode {
    Double3 centre{};
    std::array<CentreNode*, 8> children{};
    Ending ending;
};

inline PointerOctree<CentreNode> centre_octree(const format::OctreeGrid& grid,
                                               const std::vector<format::OctreeNode>& nodes) {
    return {nodes, [&](CentreNode& node, const NodeCell& cell) {
                node.centre = corner_of(grid, cell, cell.steps() / 2);
            }};
}

inline std::uint32_t find_by_centres(const CentreNode& root, const Double3& p) {
    const CentreNode* node = &root;
    while (!node->ending.is_leaf) {
        const std::size_t child = static_cast<std::size_t>(p.x >= node->centre.x) |
                                  static_cast<std::size_t>(p.y >= node->centre.y) << 1 |
                                  static_cast<std::size_t>(p.z >= node->centre.z) << 2;
        node = node->children[child];
        if (node == nullptr) return kNoNode;
    }
    return node->ending.number;
}

/// H2: a node has only its children; a search selects them by the bits of a code.
struct PlainNode {
    std::array<PlainNode*, 8> children{};
    Ending ending;
};

inline PointerOctree<PlainNode> plain_octree(const std::vector<format::OctreeNode>& nodes) {
    return {nodes, [](PlainNode&, const NodeCell&) {}};
}

inline std::uint32_t find_by_bits(const PlainNode& root, std::uint64_t code) {
    const PlainNode* node = &root;
    for (code <<= 1; !node->ending.is_leaf; code <<= 3) {
        node = node->children[code >> 61];
        if (node == nullptr) return kNoNode;
    }
    return node->ending.number;
}

/// Returns the number of bits set among eight. std::popcount is a function call in builds for
/// processors without the instruction.
inline std::uint32_t count_of_eight(std::uint32_t bits) {
    bits -= (bits >> 1) & 0x55U;
    bits = (bits & 0x33U) + ((bits >> 2) & 0x33U);
    return (bits + (bits >> 4)) & 0xfU;
}

/// H3: the product's own nodes, with the number of their first child and a mask of their children.
/// The same descent without pointers.
inline std::uint32_t find_by_masks(const std::vector<format::OctreeNode>& nodes,
                                   std::uint64_t code) {
    std::uint32_t node = 0;
    for (code <<= 1; !is_leaf(nodes[node]); code <<= 3) {
        const std::uint32_t bit = 1U << (code >> 61);
        const std::uint32_t mask = nodes[node].count & 0xffU;
        if ((mask & bit) == 0) return kNoNode;
        node = nodes[node].first + count_of_eight(mask & (bit - 1));
    }
    return node;
}

}  // namespace cdprep::study::search
