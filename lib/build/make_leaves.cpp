// SPDX-License-Identifier: MIT
#include "build/make_leaves.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <type_traits>

#include "build/chunks.h"
#include "build/frame_map.h"
#include "build/lanes.h"
#include "build/make_nodes.h"
#include "cdprep/advanced/parallel_for.h"
#include "core/prefetch.h"
#include "exact/triangle_contact.h"

namespace cdprep::build {
namespace {

using format::BvhLeaf;
using format::BvhNode;
using format::BvhShape;
using format::Double3;
using format::Float3;
using format::kBvhWidth;
using format::Triangle;

/// One coordinate of the corners of a leaf, corner by corner. Lanes past the last triangle repeat
/// it.
using CornerRow = Lanes<double, std::size_t{3} * kBvhWidth>;
using LeafCorners = std::array<CornerRow, 3>;

struct Bound {
    double lower;
    double upper;
};

Bound bound_of(const CornerRow& row) {
    Lanes<double, kBvhWidth> lower;
    std::copy_n(row.begin(), kBvhWidth, lower.begin());
    Lanes<double, kBvhWidth> upper = lower;
    for (std::size_t corner = 1; corner < 3; ++corner) {
        for_lanes<kBvhWidth>([&](std::size_t lane) {
            const double x = row[corner * kBvhWidth + lane];
            lower[lane] = x < lower[lane] ? x : lower[lane];
            upper[lane] = upper[lane] < x ? x : upper[lane];
        });
    }
    return {least(lower), greatest(upper)};
}

/// Writes leaves, whose corners are in model coordinates or in frame coordinates.
class LeafMaker {
public:
    LeafMaker(const Frame& frame, bool exact)
        : map_(frame), kernel_map_(leaf_map(frame)), exact_(exact) {}

    /// Writes one leaf and its box.
    void make(LeafCorners& corners, std::uint32_t count, BvhLeaf& leaf, BvhNode& node,
              std::size_t box) const {
        assert(count > 0 && count <= kBvhWidth && box < kBvhWidth);
        leaf.count = count;
        leaf.reserved = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            CornerRow& row = corners[axis];
            Bound bound = bound_of(row);
            node.lower[axis][box] = map_.around(bound.lower, axis).lower;
            node.upper[axis][box] = map_.around(bound.upper, axis).upper;
            if (!exact_) {
                for (double& x : row) x = map_.near(x, axis);
                bound = {map_.near(bound.lower, axis), map_.near(bound.upper, axis)};
            }
            const auto origin = static_cast<float>(0.5 * bound.lower + 0.5 * bound.upper);
            leaf.origin[axis] = origin;
            fill_axis(leaf, row, axis);
            const double reach =
                std::max(bound.upper - double{origin}, double{origin} - bound.lower);
            // The difference of two doubles is off by at most half an ulp.
            const double enlarged = reach * (1 + 0x1p-50);
            leaf.half[axis] = float_above(exact_ ? map_.scaled(enlarged) : enlarged);
        }
    }

    /// Writes a leaf of eight triangles of floats, and its box, with the bits that make() above
    /// gives. Returns, as a bit set, those with a proven area. Requires leaves in model
    /// coordinates.
    unsigned make(std::span<const Float3> positions, const Triangle* triangles, BvhLeaf& leaf,
                  BvhNode& node, std::size_t box) const {
        static_assert(sizeof(BvhLeaf) == (kernels::kLeafHalf + 3) * sizeof(float) + 8);
        assert(exact_);
        std::array<float, kernels::kPaddedBox> around;
        const unsigned with_area =
            fill_leaf_(kernel_map_, &positions[0].x, triangles->vertex.data(),
                       &leaf.corner[0][0][0], around.data());
        leaf.count = kBvhWidth;
        leaf.reserved = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            node.lower[axis][box] = around[axis];
            node.upper[axis][box] = around[kernels::kPaddedUpper + axis];
        }
        return with_area;
    }

private:
    void fill_axis(BvhLeaf& leaf, const CornerRow& row, std::size_t axis) const {
        const double taken_off = exact_ ? 0.0 : double{leaf.origin[axis]};
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const double* from = &row[corner * kBvhWidth];
            Lanes<float, kBvhWidth>& to = leaf.corner[corner][axis];
            for_lanes<kBvhWidth>(
                [&](std::size_t lane) { to[lane] = static_cast<float>(from[lane] - taken_off); });
        }
    }

    FrameMap map_;
    kernels::LeafMap kernel_map_;
    bool exact_;
    decltype(kernels::Table::fill_leaf) fill_leaf_ = kernels::active().fill_leaf;
};

