// SPDX-License-Identifier: MIT
#include "cdprep/broad_phase.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <new>
#include <utility>

#include "cdprep/format/float_environment.h"
#include "core/carver.h"
#include "core/guarded_for.h"
#include "core/require.h"
#include "core/share_out.h"
#include "kernels/kernels.h"
#include "scene/pair_pages.h"
#include "scene/world_tree.h"

// Sweep and prune was measured, eight boxes at a time, and is slower also for few or uneven boxes.
// It takes 1.1 to 4 times the time with 1,000 boxes, and 1 to 2.5 times with 300.
//
// Still and moving boxes share one tree. While pairs are kept, a box that stays in its larger box
// costs one comparison, and its pairs stay. Only boxes that left are searched for. With two trees
// each of them would be searched for twice. Walks over all boxes do take the still ones along.
namespace cdprep {
namespace {

using kernels::kAbsentBox;
using kernels::kLanes;
using kernels::kPaddedBox;
using kernels::kPaddedUpper;

constexpr float kLargest = std::numeric_limits<float>::max();

// The margin of a larger box on all sides, relative to the mean edge of the box.
constexpr float kMargin = 0.02F;
// In the direction of its last move, the margin grows by this many moves, up to a share of the mean
// edge. The number of moves depends on the box, so that equal motions end in different updates.
constexpr std::uint32_t kLeastMovesAhead = 30;
constexpr std::uint32_t kMoveSteps = 40;
constexpr float kMostAhead = 0.5F;
// The largest margin of a box whose direction is unknown. It also depends on the box.
constexpr float kMostMargin = 0.15F;

// Pairs are no longer kept if more than 1/8 of the boxes leave in two updates in a row. They are
// kept again after eight updates with fewer than 1/16.
constexpr std::uint32_t kManyLeave = 8;
constexpr std::uint32_t kFewLeave = 16;
constexpr std::uint32_t kUpdatesOfMany = 2;
constexpr std::uint32_t kUpdatesOfFew = 8;
constexpr std::uint32_t kUpdatesAfterFull = 64;  ///< where larger boxes had too many pairs
// The life of an order along the curve: updates without kept pairs, or leavers for each box.
constexpr std::uint32_t kUpdatesOfOrder = 8;
constexpr std::uint32_t kLeaversOfOrder = 2;

constexpr std::uint32_t kInsertionSort = 16;
constexpr std::uint32_t kFewPairs = 16;  ///< with more boxes for each pair, sort() counts nothing

// Work for which a thread is worth its start, and jobs that it takes at a time.
constexpr std::uint32_t kPairsOfTask = 32'768;
constexpr std::size_t kJobsOfTask = 32;

using Move = std::array<float, 3>;

bool is_possible(const BroadPhaseLimits& limits) noexcept {
    return limits.boxes <= kMostWorldBoxes && limits.threads > 0;
}

bool has_nan(const WorldBox& box) noexcept {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (std::isnan(box.lower[axis]) || std::isnan(box.upper[axis])) return true;
    }
    return false;
}

/// The coordinates of boxes, six each.
std::span<const float> numbers_of(std::span<const WorldBox> boxes) noexcept {
    static_assert(sizeof(WorldBox) == 6 * sizeof(float));
    return {reinterpret_cast<const float*>(boxes.data()), 6 * boxes.size()};
}

/// Returns whether a coordinate is NaN. Without branches, compilers look at several at a time.
bool have_nan(std::span<const WorldBox> boxes) noexcept {
    std::uint32_t found = 0;
    for (const float number : numbers_of(boxes)) found |= number != number ? 1 : 0;
    return found != 0;
}

/// Returns the first named box with a NaN, if there is one.
std::optional<std::uint32_t> find_nan(std::span<const WorldBox> boxes,
                                      std::span<const std::uint32_t> named) noexcept {
    // Many are cheaper to look at in their order, with those that are not named.
    if (named.size() > boxes.size() / 4 && !have_nan(boxes)) return std::nullopt;
    for (const std::uint32_t number : named) {
        if (has_nan(boxes[number])) return number;
    }
    return std::nullopt;
}

/// Returns how far the middle of a box has moved. Not a number if it is absent or was.
Move move_of(const float* box, const float* previous) noexcept {
    Move move{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float before = previous[axis] + previous[kPaddedUpper + axis];
        move[axis] = 0.5F * (box[axis] + box[kPaddedUpper + axis] - before);
    }
    return move;
}

/// Stores the larger box around a box that moved so. It has not moved, or was absent, where the
/// move is 0 or not a number.
void store_around(const float* box, const Move& move, std::uint32_t number,
                  float* larger) noexcept {
    float edges = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) edges += box[kPaddedUpper + axis] - box[axis];
    // An absent box has no edges, and stays absent.
    const float edge = std::max(0.0F, edges / 3);
    const std::uint32_t step = number % kMoveSteps;
    const bool is_moving = move[0] * move[0] + move[1] * move[1] + move[2] * move[2] > 0;
    const float share = static_cast<float>(step) / kMoveSteps;
    const float margin = edge * (is_moving ? kMargin : kMargin + (kMostMargin - kMargin) * share);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float way = std::abs(move[axis]) * static_cast<float>(kLeastMovesAhead + step);
        const float ahead = is_moving ? std::min(way, kMostAhead * edge) : 0;
        const float below = margin + (move[axis] < 0 ? ahead : 0);
        const float above = margin + (move[axis] > 0 ? ahead : 0);
        larger[axis] = std::max(box[axis] - below, -kLargest);
        larger[kPaddedUpper + axis] = std::min(box[kPaddedUpper + axis] + above, kLargest);
    }
}

