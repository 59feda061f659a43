// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "build/chunks.h"
#include "build/lanes.h"

// Cuts a set of items in two until all are runs of eight, so that every subtree but the last is
// full. The policy chooses the cuts; this file performs them.
//
// A cut is by rank along one axis. The policy has counted the items of each bin of that axis. The
// items before the bin in which the rank falls go to the left side, those after it to the right.
// Only the few in that bin are compared one by one. Every item moves once per cut, into the other
// of two arrays. Large sets are cut in batches of a fixed size, all of one generation in parallel.
// Each step keeps the order in which it found the items, and its decisions depend on nothing else.
// So the result is the same for any schedule and any standard library.

namespace cdprep::build {

inline constexpr std::size_t kSmallSet = 64;  ///< the most items that a policy cuts by sorting them

/// Returns the size of the largest full subtree that is smaller than `count` triangles.
[[nodiscard]] inline std::size_t subtree_size(std::size_t count) {
    std::size_t unit = format::kBvhWidth;
    while (unit * format::kBvhWidth < count) unit *= format::kBvhWidth;
    return unit;
}

inline constexpr float kFarOff = std::numeric_limits<float>::infinity();

/// The least and greatest middles of a set along each axis. The fourth lane is unused.
struct MiddleBounds {
    Lanes<float, 4> lower = all_lanes<float, 4>(kFarOff);
    Lanes<float, 4> upper = all_lanes<float, 4>(-kFarOff);

    void grow(const MiddleBounds& other) {
        take_lower(lower, other.lower);
        take_upper(upper, other.upper);
    }
    template <class Item>
    void grow_by(const Item& item) {
        for_lanes<4>([&](std::size_t lane) {
            const float middle = item.middle(lane);
            lower[lane] = middle < lower[lane] ? middle : lower[lane];
            upper[lane] = upper[lane] < middle ? middle : upper[lane];
        });
    }
    [[nodiscard]] float width(std::size_t axis) const {
        return upper[axis] - lower[axis];
    }
};

/// Maps the middles along one axis to bins.
struct Binning {
    float least = 0;
    float scale = 0;

    /// Middles closer than 2^-100 of the frame count as equal: all are in bin 0.
    [[nodiscard]] static Binning of(const MiddleBounds& bounds, std::size_t axis,
                                    std::size_t bins) {
        const float width = bounds.width(axis);
        // Slightly less than the factor that would put the greatest middle in bin `bins`.
        const float most = static_cast<float>(bins) * (1 - 0x1p-20F);
        return {bounds.lower[axis], width > 0x1p-100F ? most / width : 0};
    }
    [[nodiscard]] std::size_t bin(float middle) const {
        assert(!(middle < least));
        return static_cast<std::size_t>(static_cast<std::int32_t>((middle - least) * scale));
    }
};

/// The place where a set is cut.
struct Cut {
    std::size_t axis = 0;
    Binning binning;
    std::size_t left = 0;  ///< items on the left, a multiple of subtree_size()
    std::size_t bin = 0;   ///< the bin of the first item of the right side
};

/// The number of items of a set before the cut's bin, in it, and in all.
struct CutCounts {
    std::size_t before = 0;
    std::size_t in = 0;
    std::size_t all = 0;
};

using Ranks = std::array<std::int16_t, kSmallSet>;

/// Computes the ranks of items along an axis. A key is the place of the middle among 2^10 steps
/// from least to greatest, then the item's index, so that no two are equal. Compares every item
/// with every other, without a branch.
template <class Item>
void ranks_along(std::span<const Item> items, std::size_t axis, const MiddleBounds& bounds,
                 Ranks& rank) {
    constexpr std::int32_t kSteps = 0x10000 / std::int32_t{kSmallSet};
    const Binning steps = Binning::of(bounds, axis, kSteps);
    Ranks key;
    assert(items.size() <= kSmallSet);
    const std::size_t count = items.size();
    const std::size_t padded = (count + 7) / 8 * 8;
    for (std::size_t i = 0; i < count; ++i) {
        const auto step = static_cast<std::int32_t>(steps.bin(items[i].middle(axis)));
        key[i] = static_cast<std::int16_t>((step - kSteps / 2) * std::int32_t{kSmallSet} +
                                           static_cast<std::int32_t>(i));
    }
    for (std::size_t i = count; i < padded; ++i) key[i] = INT16_MAX;
    for (std::size_t i = 0; i < count; ++i) {
        const std::int16_t own = key[i];
        std::int16_t smaller = 0;
        for (std::size_t k = 0; k < padded; ++k) {
            smaller = static_cast<std::int16_t>(smaller + (key[k] < own ? 1 : 0));
        }
        rank[i] = smaller;
    }
}

template <class Item>
void place_by_rank(std::span<const Item> items, const Ranks& rank, std::span<Item> to) {
    for (std::size_t i = 0; i < items.size(); ++i) {
        to[static_cast<std::size_t>(rank[i])] = items[i];
    }
}

/// Cuts and orders a set of items by a policy. A policy has an Item, with a middle and a number,
/// and Bins. clear() prepares the bins, count() counts a batch's items into them, and add() joins
/// them. choose() cuts by the bins. cut_small() orders a set of at most kSmallSet items and returns
/// the number of items left of the cut.
template <class Policy>
class SetSplitter {
public:
    using Item = typename Policy::Item;

