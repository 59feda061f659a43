// SPDX-License-Identifier: MIT
// What the parts of a search for an octree's cell cost, and which choices are best:
//
//   top:  sorted leaves, by the level of the top table and by how its range is bisected:
//         `mask` moves without a branch, `branch` is std::upper_bound, as in the product, `fetch`
//         is `mask` with both next places fetched ahead, `ahead` is `branch` after the number of
//         the node in the middle of the range was fetched.
//   key:  the finest cell of a point alone, as the product has it and with the quotient by a
//         stored reciprocal, and its code by each of the kernels.
//   node: the node of a key that is stored: by bisection of the nodes, which are in the order
//         of keys, and by either table.
//
// Cells with fewer than 8 triangles are not divided. Contenders take turns, and that several
// times; all that answer the same are compared first. One thread.
//
// Usage: octree_top_bench [BAKES [ROUNDS [NAME...]]], as octree_search_bench.
//
// Prints a CSV table: nanoseconds, the median of the timings, the spread of their middle
// half, and what a tenth of them stayed below; bytes of what is searched.
#include <bit>
#include <cstdio>
#include <cstdlib>

#include "cdprep/cells/overlap_through.h"
#include "cells/octree_cells.h"
#include "core/prefetch.h"
#include "kernels/curve.h"
#include "octree_meshes.h"