void sort_run(BoxPair* first, BoxPair* last) noexcept {
    if (last - first > kInsertionSort) {
        std::sort(first, last);
        return;
    }
    for (BoxPair* at = first; at < last; ++at) {
        const BoxPair pair = *at;
        BoxPair* to = at;
        for (; to > first && pair.b < to[-1].b; --to) *to = to[-1];
        *to = pair;
    }
}

/// Returns the place of a pair in a sorted list. Looks at the last ones first, in growing steps.
BoxPair* place_from_back(BoxPair* first, BoxPair* last, const BoxPair& pair) noexcept {
    std::ptrdiff_t step = 1;
    while (last - first > step && pair < last[-step]) {
        last -= step;
        step *= 2;
    }
    return std::upper_bound(last - std::min(step, last - first), last, pair);
}

}  // namespace

struct BroadPhase::State {
    State(Carver& carver, const BroadPhaseLimits& most) noexcept
        : limits(most),
          tree(carver, most.boxes),
          exact(carver.take<float>(numbers_of_boxes())),
          larger(carver.take<float>(numbers_of_boxes())),
          previous(carver.take<float>(numbers_of_boxes())),
          filters(carver.take<BoxFilter>(most.boxes)),
          leaves(carver.take<std::uint8_t>(most.boxes)),
          numbers(carver.take<std::uint32_t>(std::uint64_t{most.threads} * numbers_of_thread())),
          leavers(carver.take<std::uint32_t>(numbers_of_thread())),
          writers(carver.take<PairPages::Writer>(most.threads)),
          pages(carver.take<BoxPair>(PairPages::room_for(most.pairs, most.threads))),
          kept(carver.take<BoxPair>(most.pairs)),
          found(carver.take<BoxPair>(PairPages::room_for(most.pairs, most.threads))) {}

    [[nodiscard]] std::uint64_t numbers_of_boxes() const noexcept {
        return std::uint64_t{limits.boxes} * kPaddedBox;
    }
    /// Scratch of a thread: what a search finds, or the places of a sort.
    [[nodiscard]] std::size_t numbers_of_thread() const noexcept {
        return std::size_t{limits.boxes} + 1;
    }
    [[nodiscard]] std::size_t page_room() const noexcept {
        return static_cast<std::size_t>(PairPages::room_for(limits.pairs, limits.threads));
    }