    /// Orders `items`; `spare` has the same size. order[i] becomes the number of the i-th item.
    SetSplitter(std::span<Item> items, std::span<Item> spare, std::span<std::uint32_t> order)
        : arrays_{items, spare}, order_(order) {
        assert(items.size() == order.size() && spare.size() == order.size());
    }

    void split(ParallelFor parallel_for) {
        std::vector<Set> large;
        std::vector<Set> tasks;
        (is_large(order_.size()) ? large : tasks).push_back({0, order_.size(), 0});
        while (!large.empty()) large = split_generation(large, tasks, parallel_for);
        parallel_for(tasks.size(), [&](std::size_t i) { split_all(tasks[i]); });
    }

private:
    /// The items [first, first + count) of one of the two arrays.
    struct Set {
        std::size_t first;
        std::size_t count;
        std::size_t array;
    };

    /// A part of a large set, for one task.
    struct Batch {
        std::size_t set;
        std::size_t first;
        std::size_t count;
        MiddleBounds bounds = {};
        typename Policy::Bins bins = {};
        /// The places for its items before the bin, in it and after it.
        std::array<std::size_t, 3> target = {};
    };

    /// Returns whether a set is too large for one task. Few large tasks balance badly; many small
    /// ones read all memory once more for each generation.
    [[nodiscard]] bool is_large(std::size_t count) const {
        return count > std::max(2 * kItemsPerTask, order_.size() / 16 + 1);
    }

    std::span<Item> items_of(const Set& set) const {
        return arrays_[set.array].subspan(set.first, set.count);
    }
    std::span<Item> target_of(const Set& set) const {
        return arrays_[1 - set.array].subspan(set.first, set.count);
    }

    /// Two at a time, so that neither waits for the other.
    static MiddleBounds bounds_of(std::span<const Item> items) {
        assert(!items.empty());
        MiddleBounds even;
        MiddleBounds odd;
        for (std::size_t i = 0; i + 1 < items.size(); i += 2) {
            even.grow_by(items[i]);
            odd.grow_by(items[i + 1]);
        }
        even.grow_by(items.back());
        even.grow(odd);
        return even;
    }

