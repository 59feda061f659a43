// SPDX-License-Identifier: MIT
#include "cdprep/build_tetra_tree.h"

#include <bit>
#include <limits>
#include <memory>

#include "cdprep/format/octree.h"
#include "chunks.h"
#include "cone_children.h"
#include "frame_map.h"
#include "radial_range.h"
#include "tetra_centre.h"
#include "winding.h"

// Level by level, all cones of a level at once: each cone's list of triangles is handed
// down to its children. Most triangles lie inside one finest cone, which is known from
// their corners alone (inner_cone); for the others the exact test is asked. Lists are
// cut into pieces of kItemsPerTask: counted first, then moved to places that are known,
// so that every list rises and no thread waits for another.
//
// Scratch, in bytes: 20 a vertex (and 1 while the centre is sought), 4 a triangle; and 9
// a reference of the longest two levels that follow each other, which are no more than
// those of the result when every cone is split, and the triangles times the octants
// that they touch.

namespace cdprep::build {
namespace {

using format::Double3;
using format::kSharedReference;
using format::TetraNode;
using format::Triangle;

constexpr double kThird = 0.57735026918962576;  ///< 1 / sqrt(3)

/// Part of a level's references: those of one cone.
struct Run {
    std::uint32_t key;
    std::size_t first;
    std::size_t last;
    std::size_t node;  ///< its number, once it has one
};

/// Part of a run, for one task.
struct Piece {
    std::size_t run;
    std::size_t first;
    std::size_t last;
    std::array<std::size_t, 8> place;  ///< for each child: first references there, then where to
};

/// One level: who is where.
struct Level {
    std::vector<std::uint32_t> items;
    std::vector<Run> runs;
};

std::uint32_t reference_of(std::uint32_t item) {
    return item & ~kSharedReference;
}

/// The deepest cone above both.
std::uint32_t common_cone(std::uint32_t a, std::uint32_t b) {
    const int bits = std::min(std::bit_width(a), std::bit_width(b));
    a >>= std::bit_width(a) - bits;
    b >>= std::bit_width(b) - bits;
    const int differing = (std::bit_width(a ^ b) + 1) / 2 * 2;
    a >>= differing;
    return std::bit_width(a) < static_cast<int>(kOctantKeyBits) ? 0 : a;
}

/// Of a part of a leaf's list, in the units of the builder.
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
        for (std::size_t axis = 0; axis < 3; ++axis) {
            place.at[axis] = static_cast<float>(std::fabs(p.at[axis]) / p.size);
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
    /// The deepest cone that certainly holds all of the triangle inside; 0 when none does.
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

    /// The part of a level that is split, of which the caller keeps the rest.
    void split_levels() {
        Level level = octants();
        for (std::uint32_t depth = 0; !level.runs.empty(); ++depth) {
            level = split(level, take_leaves(level, depth), 2);
        }
    }

    Level octants() {
        Level all;
        all.items.resize(input_.triangles.size());
        for (std::uint32_t i = 0; i < all.items.size(); ++i) all.items[i] = i;
        Level level = split(all, {{kRootKey, 0, all.items.size(), 0}}, 3);
        for (std::size_t i = 0; i < all.items.size(); ++i) {
            if (mask_[i] == 0) result_.references.push_back(static_cast<std::uint32_t>(i));
        }
        result_.tree.centre_count = static_cast<std::uint32_t>(result_.references.size());
        if (result_.tree.centre_count > 0) result_.tree.flags |= format::tetra_centre_on;
        return level;
    }

    /// Adds a level's cones to the tree, with the lists of its leaves. Returns the others.
    std::vector<Run> take_leaves(const Level& level, std::uint32_t depth) {
        std::vector<Run> inner;
        for (const Run& run : level.runs) {
            const std::size_t count = run.last - run.first;
            const bool is_leaf = depth == result_.tree.level || count < result_.tree.threshold;
            TetraNode node{};
            node.key = run.key;
            if (is_leaf) {
                node.first = static_cast<std::uint32_t>(result_.references.size());
                node.count = static_cast<std::uint32_t>(count);
                const auto first = level.items.begin() + static_cast<std::ptrdiff_t>(run.first);
                result_.references.insert(result_.references.end(), first,
                                          first + static_cast<std::ptrdiff_t>(count));
            } else {
                node.flags = format::tetra_inner;
                inner.push_back({run.key, run.first, run.last, result_.nodes.size()});
            }
            result_.nodes.push_back(node);
        }
        return inner;
    }

    static std::vector<Piece> pieces_of(const std::vector<Run>& runs) {
        std::vector<Piece> pieces;
        for (std::size_t i = 0; i < runs.size(); ++i) {
            for (std::size_t first = runs[i].first; first < runs[i].last; first += kItemsPerTask) {
                pieces.push_back({i, first, std::min(runs[i].last, first + kItemsPerTask), {}});
            }
        }
        return pieces;
    }

    /// Calls body(piece) for each, some a task.
    template <class Body>
    void for_pieces(std::vector<Piece>& pieces, const Body& body) const {
        std::vector<std::size_t> begin;
        std::size_t items = kItemsPerTask;
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            if (items >= kItemsPerTask) {
                begin.push_back(i);
                items = 0;
            }
            items += pieces[i].last - pieces[i].first;
        }
        begin.push_back(pieces.size());
        options_.parallel_for(begin.size() - 1, [&](std::size_t task) {
            for (std::size_t i = begin[task]; i < begin[task + 1]; ++i) body(pieces[i]);
        });
    }

