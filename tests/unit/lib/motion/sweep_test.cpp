// SPDX-License-Identifier: MIT
#include "cdprep/sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include "cdprep/live_model.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"
#include "support/rounds.h"

namespace cdprep::test {
namespace {

/// A mesh that deforms, and its sweep.
class Deforming {
public:
    explicit Deforming(const TestMesh& mesh, const LiveLimits& limits = {})
        : mesh_(mesh),
          arrays_(build::build_model(mesh.positions, mesh.triangles,
                                     {.bounds = build::BvhBounds::aligned})
                      .value()),
          live_memory_(LiveModel::bytes(arrays_, limits).value()),
          live_(LiveModel::in(live_memory_.span(), arrays_, limits).value()),
          sweep_memory_(Sweep::bytes(live_.model())),
          sweep_(Sweep::in(sweep_memory_.span(), live_.model()).value()) {}

    /// Moves from where it is.
    void move_to(const std::vector<Double3>& positions) {
        sweep_.begin();
        ASSERT_TRUE(live_.refit(positions).ok());
        sweep_.end();
        mesh_.positions = positions;
    }
    [[nodiscard]] const TestMesh& mesh() const {
        return mesh_;
    }
    [[nodiscard]] const Sweep& sweep() const {
        return sweep_;
    }
    [[nodiscard]] Sweep& sweep() {
        return sweep_;
    }
    [[nodiscard]] LiveModel& live() {
        return live_;
    }

private:
    TestMesh mesh_;
    build::ModelArrays arrays_;
    AlignedBytes live_memory_;
    LiveModel live_;
    AlignedBytes sweep_memory_;
    Sweep sweep_;
};

std::vector<Double3> shifted_by(std::vector<Double3> positions, const Double3& by) {
    for (Double3& p : positions) p = {p.x + by.x, p.y + by.y, p.z + by.z};
    return positions;
}

/// A wire: a thin triangle along y, at this height.
OpenModel wire_at(double z) {
    return open_tiny(TestMesh{{{0.5, -9, z}, {0.5, 9, z}, {0.5 + 1e-3, 9, z}}, {{{0, 1, 2}}}});
}

TEST(Sweep, OfAMeshThatStaysIsWithoutItsNeighbours) {
    Workspace workspace;
    const Deforming sheet(grid_sheet(4, 4));
    EXPECT_FALSE(may_touch(sheet.sweep(), wire_at(0.001).model, Motion(), workspace));
    EXPECT_TRUE(may_touch(sheet.sweep(), wire_at(0).model, Motion(), workspace));
}

TEST(Sweep, FindsWhatASheetJumpsOver) {
    Workspace workspace;
    Deforming sheet(grid_sheet(4, 4));
    sheet.move_to(shifted_by(sheet.mesh().positions, {0, 0, 10}));
    const OpenModel between = wire_at(7), below = wire_at(-0.001), above = wire_at(10.001);
    EXPECT_TRUE(may_touch(sheet.sweep(), between.model, Motion(), workspace));
    EXPECT_FALSE(may_touch(sheet.sweep(), below.model, Motion(), workspace));
    EXPECT_FALSE(may_touch(sheet.sweep(), above.model, Motion(), workspace));
    // Only the column of squares under the wire passes it.
    std::vector<TrianglePair> room(64);
    const std::size_t count =
        pairs_that_may_touch(sheet.sweep(), between.model, Motion(), workspace, room);
    EXPECT_EQ(count, 8U);
    EXPECT_TRUE(std::is_sorted(room.begin(), room.begin() + 8));
    // The next step begins where this one ended.
    sheet.move_to(shifted_by(sheet.mesh().positions, {0, 0, 1}));
    EXPECT_FALSE(may_touch(sheet.sweep(), between.model, Motion(), workspace));
}

TEST(Sweep, SeesNoContactOfModelsThatMoveTogether) {
    Workspace workspace;
    Deforming sheet(grid_sheet(4, 4));
    sheet.move_to(shifted_by(sheet.mesh().positions, {30, 0, 10}));
    const Motion together = Motion::by_velocity(Pose(), {30, 0, 10}, {}).value();
    EXPECT_FALSE(may_touch(sheet.sweep(), wire_at(0.001).model, together, workspace));
    EXPECT_TRUE(may_touch(sheet.sweep(), wire_at(0.001).model, Motion(), workspace));
    const Motion towards = Motion::by_velocity(Pose(), {30, 0, 9.9}, {}).value();
    EXPECT_TRUE(may_touch(sheet.sweep(), wire_at(0.001).model, towards, workspace));
}

TEST(Sweep, FollowsATurn) {
    Workspace workspace;
    // A needle along x that turns about z passes a pin at (0, 1): at its ends it is far from it.
    const Deforming pin(TestMesh{{{0, 1, -1}, {0, 1, 1}, {1e-3, 1, 0}}, {{{0, 1, 2}}}});
    const OpenModel needle =
        open_tiny(TestMesh{{{0, 0, 0}, {2, 0, 0}, {2, 1e-3, 0}}, {{{0, 1, 2}}}});
    const auto turning = [](double angle) {
        return Motion::by_velocity(Pose(), {}, {0, 0, angle}).value();
    };
    EXPECT_TRUE(may_touch(pin.sweep(), needle.model, turning(3), workspace));
    EXPECT_FALSE(may_touch(pin.sweep(), needle.model, turning(-0.5), workspace));
    EXPECT_FALSE(may_touch(pin.sweep(), needle.model, turning(0.5), workspace));
}

TEST(Sweep, OfATornMeshHasNoPlaceOfARemovedTriangle) {
    Workspace workspace;
    Deforming sheet(grid_sheet(4, 4), {.triangles = 64, .vertices = 30});
    const OpenModel wire = wire_at(0.5);
    std::vector<std::uint32_t> under;
    for (std::uint32_t i = 0; i < sheet.mesh().triangles.size(); ++i) {
        const auto& v = sheet.mesh().triangles[i].vertex;
        const double x = std::min({sheet.mesh().positions[v[0]].x, sheet.mesh().positions[v[1]].x,
                                   sheet.mesh().positions[v[2]].x});
        if (x == 0) under.push_back(i);
    }
    ASSERT_EQ(under.size(), 8U);
    ASSERT_TRUE(sheet.live().remove(under).ok());
    sheet.move_to(shifted_by(sheet.mesh().positions, {0, 0, 1}));
    EXPECT_FALSE(may_touch(sheet.sweep(), wire.model, Motion(), workspace));
    const std::uint32_t first =
        sheet.live().append(std::vector{sheet.mesh().triangles[under[0]]}).value();
    sheet.move_to(shifted_by(sheet.mesh().positions, {0, 0, -1}));
    std::vector<TrianglePair> room(4);
    EXPECT_EQ(pairs_that_may_touch(sheet.sweep(), wire.model, Motion(), workspace, room), 1U);
    EXPECT_EQ(room[0].a, first);
}

TEST(Sweep, OfNothingTouchesNothing) {
    Workspace workspace;
    Deforming sheet(grid_sheet(1, 1), {.triangles = 2, .vertices = 4});
    const OpenModel empty = open_tiny(TestMesh{});
    EXPECT_FALSE(may_touch(sheet.sweep(), empty.model, Motion(), workspace));
    ASSERT_TRUE(sheet.live().remove(std::vector<std::uint32_t>{0, 1}).ok());
    sheet.move_to(sheet.mesh().positions);
    EXPECT_FALSE(may_touch(sheet.sweep(), wire_at(0).model, Motion(), workspace));
}

// Its boxes are of the leaves that the model had at the end of the step.
TEST(Sweep, IsOfTheModelAtTheEndOfTheStep) {
    Deforming sheet(grid_sheet(20, 20), {.triangles = 900, .vertices = 500});
    const auto& positions = sheet.mesh().positions;
    EXPECT_TRUE(sheet.sweep().is_current());
    sheet.sweep().begin();
    EXPECT_FALSE(sheet.sweep().is_current());
    sheet.sweep().end();
    EXPECT_TRUE(sheet.sweep().is_current());
    ASSERT_TRUE(sheet.live().refit(shifted_by(positions, {1, 0, 0})).ok());
    EXPECT_FALSE(sheet.sweep().is_current());
    sheet.move_to(positions);
    EXPECT_TRUE(sheet.sweep().is_current());
    ASSERT_TRUE(sheet.live().remove(std::vector<std::uint32_t>{3}).ok());
    EXPECT_FALSE(sheet.sweep().is_current());
    std::vector<Double3> mixed = positions;
    std::shuffle(mixed.begin(), mixed.end(), std::mt19937(5));
    sheet.move_to(mixed);
    EXPECT_TRUE(sheet.sweep().is_current());
    ASSERT_GT(sheet.live().rebuild(1'000'000), 0U);
    EXPECT_FALSE(sheet.sweep().is_current());
    Workspace workspace;
    const OpenModel wire = wire_at(0);
    EXPECT_DEATH((void)may_touch(sheet.sweep(), wire.model, Motion(), workspace), "has changed");
    sheet.sweep().end();
    EXPECT_TRUE(may_touch(sheet.sweep(), wire.model, Motion(), workspace));
}

// Appended triangles move others to other leaves. When they are removed again, the mesh is as it
// was, but the sweep's boxes are not of its leaves.
TEST(Sweep, IsNotOfAModelWhoseTrianglesHaveOtherPlaces) {
    Deforming sheet(grid_sheet(40, 40), {.triangles = 3800, .vertices = 1681});
    LiveModel& live = sheet.live();
    const auto count = static_cast<std::uint32_t>(sheet.mesh().triangles.size());
    std::vector<std::uint32_t> places, added;
    for (std::uint32_t i = 0; i < count; ++i) places.push_back(live.place_of(i).value());
    // It has torn before, so that only the places differ afterwards.
    added = {live.append(std::vector{sheet.mesh().triangles[0]}).value()};
    ASSERT_TRUE(live.remove(added).ok());
    sheet.move_to(sheet.mesh().positions);
    ASSERT_TRUE(sheet.sweep().is_current());
    const std::uint32_t first = live.append(std::vector(400, sheet.mesh().triangles[5])).value();
    added.resize(400);
    std::iota(added.begin(), added.end(), first);
    EXPECT_FALSE(sheet.sweep().is_current());
    ASSERT_TRUE(live.remove(added).ok());
    std::size_t moved = 0;
    for (std::uint32_t i = 0; i < count; ++i) moved += live.place_of(i) != places[i] ? 1 : 0;
    ASSERT_GT(moved, 1000U);
    EXPECT_FALSE(sheet.sweep().is_current());
}

TEST(Sweep, NeedsEnoughAlignedMemory) {
    const OpenModel sheet = open_tiny(grid_sheet(3, 3));
    AlignedBytes memory(Sweep::bytes(sheet.model) + 64);
    EXPECT_TRUE(Sweep::in(memory.span().first(Sweep::bytes(sheet.model)), sheet.model));
    EXPECT_FALSE(Sweep::in(memory.span().first(Sweep::bytes(sheet.model) - 1), sheet.model));
    EXPECT_FALSE(Sweep::in(memory.span().subspan(8), sheet.model));
}

/// The mesh at a time of the step.
TestMesh between(const TestMesh& mesh, const std::vector<Double3>& to, double time) {
    TestMesh now = mesh;
    for (std::size_t i = 0; i < to.size(); ++i) {
        const Double3 &p = mesh.positions[i], &q = to[i];
        now.positions[i] = {p.x + time * (q.x - p.x), p.y + time * (q.y - p.y),
                            p.z + time * (q.z - p.z)};
    }
    return now;
}

// Where a sample of the step touches, the answer is yes, and the pair is in the list.
TEST(SweepLaws, DenseSamplesFindNothingThatItMisses) {
    const int rounds = asks_all() ? 5'000 : 300;
    constexpr int kSamples = 32;
    std::mt19937 random(5);
    Workspace workspace;
    int hits = 0, clear = 0;
    std::vector<TrianglePair> listed(2000), seen(2000);
    for (int round = 0; round < rounds; ++round) {
        // The sheet has two levels of nodes.
        const TestMesh start = round % 2 == 0 ? moved_by(grid_sheet(6, 6), 0.2, {-0.6, -0.6, 0})
                                              : random_soup(random(), 20, 0.4);
        std::vector<Double3> to = shifted_by(start.positions, fine_point(random, 1));
        for (Double3& p : to) {
            const Double3 by = fine_point(random, 0.2);
            p = {p.x + by.x, p.y + by.y, p.z + by.z};
        }
        const OpenModel other = open_tiny(moved_by(icosphere(0), 0.2, fine_point(random, 0.1)),
                                          {.double_precision = round % 3 == 0});
        const Motion motion = Motion::by_velocity(random_pose(random, 1.2), fine_point(random, 0.5),
                                                  fine_point(random, 0.5))
                                  .value();
        Deforming object(start);
        object.move_to(to);
        const std::size_t count =
            pairs_that_may_touch(object.sweep(), other.model, motion, workspace, listed);
        EXPECT_EQ(count > 0, may_touch(object.sweep(), other.model, motion, workspace));
        clear += count == 0 ? 1 : 0;
        bool touched = false;
        for (int i = 0; i <= kSamples; ++i) {
            const double time = double(i) / kSamples;
            const OpenModel now = open_tiny(between(start, to, time), {.double_precision = true});
            const Pair pair = {now.model, other.model, Placement::b_moves(motion.at(time))};
            const std::size_t found = overlaps(pair, workspace, seen);
            touched = touched || found > 0;
            ASSERT_TRUE(
                std::includes(listed.begin(), listed.begin() + static_cast<std::ptrdiff_t>(count),
                              seen.begin(), seen.begin() + static_cast<std::ptrdiff_t>(found)))
                << round << " at " << time;
        }
        hits += touched ? 1 : 0;
    }
    EXPECT_GT(hits, rounds / 10);
    EXPECT_GT(clear, rounds / 10);
    EXPECT_LE(rounds - clear, 3 * hits);  // few false alarms
}

}  // namespace
}  // namespace cdprep::test
