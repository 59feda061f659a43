// SPDX-License-Identifier: MIT
#include "cdprep/cells/octree_figures.h"

#include <algorithm>
#include <bit>

namespace cdprep {
namespace {

using format::AdaptiveOctreeNode;
using format::kInnerNode;
using format::OctreeNode;

/// The parts that a model's tree and a builder's tree have in common.
template <class Node>
struct Parts {
    std::uint64_t triangle_count;
    std::span<const Node> nodes;
    std::span<const std::uint32_t> references;
    std::uint64_t other_bytes;  ///< of the tree's one-element section, if any
    std::uint64_t table_bytes;
    std::uint64_t box_bytes;
};

/// Counts the nodes. They are stored level by level: children of a level's nodes are the next
/// level.
template <class Node>
void count_nodes(std::span<const Node> nodes, OctreeFigures& figures) noexcept {
    std::uint64_t next_child = 1;
    std::uint64_t level_end = 1;
    for (std::uint64_t i = 0; i < nodes.size(); ++i) {
        if (i == level_end) {
            level_end = next_child;
            ++figures.deepest;
        }
        const Node& node = nodes[i];
        if ((node.count & kInnerNode) != 0) {
            const auto children = static_cast<std::uint64_t>(std::popcount(node.count & 0xff));
            figures.empty_children += 8 - children;
            next_child += children;
        } else {
            ++figures.leaves;
            figures.largest_leaf = std::max<std::uint64_t>(figures.largest_leaf, node.count);
        }
    }
}

template <class Node>
OctreeFigures figures_of(const Parts<Node>& parts) noexcept {
    OctreeFigures figures;
    figures.triangles = parts.triangle_count;
    figures.table_bytes = parts.table_bytes;
    figures.bytes = parts.other_bytes + parts.nodes.size_bytes() + parts.references.size_bytes() +
                    parts.table_bytes + parts.box_bytes;
    figures.nodes = parts.nodes.size();
    // There is no octree, or the model has no triangles.
    if (parts.nodes.empty()) return figures;
    figures.references = parts.references.size();
    count_nodes(parts.nodes, figures);
    // Every triangle is listed at least once. If listed only once, it is not marked.
    const auto alone = std::count_if(
        parts.references.begin(), parts.references.end(),
        [](std::uint32_t reference) { return (reference & format::kSharedReference) == 0; });
    figures.shared = parts.triangle_count - static_cast<std::uint64_t>(alone);
    return figures;
}

template <class... Elements>
std::uint64_t bytes_of(std::span<const Elements>... tables) noexcept {
    return (tables.size_bytes() + ...);
}

}  // namespace

OctreeFigures octree_figures(const Model& model) noexcept {
    return figures_of<OctreeNode>(
        {model.triangle_count(), model.octree().nodes, model.octree().references,
         model.octree().grid == nullptr ? 0 : sizeof(format::OctreeGrid),
         bytes_of(model.octree().leaf_codes, model.octree().leaf_nodes, model.octree().top,
                  model.octree().modulus_table, model.octree().mixed_table),
         bytes_of(model.octree().boxes)});
}

OctreeFigures octree_figures(const build::Octree& octree, std::uint64_t triangle_count) noexcept {
    const auto view = [](const auto& elements) { return std::span(elements); };
    return figures_of<OctreeNode>(
        {triangle_count, octree.nodes, octree.references, sizeof(format::OctreeGrid),
         bytes_of(view(octree.leaf_codes), view(octree.leaf_nodes), view(octree.top),
                  view(octree.modulus_table), view(octree.mixed_table)),
         bytes_of(view(octree.boxes))});
}

OctreeFigures adaptive_octree_figures(const Model& model) noexcept {
    return figures_of<AdaptiveOctreeNode>(
        {model.triangle_count(), model.adaptive_octree().nodes, model.adaptive_octree().references,
         model.adaptive_octree().tree == nullptr ? 0 : sizeof(format::AdaptiveOctree), 0,
         bytes_of(model.adaptive_octree().boxes)});
}

OctreeFigures adaptive_octree_figures(const build::AdaptiveOctree& octree,
                                      std::uint64_t triangle_count) noexcept {
    return figures_of<AdaptiveOctreeNode>({triangle_count, octree.nodes, octree.references,
                                           sizeof(format::AdaptiveOctree), 0,
                                           std::span(octree.boxes).size_bytes()});
}

std::uint64_t seed_formula_bytes(const OctreeFigures& figures, EmptyChildren empty) noexcept {
    constexpr std::uint64_t kRoot = 72;
    constexpr std::uint64_t kNode = 80;
    constexpr std::uint64_t kReference = 4;
    if (figures.nodes == 0) return 0;
    const std::uint64_t children =
        figures.nodes - 1 + (empty == EmptyChildren::counted ? figures.empty_children : 0);
    return kRoot + kNode * children + kReference * figures.references;
}

}  // namespace cdprep
