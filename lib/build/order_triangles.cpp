// SPDX-License-Identifier: MIT
#include "build/order_triangles.h"

#include <cassert>
#include <memory>

#include "build/frame_map.h"
#include "build/split_sets.h"
#include "cdprep/format/portable.h"

namespace cdprep::build {
namespace {

using format::Double3;
using format::kBvhWidth;
using format::Triangle;

/// A triangle's box: lower x, y, z, its number, then the negated upper x, y, z. So the union of two
/// boxes is the lesser of either lane.
using BoxLanes = Lanes<float, 8>;
constexpr std::size_t kNumberLane = 3;

float half_area(const BoxLanes& box) {
    const float x = -box[4] - box[0];
    const float y = -box[5] - box[1];
    const float z = -box[6] - box[2];
    return x * y + y * z + z * x;
}

constexpr BoxLanes kEmpty = all_lanes<float, 8>(kFarOff);

/// Twice the middle of the box, and the number: all that a quick cut reads.
struct alignas(16) MiddleItem {
    Lanes<float, 4> lanes;

    [[nodiscard]] float middle(std::size_t axis) const {
        return lanes[axis];
    }
    [[nodiscard]] std::uint32_t number() const {
        return format::bit_cast<std::uint32_t>(lanes[kNumberLane]);
    }
};

struct alignas(32) BoxItem {
    BoxLanes box;

    /// Returns twice the middle: the halving would change no comparison.
    [[nodiscard]] float middle(std::size_t axis) const {
        return box[axis] - box[4 + axis];
    }
    [[nodiscard]] std::uint32_t number() const {
        return format::bit_cast<std::uint32_t>(box[kNumberLane]);
    }
};

struct CentreReach {
    double lower;
    double upper;
};

/// Returns the reach of a triangle along an axis. Cuts do not require boxes that are rounded
/// outwards.
CentreReach reach_of(const Triangle& triangle, std::span<const Double3> positions,
                     const FrameMap& map, std::size_t axis) {
    const double a = coordinate(positions[triangle.vertex[0]], axis);
    const double b = coordinate(positions[triangle.vertex[1]], axis);
    const double c = coordinate(positions[triangle.vertex[2]], axis);
    return {map.near(std::min({a, b, c}), axis), map.near(std::max({a, b, c}), axis)};
}

void make_item(const Triangle& triangle, std::uint32_t number, std::span<const Double3> positions,
               const FrameMap& map, BoxItem& item) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const CentreReach reach = reach_of(triangle, positions, map, axis);
        item.box[axis] = static_cast<float>(reach.lower);
        item.box[4 + axis] = -static_cast<float>(reach.upper);
    }
    item.box[kNumberLane] = format::bit_cast<float>(number);
    item.box[7] = 0;
}

void make_item(const Triangle& triangle, std::uint32_t number, std::span<const Double3> positions,
               const FrameMap& map, MiddleItem& item) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const CentreReach reach = reach_of(triangle, positions, map, axis);
        item.lanes[axis] = static_cast<float>(reach.lower + reach.upper);
    }
    item.lanes[kNumberLane] = format::bit_cast<float>(number);
}

/// Rounds to the nearest multiple of the subtree size that leaves neither side empty.
std::size_t snap(std::size_t left, std::size_t count) {
    const std::size_t unit = subtree_size(count);
    const std::size_t most = (count - 1) / unit;
    assert(most > 0);
    return unit * std::clamp<std::size_t>((left + unit / 2) / unit, 1, most);
}

template <class Counts>
CutCounts counts_around(const Counts& count, std::size_t bin) {
    assert(bin < count.size());
    CutCounts result;
    for (std::size_t i = 0; i < count.size(); ++i) {
        if (i < bin) result.before += count[i];
        result.all += count[i];
    }
    result.in = count[bin];
    return result;
}

template <class Counts>
std::size_t bin_of_rank(const Counts& count, std::size_t rank) {
    std::size_t bin = 0;
    for (std::size_t before = count[0]; before <= rank; before += count[bin]) ++bin;
    return bin;
}

/// Cuts across the longest side of the middles' bounds, as near to half as full subtrees allow.
struct QuickPolicy {
    using Item = MiddleItem;
    static constexpr std::size_t kBins = 64;

    struct Bins {
        std::size_t axis;
        Binning binning;
        std::array<std::uint32_t, kBins> count;
    };