    BroadPhaseUpdate update_all(std::span<const WorldBox> boxes,
                                std::span<const BoxFilter> new_filters, ParallelFor run) noexcept;
    BroadPhaseUpdate update_some(std::span<const WorldBox> boxes,
                                 std::span<const BoxFilter> new_filters,
                                 std::span<const std::uint32_t> moved, ParallelFor run) noexcept;

    void forget(std::uint32_t boxes) noexcept;
    void refilter(std::uint32_t number, std::span<const BoxFilter> new_filters) noexcept;
    void store(std::span<const WorldBox> boxes, const std::uint32_t* named,
               std::size_t named_count) noexcept;
    void add_leaver(std::uint32_t number) noexcept;
    BroadPhaseUpdate finish(ParallelFor run) noexcept;
    void choose_way() noexcept;
    std::size_t find_meeting(ParallelFor run) noexcept;
    bool update_kept(ParallelFor run) noexcept;
    bool search_leavers(ParallelFor run) noexcept;
    bool merge_found(std::uint32_t pairs) noexcept;
    BroadPhaseUpdate find_without_kept(ParallelFor run) noexcept;

    template <class Body>
    std::uint64_t gather_pairs(std::span<BoxPair> room, std::size_t jobs, ParallelFor run,
                               const Body& body) noexcept;
    std::uint64_t find_all(ParallelFor run) noexcept;
    void find_pairs_of_leaf(std::size_t leaf, std::uint32_t* scratch,
                            PairPages::Writer& writer) noexcept;
    void find_pairs_of_leaves(std::size_t a, std::size_t b, const float* around_b,
                              PairPages::Writer& writer) noexcept;
    void find_pairs_of_leaver(std::uint32_t one, std::uint32_t* scratch,
                              PairPages::Writer& writer) noexcept;
    void sort(const BoxPair* from, std::uint64_t pairs, BoxPair* to) noexcept;

    BroadPhaseLimits limits;
    WorldTree tree;
    float* exact;     ///< padded boxes as given
    float* larger;    ///< around these
    float* previous;  ///< padded boxes before the last update that named them
    BoxFilter* filters;
    std::uint8_t* leaves;    ///< 1 for each leaver
    std::uint32_t* numbers;  ///< scratch
    std::uint32_t* leavers;  ///< boxes that left their larger box in this update
    PairPages::Writer* writers;
    BoxPair* pages;  ///< new pairs, in no order
    BoxPair* kept;   ///< pairs of larger boxes that meet, sorted
    BoxPair* found;  ///< the result

    std::uint32_t count = 0;  ///< boxes
    std::uint32_t leaver_count = 0;
    std::uint32_t kept_count = 0;
    bool has_kept = false;                  ///< `kept` and the tree are those of the larger boxes
    bool has_order = false;                 ///< the tree has an order
    bool has_filters = false;               ///< otherwise all are the default
    bool keeps = true;                      ///< the way that is chosen
    std::uint32_t of_many = 0, of_few = 0;  ///< updates in a row
    std::uint32_t wait = 0;                 ///< updates before pairs may be kept again
    /// Updates without kept pairs, otherwise boxes that left: a change between them only makes the
    /// next order earlier.
    std::uint32_t order_age = 0;
};

// Ways in -----------------------------------------------------------------------------------------

void BroadPhase::State::forget(std::uint32_t boxes) noexcept {
    count = boxes;
    has_kept = has_order = false;
    keeps = true;
    of_many = of_few = wait = 0;
    if (std::exchange(has_filters, false)) std::fill_n(filters, limits.boxes, BoxFilter{});
    for (std::size_t i = 0; i < count; ++i) {
        std::copy_n(kAbsentBox, kPaddedBox, exact + i * kPaddedBox);
        std::copy_n(kAbsentBox, kPaddedBox, larger + i * kPaddedBox);
        std::copy_n(kAbsentBox, kPaddedBox, previous + i * kPaddedBox);
    }
}

