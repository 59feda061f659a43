// SPDX-License-Identifier: MIT
#include "cdprep/cells/build_tetra_tree.h"

#include <bit>
#include <cassert>
#include <limits>
#include <memory>

#include "build/chunks.h"
#include "build/frame_map.h"
#include "cdprep/advanced/parallel_for.h"
#include "cdprep/cells/build_octree.h"
#include "cdprep/format/float_environment.h"
#include "cdprep/format/octree.h"
#include "cells/build/cone_children.h"
#include "cells/build/tetra_steps.h"
#include "core/guarded_for.h"
#include "exact/winding.h"

// Built level by level, all cones of a level at once. Each cone's list of triangles is passed down
// to its children. Most triangles lie inside one finest cone, which is known from their corners
// alone (inner_cone). The exact test decides the others. Lists are cut into batches of
// kItemsPerTask. These are counted first, then moved to known places. So every list rises and no
// thread waits for another. The first levels, whose cones are split in any case, are done in one
// step.
//
// Scratch: a vertex takes 20 bytes, and 1 more during the search for the centre. A triangle takes 4
// bytes, and 3 more in the first step. A reference of two consecutive levels takes 9 bytes. Neither
// level has more references than the result: a triangle that touches a cone touches a child.

namespace cdprep::build {
namespace {

using format::Double3;
using format::kSharedReference;
using format::TetraNode;
using format::Triangle;

constexpr double kThird = 0.57735026918962576;  ///< 1 / sqrt(3)

/// A part of a level's references: those of one cone.
struct Run {
    std::uint32_t key;
    std::size_t first;
    std::size_t last;
    std::size_t node;  ///< its number, once it has one
};

/// A part of a run, for one task.
struct TetraBatch {
    std::size_t run;
    std::size_t first;
    std::size_t last;
    std::array<std::size_t, 4> place;  ///< for each child: counts, then the place of the next
};

/// One level: its references, and the cones that they belong to.
struct TetraLevel {
    std::unique_ptr<std::uint32_t[]> items;
    std::size_t count;
    std::vector<Run> runs;
};

std::uint32_t reference_of(std::uint32_t item) {
    return item & ~kSharedReference;
}

/// Returns the deepest cone above both, or 0.
std::uint32_t common_cone(std::uint32_t a, std::uint32_t b) {
    assert(a != 0 && b != 0);
    const int bits = std::min(std::bit_width(a), std::bit_width(b));
    a >>= std::bit_width(a) - bits;
    b >>= std::bit_width(b) - bits;
    const int differing = (std::bit_width(a ^ b) + 1) / 2 * 2;
    a >>= differing;
    return std::bit_width(a) < static_cast<int>(kOctantKeyBits) ? 0 : a;
}

/// The reach of a part of a leaf's list, in the units of the builder.
struct LeafReach {
    std::size_t node;
    RadialRange reach;
};

class TreeBuilder {
public:
    TreeBuilder(std::span<const Double3> positions, std::span<const Triangle> triangles,
                const TetraTreeOptions& options)
        : input_{positions, triangles, {}, {}, 1, 0}, options_(options) {
        TetraTree& result = result_;
        result.tree.level = std::min(options.level, format::kMaxTetraLevel);
        result.tree.threshold = std::max(options.threshold, 1U);
        result.tree.bounding = options.bounding;
    }

    TetraTree build() {
        if (!input_.triangles.empty()) {
            find_centre();
            place_vertices();
            place_triangles();
            split_levels();
            find_radii();
            if (options_.bounding == format::TetraBounding::boxes) {
                make_tetra_boxes(input_, exponent_, options_, result_);
            }
            find_inside();
        }
        fill_top();
        return std::move(result_);
    }

private:
    void find_centre() {
        const TetraCentre centre =
            tetra_centre(input_.positions, input_.triangles, options_.parallel_for);
        result_.tree.centre = centre.at;
        exponent_ = centre.exponent;
        input_.centre = centre.at;
        input_.scale = std::ldexp(1.0, exponent_);
        input_.level = result_.tree.level;
    }