/// Triangles anywhere in memory, with an order of their own.
class OrderedTriangles {
public:
    static constexpr bool kIsOfKernel = false;

    OrderedTriangles(std::span<const std::uint32_t> order, std::span<const Double3> positions,
                     std::span<const Triangle> triangles)
        : order_(order), positions_(positions), triangles_(triangles) {}

    [[nodiscard]] std::size_t size() const {
        return order_.size();
    }
    [[nodiscard]] const Triangle& triangle(std::size_t index) const {
        return triangles_[order_[index]];
    }
    [[nodiscard]] const Double3& position(std::uint32_t vertex) const {
        return positions_[vertex];
    }

    /// Prefetches the data of leaves ahead: the tree order is not the order in memory.
    void ask_ahead_of(std::size_t leaf) const {
        each_of(leaf + 2 * kLeavesAhead, [](const Triangle& t) { prefetch(&t); });
        each_of(leaf + kLeavesAhead, [&](const Triangle& t) {
            for (const std::uint32_t vertex : t.vertex) prefetch(&positions_[vertex]);
        });
    }

private:
    static constexpr std::size_t kLeavesAhead = 2;

    template <class Ask>
    void each_of(std::size_t leaf, const Ask& ask) const {
        const std::size_t begin = leaf * kBvhWidth;
        if (begin + kBvhWidth > order_.size()) return;
        for (const std::uint32_t number : order_.subspan(begin, kBvhWidth)) ask(triangles_[number]);
    }

    std::span<const std::uint32_t> order_;
    std::span<const Double3> positions_;
    std::span<const Triangle> triangles_;
};

/// Triangles stored in tree order, with vertices nearly so: the processor itself predicts the next
/// reads.
template <class Position>
class SortedTriangles {
public:
    /// Whether a kernel takes eight of them at a time.
    static constexpr bool kIsOfKernel = std::is_same_v<Position, Float3>;

    SortedTriangles(std::span<const Position> positions, std::span<const Triangle> triangles)
        : positions_(positions), triangles_(triangles) {}

    [[nodiscard]] std::size_t size() const {
        return triangles_.size();
    }
    [[nodiscard]] const Triangle& triangle(std::size_t index) const {
        return triangles_[index];
    }
    [[nodiscard]] Double3 position(std::uint32_t vertex) const {
        return as_double(positions_[vertex]);
    }
    void ask_ahead_of(std::size_t /*leaf*/) const {}

    [[nodiscard]] std::span<const Position> positions() const {
        return positions_;
    }

private:
    std::span<const Position> positions_;
    std::span<const Triangle> triangles_;
};

/// Returns the lane whose triangle is stored in a lane: itself if it has one. Otherwise it is the
/// last before it that has, or else the first.
std::size_t lane_for(std::size_t lane, unsigned lanes) {
    const unsigned up_to = lanes & ((2U << lane) - 1);
    return static_cast<std::size_t>(up_to != 0 ? std::bit_width(up_to) - 1
                                               : std::countr_zero(lanes));
}

/// Returns the lanes whose corners are proven not to be collinear: the coordinate `axis` of their
/// normal is not 0. Let u = 2^-53. The differences, the products and their difference round by less
/// than 5 u of the products' magnitudes. Where numbers underflow or overflow, nothing is proven.
unsigned lanes_with_area(const LeafCorners& corners, std::size_t axis) {
    constexpr double kRounding = 0x1p-50, kLeast = 0x1p-960;
    const CornerRow& x = corners[(axis + 1) % 3];
    const CornerRow& y = corners[(axis + 2) % 3];
    Lanes<double, kBvhWidth> proof;
    for_lanes<kBvhWidth>([&](std::size_t lane) {
        const std::size_t b = kBvhWidth + lane, c = std::size_t{2} * kBvhWidth + lane;
        const double first = (x[b] - x[lane]) * (y[c] - y[lane]);
        const double second = (y[b] - y[lane]) * (x[c] - x[lane]);
        proof[lane] = std::fabs(first - second) -
                      (kRounding * (std::fabs(first) + std::fabs(second)) + kLeast);
    });
    unsigned lanes = 0;
    for (std::size_t lane = 0; lane < kBvhWidth; ++lane) {
        lanes |= static_cast<unsigned>(proof[lane] > 0) << lane;
    }
    return lanes;
}