    /// The children, 2^bits each, of cones that are split; and in mask_ who went where.
    Level split(const Level& from, const std::vector<Run>& runs, std::uint32_t bits) {
        std::vector<Piece> pieces = pieces_of(runs);
        mask_.resize(from.items.size());
        for_pieces(pieces, [&](Piece& piece) { count_piece(from, runs[piece.run], bits, piece); });
        Level level;
        place_pieces(runs, bits, pieces, level);
        for_pieces(pieces, [&](Piece& piece) { move_piece(from, piece, level); });
        return level;
    }

    void count_piece(const Level& from, const Run& run, std::uint32_t bits, Piece& piece) {
        ConeChildren children(input_, run.key);
        for (std::size_t i = piece.first; i < piece.last; ++i) {
            const std::uint32_t triangle = reference_of(from.items[i]);
            const std::uint32_t home = home_[triangle];
            const int below = std::bit_width(home) - std::bit_width(run.key);
            std::uint32_t mask = 0;
            if (below > 0) {
                const std::uint32_t child = home >> (static_cast<std::uint32_t>(below) - bits);
                mask = 1U << (child & ((1U << bits) - 1));
            } else {
                mask = children.touched_by(triangle, home != 0);
            }
            mask_[i] = static_cast<std::uint8_t>(mask);
            for (std::uint32_t rest = mask; rest != 0; rest &= rest - 1) {
                ++piece.place[static_cast<std::size_t>(std::countr_zero(rest))];
            }
        }
    }

    /// Turns counts into places, and makes the children that have something.
    void place_pieces(const std::vector<Run>& runs, std::uint32_t bits, std::vector<Piece>& pieces,
                      Level& level) {
        std::size_t end = 0;
        std::size_t piece = 0;
        for (std::size_t i = 0; i < runs.size(); ++i) {
            const std::size_t first_piece = piece;
            while (piece < pieces.size() && pieces[piece].run == i) ++piece;
            const std::size_t first_child = level.runs.size();
            for (std::uint32_t child = 0; child < 1U << bits; ++child) {
                const std::size_t begin = end;
                for (std::size_t k = first_piece; k < piece; ++k) {
                    const std::size_t count = pieces[k].place[child];
                    pieces[k].place[child] = end;
                    end += count;
                }
                if (end == begin) continue;
                level.runs.push_back({runs[i].key << bits | child, begin, end, 0});
            }
            if (runs[i].key != kRootKey) link_children(runs[i].node, level.runs, first_child);
        }
        level.items.resize(end);
    }