    void place_vertices() {
        const std::size_t count = input_.positions.size();
        places_ = std::make_unique_for_overwrite<PlacedVertex[]>(count);
        reach_ = std::make_unique_for_overwrite<float[]>(count);
        input_.places = {places_.get(), count};
        for_chunks(count, kItemsPerTask, options_.parallel_for,
                   [&](std::size_t first, std::size_t last) {
                       for (std::size_t i = first; i < last; ++i) place_vertex(i);
                   });
    }
    void place_vertex(std::size_t i) {
        const SeenPoint p = seen_point(input_.centre, input_.positions[i], input_.scale);
        PlacedVertex& place = places_[i];
        place.inner_cone = inner_cone(p, input_.level);
        const double one = 1 / p.size;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            place.at[axis] = static_cast<float>(std::fabs(p.at[axis]) * one);
        }
        reach_[i] = static_cast<float>(p.size);
    }

    void place_triangles() {
        const std::size_t count = input_.triangles.size();
        home_ = std::make_unique_for_overwrite<std::uint32_t[]>(count);
        for_chunks(count, kItemsPerTask, options_.parallel_for,
                   [&](std::size_t first, std::size_t last) {
                       for (std::size_t i = first; i < last; ++i) home_[i] = home_of(i);
                   });
    }
    /// Returns the deepest cone that certainly contains the whole triangle, or 0 if there is none.
    [[nodiscard]] std::uint32_t home_of(std::size_t triangle) const {
        const auto& v = input_.triangles[triangle].vertex;
        const std::uint32_t a = places_[v[0]].inner_cone;
        const std::uint32_t b = places_[v[1]].inner_cone;
        const std::uint32_t c = places_[v[2]].inner_cone;
        if (a == b && b == c) return a;
        return a == 0 || b == 0 || c == 0 ? 0 : common_cone_of_three(a, b, c);
    }
    static std::uint32_t common_cone_of_three(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const std::uint32_t ab = common_cone(a, b);
        return ab == 0 ? 0 : common_cone(ab, c);
    }

    void split_levels() {
        std::uint32_t depth = level_at_once();
        TetraLevel level = first_level(depth);
        for (; !level.runs.empty(); ++depth) {
            std::vector<Run> inner = runs_to_split(level, depth);
            std::vector<TetraBatch> batches = count_children(level, inner);
            if (!has_room(level, inner, batches)) {
                inner.clear();
                batches.clear();
            }
            take_nodes(level, inner);
            level = move_down(level, inner, batches);
        }
    }

    /// Returns the level into which triangles are sorted first. If the cones above it are split in
    /// any case, their lists are never used. With few triangles that is unlikely, and the result is
    /// 0.
    [[nodiscard]] std::uint32_t level_at_once() const {
        constexpr std::size_t kTimes = 8;
        const format::TetraTree& tree = result_.tree;
        const std::uint32_t level = std::min(tree.level, kMostLevelAtOnce);
        const std::size_t enough =
            kTimes * std::size_t{tree.threshold} * format::tetra_cones(level);
        return tree.threshold == 1 || input_.triangles.size() >= enough ? level : 0;
    }

    /// Returns the cones of level `depth` and adds those of the levels above to the tree. If these
    /// are not all split, returns the octants and sets `depth` to 0.
    TetraLevel first_level(std::uint32_t& depth) {
        ConeLists lists = split_at_once(input_, home_.get(), depth, options_.parallel_for);
        if (!may_be_first(lists, depth)) {
            depth = 0;
            lists = split_at_once(input_, home_.get(), 0, options_.parallel_for);
        }
        result_.references = std::move(lists.centre);
        result_.tree.centre_count = static_cast<std::uint32_t>(result_.references.size());
        if (result_.tree.centre_count > 0) result_.tree.flags |= format::tetra_centre_on;
        for (std::uint32_t above = 0; above < depth; ++above) take_inner(lists, depth, above);
        return {std::move(lists.items), lists.first.back(), runs_of(lists, depth, depth)};
    }

    /// Returns the cones of level `above` that contain something from the lists of level `level`.
    static std::vector<Run> runs_of(const ConeLists& lists, std::uint32_t level,
                                    std::uint32_t above) {
        assert(above <= level);
        std::vector<Run> runs;
        const std::uint32_t below = 2 * (level - above);
        for (std::uint32_t i = 0; i < format::tetra_cones(above); ++i) {
            const std::size_t first = lists.first[std::size_t{i} << below];
            const std::size_t last = lists.first[(std::size_t{i} + 1) << below];
            if (last > first) runs.push_back({format::tetra_cones(above) + i, first, last, 0});
        }
        return runs;
    }