/// Takes the filter of a box. A box with another filter leaves.
void BroadPhase::State::refilter(std::uint32_t number,
                                 std::span<const BoxFilter> new_filters) noexcept {
    const BoxFilter filter = new_filters.empty() ? BoxFilter{} : new_filters[number];
    if (std::exchange(filters[number], filter) != filter) add_leaver(number);
}

void BroadPhase::State::add_leaver(std::uint32_t number) noexcept {
    if (leaves[number] != 0) return;
    leaves[number] = 1;
    leavers[leaver_count++] = number;
}

/// Stores the boxes with the given numbers, or the first `named_count` if `named` is null. A box
/// leaves if it is no longer inside its larger box. Those that are not named did not move.
void BroadPhase::State::store(std::span<const WorldBox> boxes, const std::uint32_t* named,
                              std::size_t named_count) noexcept {
    leaver_count = static_cast<std::uint32_t>(kernels::active().store_boxes(
        {numbers_of(boxes).data(), exact, previous, larger, leaves}, named, named_count, leavers));
}

BroadPhaseUpdate BroadPhase::State::update_all(std::span<const WorldBox> boxes,
                                               std::span<const BoxFilter> new_filters,
                                               ParallelFor run) noexcept {
    if (have_nan(boxes)) {
        const auto first = std::find_if(boxes.begin(), boxes.end(), has_nan) - boxes.begin();
        return {.complete = false, .refused = static_cast<std::uint32_t>(first)};
    }
    if (boxes.size() != count) forget(static_cast<std::uint32_t>(boxes.size()));
    store(boxes, nullptr, count);
    if (has_filters || !new_filters.empty()) {
        for (std::uint32_t i = 0; i < count; ++i) refilter(i, new_filters);
        has_filters = !new_filters.empty();
    }
    return finish(run);
}

BroadPhaseUpdate BroadPhase::State::update_some(std::span<const WorldBox> boxes,
                                                std::span<const BoxFilter> new_filters,
                                                std::span<const std::uint32_t> moved,
                                                ParallelFor run) noexcept {
    if (const auto number = find_nan(boxes, moved)) return {.complete = false, .refused = *number};
    store(boxes, moved.data(), moved.size());
    if (has_filters || !new_filters.empty()) {
        for (const std::uint32_t number : moved) refilter(number, new_filters);
        has_filters = true;  // of the boxes that did not move
    }
    return finish(run);
}

/// Chooses the way of this update by the boxes that left in it and before.
void BroadPhase::State::choose_way() noexcept {
    const std::uint64_t left = leaver_count;
    of_many = left * kManyLeave > count ? of_many + 1 : 0;
    of_few = left * kFewLeave < count ? of_few + 1 : 0;
    if (keeps && of_many >= kUpdatesOfMany) keeps = false;
    if (wait > 0) --wait;
    if (!keeps && wait == 0 && of_few >= kUpdatesOfFew) keeps = true;
}

/// Copies the kept pairs whose boxes meet to `found`. Returns how many they are.
std::size_t BroadPhase::State::find_meeting(ParallelFor run) noexcept {
    const std::size_t parts = kept_count < kPairsOfTask ? 1 : limits.threads;
    const auto begin_of = [&](std::size_t part) { return kept_count * part / parts; };
    run_workers(parts, run, [&](std::size_t part) {
        const std::size_t begin = begin_of(part);
        numbers[part * numbers_of_thread()] =
            static_cast<std::uint32_t>(kernels::active().meeting_pairs(
                exact, &kept[begin].a, begin_of(part + 1) - begin, &found[begin].a));
    });
    std::size_t count_met = numbers[0];
    for (std::size_t part = 1; part < parts; ++part) {
        const BoxPair* from = found + begin_of(part);
        const std::uint32_t met = numbers[part * numbers_of_thread()];
        std::copy(from, from + met, found + count_met);
        count_met += met;
    }
    return count_met;
}