    static std::size_t longest(const MiddleBounds& bounds) {
        std::size_t axis = 0;
        for (std::size_t i = 1; i < 3; ++i) {
            if (bounds.width(i) > bounds.width(axis)) axis = i;
        }
        return axis;
    }
    static void clear(Bins& bins, const MiddleBounds& bounds) {
        bins.axis = longest(bounds);
        bins.binning = Binning::of(bounds, bins.axis, kBins);
        bins.count.fill(0);
    }
    static void count(Bins& bins, std::span<const Item> items) {
        // Neighbours in the list often are neighbours in space. With two counters, neither waits
        // for the other.
        std::array<std::uint32_t, kBins> odd{};
        const auto bin = [&](std::size_t i) {
            return bins.binning.bin(items[i].middle(bins.axis));
        };
        for (std::size_t i = 0; i + 1 < items.size(); i += 2) {
            ++bins.count[bin(i)];
            ++odd[bin(i + 1)];
        }
        if (items.size() % 2 != 0) ++bins.count[bin(items.size() - 1)];
        for (std::size_t i = 0; i < kBins; ++i) bins.count[i] += odd[i];
    }
    static void add(Bins& bins, const Bins& other) {
        for (std::size_t i = 0; i < kBins; ++i) bins.count[i] += other.count[i];
    }
    static Cut choose(const Bins& bins, std::size_t count) {
        const std::size_t left = snap(count / 2, count);
        return {bins.axis, bins.binning, left, bin_of_rank(bins.count, left)};
    }
    static CutCounts counts(const Bins& bins, const Cut& cut) {
        return counts_around(bins.count, cut.bin);
    }
    static std::size_t cut_small(std::span<const Item> items, const MiddleBounds& bounds,
                                 std::span<Item> to) {
        Ranks rank;
        ranks_along(items, longest(bounds), bounds, rank);
        place_by_rank(items, rank, to);
        return snap(items.size() / 2, items.size());
    }
};

/// Cuts by the surface-area heuristic. Of the cuts between full subtrees along any axis, takes the
/// one with the least sum of area times items of both sides. For larger sets, the areas are those
/// of 32 bins, interpolated between the bins' borders.
struct BestPolicy {
    using Item = BoxItem;
    static constexpr std::size_t kBins = 32;

    struct Bins {
        std::array<Binning, 3> binning;
        std::array<std::array<BoxLanes, kBins>, 3> box;
        std::array<std::array<std::uint32_t, kBins>, 3> count;
    };

