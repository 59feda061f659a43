// SPDX-License-Identifier: MIT
#include "cdprep/octree_figures.h"

#include <algorithm>
#include <bit>

#include "octree_cells.h"

namespace cdprep {
namespace {

using format::kInnerNode;
using format::OctreeNode;

/// What both a model and a builder's tree have.
struct Parts {
    std::uint64_t triangle_count;
    std::span<const OctreeNode> nodes;
    std::span<const std::uint32_t> references;
    std::uint64_t table_bytes;
};

void count_nodes(std::span<const OctreeNode> nodes, OctreeFigures& figures) noexcept {
    for (const OctreeNode& node : nodes) {
        if ((node.count & kInnerNode) != 0) {
            const int children = std::popcount(node.count & 0xff);
            figures.empty_children += 8 - static_cast<std::uint64_t>(children);
        } else {
            ++figures.leaves;
            figures.largest_leaf = std::max<std::uint64_t>(figures.largest_leaf, node.count);
        }
    }
}

OctreeFigures figures_of(const Parts& parts) noexcept {
    OctreeFigures figures;
    figures.triangles = parts.triangle_count;
    figures.nodes = parts.nodes.size();
    if (parts.nodes.empty()) return figures;
    figures.references = parts.references.size();
    figures.deepest = level_of(parts.nodes.back().key);
    count_nodes(parts.nodes, figures);
    // A triangle is listed once at least, and then without the mark.
    const auto alone = std::count_if(
        parts.references.begin(), parts.references.end(),
        [](std::uint32_t reference) { return (reference & format::kSharedReference) == 0; });
    figures.shared = parts.triangle_count - static_cast<std::uint64_t>(alone);
    figures.table_bytes = parts.table_bytes;
    figures.bytes = sizeof(format::OctreeGrid) + parts.nodes.size_bytes() +
                    parts.references.size_bytes() + parts.table_bytes;
    return figures;
}

template <class... Elements>
std::uint64_t bytes_of(std::span<const Elements>... tables) noexcept {
    return (tables.size_bytes() + ...);
}

}  // namespace

OctreeFigures octree_figures(const Model& model) noexcept {
    return figures_of(
        {model.triangle_count(), model.octree_nodes(), model.octree_references(),
         bytes_of(model.octree_leaf_codes(), model.octree_leaf_nodes(), model.octree_top(),
                  model.octree_modulus_table(), model.octree_mixed_table())});
}

OctreeFigures octree_figures(const build::Octree& octree, std::uint64_t triangle_count) noexcept {
    const auto view = [](const auto& elements) { return std::span(elements); };
    return figures_of({triangle_count, octree.nodes, octree.references,
                       bytes_of(view(octree.leaf_codes), view(octree.leaf_nodes), view(octree.top),
                                view(octree.modulus_table), view(octree.mixed_table))});
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