    /// The children will be the next nodes, in the order of their runs.
    void link_children(std::size_t node, const std::vector<Run>& runs, std::size_t first_child) {
        TetraNode& parent = result_.nodes[node];
        parent.first = static_cast<std::uint32_t>(result_.nodes.size() + first_child);
        parent.count = static_cast<std::uint32_t>(runs.size() - first_child);
        for (std::size_t i = first_child; i < runs.size(); ++i) {
            parent.flags |= 1U << (runs[i].key & 3U);
        }
    }

    void move_piece(const Level& from, Piece& piece, Level& level) const {
        for (std::size_t i = piece.first; i < piece.last; ++i) {
            std::uint32_t item = from.items[i];
            const std::uint32_t mask = mask_[i];
            if ((mask & (mask - 1)) != 0) item |= kSharedReference;
            for (std::uint32_t rest = mask; rest != 0; rest &= rest - 1) {
                level.items[piece.place[static_cast<std::size_t>(std::countr_zero(rest))]++] = item;
            }
        }
    }

    /// Of leaves from their triangles, of the others from their children: these cover them.
    void find_radii() {
        std::vector<TetraNode>& nodes = result_.nodes;
        std::vector<RadialRange> reach(nodes.size());
        for (const LeafReach& part : reach_of_leaves()) {
            reach[part.node].add(part.reach);
        }
        for (std::size_t i = nodes.size(); i-- > 0;) {
            TetraNode& node = nodes[i];
            if ((node.flags & format::tetra_inner) != 0) {
                for (std::size_t k = node.first; k < node.first + node.count; ++k) {
                    reach[i].add(reach[k]);
                }
            }
            set_radii(reach[i], node);
        }
    }

    /// A leaf may be in several tasks: parts of its list.
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
        // Before all lists are the triangles that hold the centre.
        if (leaf != leaves.begin()) --leaf;
        for (; leaf != leaves.end() && result_.nodes[*leaf].first < last; ++leaf) {
            const TetraNode& node = result_.nodes[*leaf];
            const std::size_t begin = std::max<std::size_t>(first, node.first);
            const std::size_t end =
                std::min<std::size_t>(last, node.first + std::size_t{node.count});
            if (begin < end) parts.push_back({*leaf, reach_of_part(node.key, begin, end)});
        }
    }

    /// A triangle that is listed in one leaf lies in it, whole: these come first.
    [[nodiscard]] RadialRange reach_of_part(std::uint32_t key, std::size_t begin,
                                            std::size_t end) const {
        RadialRange range = reach_of_unshared(begin, end);
        const ConeFaces faces = cone_faces(tetra_cone(key));
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t item = result_.references[i];
            if ((item & kSharedReference) == 0) continue;
            add_part(faces, input_.seen(reference_of(item)), range);
        }
        return range;
    }

    [[nodiscard]] RadialRange reach_of_unshared(std::size_t begin, std::size_t end) const {
        constexpr float kFar = std::numeric_limits<float>::infinity();
        float least = kFar;
        float greatest = 0;
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t item = result_.references[i];
            if ((item & kSharedReference) != 0) continue;
            for (const std::uint32_t v : input_.triangles[item].vertex) {
                least = std::min(least, reach_[v]);
                greatest = std::max(greatest, reach_[v]);
            }
        }
        if (least == kFar) return {};
        // Rounded to double by 8 u and to float by 2^-24; tiny ones by some 2^-149.
        constexpr double kRounding = 0x1p-22;
        constexpr double kTiny = 0x1p-140;
        return {std::max(0.0, double{least} * (1 - kRounding) - kTiny),
                double{greatest} * (1 + kRounding) + kTiny};
    }

    void set_radii(const RadialRange& reach, TetraNode& node) const {
        // The factor and two products round; then lengths below every float.
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

    /// A ray from the centre crosses triangles of one cone only: that of its direction,
    /// closed, even when it is perturbed.
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
    std::vector<std::uint8_t> mask_;          ///< per reference of a level
};

}  // namespace

TetraTree build_tetra_tree(std::span<const Double3> positions, std::span<const Triangle> triangles,
                           const TetraTreeOptions& options) {
    return TreeBuilder(positions, triangles, options).build();
}

}  // namespace cdprep::build