    static void clear(Bins& bins, const MiddleBounds& bounds) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            bins.binning[axis] = Binning::of(bounds, axis, kBins);
            bins.box[axis].fill(kEmpty);
            bins.count[axis].fill(0);
        }
    }
    static void count(Bins& bins, std::span<const Item> items) {
        for (const Item& item : items) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const std::size_t bin = bins.binning[axis].bin(item.middle(axis));
                take_lower(bins.box[axis][bin], item.box);
                ++bins.count[axis][bin];
            }
        }
    }
    static void add(Bins& bins, const Bins& other) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::size_t bin = 0; bin < kBins; ++bin) {
                take_lower(bins.box[axis][bin], other.box[axis][bin]);
                bins.count[axis][bin] += other.count[axis][bin];
            }
        }
    }
    static CutCounts counts(const Bins& bins, const Cut& cut) {
        return counts_around(bins.count[cut.axis], cut.bin);
    }

    /// The areas and items of everything before each bin's border and from it on.
    struct Sweep {
        std::array<float, kBins + 1> area_before{};
        std::array<float, kBins + 1> area_from{};
        std::array<std::size_t, kBins + 1> items_before{};

        /// Returns the cost of the cut with `left` of all `count` items on the left; the cut falls
        /// into `bin`.
        [[nodiscard]] float cost(std::size_t left, std::size_t count, std::size_t bin) const {
            assert(items_before[bin] <= left && left < items_before[bin + 1]);
            const auto in = static_cast<float>(items_before[bin + 1] - items_before[bin]);
            const float share = static_cast<float>(left - items_before[bin]) / in;
            const float left_area =
                area_before[bin] + share * (area_before[bin + 1] - area_before[bin]);
            const float right_area = area_from[bin] + share * (area_from[bin + 1] - area_from[bin]);
            return left_area * static_cast<float>(left) +
                   right_area * static_cast<float>(count - left);
        }
    };
    static Sweep sweep(const Bins& bins, std::size_t axis) {
        Sweep result;
        BoxLanes before = kEmpty;
        BoxLanes behind = kEmpty;
        for (std::size_t i = 0; i < kBins; ++i) {
            take_lower(before, bins.box[axis][i]);
            result.items_before[i + 1] = result.items_before[i] + bins.count[axis][i];
            result.area_before[i + 1] = result.items_before[i + 1] > 0 ? half_area(before) : 0;
            const std::size_t j = kBins - 1 - i;
            take_lower(behind, bins.box[axis][j]);
            result.area_from[j] = behind[0] < kFarOff ? half_area(behind) : 0;
        }
        return result;
    }
    static Cut choose(const Bins& bins, std::size_t count) {
        const std::size_t unit = subtree_size(count);
        float least_cost = kFarOff;
        Cut best{0, bins.binning[0], snap(count / 2, count), 0};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (!(bins.binning[axis].scale > 0)) continue;
            const Sweep areas = sweep(bins, axis);
            std::size_t bin = 0;
            for (std::size_t left = unit; left < count; left += unit) {
                while (areas.items_before[bin + 1] <= left) ++bin;
                const float cost = areas.cost(left, count, bin);
                if (cost >= least_cost) continue;
                least_cost = cost;
                best = {axis, bins.binning[axis], left, bin};
            }
        }
        return best;
    }

    struct RunCut {
        float cost = kFarOff;
        std::size_t left = 0;
    };

    /// Returns the best cut after one of the runs of eight in the order of ranks.
    static RunCut cut_between_runs(std::span<const Item> items, const Ranks& rank) {
        const std::size_t count = items.size();
        const std::size_t runs = (count + kBvhWidth - 1) / kBvhWidth;
        assert(runs >= 2 && runs <= kBvhWidth);
        std::array<BoxLanes, kBvhWidth> run;
        run.fill(kEmpty);
        for (std::size_t i = 0; i < count; ++i) {
            take_lower(run[static_cast<std::size_t>(rank[i]) / kBvhWidth], items[i].box);
        }
        std::array<float, kBvhWidth> area_from{};
        BoxLanes box = kEmpty;
        for (std::size_t i = runs - 1; i > 0; --i) {
            take_lower(box, run[i]);
            area_from[i] = half_area(box);
        }
        box = kEmpty;
        RunCut best;
        for (std::size_t i = 1; i < runs; ++i) {
            take_lower(box, run[i - 1]);
            const std::size_t left = i * kBvhWidth;
            const float cost = half_area(box) * static_cast<float>(left) +
                               area_from[i] * static_cast<float>(count - left);
            if (cost < best.cost) best = {cost, left};
        }
        return best;
    }
    static std::size_t cut_small(std::span<const Item> items, const MiddleBounds& bounds,
                                 std::span<Item> to) {
        RunCut best;
        Ranks best_rank;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            Ranks rank;
            ranks_along(items, axis, bounds, rank);
            const RunCut cut = cut_between_runs(items, rank);
            if (cut.cost >= best.cost) continue;
            best = cut;
            best_rank = rank;
        }
        assert(best.left > 0);
        place_by_rank(items, best_rank, to);
        return best.left;
    }
};

template <class Policy>
void order_by(Bvh& bvh, std::span<const Double3> positions, std::span<const Triangle> triangles,
              ParallelFor parallel_for) {
    using Item = typename Policy::Item;
    const std::size_t count = triangles.size();
    const FrameMap map(bvh.frame);
    const auto items = std::make_unique_for_overwrite<Item[]>(count);
    const auto spare = std::make_unique_for_overwrite<Item[]>(count);
    for_chunks(count, kItemsPerTask, parallel_for, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            make_item(triangles[i], static_cast<std::uint32_t>(i), positions, map, items[i]);
        }
    });
    bvh.order.resize(count);
    SetSplitter<Policy>({items.get(), count}, {spare.get(), count}, bvh.order).split(parallel_for);
}

}  // namespace

void order_triangles(Bvh& bvh, std::span<const Double3> positions,
                     std::span<const Triangle> triangles, const BvhOptions& options) {
    if (options.quality == Quality::fast) {
        order_by<QuickPolicy>(bvh, positions, triangles, options.parallel_for);
    } else {
        order_by<BestPolicy>(bvh, positions, triangles, options.parallel_for);
    }
}

}  // namespace cdprep::build
