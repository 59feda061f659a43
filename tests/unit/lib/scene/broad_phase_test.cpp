// SPDX-License-Identifier: MIT
#include "cdprep/broad_phase.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "support/moving_boxes.h"
#include "support/rounds.h"
#include "support/run_threads.h"

namespace cdprep {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr WorldBox kAbsent = {{1, 0, 0}, {0, 1, 1}};
constexpr WorldBox kEverything = {{-kInfinity, -kInfinity, -kInfinity},
                                  {kInfinity, kInfinity, kInfinity}};

using Pairs = std::vector<BoxPair>;

Pairs pairs_of(const BroadPhaseUpdate& update) {
    EXPECT_TRUE(update.complete);
    return {update.pairs.begin(), update.pairs.end()};
}

BroadPhase made_for(std::size_t boxes, std::size_t pairs) {
    return BroadPhase(
        {.boxes = static_cast<std::uint32_t>(boxes), .pairs = static_cast<std::uint32_t>(pairs)});
}

WorldBox cube(float x, float y, float z, float edge) {
    return {{x, y, z}, {x + edge, y + edge, z + edge}};
}

/// Boxes whose faces lie on a coarse grid, so that many touch.
std::vector<WorldBox> grid_boxes(std::size_t count, std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto coordinate = [&] { return static_cast<float>(random() % 12); };
    std::vector<WorldBox> boxes(count);
    for (WorldBox& box : boxes) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box.lower[axis] = coordinate();
            box.upper[axis] = box.lower[axis] + static_cast<float>(random() % 3);
        }
    }
    return boxes;
}

bool boxes_meet(const WorldBox& a, const WorldBox& b) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (a.lower[axis] > b.upper[axis] || b.lower[axis] > a.upper[axis]) return false;
    }
    return true;
}

/// Plain spatial hashing: boxes in the cells of a grid, and the pairs of each cell. Another way to
/// the same pairs, for more boxes than can be compared each with each.
class SpatialHash {
public:
    explicit SpatialHash(std::span<const WorldBox> boxes)
        : boxes_(boxes), buckets_(2 * boxes.size() + 1) {
        double edges = 0;
        for (const WorldBox& box : boxes) edges += double{box.upper[0]} - box.lower[0];
        edge_ = 2 * edges / static_cast<double>(boxes.size());
        for (std::uint32_t i = 0; i < boxes.size(); ++i) add(i);
    }
    [[nodiscard]] Pairs pairs() const {
        Pairs pairs;
        for (const std::vector<Entry>& bucket : buckets_) {
            for (std::size_t i = 0; i < bucket.size(); ++i) {
                for (std::size_t j = 0; j < i; ++j) add_pair(bucket[j], bucket[i], pairs);
            }
        }
        std::sort(pairs.begin(), pairs.end());
        return pairs;
    }

private:
    using Cell = std::array<std::int64_t, 3>;
    struct Entry {
        Cell cell;
        std::uint32_t box;
    };

    [[nodiscard]] Cell cell_of(const float* corner) const {
        const auto place = [&](std::size_t axis) {
            return static_cast<std::int64_t>(std::floor(corner[axis] / edge_));
        };
        return {place(0), place(1), place(2)};
    }
    void add(std::uint32_t number) {
        const Cell first = cell_of(boxes_[number].lower), last = cell_of(boxes_[number].upper);
        Cell cell = first;
        for (cell[2] = first[2]; cell[2] <= last[2]; ++cell[2]) {
            for (cell[1] = first[1]; cell[1] <= last[1]; ++cell[1]) {
                for (cell[0] = first[0]; cell[0] <= last[0]; ++cell[0]) {
                    bucket_of(cell).push_back({cell, number});
                }
            }
        }
    }
    [[nodiscard]] std::vector<Entry>& bucket_of(const Cell& cell) {
        const auto mixed = static_cast<std::uint64_t>(cell[0]) * 73856093U ^
                           static_cast<std::uint64_t>(cell[1]) * 19349663U ^
                           static_cast<std::uint64_t>(cell[2]) * 83492791U;
        return buckets_[mixed % buckets_.size()];
    }
    /// Two boxes that meet share cells; the first of them in all three directions has the pair.
    void add_pair(const Entry& a, const Entry& b, Pairs& pairs) const {
        if (a.cell != b.cell || !boxes_meet(boxes_[a.box], boxes_[b.box])) return;
        const Cell at = cell_of(boxes_[a.box].lower), to = cell_of(boxes_[b.box].lower);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (a.cell[axis] != std::max(at[axis], to[axis])) return;
        }
        pairs.push_back({a.box, b.box});
    }

    std::span<const WorldBox> boxes_;
    std::vector<std::vector<Entry>> buckets_;
    double edge_ = 0;  ///< of a cell: twice the mean edge of a box
};

