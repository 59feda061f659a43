// SPDX-License-Identifier: MIT
#include "cdprep/build_bvh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "chunks.h"
#include "make_leaves.h"
#include "make_oriented.h"
#include "make_swept.h"

// The builder works on boxes that are already rounded outwards into the frame,
// so every union of them is exact and no later step can lose a vertex. All
// decisions depend on sets (counts, least and greatest coordinates) and never on
// the order of the items, and ties go to the lower number: the result is the same
// for any schedule and any standard library.

namespace cdprep::build {
namespace {

using format::BvhNode;
using format::BvhShape;
using format::Double3;
using format::kBvhWidth;
using format::Triangle;

constexpr std::size_t kBins = 16;

struct Box {
    std::array<float, 3> lower = {1, 1, 1};
    std::array<float, 3> upper = {-1, -1, -1};
};

/// The box that every union leaves unchanged: outside the frame on all sides.
constexpr Box kEmpty = {{2, 2, 2}, {-2, -2, -2}};

void grow(Box& box, const Box& other) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box.lower[axis] = std::min(box.lower[axis], other.lower[axis]);
        box.upper[axis] = std::max(box.upper[axis], other.upper[axis]);
    }
}

float half_area(const Box& box) {
    const float x = box.upper[0] - box.lower[0];
    const float y = box.upper[1] - box.lower[1];
    const float z = box.upper[2] - box.lower[2];
    return x * y + y * z + z * x;
}

struct Item {
    Box box;
    std::uint32_t triangle;
};

/// Twice the box's middle: the halving would change no comparison.
float middle(const Item& item, std::size_t axis) {
    return item.box.lower[axis] + item.box.upper[axis];
}

double coordinate(const Double3& p, std::size_t axis) {
    return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

/// Bounds of all vertices that triangles use.
struct Extent {
    std::array<double, 3> lower;
    std::array<double, 3> upper;
};

Extent extent_of(std::span<const Double3> positions, std::span<const Triangle> triangles) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Extent extent{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
    for (const Triangle& triangle : triangles) {
        for (const std::uint32_t vertex : triangle.vertex) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const double x = coordinate(positions[vertex], axis);
                extent.lower[axis] = std::min(extent.lower[axis], x);
                extent.upper[axis] = std::max(extent.upper[axis], x);
            }
        }
    }
    return extent;
}

/// Centres the box and scales it by a power of two so that no coordinate leaves
/// [-1, 1], not even after rounding: the largest distance lands in [1/4, 1/2].
Frame frame_of(const Extent& extent) {
    std::array<double, 3> origin{};
    double reach = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        origin[axis] = 0.5 * extent.lower[axis] + 0.5 * extent.upper[axis];
        reach =
            std::max({reach, extent.upper[axis] - origin[axis], origin[axis] - extent.lower[axis]});
    }
    Frame frame{{origin[0], origin[1], origin[2]}, 0};
    if (reach > 0) {
        int exponent = 0;
        std::frexp(reach, &exponent);
        frame.exponent = -exponent - 1;
    }
    return frame;
}

/// A frame coordinate between two floats.
struct Interval {
    float lower;
    float upper;
};

/// Returns floats around (x - origin) * 2^exponent. The difference rounds by at
/// most half an ulp and the scaling only when it falls below the normal range;
/// both are noticed, and then the double is widened before it becomes a float.
Interval to_frame(double x, double origin, int exponent) {
    const double difference = x - origin;
    const double virtual_origin = x - difference;
    const double virtual_x = difference + virtual_origin;
    const double tail = (x - virtual_x) + (virtual_origin - origin);
    const double scaled = std::ldexp(difference, exponent);
    double low = scaled;
    double high = scaled;
    if (tail != 0 || std::ldexp(scaled, -exponent) != difference) {
        constexpr double kBelowEveryFloat = 0x1p-1000;
        const double slack = std::fabs(scaled) * 0x1p-51 + kBelowEveryFloat;
        low -= slack;
        high += slack;
    }
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    auto lower = static_cast<float>(low);
    auto upper = static_cast<float>(high);
    if (lower > low) lower = std::nextafter(lower, -kInfinity);
    if (upper < high) upper = std::nextafter(upper, kInfinity);
    return {lower, upper};
}

Box box_of(const Triangle& triangle, std::span<const Double3> positions, const Frame& frame) {
    Box box = kEmpty;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        // Rounding is monotone: only the two outermost corners matter.
        const double a = coordinate(positions[triangle.vertex[0]], axis);
        const double b = coordinate(positions[triangle.vertex[1]], axis);
        const double c = coordinate(positions[triangle.vertex[2]], axis);
        const double origin = coordinate(frame.origin, axis);
        box.lower[axis] = to_frame(std::min({a, b, c}), origin, frame.exponent).lower;
        box.upper[axis] = to_frame(std::max({a, b, c}), origin, frame.exponent).upper;
    }
    return box;
}