    /// Returns whether all cones above would be split. A cone's list holds everything that the list
    /// of a cone below holds.
    [[nodiscard]] bool may_be_first(const ConeLists& lists, std::uint32_t level) const {
        if (level == 0) return true;
        if (lists.first.back() > most_references()) return false;
        std::vector<std::size_t> most(format::tetra_cones(level));
        for (std::size_t i = 0; i < most.size(); ++i) most[i] = lists.first[i + 1] - lists.first[i];
        while (most.size() > format::tetra_cones(0)) {
            for (std::size_t i = 0; 4 * i < most.size(); ++i) {
                const auto children = most.begin() + static_cast<std::ptrdiff_t>(4 * i);
                most[i] = *std::max_element(children, children + 4);
                if (most[i] > 0 && most[i] < result_.tree.threshold) return false;
            }
            most.resize(most.size() / 4);
        }
        return true;
    }

    /// Adds the cones of level `above`. All of them are split.
    void take_inner(const ConeLists& lists, std::uint32_t level, std::uint32_t above) {
        const std::vector<Run> runs = runs_of(lists, level, above);
        const std::vector<Run> children = runs_of(lists, level, above + 1);
        const std::size_t end = result_.nodes.size() + runs.size();
        std::size_t child = 0;
        for (const Run& run : runs) {
            const std::size_t first = child;
            while (child < children.size() && children[child].key >> 2 == run.key) ++child;
            result_.nodes.push_back({run.key, 0, 0, 0, 0, format::tetra_inner});
            link_children(result_.nodes.back(), end + first,
                          std::span(children).subspan(first, child - first));
        }
    }

    [[nodiscard]] std::uint64_t most_references() const {
        constexpr std::uint64_t kMost = std::uint64_t{1} << 31;
        const std::uint64_t share = kMostReferencesPerTriangle * input_.triangles.size();
        return std::min(kMostFreeReferences + share, kMost);
    }

    [[nodiscard]] std::vector<Run> runs_to_split(const TetraLevel& level,
                                                 std::uint32_t depth) const {
        std::vector<Run> inner;
        if (depth == result_.tree.level) return inner;
        for (const Run& run : level.runs) {
            if (run.last - run.first >= result_.tree.threshold) inner.push_back(run);
        }
        return inner;
    }

    /// Returns whether the references of the level, with these cones split, are few enough.
    [[nodiscard]] bool has_room(const TetraLevel& level, const std::vector<Run>& inner,
                                const std::vector<TetraBatch>& batches) const {
        std::uint64_t count = result_.references.size() + level.count;
        for (const Run& run : inner) count -= run.last - run.first;
        for (const TetraBatch& batch : batches) {
            for (const std::size_t child : batch.place) count += child;
        }
        return count <= most_references();
    }

    /// Adds a level's cones to the tree, with the lists of those that are not split.
    void take_nodes(const TetraLevel& level, std::vector<Run>& inner) {
        std::vector<std::uint32_t>& references = result_.references;
        std::size_t next = 0;
        for (const Run& run : level.runs) {
            TetraNode node{};
            node.key = run.key;
            if (next < inner.size() && inner[next].key == run.key) {
                node.flags = format::tetra_inner;
                inner[next++].node = result_.nodes.size();
            } else {
                node.first = static_cast<std::uint32_t>(references.size());
                node.count = static_cast<std::uint32_t>(run.last - run.first);
                references.insert(references.end(), level.items.get() + run.first,
                                  level.items.get() + run.last);
            }
            result_.nodes.push_back(node);
        }
    }

    static std::vector<TetraBatch> batches_of(const std::vector<Run>& runs) {
        std::vector<TetraBatch> batches;
        for (std::size_t i = 0; i < runs.size(); ++i) {
            for (std::size_t first = runs[i].first; first < runs[i].last; first += kItemsPerTask) {
                batches.push_back({i, first, std::min(runs[i].last, first + kItemsPerTask), {}});
            }
        }
        return batches;
    }