    /// Moves each item to the place for its bin. The side is unpredictable, so no branch depends on
    /// it. A branch tests for the cut's bin, which is predictable.
    static void scatter(std::span<const Item> items, const Cut& cut,
                        std::array<std::size_t, 3> target, std::span<Item> out) {
        const auto border = static_cast<std::int64_t>(cut.bin);
        auto [before, in, behind] = target;
        for (const Item& item : items) {
            const auto bin = static_cast<std::int64_t>(cut.binning.bin(item.middle(cut.axis)));
            if (bin == border) {
                out[in++] = item;
                continue;
            }
            // All ones after the border.
            const auto mask = static_cast<std::size_t>((border - bin) >> 63);
            out[before ^ ((before ^ behind) & mask)] = item;
            before += 1 + mask;
            behind -= mask;
        }
    }

    /// Sorts the items of the cut's bin by side, the left ones first.
    static void settle(std::span<Item> items, std::size_t left, std::size_t axis,
                       std::span<Item> scratch) {
        assert(left <= items.size() && items.size() <= scratch.size());
        if (left == 0 || left == items.size()) return;
        struct Key {
            float middle;
            std::uint32_t place;
            bool operator<(const Key& other) const {
                return middle != other.middle ? middle < other.middle : place < other.place;
            }
        };
        std::vector<Key> keys(items.size());
        for (std::size_t i = 0; i < keys.size(); ++i) {
            keys[i] = {items[i].middle(axis), static_cast<std::uint32_t>(i)};
        }
        const auto border = keys.begin() + static_cast<std::ptrdiff_t>(left);
        std::nth_element(keys.begin(), border, keys.end());
        const Key first_right = *border;
        std::array<std::size_t, 2> target = {0, left};
        std::copy(items.begin(), items.end(), scratch.begin());
        for (std::size_t i = 0; i < items.size(); ++i) {
            const Key key = {scratch[i].middle(axis), static_cast<std::uint32_t>(i)};
            items[target[key < first_right ? 0 : 1]++] = scratch[i];
        }
    }

    static void settle(const Cut& cut, const CutCounts& counts, std::span<Item> from,
                       std::span<Item> to) {
        assert(counts.before <= cut.left && cut.left <= counts.before + counts.in);
        settle(to.subspan(counts.before, counts.in), cut.left - counts.before, cut.axis,
               from.first(counts.in));
    }

    /// Cuts a set; both sides are then in the other array.
    std::size_t cut_in_two(const Set& set) const {
        const std::span<Item> items = items_of(set);
        const std::span<Item> to = target_of(set);
        const MiddleBounds bounds = bounds_of(items);
        if (set.count <= kSmallSet) return Policy::cut_small(items, bounds, to);
        typename Policy::Bins bins;
        Policy::clear(bins, bounds);
        Policy::count(bins, items);
        const Cut cut = Policy::choose(bins, set.count);
        const CutCounts counts = Policy::counts(bins, cut);
        scatter(items, cut, {0, counts.before, counts.before + counts.in}, to);
        settle(cut, counts, items, to);
        return cut.left;
    }

    void split_all(Set set) const {
        while (set.count > format::kBvhWidth) {
            const std::size_t left = cut_in_two(set);
            assert(left > 0 && left < set.count && left % subtree_size(set.count) == 0);
            set.array = 1 - set.array;
            split_all({set.first, left, set.array});
            set.first += left;
            set.count -= left;
        }
        put_in_order(items_of(set), order_.subspan(set.first, set.count));
    }

    /// Writes the numbers of one leaf, least first. The place of each is the count of lesser ones.
    static void put_in_order(std::span<const Item> items, std::span<std::uint32_t> numbers) {
        assert(items.size() <= format::kBvhWidth && items.size() == numbers.size());
        Lanes<std::int32_t, 8> number = all_lanes<std::int32_t, 8>(INT32_MAX);
        Lanes<std::int32_t, 8> lesser = {};
        for (std::size_t i = 0; i < items.size(); ++i) {
            number[i] = static_cast<std::int32_t>(items[i].number());
        }
        for (std::size_t i = 0; i < items.size(); ++i) {
            const std::int32_t own = number[i];
            for_lanes<8>([&](std::size_t lane) { lesser[lane] += own < number[lane] ? 1 : 0; });
        }
        for (std::size_t i = 0; i < items.size(); ++i) {
            numbers[static_cast<std::size_t>(lesser[i])] = items[i].number();
        }
    }