BroadPhaseUpdate BroadPhase::State::finish(ParallelFor run) noexcept {
    if (has_kept || has_order) choose_way();
    for (std::uint32_t i = 0; i < leaver_count; ++i) {
        const std::size_t at = std::size_t{leavers[i]} * kPaddedBox;
        const Move move = move_of(exact + at, previous + at);
        store_around(exact + at, move, leavers[i], larger + at);
    }
    const std::uint32_t escaped = leaver_count;
    const bool was_kept = keeps && update_kept(run);
    for (std::uint32_t i = 0; i < leaver_count; ++i) leaves[leavers[i]] = 0;
    BroadPhaseUpdate result;
    if (was_kept) {
        result.pairs = {found, find_meeting(run)};
        result.kept = true;
    } else {
        if (keeps) wait = kUpdatesAfterFull;
        has_kept = keeps = false;
        result = find_without_kept(run);
    }
    result.escaped = escaped;
    return result;
}

// All pairs ---------------------------------------------------------------------------------------

/// Calls `body(job, scratch, writer)` for each job. Returns the number of pairs. They are in `room`
/// if there are at most limits.pairs.
template <class Body>
std::uint64_t BroadPhase::State::gather_pairs(std::span<BoxPair> room, std::size_t jobs,
                                              ParallelFor run, const Body& body) noexcept {
    PairPages list(room);
    const std::size_t workers = jobs < kJobsOfTask ? 1 : limits.threads;
    Shares shares(jobs, kJobsOfTask);
    for (std::size_t i = 0; i < workers; ++i) writers[i].start(list);
    run_workers(workers, run, [&](std::size_t worker) {
        shares.take([&](std::size_t job) {
            body(job, numbers + worker * numbers_of_thread(), writers[worker]);
        });
    });
    return list.close({writers, workers});
}

/// Finds the pairs of the boxes of leaf A with those of leaf B, which may be A. `around_b` is a
/// lane of a node.
void BroadPhase::State::find_pairs_of_leaves(std::size_t a, std::size_t b, const float* around_b,
                                             PairPages::Writer& writer) noexcept {
    kernels::BoxPairs pairs =
        kernels::active().meeting_boxes(tree.node(0, a), tree.node(0, b), around_b);
    constexpr kernels::BoxPairs kOnce = 0x0080c0e0f0f8fcfe;  // bits 8 i + j with j > i
    if (a == b) pairs &= kOnce;
    for (; pairs != 0; pairs &= pairs - 1) {
        const auto bit = std::size_t{format::lowest_set_bit(pairs)};
        const std::uint32_t one = tree.box_at(a * kLanes + bit / kLanes);
        const std::uint32_t two = tree.box_at(b * kLanes + bit % kLanes);
        if (filters[one].allows(filters[two])) writer.add(one, two);
    }
}

/// Finds the pairs of a leaf with itself and those behind it.
void BroadPhase::State::find_pairs_of_leaf(std::size_t leaf, std::uint32_t* scratch,
                                           PairPages::Writer& writer) noexcept {
    const auto lane_around = [&](std::size_t number) {
        return tree.node(1, number / kLanes) + number % kLanes;
    };
    float box[kPaddedBox] = {};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box[axis] = lane_around(leaf)[axis * kLanes];
        box[kPaddedUpper + axis] = lane_around(leaf)[(3 + axis) * kLanes];
    }
    const std::size_t met =
        kernels::active().met_boxes(tree.view(), box, 1, static_cast<std::uint32_t>(leaf), scratch);
    for (std::size_t i = 0; i < met; ++i) {
        find_pairs_of_leaves(leaf, scratch[i], lane_around(scratch[i]), writer);
    }
}

/// Finds all pairs of the tree's boxes. Returns their number; stores them in `pages`.
std::uint64_t BroadPhase::State::find_all(ParallelFor run) noexcept {
    return gather_pairs({pages, page_room()}, tree.leaf_count(), run,
                        [&](std::size_t leaf, std::uint32_t* scratch, PairPages::Writer& writer) {
                            find_pairs_of_leaf(leaf, scratch, writer);
                        });
}