// Both ways of an update: pairs that are kept, and walks over all.
TEST(BroadPhase, EqualsSpatialHashing) {
    for (const test::BoxScene scene : test::kBoxScenes) {
        for (const std::size_t count : {1000, 10'000, 30'000}) {
            SCOPED_TRACE(std::string(test::name_of(scene)) + " " + std::to_string(count));
            test::MovingBoxes boxes(scene, count, 43);
            BroadPhase all = made_for(count, 40 * count), some = made_for(count, 40 * count);
            ASSERT_TRUE(some.update(boxes.boxes()).complete);
            std::size_t most = 0;
            for (int step = 0; step < 7; ++step) {
                const Pairs found = pairs_of(all.update(boxes.boxes()));
                const Pairs of_moved =
                    pairs_of(some.update_moved(boxes.boxes(), {}, boxes.moved()));
                ASSERT_TRUE(found == of_moved);
                if (step % 3 == 0) {
                    ASSERT_TRUE(found == SpatialHash(boxes.boxes()).pairs());
                    if (count == 1000) {
                        ASSERT_TRUE(found == test::brute_force_pairs(boxes.boxes()));
                    }
                }
                most = std::max(most, found.size());
                boxes.step();
            }
            ASSERT_GT(most, count / 4);
        }
    }
}

TEST(BroadPhase, EqualsBruteForceAsBoxesMove) {
    for (const test::BoxScene scene : test::kBoxScenes) {
        for (const std::size_t count : {0, 1, 2, 7, 8, 9, 63, 64, 65, 600}) {
            SCOPED_TRACE(std::string(test::name_of(scene)) + " " + std::to_string(count));
            test::MovingBoxes boxes(scene, count, 7);
            BroadPhase all = made_for(count, 40 * count), some = made_for(count, 40 * count);
            ASSERT_EQ(pairs_of(some.update(boxes.boxes())), test::brute_force_pairs(boxes.boxes()));
            for (int step = 0; step < 40; ++step) {
                const Pairs expected = test::brute_force_pairs(boxes.boxes());
                ASSERT_EQ(pairs_of(all.update(boxes.boxes())), expected);
                ASSERT_EQ(pairs_of(some.update_moved(boxes.boxes(), {}, boxes.moved())), expected);
                boxes.step();
            }
        }
    }
}