    static std::vector<Batch> batches_of(const std::vector<Set>& sets) {
        std::vector<Batch> batches;
        for (std::size_t i = 0; i < sets.size(); ++i) {
            for (std::size_t first = 0; first < sets[i].count; first += kItemsPerTask) {
                batches.push_back({i, first, std::min(kItemsPerTask, sets[i].count - first)});
            }
        }
        return batches;
    }

    /// Cuts all sets; returns the sides that are still large.
    std::vector<Set> split_generation(const std::vector<Set>& sets, std::vector<Set>& tasks,
                                      ParallelFor parallel_for) const {
        std::vector<Batch> batches = batches_of(sets);
        const auto items = [&](const Batch& batch) {
            return items_of(sets[batch.set]).subspan(batch.first, batch.count);
        };
        parallel_for(batches.size(),
                     [&](std::size_t i) { batches[i].bounds = bounds_of(items(batches[i])); });
        std::vector<MiddleBounds> bounds(sets.size());
        for (const Batch& batch : batches) bounds[batch.set].grow(batch.bounds);
        parallel_for(batches.size(), [&](std::size_t i) {
            Policy::clear(batches[i].bins, bounds[batches[i].set]);
            Policy::count(batches[i].bins, items(batches[i]));
        });
        std::vector<Cut> cuts(sets.size());
        std::vector<CutCounts> counts(sets.size());
        aim(sets, batches, cuts, counts);
        parallel_for(batches.size(), [&](std::size_t i) {
            const Batch& batch = batches[i];
            scatter(items(batch), cuts[batch.set], batch.target, target_of(sets[batch.set]));
        });
        parallel_for(sets.size(), [&](std::size_t i) {
            settle(cuts[i], counts[i], items_of(sets[i]), target_of(sets[i]));
        });
        std::vector<Set> next;
        for (std::size_t i = 0; i < sets.size(); ++i) {
            const Set& set = sets[i];
            const std::size_t left = cuts[i].left;
            for (const Set side : {Set{set.first, left, 1 - set.array},
                                   Set{set.first + left, set.count - left, 1 - set.array}}) {
                (is_large(side.count) ? next : tasks).push_back(side);
            }
        }
        return next;
    }

    /// Chooses the cuts, and the places for the items of each batch.
    static void aim(const std::vector<Set>& sets, std::vector<Batch>& batches,
                    std::vector<Cut>& cuts, std::vector<CutCounts>& counts) {
        std::vector<typename Policy::Bins> bins(sets.size());
        std::vector<bool> begun(sets.size());
        for (const Batch& batch : batches) {
            if (begun[batch.set]) {
                Policy::add(bins[batch.set], batch.bins);
            } else {
                bins[batch.set] = batch.bins;
                begun[batch.set] = true;
            }
        }
        std::vector<std::array<std::size_t, 3>> target(sets.size());
        for (std::size_t i = 0; i < sets.size(); ++i) {
            cuts[i] = Policy::choose(bins[i], sets[i].count);
            counts[i] = Policy::counts(bins[i], cuts[i]);
            assert(counts[i].all == sets[i].count);
            target[i] = {0, counts[i].before, counts[i].before + counts[i].in};
        }
        for (Batch& batch : batches) {
            std::array<std::size_t, 3>& next = target[batch.set];
            batch.target = next;
            const CutCounts own = Policy::counts(batch.bins, cuts[batch.set]);
            next[0] += own.before;
            next[1] += own.in;
            next[2] += own.all - own.before - own.in;
        }
    }

    std::array<std::span<Item>, 2> arrays_;
    std::span<std::uint32_t> order_;
};

}  // namespace cdprep::build