/// Sorts pairs: many by counting those of each lower number.
void BroadPhase::State::sort(const BoxPair* from, std::uint64_t pairs, BoxPair* to) noexcept {
    if (pairs * kFewPairs < count) return std::sort(to, std::copy(from, from + pairs, to));
    std::fill_n(numbers, count + 1, 0);
    for (std::uint64_t i = 0; i < pairs; ++i) ++numbers[from[i].a];
    std::uint32_t sum = 0;
    for (std::uint32_t i = 0; i <= count; ++i) sum += std::exchange(numbers[i], sum);
    for (std::uint64_t i = 0; i < pairs; ++i) to[numbers[from[i].a]++] = from[i];
    // Now each place is that behind the pairs of the number.
    std::uint32_t first = 0;
    for (std::uint32_t i = 0; i < count; first = numbers[i++]) {
        if (numbers[i] - first > 1) sort_run(to + first, to + numbers[i]);
    }
}

BroadPhaseUpdate BroadPhase::State::find_without_kept(ParallelFor run) noexcept {
    if (has_order && order_age < kUpdatesOfOrder) {
        ++order_age;
        tree.rebuild(exact);
    } else {
        tree.build(exact, count);
        has_order = true;
        order_age = 0;
    }
    const std::uint64_t pairs = find_all(run);
    if (pairs > limits.pairs) return {.complete = false, .needed = pairs};
    sort(pages, pairs, found);
    return {.pairs = {found, static_cast<std::size_t>(pairs)}};
}

// Kept pairs --------------------------------------------------------------------------------------

/// Brings the pairs of larger boxes up to date. Returns false if there are too many of them.
bool BroadPhase::State::update_kept(ParallelFor run) noexcept {
    if (has_kept && std::uint64_t{leaver_count} * kManyLeave <= count) return search_leavers(run);
    tree.build(larger, count);
    has_order = true;
    order_age = 0;
    const std::uint64_t pairs = find_all(run);
    has_kept = pairs <= limits.pairs;
    if (!has_kept) return false;
    sort(pages, pairs, kept);
    kept_count = static_cast<std::uint32_t>(pairs);
    return true;
}

/// Finds the pairs of a box that left. Two that left find each other twice, but are one pair.
void BroadPhase::State::find_pairs_of_leaver(std::uint32_t one, std::uint32_t* scratch,
                                             PairPages::Writer& writer) noexcept {
    const std::size_t met = kernels::active().met_boxes(
        tree.view(), larger + std::size_t{one} * kPaddedBox, 0, 0, scratch);
    for (std::size_t i = 0; i < met; ++i) {
        const std::uint32_t two = tree.box_at(scratch[i]);
        if (leaves[two] != 0 && two <= one) continue;
        if (filters[one].allows(filters[two])) writer.add(one, two);
    }
}

/// Searches for the pairs of the boxes that left alone.
bool BroadPhase::State::search_leavers(ParallelFor run) noexcept {
    if (leaver_count == 0) return true;
    order_age += leaver_count;
    if (order_age / kLeaversOfOrder > count) {
        tree.build(larger, count);
        order_age = 0;
    } else {
        for (std::uint32_t i = 0; i < leaver_count; ++i) {
            tree.set(leavers[i], larger + std::size_t{leavers[i]} * kPaddedBox);
        }
    }
    const std::uint64_t pairs =
        gather_pairs({found, page_room()}, leaver_count, run,
                     [&](std::size_t i, std::uint32_t* scratch, PairPages::Writer& writer) {
                         find_pairs_of_leaver(leavers[i], scratch, writer);
                     });
    has_kept = pairs <= limits.pairs && merge_found(static_cast<std::uint32_t>(pairs));
    return has_kept;
}