    /// Calls body(batch) for each batch, several per task.
    template <class Body>
    void for_batches(std::vector<TetraBatch>& batches, const Body& body) const {
        std::vector<std::size_t> begin;
        std::size_t items = kItemsPerTask;
        for (std::size_t i = 0; i < batches.size(); ++i) {
            if (items >= kItemsPerTask) {
                begin.push_back(i);
                items = 0;
            }
            items += batches[i].last - batches[i].first;
        }
        begin.push_back(batches.size());
        options_.parallel_for(begin.size() - 1, [&](std::size_t task) {
            for (std::size_t i = begin[task]; i < begin[task + 1]; ++i) body(batches[i]);
        });
    }

    /// Counts, for each batch, how many references go to each child. Stores in mask_ the children
    /// of each reference.
    std::vector<TetraBatch> count_children(const TetraLevel& level, const std::vector<Run>& runs) {
        std::vector<TetraBatch> batches = batches_of(runs);
        if (batches.empty()) return batches;
        mask_ = std::make_unique_for_overwrite<std::uint8_t[]>(level.count);
        for_batches(batches,
                    [&](TetraBatch& batch) { count_batch(level, runs[batch.run].key, batch); });
        return batches;
    }

    void count_batch(const TetraLevel& level, std::uint32_t key, TetraBatch& batch) {
        ConeChildren children(input_, key);
        const int width = std::bit_width(key);
        for (std::size_t i = batch.first; i < batch.last; ++i) {
            const std::uint32_t triangle = reference_of(level.items[i]);
            const std::uint32_t home = home_[triangle];
            const int below = std::bit_width(home) - width;
            assert(below <= 0 || home >> below == key);
            const std::uint32_t mask = below > 0 ? 1U << (home >> (below - 2) & 3U)
                                                 : children.touched_by(triangle, home != 0);
            assert(mask != 0 && mask <= 0xf);
            mask_[i] = static_cast<std::uint8_t>(mask);
            for (std::size_t child = 0; child < 4; ++child) {
                batch.place[child] += mask >> child & 1U;
            }
        }
    }

    /// Returns the children with references, each list in the order of its parent's.
    TetraLevel move_down(const TetraLevel& from, const std::vector<Run>& runs,
                         std::vector<TetraBatch>& batches) {
        TetraLevel level{};
        std::size_t batch = 0;
        for (std::size_t i = 0; i < runs.size(); ++i) {
            const std::size_t first_batch = batch;
            while (batch < batches.size() && batches[batch].run == i) ++batch;
            const std::size_t first_child = level.runs.size();
            place_batches(runs[i].key, std::span(batches).subspan(first_batch, batch - first_batch),
                          level);
            link_children(result_.nodes[runs[i].node], result_.nodes.size() + first_child,
                          std::span(level.runs).subspan(first_child));
        }
        assert(batch == batches.size());
        level.items = std::make_unique_for_overwrite<std::uint32_t[]>(level.count);
        for_batches(batches, [&](TetraBatch& part) { move_batch(from, part, level); });
        return level;
    }

    /// Turns the counts of one cone's batches into places, and adds its children to the level.
    static void place_batches(std::uint32_t key, std::span<TetraBatch> batches, TetraLevel& level) {
        for (std::uint32_t child = 0; child < 4; ++child) {
            const std::size_t begin = level.count;
            for (TetraBatch& batch : batches) {
                const std::size_t count = batch.place[child];
                batch.place[child] = level.count;
                level.count += count;
            }
            if (level.count > begin)
                level.runs.push_back({key << 2 | child, begin, level.count, 0});
        }
    }

    static void link_children(TetraNode& parent, std::size_t first, std::span<const Run> children) {
        assert(!children.empty() && children.size() <= 4);
        parent.first = static_cast<std::uint32_t>(first);
        parent.count = static_cast<std::uint32_t>(children.size());
        for (const Run& child : children) parent.flags |= 1U << (child.key & 3U);
    }

    void move_batch(const TetraLevel& from, TetraBatch& batch, TetraLevel& level) const {
        for (std::size_t i = batch.first; i < batch.last; ++i) {
            std::uint32_t item = from.items[i];
            const std::uint32_t mask = mask_[i];
            if ((mask & (mask - 1)) != 0) item |= kSharedReference;
            for (std::uint32_t rest = mask; rest != 0; rest &= rest - 1) {
                level.items[batch.place[static_cast<std::size_t>(std::countr_zero(rest))]++] = item;
            }
        }
    }