namespace cdprep {
namespace {

using namespace study::search;  // NOLINT(google-build-using-namespace)

constexpr std::array<std::uint32_t, 2> kDepths = {8, 12};
constexpr std::uint32_t kThreshold = 8;
constexpr std::uint32_t kMostTopLevel = 7;
constexpr std::array<std::uint32_t, 6> kTopLevels = {0, 3, 4, 5, 6, kMostTopLevel};

/// Rising codes, of which those are counted that are at most one.
using Codes = std::span<const std::uint64_t>;

std::size_t count_by_branch(Codes codes, std::uint64_t code) {
    return static_cast<std::size_t>(std::upper_bound(codes.begin(), codes.end(), code) -
                                    codes.begin());
}

std::size_t count_fetching(Codes codes, std::uint64_t code) {
    const std::uint64_t* begin = codes.data();
    std::size_t count = codes.size();
    while (count > 1) {
        const std::size_t half = count / 2;
        const std::size_t next = (count - half) / 2;
        prefetch(begin + next);
        prefetch(begin + half + next);
        begin += half & -static_cast<std::size_t>(begin[half - 1] <= code);
        count -= half;
    }
    return static_cast<std::size_t>(begin - codes.data()) + (count == 1 && *begin <= code ? 1 : 0);
}

std::vector<std::uint32_t> top_of(const build::Octree& octree, std::uint32_t level) {
    std::vector<std::uint32_t> top;
    const auto& codes = octree.leaf_codes;
    for (std::uint64_t cell = 0; cell < std::uint64_t{1} << (3 * level); ++cell) {
        const auto at = std::lower_bound(codes.begin(), codes.end(), cell * cells_below(level));
        top.push_back(static_cast<std::uint32_t>(at - codes.begin()));
    }
    top.push_back(static_cast<std::uint32_t>(codes.size()));
    return top;
}

template <class Count>
std::uint32_t find_leaf_by(const OctreeIndex& index, std::uint64_t code, Count count) {
    const std::uint64_t cell = code >> (3 * (format::kOctreeBits - index.top_level));
    const std::uint32_t first = index.top[cell];
    const std::size_t before =
        first + count(index.leaf_codes.subspan(first, index.top[cell + 1] - first), code);
    return last_leaf(index, before, code);
}

/// Each level with each way.
std::vector<Contender> top_contenders(const build::Octree& octree,
                                      const std::vector<std::vector<std::uint32_t>>& tops) {
    std::vector<Contender> made;
    const auto add = [&](const char* name, std::uint32_t level, auto count) {
        OctreeIndex index = octree_index(octree);
        index.top_level = level;
        index.top = tops[level];
        const format::OctreeGrid grid = octree.grid;
        made.push_back(contender(
            "top" + std::to_string(level) + "/" + name,
            memory_of(octree.nodes, octree.leaf_nodes, octree.leaf_codes, tops[level]),
            [=](const Double3& p) { return find_leaf_by(index, code_of_point(grid, p), count); }));
    };
    const auto add_ahead = [&](std::uint32_t level) {
        const Codes all = octree.leaf_codes;
        const std::uint32_t* nodes = octree.leaf_nodes.data();
        add("ahead", level, [=](Codes c, std::uint64_t code) {
            prefetch(nodes + (c.data() - all.data()) + c.size() / 2);
            return count_by_branch(c, code);
        });
    };
    for (const std::uint32_t level : kTopLevels) {
        add("mask", level,
            [](Codes c, std::uint64_t code) { return count_without_branch(c, code); });
        add("branch", level, [](Codes c, std::uint64_t code) { return count_by_branch(c, code); });
        add("fetch", level, [](Codes c, std::uint64_t code) { return count_fetching(c, code); });
        add_ahead(level);
    }
    return made;
}

void print_rows(const OctreeMesh& mesh, std::uint32_t depth, const build::Octree& octree,
                const std::vector<Contender>& contenders, const QuerySet& set, State state,
                std::size_t rounds) {
    const auto ns = time_all(contenders, set.points, state, rounds);
    for (std::size_t c = 0; c < ns.size(); ++c) {
        std::printf("%s,%u,%zu,%s,%s,%s,%.1f,%.1f,%.1f,%zu,%zu\n", mesh.name.c_str(), depth,
                    octree.leaf_codes.size(), set.name, kStates[state], contenders[c].name.c_str(),
                    median(ns[c]), spread(ns[c]), median(ns[c], 0.1), ns[c].size(),
                    bytes_of(contenders[c].memory));
    }
    std::fflush(stdout);
}

void measure_tops(const OctreeMesh& mesh, std::uint32_t depth, const build::Octree& octree,
                  std::size_t rounds) {
    std::vector<std::vector<std::uint32_t>> tops;
    for (std::uint32_t level = 0; level <= kMostTopLevel; ++level) {
        tops.push_back(top_of(octree, level));
    }
    const std::vector<Contender> contenders = top_contenders(octree, tops);
    Random random(7);
    for (const QuerySet& set :
         {uniform_set(octree.grid, kQueries, random), surface_set(mesh.mesh, kQueries, random),
          walk_set(mesh.mesh, kQueries, random)}) {
        share_found(contenders, set.points);
        for (const State state : {warm, in_turn, cold}) {
            print_rows(mesh, depth, octree, contenders, set, state, rounds);
        }
    }
}

/// octree_cell() with a product in place of the quotient; step's reciprocal must be normal.
std::uint32_t cell_by_product(double origin, double step, double per_step, double x) {
    const double guess = (x - origin) * per_step;
    if (!(guess > 0)) return 0;
    auto i = static_cast<std::uint32_t>(std::min(guess, kOctreeSteps - 1.0));
    if (i > 0 && x < octree_plane(origin, step, i)) --i;
    if (i + 1 < kOctreeSteps && x >= octree_plane(origin, step, i + 1)) ++i;
    return i;
}

std::uint32_t folded(std::uint64_t code) {
    return static_cast<std::uint32_t>(code ^ code >> 32);
}

/// What the answer is made of, folded into 32 bits.
std::vector<Contender> key_contenders(const format::OctreeGrid& grid) {
    std::vector<Contender> made;
    const auto add = [&](const std::string& name, auto find) {
        made.push_back(contender("key/" + name, {}, find));
    };
    const double per_step = 1 / grid.step;
    const auto by_product = [=](const Double3& p) {
        return CellPlace{cell_by_product(grid.origin.x, grid.step, per_step, p.x),
                         cell_by_product(grid.origin.y, grid.step, per_step, p.y),
                         cell_by_product(grid.origin.z, grid.step, per_step, p.z)};
    };
    const kernels::AvailableCurves curves = kernels::available_curves();
    for (std::size_t i = 0; i < curves.count; ++i) {
        const kernels::Curve& curve = *curves.curve[i];
        const auto code = [code_of = curve.code](const CellPlace& cell) {
            return folded(code_of(cell[0], cell[1], cell[2]));
        };
        add(std::string("quotient_") + curve.name,
            [=](const Double3& p) { return code(octree_cell(grid, p)); });
        add(std::string("product_") + curve.name,
            [=](const Double3& p) { return code(by_product(p)); });
    }
    return made;
}

void measure_keys(const OctreeMesh& mesh, const build::Octree& octree, std::size_t rounds) {
    const std::vector<Contender> contenders = key_contenders(octree.grid);
    Random random(7);
    const QuerySet set = surface_set(mesh.mesh, kQueries, random);
    share_found(contenders, set.points);
    for (const State state : {warm, in_turn}) {
        print_rows(mesh, octree.grid.level, octree, contenders, set, state, rounds);
    }
}

/// Keys are asked in the place of points: p.x is the bits of one.
std::uint64_t key_of(const Double3& p) {
    return std::bit_cast<std::uint64_t>(p.x);
}

std::vector<Contender> node_contenders(const build::Octree& octree) {
    const OctreeIndex index = octree_index(octree);
    const auto by = [index](CellSearch search) {
        return [=](const Double3& p) { return find_node(index, search, key_of(p)); };
    };
    return {contender("node/in_order", memory_of(octree.nodes),
                      [=](const Double3& p) { return find_node_in_order(index, key_of(p)); }),
            contender("node/modulus", memory_of(octree.nodes, octree.modulus_table),
                      by(CellSearch::modulus)),
            contender("node/mixed", memory_of(octree.nodes, octree.mixed_table),
                      by(CellSearch::mixed))};
}

void measure_nodes(const OctreeMesh& mesh, const build::Octree& octree, std::size_t rounds) {
    Random random(7);
    QuerySet set{"nodes", {}};
    for (std::size_t i = 0; i < kQueries; ++i) {
        const std::uint64_t key = octree.nodes[random() % octree.nodes.size()].key;
        set.points.push_back({std::bit_cast<double>(key), 0, 0});
    }
    const std::vector<Contender> contenders = node_contenders(octree);
    share_found(contenders, set.points);
    for (const State state : {warm, in_turn, cold}) {
        print_rows(mesh, octree.grid.level, octree, contenders, set, state, rounds);
    }
}

void run(const std::vector<OctreeMesh>& meshes, std::size_t rounds) {
    std::printf(
        "mesh,depth,leaves,points,state,contender,median_ns,spread_ns,tenth_ns,timings,bytes\n");
    for (const OctreeMesh& mesh : meshes) {
        for (const std::uint32_t depth : kDepths) {
            const build::Octree octree =
                build::build_octree(mesh.mesh.positions, mesh.mesh.triangles,
                                    {.level = depth, .threshold = kThreshold});
            measure_tops(mesh, depth, octree, rounds);
            measure_keys(mesh, octree, rounds);
            measure_nodes(mesh, octree, rounds);
        }
    }
}

}  // namespace
}  // namespace cdprep

int main(int count, char** arguments) {
    const std::size_t rounds =
        count > 2 ? static_cast<std::size_t>(std::max(1, std::atoi(arguments[2]))) : 9;
    std::vector<std::string> names(arguments + std::min(count, 3), arguments + count);
    if (names.empty()) names = {"bunny", "armadillo", "dragon"};
    cdprep::run(cdprep::octree_meshes(count > 1 ? arguments[1] : "", names), rounds);
}