/// Drops the kept pairs of boxes that left, and merges the new ones with the others. Returns false
/// if there are too many.
bool BroadPhase::State::merge_found(std::uint32_t pairs) noexcept {
    sort(found, pairs, pages);
    BoxPair* stay = kept;
    for (std::uint32_t i = 0; i < kept_count; ++i) {  // without branches that depend on the pair
        const BoxPair pair = kept[i];
        *stay = pair;
        stay += 1 ^ (leaves[pair.a] | leaves[pair.b]);
    }
    const auto staying = static_cast<std::uint32_t>(stay - kept);
    if (staying > limits.pairs - pairs) return false;
    kept_count = staying + pairs;
    BoxPair* to = kept + kept_count;
    for (std::uint32_t i = pairs; i > 0; --i) {  // from the back, so that all stay in one place
        BoxPair* const at = place_from_back(kept, stay, pages[i - 1]);
        to = std::move_backward(at, stay, to);
        stay = at;
        *--to = pages[i - 1];
    }
    return true;
}

// The class ---------------------------------------------------------------------------------------

void BroadPhase::Release::operator()(State* state) const noexcept {
    if (owns) ::operator delete (state, std::align_val_t{kCarveAlignment});
}

BroadPhase::BroadPhase(std::unique_ptr<State, Release> state) noexcept : state_(std::move(state)) {}
BroadPhase::BroadPhase(BroadPhase&&) noexcept = default;
BroadPhase& BroadPhase::operator=(BroadPhase&&) noexcept = default;
BroadPhase::~BroadPhase() = default;

BroadPhase::BroadPhase(const BroadPhaseLimits& limits) : state_(nullptr, Release{true}) {
    if (!is_possible(limits))
        stop_with("A broad phase has at most 2^29 boxes and at least one thread.");
    auto* const memory =
        static_cast<std::byte*>(::operator new (size(limits), std::align_val_t{kCarveAlignment}));
    state_.reset(make(memory, limits));
}

BroadPhase::State* BroadPhase::make(std::byte* memory, const BroadPhaseLimits& limits) noexcept {
    Carver carver(memory);
    State* const state = carver.take_room<State>();
    return new (state) State(carver, limits);
}

std::size_t BroadPhase::size(const BroadPhaseLimits& limits) noexcept {
    Carver carver(nullptr);
    carver.take_room<State>();
    State measured(carver, limits);
    return carver.used();
}

std::size_t BroadPhase::alignment() noexcept {
    return kCarveAlignment;
}

std::optional<BroadPhase> BroadPhase::in_memory(std::span<std::byte> memory,
                                                const BroadPhaseLimits& limits) noexcept {
    const auto address = reinterpret_cast<std::uintptr_t>(memory.data());
    if (!is_possible(limits) || memory.size() < size(limits) || address % kCarveAlignment != 0) {
        return std::nullopt;
    }
    return BroadPhase(std::unique_ptr<State, Release>(make(memory.data(), limits), Release{false}));
}

namespace {

void require_sizes(std::size_t boxes, std::size_t filters, std::size_t most) noexcept {
    if (boxes > most) stop_with("The broad phase was made for fewer boxes.");
    if (filters != 0 && filters != boxes) stop_with("A broad phase needs a filter for each box.");
}

}  // namespace

BroadPhaseUpdate BroadPhase::update(std::span<const WorldBox> boxes,
                                    std::span<const BoxFilter> filters,
                                    ParallelFor parallel_for) noexcept {
    require_sizes(boxes.size(), filters.size(), state_->limits.boxes);
    format::FloatEnvironment environment;
    const GuardedFor run(environment, parallel_for);
    return state_->update_all(boxes, filters, run);
}

BroadPhaseUpdate BroadPhase::update_moved(std::span<const WorldBox> boxes,
                                          std::span<const BoxFilter> filters,
                                          std::span<const std::uint32_t> moved,
                                          ParallelFor parallel_for) noexcept {
    require_sizes(boxes.size(), filters.size(), state_->limits.boxes);
    if (boxes.size() != state_->count)
        stop_with("The number of boxes differs from that of the last update.");
    std::uint32_t most = 0;
    for (const std::uint32_t number : moved) most = std::max(most, number);
    if (!moved.empty() && most >= boxes.size())
        stop_with("The number of a moved box is out of range.");
    format::FloatEnvironment environment;
    const GuardedFor run(environment, parallel_for);
    return state_->update_some(boxes, filters, moved, run);
}

}  // namespace cdprep
