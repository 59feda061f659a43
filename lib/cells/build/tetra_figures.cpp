// SPDX-License-Identifier: MIT
#include "cdprep/cells/tetra_figures.h"

#include <algorithm>
#include <vector>

#include "cdprep/format/float_environment.h"
#include "cdprep/format/octree.h"
#include "cells/tetra_cones.h"
#include "core/moved_model.h"
#include "exact/winding.h"

namespace cdprep {
namespace {

using format::kSharedReference;
using format::TetraNode;

/// The parts that a model's tree and a builder's tree have in common.
struct TetraParts {
    const format::TetraTree* tree;
    std::uint64_t triangle_count;
    std::span<const TetraNode> nodes;
    std::span<const std::uint32_t> references;
    std::span<const std::uint32_t> top;
    std::span<const format::BvhNode> boxes;
    std::span<const format::OrientedNode> oriented;
};

bool is_leaf(const TetraNode& node) noexcept {
    return (node.flags & format::tetra_inner) == 0;
}

void count_nodes(std::span<const TetraNode> nodes, TetraFigures& figures) noexcept {
    std::uint64_t octants = 0;
    for (const TetraNode& node : nodes) {
        octants += node.key < 16 ? 1 : 0;
        if (is_leaf(node)) {
            ++figures.leaves;
            figures.largest_leaf = std::max<std::uint64_t>(figures.largest_leaf, node.count);
        } else {
            figures.empty_cones += 4 - node.count;
        }
    }
    figures.empty_cones += 8 - octants;
}

void count_references(const TetraParts& parts, TetraFigures& figures) {
    std::vector<std::uint32_t> uses(parts.triangle_count);
    for (const std::uint32_t reference : parts.references) ++uses[reference & ~kSharedReference];
    for (const std::uint32_t count : uses) {
        figures.shared += count > 1 ? 1 : 0;
        figures.in_many += count > 8 ? 1 : 0;
    }
}

TetraFigures figures_of(const TetraParts& parts) {
    TetraFigures figures;
    figures.triangles = parts.triangle_count;
    if (parts.tree == nullptr) return figures;
    figures.nodes = parts.nodes.size();
    figures.references = parts.references.size();
    figures.centre_count = parts.tree->centre_count;
    figures.centre_inside = (parts.tree->flags & format::tetra_centre_inside) != 0;
    figures.bytes = sizeof(format::TetraTree) + parts.nodes.size_bytes() +
                    parts.references.size_bytes() + parts.top.size_bytes() +
                    parts.boxes.size_bytes() + parts.oriented.size_bytes();
    count_references(parts, figures);
    if (parts.nodes.empty()) return figures;
    figures.deepest = tetra_level(parts.nodes.back().key);
    count_nodes(parts.nodes, figures);
    return figures;
}

/// Returns the number of triangles that the ray through the middle of a leaf crosses. It crosses no
/// triangles of other leaves.
template <class CornersOf>
std::uint64_t layers_of(const TetraParts& parts, const TetraNode& leaf,
                        const CornersOf& corners_of) {
    const Double3& centre = parts.tree->centre;
    const Double3 from = behind_centre(centre, tetra_cone(leaf.key));
    std::uint64_t layers = 0;
    for (const std::uint32_t reference : parts.references.subspan(leaf.first, leaf.count)) {
        const Corners t = corners_of(reference & ~kSharedReference);
        layers += winding_term(from, centre, t).crossings != 0 ? 1 : 0;
    }
    return layers;
}

template <class CornersOf>
void count_layers(const TetraParts& parts, const CornersOf& corners_of, TetraFigures& figures) {
    std::uint64_t sum = 0;
    for (const TetraNode& node : parts.nodes) {
        if (!is_leaf(node)) continue;
        const std::uint64_t layers = layers_of(parts, node, corners_of);
        sum += layers;
        figures.most_layers = std::max(figures.most_layers, layers);
    }
    if (figures.leaves == 0) return;
    figures.mean_layers = static_cast<double>(sum) / static_cast<double>(figures.leaves);
}

}  // namespace

TetraFigures tetra_figures(const Model& model) {
    const format::FloatEnvironment environment;
    const TetraParts parts = {model.tetra_tree().tree,    model.triangle_count(),
                              model.tetra_tree().nodes,   model.tetra_tree().references,
                              model.tetra_tree().top,     model.tetra_tree().boxes,
                              model.tetra_tree().oriented};
    TetraFigures figures = figures_of(parts);
    const bool has_positions =
        !model.mesh().positions_f32.empty() || !model.mesh().positions_f64.empty();
    if (!model.mesh().triangles.empty() && has_positions) {
        const MovedModel still(model, nullptr);
        count_layers(
            parts, [&](std::uint32_t i) { return still.corners(i); }, figures);
    }
    return figures;
}

TetraFigures tetra_figures(const build::TetraTree& tree, std::span<const format::Double3> positions,
                           std::span<const format::Triangle> triangles) {
    const format::FloatEnvironment environment;
    const TetraParts parts = {&tree.tree, triangles.size(), tree.nodes,   tree.references,
                              tree.top,   tree.boxes,       tree.oriented};
    TetraFigures figures = figures_of(parts);
    const auto corners_of = [&](std::uint32_t i) {
        const auto& v = triangles[i].vertex;
        return Corners{positions[v[0]], positions[v[1]], positions[v[2]]};
    };
    count_layers(parts, corners_of, figures);
    return figures;
}

std::uint64_t seed_formula_bytes(const TetraFigures& figures) noexcept {
    constexpr std::uint64_t kRoot = 340;
    constexpr std::uint64_t kNode = 88;
    constexpr std::uint64_t kReference = 4;
    if (figures.nodes == 0) return 0;
    return kRoot + kNode * (figures.nodes + figures.empty_cones) + kReference * figures.references;
}

}  // namespace cdprep