/// A set of items to split, `[first, first + count)`.
struct Range {
    std::size_t first;
    std::size_t count;
};

/// Size of the largest full subtree that is smaller than `count` triangles.
std::size_t subtree_size(std::size_t count) {
    std::size_t unit = kBvhWidth;
    while (unit * kBvhWidth < count) unit *= kBvhWidth;
    return unit;
}

/// Where and how a set is cut.
struct Cut {
    std::size_t axis = 0;
    std::size_t left = 0;    ///< items on the left, a multiple of subtree_size()
    bool by_middle = false;  ///< false: all middles are equal, cut by number
};

struct Bins {
    std::array<Box, kBins> box;
    std::array<std::size_t, kBins> count{};
};

/// Maps middles in [least, greatest] to bins.
struct Binning {
    float least;
    float scale;
    std::size_t bin(float value) const {
        const auto index = static_cast<int>((value - least) * scale);
        return static_cast<std::size_t>(std::clamp(index, 0, static_cast<int>(kBins) - 1));
    }
};

/// The least cost of cutting behind one of the bins, by area times subtrees of
/// either side, counted in items.
struct BinCut {
    float cost = std::numeric_limits<float>::infinity();
    std::size_t left = 0;
};

BinCut best_cut(const Bins& bins) {
    std::array<float, kBins> right_cost{};
    Box box = kEmpty;
    std::size_t count = 0;
    for (std::size_t i = kBins - 1; i > 0; --i) {
        grow(box, bins.box[i]);
        count += bins.count[i];
        right_cost[i] = count == 0 ? 0 : half_area(box) * static_cast<float>(count);
    }
    BinCut best;
    box = kEmpty;
    count = 0;
    for (std::size_t i = 0; i + 1 < kBins; ++i) {
        grow(box, bins.box[i]);
        count += bins.count[i];
        if (count == 0) continue;
        const float cost = half_area(box) * static_cast<float>(count) + right_cost[i + 1];
        if (cost < best.cost) best = {cost, count};
    }
    return best;
}

/// Rounds to the nearest multiple of the subtree size that leaves both sides
/// something.
std::size_t snap(std::size_t left, std::size_t count) {
    const std::size_t unit = subtree_size(count);
    const std::size_t most = (count - 1) / unit;
    return unit * std::clamp<std::size_t>((left + unit / 2) / unit, 1, most);
}

Cut find_cut(std::span<const Item> items) {
    Box middles = {{4, 4, 4}, {-4, -4, -4}};
    for (const Item& item : items) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            middles.lower[axis] = std::min(middles.lower[axis], middle(item, axis));
            middles.upper[axis] = std::max(middles.upper[axis], middle(item, axis));
        }
    }
    std::array<Binning, 3> binning{};
    std::array<Bins, 3> bins;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float width = middles.upper[axis] - middles.lower[axis];
        binning[axis] = {middles.lower[axis], width > 0 ? kBins / width : 0};
        bins[axis].box.fill(kEmpty);
    }
    for (const Item& item : items) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::size_t bin = binning[axis].bin(middle(item, axis));
            grow(bins[axis].box[bin], item.box);
            ++bins[axis].count[bin];
        }
    }
    BinCut best;
    Cut cut{0, snap(items.size() / 2, items.size()), false};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!(middles.upper[axis] > middles.lower[axis])) continue;
        const BinCut candidate = best_cut(bins[axis]);
        if (candidate.cost < best.cost || !cut.by_middle) {
            best = candidate;
            cut = {axis, snap(candidate.left, items.size()), true};
        }
    }
    return cut;
}

/// Moves the items of the cut's left side to the front.
void partition(std::span<Item> items, const Cut& cut) {
    const auto border = items.begin() + static_cast<std::ptrdiff_t>(cut.left);
    std::nth_element(items.begin(), border, items.end(), [&](const Item& a, const Item& b) {
        if (cut.by_middle) {
            const float at_a = middle(a, cut.axis);
            const float at_b = middle(b, cut.axis);
            if (at_a != at_b) return at_a < at_b;
        }
        return a.triangle < b.triangle;
    });
}

