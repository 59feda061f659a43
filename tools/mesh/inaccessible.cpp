// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/inaccessible.h"

#include <algorithm>

#include "mesh/radial_cover.h"

namespace cdprep::mesh {
namespace {

constexpr std::size_t kTrianglesPerTask = 256;

std::uint32_t triangle_of(std::uint32_t reference) {
    return reference & ~format::kSharedReference;
}

std::span<const std::uint32_t> listed(const TetraLists& tree, const format::TetraNode& leaf) {
    return tree.references.subspan(leaf.first, leaf.count);
}

/// By triangle, the leaves that list it.
class LeavesOf {
public:
    LeavesOf(const TetraLists& tree, std::size_t triangle_count) : first_(triangle_count + 1) {
        const auto for_each = [&](auto visit) {
            for (std::uint32_t i = 0; i < tree.nodes.size(); ++i) {
                if ((tree.nodes[i].flags & format::tetra_inner) != 0) continue;
                for (const std::uint32_t reference : listed(tree, tree.nodes[i])) {
                    visit(triangle_of(reference), i);
                }
            }
        };
        for_each([&](std::uint32_t triangle, std::uint32_t) { ++first_[triangle + 1]; });
        for (std::size_t i = 0; i < triangle_count; ++i) first_[i + 1] += first_[i];
        leaves_.resize(first_.back());
        std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
        for_each(
            [&](std::uint32_t triangle, std::uint32_t leaf) { leaves_[next[triangle]++] = leaf; });
    }

    [[nodiscard]] std::span<const std::uint32_t> operator[](std::uint32_t triangle) const {
        return std::span(leaves_).subspan(first_[triangle],
                                          first_[triangle + 1] - first_[triangle]);
    }

private:
    std::vector<std::size_t> first_;
    std::vector<std::uint32_t> leaves_;
};

/// All that may hide the triangle: what shares a leaf with it, and what holds the centre.
void find_others(const TetraLists& tree, std::span<const std::uint32_t> leaves,
                 std::vector<std::uint32_t>& others) {
    others.clear();
    const auto add = [&](std::uint32_t reference) { others.push_back(triangle_of(reference)); };
    for (const std::uint32_t leaf : leaves) {
        const auto list = listed(tree, tree.nodes[leaf]);
        std::for_each(list.begin(), list.end(), add);
    }
    if (leaves.size() < 2) return;
    std::sort(others.begin(), others.end());
    others.erase(std::unique(others.begin(), others.end()), others.end());
}

}  // namespace

Inaccessible find_inaccessible(const TetraLists& tree, std::span<const Double3> positions,
                               std::span<const Triangle> triangles, ParallelFor parallel_for) {
    const RadialCover cover(tree.tree.centre, positions, triangles);
    const LeavesOf leaves_of(tree, triangles.size());
    std::vector<std::uint8_t> hidden(triangles.size());
    const auto task = [&](std::size_t number) {
        std::vector<std::uint32_t> others;
        const std::size_t first = number * kTrianglesPerTask;
        const std::size_t last = std::min(first + kTrianglesPerTask, triangles.size());
        for (std::size_t i = first; i < last; ++i) {
            const auto triangle = static_cast<std::uint32_t>(i);
            find_others(tree, leaves_of[triangle], others);
            hidden[i] = cover.is_hidden(triangle, others) ? 1 : 0;
        }
    };
    parallel_for((triangles.size() + kTrianglesPerTask - 1) / kTrianglesPerTask, task);
    Inaccessible result;
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        if (hidden[i] != 0) result.triangles.push_back(i);
        if (cover.is_edge_on(i)) ++result.edge_on;
    }
    return result;
}

}  // namespace cdprep::mesh