/// Returns the lanes whose corners are collinear, of those that are not proven to have an area.
/// corner(lane, k) is corner k of a lane.
template <class Corner>
unsigned degenerate_lanes(unsigned open, const Corner& corner) {
    unsigned found = 0;
    for (; open != 0; open &= open - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(open));
        const bool is_flat = is_degenerate({corner(lane, 0), corner(lane, 1), corner(lane, 2)});
        found |= static_cast<unsigned>(is_flat) << lane;
    }
    return found;
}

/// Stores the bits of a leaf's places: those that are degenerate.
void mark_places(unsigned marks, std::size_t leaf, std::span<std::uint64_t> words) {
    const std::size_t shift = leaf % kBvhWidth * kBvhWidth;
    std::uint64_t& word = words[leaf / kBvhWidth];
    word = (word & ~(std::uint64_t{0xff} << shift)) | std::uint64_t{marks} << shift;
}

/// Makes the leaves of a tree, one at a time.
template <class Source>
class LeafFiller {
public:
    LeafFiller(const LeafRoom& room, const Source& source)
        : room_(room),
          source_(source),
          maker_(room.frame, room.exact),
          lowest_(
              &room.nodes[format::bvh_shape(static_cast<std::uint32_t>(source.size())).first[0]]) {}

    void make(std::size_t leaf) {
        source_.ask_ahead_of(leaf);
        const std::size_t places =
            std::min<std::size_t>(kBvhWidth, source_.size() - leaf * kBvhWidth);
        const unsigned all = (1U << places) - 1;
        const unsigned lanes = room_.lanes == nullptr ? all : room_.lanes[leaf];
        const unsigned degenerate = (all & ~lanes) | make_at(leaf, lanes);
        if (!room_.degenerate_bits.empty()) mark_places(degenerate, leaf, room_.degenerate_bits);
    }

private:
    static constexpr unsigned kFull = (1U << kBvhWidth) - 1;

    [[nodiscard]] BvhNode& node(std::size_t leaf) const {
        return lowest_[leaf / kBvhWidth];
    }

    /// Makes a leaf with triangles at some places. Returns those that are degenerate, if they are
    /// wanted.
    unsigned make_at(std::size_t leaf, unsigned lanes) {
        if (lanes == 0) {
            set_unused_box(node(leaf), leaf % kBvhWidth);
            return 0;
        }
        if constexpr (Source::kIsOfKernel) {
            if (room_.exact) return make_of_floats(leaf, lanes);
        }
        return make_of_any(leaf, lanes);
    }

    /// As above, for triangles of floats.
    unsigned make_of_floats(std::size_t leaf, unsigned lanes) const {
        const Triangle* triangles = &source_.triangle(leaf * kBvhWidth);
        std::array<Triangle, kBvhWidth> stored;
        if (lanes != kFull) {
            for (std::size_t lane = 0; lane < kBvhWidth; ++lane) {
                stored[lane] = triangles[lane_for(lane, lanes)];
            }
            triangles = stored.data();
        }
        BvhLeaf& to = room_.leaves[leaf];
        const unsigned with_area =
            maker_.make(source_.positions(), triangles, to, node(leaf), leaf % kBvhWidth);
        to.count = static_cast<std::uint32_t>(std::popcount(lanes));
        if (room_.degenerate_bits.empty()) return 0;
        return degenerate_lanes(lanes & ~with_area, [&](std::size_t lane, std::size_t k) {
            const auto& x = to.corner[k];
            return Double3{double{x[0][lane]}, double{x[1][lane]}, double{x[2][lane]}};
        });
    }