/// Splits until every leaf is one run of up to eight items, sorted by number.
void split_all(std::span<Item> items) {
    while (items.size() > kBvhWidth) {
        const Cut cut = find_cut(items);
        partition(items, cut);
        split_all(items.first(cut.left));
        items = items.subspan(cut.left);
    }
    std::sort(items.begin(), items.end(),
              [](const Item& a, const Item& b) { return a.triangle < b.triangle; });
}

/// Splits large sets, all of one generation side by side, until each is a task.
void split_in_parallel(std::span<Item> items, const ParallelFor& parallel_for) {
    std::vector<Range> large = {{0, items.size()}};
    std::vector<Range> tasks;
    while (!large.empty()) {
        std::vector<std::size_t> left(large.size());
        parallel_for(large.size(), [&](std::size_t i) {
            const auto range = items.subspan(large[i].first, large[i].count);
            const Cut cut = find_cut(range);
            partition(range, cut);
            left[i] = cut.left;
        });
        std::vector<Range> next;
        for (std::size_t i = 0; i < large.size(); ++i) {
            for (const Range part : {Range{large[i].first, left[i]},
                                     Range{large[i].first + left[i], large[i].count - left[i]}}) {
                (part.count > kItemsPerTask ? next : tasks).push_back(part);
            }
        }
        large = std::move(next);
    }
    parallel_for(tasks.size(),
                 [&](std::size_t i) { split_all(items.subspan(tasks[i].first, tasks[i].count)); });
}

void set_box(BvhNode& node, std::size_t box, const Box& value) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        node.lower[axis][box] = value.lower[axis];
        node.upper[axis][box] = value.upper[axis];
    }
}

Box union_of(const BvhNode& node, std::size_t used) {
    Box box = kEmpty;
    for (std::size_t i = 0; i < used; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box.lower[axis] = std::min(box.lower[axis], node.lower[axis][i]);
            box.upper[axis] = std::max(box.upper[axis], node.upper[axis][i]);
        }
    }
    return box;
}

Box union_of(std::span<const Item> items) {
    Box box = kEmpty;
    for (const Item& item : items) grow(box, item.box);
    return box;
}

std::vector<BvhNode> make_nodes(std::span<const Item> items) {
    const BvhShape shape = format::bvh_shape(static_cast<std::uint32_t>(items.size()));
    std::vector<BvhNode> nodes(shape.node_count);
    for (std::uint32_t level = 0; level < shape.levels; ++level) {
        for (std::uint32_t i = 0; i < shape.count[level]; ++i) {
            BvhNode& node = nodes[shape.first[level] + i];
            const std::uint32_t used = shape.used_boxes(level, i);
            for (std::uint32_t j = 0; j < kBvhWidth; ++j) {
                const std::size_t below = std::size_t{i} * kBvhWidth + j;
                if (j >= used) {
                    set_box(node, j, Box{});
                } else if (level == 0) {
                    const std::size_t first = below * kBvhWidth;
                    const std::size_t count =
                        std::min<std::size_t>(kBvhWidth, items.size() - first);
                    set_box(node, j, union_of(items.subspan(first, count)));
                } else {
                    const auto child = static_cast<std::uint32_t>(below);
                    set_box(node, j,
                            union_of(nodes[shape.first[level - 1] + child],
                                     shape.used_boxes(level - 1, child)));
                }
            }
        }
    }
    return nodes;
}

}  // namespace

void serial_for(std::size_t count, const std::function<void(std::size_t)>& body) {
    for (std::size_t i = 0; i < count; ++i) body(i);
}

Bvh build_bvh(std::span<const Double3> positions, std::span<const Triangle> triangles,
              const BvhOptions& options) {
    Bvh bvh;
    if (triangles.empty()) return bvh;
    bvh.frame = frame_of(extent_of(positions, triangles));

    std::vector<Item> items(triangles.size());
    for_chunks(items.size(), kItemsPerTask, options.parallel_for,
               [&](std::size_t first, std::size_t last) {
                   for (std::size_t i = first; i < last; ++i) {
                       items[i] = {box_of(triangles[i], positions, bvh.frame),
                                   static_cast<std::uint32_t>(i)};
                   }
               });
    if (items.size() > kItemsPerTask) {
        split_in_parallel(items, options.parallel_for);
    } else {
        split_all(items);
    }
    bvh.order.reserve(items.size());
    for (const Item& item : items) bvh.order.push_back(item.triangle);
    bvh.nodes = make_nodes(items);
    make_leaves(bvh, positions, triangles, options.parallel_for);
    if (options.bounds != BvhBounds::aligned) make_oriented(bvh, options.parallel_for);
    if (options.bounds > BvhBounds::oriented) make_swept(bvh, options.bounds, options.parallel_for);
    return bvh;
}

}  // namespace cdprep::build
