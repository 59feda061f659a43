// SPDX-License-Identifier: GPL-3.0-or-later
#include "cell_searches/cell_searches.h"
#include "cdprep/cells/overlap_through.h"

namespace cdprep::study::search {

namespace {

/// Returns the leaf, if any: it is at the deepest level whose cell is stored.
std::uint32_t find_by_levels(const OctreeIndex& index, std::uint64_t code) {
    std::uint32_t found = 0;
    std::uint32_t least = 0;
    std::uint32_t most = index.deepest;
    while (least < most && !is_leaf(index.nodes[found])) {
        const std::uint32_t level = (least + most + 1) / 2;
        const std::uint64_t key = key_at(code, level);
        const std::uint32_t node =
            find_chained(index, index.mixed_table, format::mixed_slot(key, index.slot_bits), key);
        if (node == kNoNode) {
            most = level - 1;
        } else {
            least = level;
            found = node;
        }
    }
    return is_leaf(index.nodes[found]) ? found : kNoNode;
}

void add_hierarchical(const Forms& forms, std::vector<Contender>& to) {
    const format::OctreeGrid& grid = forms.octree.grid;
    const auto& nodes = forms.octree.nodes;
    to.push_back(contender("H0", memory_of(forms.boxes.pool()),
                           [&](const Double3& p) { return find_by_boxes(forms.boxes.root(), p); }));
    to.push_back(contender("H1", memory_of(forms.centres.pool()), [&](const Double3& p) {
        return find_by_centres(forms.centres.root(), p);
    }));
    to.push_back(contender("H2", memory_of(forms.plain.pool()), [&](const Double3& p) {
        return find_by_bits(forms.plain.root(), code_of_point(grid, p));
    }));
    to.push_back(contender("H3", memory_of(nodes), [&](const Double3& p) {
        return find_by_masks(nodes, code_of_point(grid, p));
    }));
}

void add_by_key(const Forms& forms, std::vector<Contender>& to) {
    const build::Octree& octree = forms.octree;
    const format::OctreeGrid& grid = octree.grid;
    const OctreeIndex index = octree_index(octree);
    const Memory modulus = memory_of(octree.nodes, octree.modulus_table);
    const Memory mixed = memory_of(octree.nodes, octree.mixed_table);
    to.push_back(contender("K0", modulus, [=, &grid](const Double3& p) {
        return find_leaf(index, CellSearch::modulus, code_of_point(grid, p));
    }));
    to.push_back(contender("K1", mixed, [=, &grid](const Double3& p) {
        return find_leaf(index, CellSearch::mixed, code_of_point(grid, p));
    }));
    to.push_back(contender("K2", mixed, [=, &grid](const Double3& p) {
        return find_by_levels(index, code_of_point(grid, p));
    }));
    to.push_back(contender("L1", memory_of(octree.nodes, octree.leaf_nodes, octree.leaf_codes),
                           [=, &grid](const Double3& p) {
                               const std::uint64_t code = code_of_point(grid, p);
                               return last_leaf(index, count_without_branch(index.leaf_codes, code),
                                                code);
                           }));
    to.push_back(
        contender("L2", memory_of(octree.nodes, octree.leaf_nodes, octree.leaf_codes, octree.top),
                  [=, &grid](const Double3& p) {
                      return find_leaf(index, CellSearch::sorted, code_of_point(grid, p));
                  }));
}

}  // namespace

std::vector<Contender> search_contenders(const Forms& forms) {
    std::vector<Contender> contenders;
    add_hierarchical(forms, contenders);
    add_by_key(forms, contenders);
    return contenders;
}

}  // namespace cdprep::study::search