    /// Computes the radii of leaves from their triangles and those of other nodes from their
    /// children, which cover them.
    void find_radii() {
        std::vector<TetraNode>& nodes = result_.nodes;
        std::vector<RadialRange> reach(nodes.size());
        for (const LeafReach& part : reach_of_leaves()) {
            reach[part.node].add(part.reach);
        }
        for (std::size_t i = nodes.size(); i-- > 0;) {
            TetraNode& node = nodes[i];
            if ((node.flags & format::tetra_inner) != 0) {
                assert(node.first > i);  // children follow their parents
                for (std::size_t k = node.first; k < node.first + node.count; ++k) {
                    reach[i].add(reach[k]);
                }
            }
            set_radii(reach[i], node);
        }
    }

    /// Returns the reach of all leaves. A leaf may occur several times, with parts of its list from
    /// several tasks.
    [[nodiscard]] std::vector<LeafReach> reach_of_leaves() const {
        std::vector<std::uint32_t> leaves;
        for (std::uint32_t i = 0; i < result_.nodes.size(); ++i) {
            if ((result_.nodes[i].flags & format::tetra_inner) == 0) leaves.push_back(i);
        }
        const std::size_t count = result_.references.size();
        std::vector<std::vector<LeafReach>> parts((count + kItemsPerTask - 1) / kItemsPerTask);
        for_chunks(count, kItemsPerTask, options_.parallel_for,
                   [&](std::size_t first, std::size_t last) {
                       reach_of_references(leaves, first, last, parts[first / kItemsPerTask]);
                   });
        std::vector<LeafReach> all;
        for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
        return all;
    }

    void reach_of_references(const std::vector<std::uint32_t>& leaves, std::size_t first,
                             std::size_t last, std::vector<LeafReach>& parts) const {
        // The last leaf that begins at or before the first reference.
        auto leaf = std::upper_bound(leaves.begin(), leaves.end(), first,
                                     [&](std::size_t place, std::uint32_t node) {
                                         return place < result_.nodes[node].first;
                                     });
        // The triangles that hold the centre come before all lists.
        if (leaf != leaves.begin()) --leaf;
        for (; leaf != leaves.end() && result_.nodes[*leaf].first < last; ++leaf) {
            const TetraNode& node = result_.nodes[*leaf];
            const std::size_t begin = std::max<std::size_t>(first, node.first);
            const std::size_t end =
                std::min<std::size_t>(last, node.first + std::size_t{node.count});
            if (begin < end) parts.push_back({*leaf, reach_of_part(node.key, begin, end)});
        }
    }

    /// The least and greatest sum of sizes of a triangle's corners. For corners within the octant,
    /// that sum is their distance from the centre.
    struct Sizes {
        float least;
        float greatest;
    };
    [[nodiscard]] Sizes sizes_of(std::uint32_t triangle) const {
        const auto& v = input_.triangles[triangle].vertex;
        const float a = reach_[v[0]], b = reach_[v[1]], c = reach_[v[2]];
        return {std::min(std::min(a, b), c), std::max(std::max(a, b), c)};
    }
    /// Returns the range, widened by the rounding: to double by 8 u and to float by 2^-24; tiny
    /// numbers by about 2^-149.
    static RadialRange range_of(const Sizes& sizes) {
        constexpr double kRounding = 0x1p-22;
        constexpr double kTiny = 0x1p-140;
        return {std::max(0.0, double{sizes.least} * (1 - kRounding) - kTiny),
                double{sizes.greatest} * (1 + kRounding) + kTiny};
    }

    /// Returns the reach of a part of a leaf's list. A triangle listed in one leaf only lies
    /// entirely in it. These come first; the shared ones follow. The loop has no branch, because it
    /// is unpredictable which triangles are shared.
    [[nodiscard]] RadialRange reach_of_part(std::uint32_t key, std::size_t begin,
                                            std::size_t end) const {
        constexpr float kFar = std::numeric_limits<float>::infinity();
        std::array<std::uint32_t, kItemsPerTask> shared;
        assert(end - begin <= shared.size());
        std::size_t shared_count = 0;
        Sizes all = {kFar, 0};
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t item = result_.references[i];
            const bool is_shared = (item & kSharedReference) != 0;
            const Sizes sizes = sizes_of(reference_of(item));
            all.least = std::min(all.least, is_shared ? kFar : sizes.least);
            all.greatest = std::max(all.greatest, is_shared ? 0 : sizes.greatest);
            shared[shared_count] = reference_of(item);
            shared_count += is_shared ? 1 : 0;
        }
        RadialRange range = all.least == kFar ? RadialRange{} : range_of(all);
        add_parts(key, std::span(shared.data(), shared_count), range);
        return range;
    }