    /// As above, for triangles of any kind.
    unsigned make_of_any(std::size_t leaf, unsigned lanes) {
        for (std::size_t lane = 0; lane < kBvhWidth; ++lane) {
            const Triangle& t = source_.triangle(leaf * kBvhWidth + lane_for(lane, lanes));
            for (std::size_t k = 0; k < 3; ++k) {
                const Double3& p = source_.position(t.vertex[k]);
                const std::size_t at = k * kBvhWidth + lane;
                corners_[0][at] = p.x;
                corners_[1][at] = p.y;
                corners_[2][at] = p.z;
            }
        }
        unsigned open = room_.degenerate_bits.empty() ? 0 : lanes;
        for (std::size_t axis = 0; axis < 3 && open != 0; ++axis) {
            open &= ~lanes_with_area(corners_, axis);
        }
        const unsigned degenerate = degenerate_lanes(open, [&](std::size_t lane, std::size_t k) {
            const std::size_t i = k * kBvhWidth + lane;
            return Double3{corners_[0][i], corners_[1][i], corners_[2][i]};
        });
        maker_.make(corners_, static_cast<std::uint32_t>(std::popcount(lanes)), room_.leaves[leaf],
                    node(leaf), leaf % kBvhWidth);
        return degenerate;
    }

    const LeafRoom& room_;
    const Source& source_;
    LeafMaker maker_;
    BvhNode* lowest_;  ///< the nodes around leaves
    LeafCorners corners_{};
};

template <class Source>
void make_range(const LeafRoom& room, const Source& source, std::size_t first, std::size_t last) {
    LeafFiller<Source> filler(room, source);
    for (std::size_t leaf = first; leaf < last; ++leaf) filler.make(leaf);
}

template <class Source>
void make_leaves_of(const LeafRoom& room, const Source& source, ParallelFor parallel_for) {
    for_chunks(room.leaves.size(), kLeavesPerTask, parallel_for,
               [&](std::size_t first, std::size_t last) { make_range(room, source, first, last); });
    const std::size_t last = room.leaves.size();
    const BvhShape shape = format::bvh_shape(static_cast<std::uint32_t>(source.size()));
    BvhNode* const lowest = &room.nodes[shape.first[0]];
    if (last % kBvhWidth != 0) set_unused_boxes(lowest[last / kBvhWidth], last % kBvhWidth);
}

}  // namespace

kernels::LeafMap leaf_map(const Frame& frame) {
    const auto [x, y, z] = frame.origin;
    const Scale scale(frame.exponent), back(-frame.exponent);
    return {
        {x, y, z, 0, x, y, z, 0}, {scale.first(), scale.second()}, {back.first(), back.second()}};
}

void make_leaves(Bvh& bvh, std::span<const Double3> positions, std::span<const Triangle> triangles,
                 ParallelFor parallel_for) {
    make_leaves_of({bvh.frame, bvh.exact_leaves, bvh.nodes, bvh.leaves},
                   OrderedTriangles(bvh.order, positions, triangles), parallel_for);
}

void make_leaves(const LeafRoom& room, std::span<const Double3> positions,
                 std::span<const Triangle> triangles, ParallelFor parallel_for) {
    make_leaves_of(room, SortedTriangles<Double3>(positions, triangles), parallel_for);
}

void make_leaves(const LeafRoom& room, std::span<const Float3> positions,
                 std::span<const Triangle> triangles, ParallelFor parallel_for) {
    make_leaves_of(room, SortedTriangles<Float3>(positions, triangles), parallel_for);
}

void make_some_leaves(const LeafRoom& room, std::span<const Double3> positions,
                      std::span<const Triangle> triangles, std::size_t first, std::size_t last) {
    make_range(room, SortedTriangles<Double3>(positions, triangles), first, last);
}

void make_some_leaves(const LeafRoom& room, std::span<const Float3> positions,
                      std::span<const Triangle> triangles, std::size_t first, std::size_t last) {
    make_range(room, SortedTriangles<Float3>(positions, triangles), first, last);
}

}  // namespace cdprep::build