TEST(BroadPhase, EqualsBruteForceOfTenThousand) {
    for (const test::BoxScene scene : test::kBoxScenes) {
        SCOPED_TRACE(test::name_of(scene));
        test::MovingBoxes boxes(scene, 10'000, 3);
        BroadPhase broad_phase = made_for(10'000, 400'000);
        for (int step = 0; step < 12; ++step) {
            const BroadPhaseUpdate update = broad_phase.update(boxes.boxes());
            if (step % 11 == 0) {
                ASSERT_EQ(pairs_of(update), test::brute_force_pairs(boxes.boxes()));
            }
            boxes.step();
        }
    }
}

// Boxes that move far leave in every update, and then stay: both ways and the changes between them.
TEST(BroadPhase, BothWaysGiveTheSame) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> any(0, 20);
    std::vector<WorldBox> boxes(300);
    BroadPhase broad_phase = made_for(boxes.size(), 10'000);
    int kept = 0, anew = 0;
    for (int step = 0; step < 120; ++step) {
        const std::size_t moves = step / 30 % 2 == 0 ? boxes.size() : 5;
        for (std::size_t i = 0; i < moves; ++i) {
            boxes[i] = cube(any(random), any(random), any(random), 2);
        }
        const BroadPhaseUpdate update = broad_phase.update(boxes);
        ASSERT_EQ(pairs_of(update), test::brute_force_pairs(boxes));
        ++(update.kept ? kept : anew);
    }
    EXPECT_GT(kept, 30);
    EXPECT_GT(anew, 30);
}

TEST(BroadPhase, ThreadsGiveTheSame) {
    for (const test::BoxScene scene : test::kBoxScenes) {
        for (const std::uint32_t count : {64U, 65U, 1000U, 3000U}) {
            SCOPED_TRACE(std::string(test::name_of(scene)) + " " + std::to_string(count));
            test::MovingBoxes boxes(scene, count, 41);
            std::vector<BroadPhase> all, some;
            for (const std::uint32_t threads : {1U, 2U, 8U}) {
                const BroadPhaseLimits limits{
                    .boxes = count, .pairs = 20 * count, .threads = threads};
                all.emplace_back(limits);
                some.emplace_back(limits);
                ASSERT_TRUE(some.back().update(boxes.boxes()).complete);
            }
            for (int step = 0; step < 30; ++step) {
                const Pairs expected = pairs_of(all[0].update(boxes.boxes()));
                for (BroadPhase& phase : all) {
                    ASSERT_EQ(pairs_of(phase.update(boxes.boxes(), {}, test::run_threads)),
                              expected);
                }
                for (BroadPhase& phase : some) {
                    ASSERT_EQ(pairs_of(phase.update_moved(boxes.boxes(), {}, boxes.moved(),
                                                          test::run_threads)),
                              expected);
                }
                boxes.step();
            }
        }
    }
}

// With this many kept pairs, threads share them too.
TEST(BroadPhase, ThreadsShareManyKeptPairs) {
    constexpr std::uint32_t kCount = 2000, kPairs = 32'768;
    std::vector<WorldBox> boxes(kCount);
    for (std::uint32_t i = 0; i < kCount; ++i) {
        boxes[i] = cube(0.03F * static_cast<float>(i), 0, 0, 1);
    }
    std::vector<BroadPhase> phases;
    for (const std::uint32_t threads : {1U, 2U, 8U}) {
        phases.emplace_back(
            BroadPhaseLimits{.boxes = kCount, .pairs = 100 * kCount, .threads = threads});
    }
    int kept = 0;
    for (int step = 0; step < 20; ++step) {
        for (std::uint32_t i = 0; i < kCount; i += 50) boxes[i].upper[0] += 0.002F;
        const BroadPhaseUpdate update = phases[0].update(boxes);
        kept += update.kept && update.pairs.size() >= kPairs ? 1 : 0;
        const Pairs expected = pairs_of(update);
        ASSERT_EQ(expected, test::brute_force_pairs(boxes));
        for (std::size_t i = 1; i < phases.size(); ++i) {
            ASSERT_EQ(pairs_of(phases[i].update(boxes, {}, test::run_threads)), expected);
        }
    }
    EXPECT_GT(kept, 5);
}

TEST(BroadPhase, TouchingBoxesMeet) {
    const std::vector<WorldBox> boxes = grid_boxes(500, 11);
    BroadPhase broad_phase = made_for(boxes.size(), 100'000);
    ASSERT_EQ(pairs_of(broad_phase.update(boxes)), test::brute_force_pairs(boxes));
    const std::vector<WorldBox> corners = {cube(0, 0, 0, 1), cube(1, 1, 1, 1),
                                           cube(std::nextafter(1.0F, 2.0F), 0, 0, 1)};
    ASSERT_EQ(pairs_of(broad_phase.update(corners)), (Pairs{{0, 1}, {1, 2}}));
}

TEST(BroadPhase, TakesFlatInfiniteEqualAndAbsentBoxes) {
    for (const std::uint32_t threads : {1U, 8U}) {
        std::vector<WorldBox> boxes = grid_boxes(100, 13);
        boxes[3] = kEverything;
        boxes[4] = {{-kInfinity, 2, 2}, {kInfinity, 2, 2}};
        boxes[5] = {{-3e38F, -3e38F, -3e38F}, {3e38F, 3e38F, 3e38F}};
        boxes[6] = {{5, 5, 5}, {5, 5, 5}};
        boxes[7] = {{-kInfinity, -kInfinity, -kInfinity}, {kInfinity, kInfinity, 1}};  // a ground
        for (std::size_t i = 20; i < 60; ++i) boxes[i] = cube(4, 4, 4, 1);
        for (std::size_t i = 70; i < 80; ++i) boxes[i] = kAbsent;
        boxes[80] = {{kInfinity, kInfinity, kInfinity}, {kInfinity, kInfinity, kInfinity}};
        boxes[81] = {{0, 0, 0}, {-1, -1, kInfinity}};
        BroadPhase all({.boxes = 100, .pairs = 10'000, .threads = threads});
        BroadPhase some({.boxes = 100, .pairs = 10'000, .threads = threads});
        std::vector<std::uint32_t> numbers(boxes.size());
        std::iota(numbers.begin(), numbers.end(), 0U);
        const auto expect_all = [&] {
            const Pairs expected = test::brute_force_pairs(boxes);
            ASSERT_EQ(pairs_of(all.update(boxes, {}, test::run_threads)), expected);
            ASSERT_EQ(pairs_of(some.update_moved(boxes, {}, numbers, test::run_threads)), expected);
        };
        ASSERT_TRUE(some.update(boxes).complete);
        expect_all();
        for (std::size_t i = 0; i < boxes.size(); i += 7) std::swap(boxes[i], boxes[99 - i]);
        expect_all();
        std::fill(boxes.begin(), boxes.end(), kAbsent);
        expect_all();
        std::fill(boxes.begin(), boxes.end(), kEverything);
        expect_all();
        EXPECT_EQ(all.update(boxes).pairs.size(), 100U * 99 / 2);
    }
}

TEST(BroadPhase, BoxesComeAndGo) {
    std::mt19937 random(17);
    std::uniform_real_distribution<float> any(0, 6);
    std::vector<WorldBox> boxes(30, kAbsent);
    BroadPhase broad_phase = made_for(boxes.size(), 10'000);
    ASSERT_TRUE(pairs_of(broad_phase.update(boxes)).empty());
    const int steps = test::rounds(1'000'000, 20);
    for (int step = 0; step < steps; ++step) {
        std::vector<std::uint32_t> moved(random() % 6);
        for (std::uint32_t& number : moved) {
            number = static_cast<std::uint32_t>(random() % boxes.size());
            const float edge = std::exp2(static_cast<float>(random() % 6) - 3);
            boxes[number] =
                random() % 3 == 0 ? kAbsent : cube(any(random), any(random), any(random), edge);
        }
        const Pairs pairs = pairs_of(broad_phase.update_moved(boxes, {}, moved));
        ASSERT_EQ(pairs, test::brute_force_pairs(boxes)) << step;
    }
}

TEST(BroadPhase, FiltersAreMutual) {
    std::mt19937 random(19);
    std::vector<WorldBox> boxes = grid_boxes(300, 19);
    std::vector<BoxFilter> filters(boxes.size());
    for (BoxFilter& filter : filters) {
        filter = {std::uint32_t{1} << random() % 4, static_cast<std::uint32_t>(random() % 16)};
    }
    BroadPhase broad_phase = made_for(boxes.size(), 60'000);
    for (int step = 0; step < 40; ++step) {
        ASSERT_EQ(pairs_of(broad_phase.update(boxes, filters)),
                  test::brute_force_pairs(boxes, filters));
        // No box moves, but some change what they accept.
        const auto number = static_cast<std::uint32_t>(random() % boxes.size());
        filters[number].accepts ^= 5;
        ASSERT_EQ(pairs_of(broad_phase.update_moved(boxes, filters, {&number, 1})),
                  test::brute_force_pairs(boxes, filters));
        filters[random() % boxes.size()].layers = 8;
    }
    ASSERT_EQ(pairs_of(broad_phase.update(boxes)), test::brute_force_pairs(boxes));
}

// Filters come and go, with all boxes named or some, and with other numbers of boxes.
TEST(BroadPhase, FiltersComeAndGo) {
    std::mt19937 random(31);
    const std::vector<WorldBox> all = grid_boxes(120, 31);
    std::vector<BoxFilter> own(all.size());
    for (BoxFilter& filter : own) {
        filter = {std::uint32_t{1} << random() % 3, static_cast<std::uint32_t>(random() % 8)};
    }
    BroadPhase broad_phase = made_for(all.size(), 8'000);
    std::size_t count = all.size();
    std::vector<BoxFilter> last(count);  // as the broad phase knows them
    ASSERT_TRUE(broad_phase.update(all).complete);
    for (int step = 0; step < 2'000; ++step) {
        const bool names_some = random() % 3 > 0;
        if (!names_some) count = random() % 4 > 0 ? count : 40 + random() % 80;
        const std::span<const WorldBox> boxes(all.data(), count);
        const std::span<const BoxFilter> filters(own.data(), random() % 2 == 0 ? count : 0);
        const auto filter_of = [&](std::size_t i) {
            return filters.empty() ? BoxFilter{} : filters[i];
        };
        std::vector<std::uint32_t> moved;
        for (int i = 0; i < 9; ++i) moved.push_back(static_cast<std::uint32_t>(random() % count));
        last.resize(count);
        for (std::size_t i = 0; i < count && !names_some; ++i) last[i] = filter_of(i);
        for (std::size_t i = 0; i < moved.size() && names_some; ++i) {
            last[moved[i]] = filter_of(moved[i]);
        }
        const Pairs found = pairs_of(names_some ? broad_phase.update_moved(boxes, filters, moved)
                                                : broad_phase.update(boxes, filters));
        ASSERT_EQ(found, test::brute_force_pairs(boxes, last)) << step;
    }
}

TEST(BroadPhase, SaysHowMuchRoomIsNeeded) {
    const std::vector<WorldBox> boxes(50, cube(0, 0, 0, 1));
    constexpr std::size_t kAll = 50 * 49 / 2;
    for (const std::size_t room : {std::size_t{0}, std::size_t{10}, kAll - 1}) {
        BroadPhase broad_phase = made_for(boxes.size(), room);
        for (int repeat = 0; repeat < 3; ++repeat) {
            const BroadPhaseUpdate update = broad_phase.update(boxes);
            EXPECT_FALSE(update.complete);
            EXPECT_TRUE(update.pairs.empty());
            EXPECT_EQ(update.needed, kAll);
        }
    }
    BroadPhase broad_phase = made_for(boxes.size(), kAll);
    EXPECT_EQ(pairs_of(broad_phase.update(boxes)).size(), kAll);
}

// The larger boxes form more pairs than there is room for, the boxes themselves do not.
TEST(BroadPhase, RoomForThePairsIsEnough) {
    test::MovingBoxes boxes(test::BoxScene::pile, 400, 23);
    std::size_t most = 0;
    std::vector<std::vector<WorldBox>> steps;
    for (int step = 0; step < 60; ++step) {
        steps.emplace_back(boxes.boxes().begin(), boxes.boxes().end());
        most = std::max(most, test::brute_force_pairs(boxes.boxes()).size());
        boxes.step();
    }
    BroadPhase broad_phase = made_for(400, most);
    for (const auto& step : steps) {
        ASSERT_EQ(pairs_of(broad_phase.update(step)), test::brute_force_pairs(step));
    }
}

TEST(BroadPhase, RefusesNanAndChangesNothing) {
    std::vector<WorldBox> boxes = grid_boxes(40, 29);
    BroadPhase broad_phase = made_for(boxes.size(), 2000);
    const BroadPhaseUpdate before = broad_phase.update(boxes);
    const Pairs expected = pairs_of(before);
    for (const bool names_moved : {false, true}) {
        std::vector<WorldBox> wrong = boxes;
        wrong[3] = kEverything;
        wrong[17].upper[1] = kNan;
        const std::vector<std::uint32_t> moved = {3, 17};
        const BroadPhaseUpdate update =
            names_moved ? broad_phase.update_moved(wrong, {}, moved) : broad_phase.update(wrong);
        EXPECT_FALSE(update.complete);
        EXPECT_EQ(update.refused, 17U);
        EXPECT_EQ(pairs_of(before), expected);
        EXPECT_EQ(pairs_of(broad_phase.update_moved(boxes, {}, {})), expected);
    }
}

TEST(BroadPhase, LivesInMemoryOfTheCaller) {
    const BroadPhaseLimits limits = {.boxes = 100, .pairs = 1000};
    const std::size_t size = BroadPhase::size(limits), alignment = BroadPhase::alignment();
    std::vector<std::byte> room(size + 2 * alignment);
    void* at = room.data();
    std::size_t space = room.size();
    auto* const memory = static_cast<std::byte*>(std::align(alignment, size, at, space));
    EXPECT_FALSE(BroadPhase::in_memory({memory, size - 1}, limits));
    EXPECT_FALSE(BroadPhase::in_memory({memory + 1, size}, limits));
    EXPECT_FALSE(BroadPhase::in_memory({memory, size}, {.boxes = 1U << 30, .pairs = 0}));
    const std::vector<WorldBox> boxes = grid_boxes(100, 31);
    std::optional<BroadPhase> broad_phase = BroadPhase::in_memory({memory, size}, limits);
    ASSERT_TRUE(broad_phase);
    const BroadPhaseUpdate update = broad_phase->update(boxes);
    EXPECT_EQ(pairs_of(update), test::brute_force_pairs(boxes));
}

TEST(BroadPhaseDeathTest, StopsOnWrongSizes) {
    const std::vector<WorldBox> boxes = grid_boxes(10, 37);
    const std::vector<BoxFilter> filters(9);
    const std::vector<std::uint32_t> moved = {10};
    BroadPhase small = made_for(9, 100), enough = made_for(10, 100);
    EXPECT_DEATH((void)small.update(boxes), "was made for fewer boxes");
    EXPECT_DEATH((void)enough.update(boxes, filters), "needs a filter for each box");
    EXPECT_DEATH((void)enough.update_moved(boxes, {}, moved),
                 "differs from that of the last update");
    (void)enough.update(boxes);
    EXPECT_DEATH((void)enough.update_moved(boxes, {}, moved),
                 "number of a moved box is out of range");
}

}  // namespace
}  // namespace cdprep