    /// Adds triangles that are in this leaf and in others.
    void add_parts(std::uint32_t key, std::span<const std::uint32_t> triangles,
                   RadialRange& range) const {
        const ConeFaces faces = cone_faces(tetra_cone(key));
        for (const std::uint32_t triangle : triangles) {
            const RadialRange whole = range_of(sizes_of(triangle));
            // Its corners are in one octant, and others reach as far: its part adds nothing.
            const bool is_within = home_[triangle] != 0 && whole.least >= range.least &&
                                   whole.greatest <= range.greatest;
            if (!is_within) add_part(faces, input_.seen(triangle), range);
        }
    }

    void set_radii(const RadialRange& reach, TetraNode& node) const {
        // The factor and two products are rounded. kTiny covers lengths below every float.
        constexpr double kRounding = 0x1p-50;
        constexpr double kTiny = 0x1p-1000;
        constexpr double kMost = std::numeric_limits<float>::max();
        const int exponent = options_.frame_exponent - exponent_;
        const double least = std::ldexp(reach.least * (kThird * (1 - kRounding)), exponent) - kTiny;
        const double greatest =
            std::ldexp(reach.greatest * (kThird * (1 + kRounding)), exponent) + kTiny;
        node.radius_max =
            greatest > kMost ? std::numeric_limits<float>::infinity() : float_above(greatest);
        if (options_.bounding == format::TetraBounding::tetra) return;
        node.radius_min = float_below(std::clamp(least, 0.0, kMost));
    }

    /// Sets the flag tetra_centre_inside. A ray from the centre crosses only triangles of the
    /// closed cone of its direction, even when it is perturbed.
    void find_inside() {
        if (result_.nodes.empty() || result_.tree.centre_count > 0) return;
        const TetraNode& leaf = result_.nodes.back();
        const Double3 from = behind_centre(input_.centre, tetra_cone(leaf.key));
        int winding = 0;
        for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
            const std::uint32_t triangle = reference_of(result_.references[i]);
            winding += winding_term(from, input_.centre, input_.corners(triangle)).crossings;
        }
        if (winding != 0) result_.tree.flags |= format::tetra_centre_inside;
    }

    void fill_top() {
        format::TetraTree& tree = result_.tree;
        while (tree.top_level < tree.level &&
               format::tetra_cones(tree.top_level + 1) <= 2 * result_.nodes.size()) {
            ++tree.top_level;
        }
        result_.top.assign(format::tetra_cones(tree.top_level), 0);
        for (std::uint32_t i = 0; i < result_.nodes.size(); ++i) {
            const TetraNode& node = result_.nodes[i];
            const std::uint32_t level = tetra_level(node.key);
            if (level > tree.top_level) break;
            if (level < tree.top_level && (node.flags & format::tetra_inner) != 0) continue;
            const std::uint32_t below = 2 * (tree.top_level - level);
            const std::size_t first = (std::size_t{node.key} << below) - result_.top.size();
            std::fill_n(result_.top.begin() + static_cast<std::ptrdiff_t>(first),
                        std::size_t{1} << below, i + 1);
        }
    }

    TetraInput input_;
    TetraTreeOptions options_;
    TetraTree result_;
    std::int32_t exponent_ = 0;               ///< of input_.scale
    std::unique_ptr<PlacedVertex[]> places_;  ///< per vertex
    std::unique_ptr<float[]> reach_;          ///< per vertex: sum of the sizes, scaled
    std::unique_ptr<std::uint32_t[]> home_;   ///< per triangle
    std::unique_ptr<std::uint8_t[]> mask_;    ///< per reference of a level
};

}  // namespace

TetraTree build_tetra_tree(std::span<const Double3> positions, std::span<const Triangle> triangles,
                           const TetraTreeOptions& options) {
    format::FloatEnvironment environment;
    const GuardedFor guarded(environment, options.parallel_for);
    TetraTreeOptions inside = options;
    inside.parallel_for = guarded;
    return TreeBuilder(positions, triangles, inside).build();
}

}  // namespace cdprep::build
