// SPDX-License-Identifier: MIT
#include "cdprep/window.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <thread>

#include "cdprep/live_model.h"
#include "cdprep/pairs.h"
#include "cdprep/points.h"
#include "support/open_tiny.h"
#include "support/placements.h"
#include "support/random_pose.h"
#include "support/rounds.h"
#include "support/same_distance.h"

#ifdef __linux__
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>
#endif

namespace cdprep::test {
namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();

/// A window and its memory.
struct OwnedWindow {
    AlignedBytes memory;
    Window window;
};

OwnedWindow window_of(std::uint32_t leaves) {
    AlignedBytes memory(Window::bytes({leaves}).value());
    auto made = Window::in(memory.span(), {leaves});
    return {std::move(memory), std::move(made).value()};
}

/// A live model and its memory.
struct OwnedLive {
    AlignedBytes memory;
    LiveModel object;
};

OwnedLive live_of(const TestMesh& mesh, const LiveLimits& limits = {}) {
    const auto arrays =
        build::build_model(mesh.positions, mesh.triangles, {.bounds = build::BvhBounds::aligned})
            .value();
    AlignedBytes memory(LiveModel::bytes(arrays, limits).value());
    auto made = LiveModel::in(memory.span(), arrays, limits);
    return {std::move(memory), std::move(made).value()};
}

TestMesh large_mesh() {
    return torus(1, 0.3, 60, 40);
}
TestMesh small_mesh() {
    return turned(moved_by(icosphere(1), 0.1, {}), 0.4);
}

/// A torn torus: a third of its triangles are removed, some are appended again.
OwnedLive torn_torus() {
    const TestMesh mesh = large_mesh();
    const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
    OwnedLive live = live_of(mesh, {.triangles = count});
    std::vector<std::uint32_t> gone;
    std::vector<Triangle> again;
    for (std::uint32_t i = 0; i < count; i += 3) {
        gone.push_back(i);
        if (i % 2 == 0) again.push_back(mesh.triangles[i]);
    }
    EXPECT_TRUE(live.object.remove(gone));
    EXPECT_TRUE(live.object.append(again));
    return live;
}

using PairList = std::vector<TrianglePair>;

PairList near_pairs(const Pair& pair, double tolerance, Workspace& workspace) {
    PairList pairs(pairs_within(pair, tolerance, workspace, {}));
    EXPECT_EQ(pairs_within(pair, tolerance, workspace, pairs), pairs.size());
    return pairs;
}
PairList touching_pairs(const Pair& pair, Workspace& workspace) {
    PairList pairs(overlaps(pair, workspace, {}));
    EXPECT_EQ(overlaps(pair, workspace, pairs), pairs.size());
    return pairs;
}

/// A probe that turns and glides around the torus, mostly near the surface, and sometimes jumps.
class Glide {
public:
    explicit Glide(std::uint32_t seed) : random_(seed) {}

    Placement next(unsigned kind) {
        if (random_() % 2000 == 0) angle_ += 1;
        angle_ += 1e-3 * step_(random_);
        around_ += 4e-3 * step_(random_);
        const double r = 0.4 + 0.05 * std::sin(turn_ * 3);
        const double out = 1 + r * std::cos(around_);
        turn_ += 2e-3 * step_(random_);
        const Pose pose =
            Pose::from_quaternion(
                std::cos(turn_), 0.3 * std::sin(turn_), std::sin(turn_), 0.1,
                {out * std::cos(angle_), out * std::sin(angle_), r * std::sin(around_)})
                .value();
        if (kind == 1) return Placement::a_moves(inverse(pose));
        const Pose world = Pose::from_quaternion(1, 0.2, angle_, 0, {5, -3, angle_}).value();
        if (kind == 2) return Placement::world(world, compose(world, pose));
        return Placement::b_moves(pose);
    }

private:
    static Pose inverse(const Pose& pose) {
        return relative_pose(pose, Pose());
    }
    static Pose compose(const Pose& outer, const Pose& inner) {
        return relative_pose(relative_pose(outer, Pose()), inner);
    }
    std::mt19937 random_;
    std::normal_distribution<double> step_;
    double angle_ = 0, around_ = 0, turn_ = 0;
};

/// What a walk met.
struct Met {
    std::size_t complete = 0, incomplete = 0, touching = 0, lists = 0, fills = 0;
};

/// Compares answers of the window with those of the whole model, where they claim to be complete.
/// Where they do not, their bounds must hold.
void expect_answers_of_all(const Model& all, const Model& probe, int steps, unsigned kind,
                           double radius, Met& met) {
    OwnedWindow owned = window_of(200);
    Window& window = owned.window;
    Workspace workspace;
    PairCache cache, of_all;
    Glide glide(kind + 7);
    LastDistance last;
    for (int step = 0; step < steps; ++step) {
        const Placement placement = glide.next(kind);
        const double margin = window.margin(probe, placement);
        if (margin < 0 && step % 40 == 0) {
            window.fill({all, probe, placement}, radius);
            ++met.fills;
        }
        const Pair near{window.model(), probe, placement, {}, step % 2 == 0 ? &cache : nullptr};
        const Pair whole{all, probe, placement, {}, &of_all};
        const BoundedDistance found =
            window.distance(near, workspace, {}, {.work = step % 9 == 0 ? 20U : 0U, .last = &last});
        const auto truth = distance(whole, workspace);
        ASSERT_LE(found.lower, truth->upper) << step;
        ASSERT_GE(found.upper, truth->lower) << step;
        if (!found.is_complete) {
            ++met.incomplete;
        } else if (truth->upper == 0) {
            ASSERT_EQ(found.upper, 0) << step;
            ++met.touching;
        } else {
            ASSERT_TRUE(found.nearest) << step;
            expect_same(found.nearest, truth);
            ++met.complete;
        }
        if (step % 200 != 0) continue;
        const double now = window.margin(probe, placement);
        if (now < 0) continue;
        ++met.lists;
        ASSERT_EQ(touching_pairs(near, workspace), touching_pairs(whole, workspace));
        ASSERT_EQ(collide(near, workspace).hit, collide(whole, workspace).hit);
        ASSERT_EQ(near_pairs(near, now, workspace), near_pairs(whole, now, workspace));
        ASSERT_EQ(within(near, now / 2, workspace), within(whole, now / 2, workspace));
    }
}

TEST(Window, CompleteAnswersAreThoseAboutTheWholeModel) {
    const OpenModel probe = open_tiny(small_mesh());
    const OpenModel fine = open_tiny(small_mesh(), {.double_precision = true});
    const OpenModel floats = open_tiny(large_mesh());
    const OpenModel doubles = open_tiny(large_mesh(), {.double_precision = true});
    const OwnedLive torn = torn_torus();
    const std::array<const Model*, 3> models = {&floats.model, &doubles.model,
                                                &torn.object.model()};
    const int kSteps = (rounds(1'000'000, 10) + 8) / 9;
    Met met;
    for (const Model* all : models) {
        for (const unsigned kind : {0U, 1U, 2U}) {
            const Model& with = kind == 1 ? fine.model : probe.model;
            expect_answers_of_all(*all, with, kSteps, kind, kind == 2 ? 0.05 : 0.12, met);
            if (HasFatalFailure()) return;
        }
    }
    const auto steps = static_cast<std::size_t>(9 * kSteps);
    EXPECT_GT(met.complete, steps / 10);
    EXPECT_GT(met.touching, steps / 50);
    EXPECT_GT(met.incomplete, steps / 50);
    EXPECT_GT(met.lists, steps / 1000);
    EXPECT_GT(met.fills, 20U);
}

// The window has every triangle within its radius, for any radius and placement.
TEST(Window, NothingWithinTheRadiusIsMissing) {
    std::mt19937 random(3);
    const int kRounds = rounds(1500, 5);
    std::size_t pairs = 0, skipped = 0, whole = 0, none = 0;
    for (int round = 0; round < kRounds; ++round) {
        const TestMesh mesh =
            round % 2 == 0 ? random_soup(random(), 300, 0.3) : coarse_grid_soup(random(), 300, 4);
        const OpenModel all = open_tiny(mesh, {.double_precision = round % 3 == 0});
        const OpenModel probe = open_tiny(random_soup(random(), 50, 0.2));
        const Placement placement =
            placement_of_kind(random(), random_pose(random, 2), random_pose(random, 1));
        const double radius =
            std::ldexp(1 + 1e-3 * (random() % 999), static_cast<int>(random() % 6) - 4);
        OwnedWindow owned = window_of(38);
        const WindowFill held = owned.window.fill({all.model, probe.model, placement}, radius);
        ASSERT_EQ(held.radius, radius);
        Workspace workspace;
        const PairList expected =
            near_pairs({all.model, probe.model, placement}, radius, workspace);
        ASSERT_EQ(near_pairs({owned.window.model(), probe.model, placement}, radius, workspace),
                  expected);
        const PairOptions skip = {.degenerate = Degenerate::skip};
        const Pair proper{all.model, probe.model, placement, skip};
        const PairList fewer = near_pairs(proper, radius, workspace);
        ASSERT_EQ(
            near_pairs({owned.window.model(), probe.model, placement, skip}, radius, workspace),
            fewer);
        skipped += expected.size() - fewer.size();
        const double margin = owned.window.margin(probe.model, placement);
        EXPECT_LE(margin, radius);
        EXPECT_GT(margin, radius * (1 - 1e-8));
        pairs += expected.size();
        whole += held.leaves == 38 ? 1 : 0;
        none += held.leaves == 0 ? 1 : 0;
    }
    EXPECT_GT(pairs, 1000U);
    EXPECT_GT(skipped, 100U);
    EXPECT_LT(whole, static_cast<std::size_t>(kRounds) / 2);
    EXPECT_LT(none, static_cast<std::size_t>(kRounds) / 2);
}

TEST(Window, TooLittleRoomShrinksTheRadius) {
    const OpenModel all = open_tiny(large_mesh()), probe = open_tiny(small_mesh());
    Workspace workspace;
    const Placement placement = shifted({1, 0, 0.45});
    const Pair pair{all.model, probe.model, placement};
    double before = -1;
    std::size_t shrunk = 0;
    for (std::uint32_t room = 1; room <= 700; room = room * 3 / 2 + 1) {
        for (const double radius : {0.3, 50.0, kEndless}) {
            OwnedWindow owned = window_of(room);
            const WindowFill held = owned.window.fill(pair, radius);
            EXPECT_LE(held.leaves, room);
            EXPECT_LE(held.radius, radius);
            EXPECT_EQ(owned.window.filled().radius, held.radius);
            const Pair near{owned.window.model(), probe.model, placement};
            if (held.radius < 0) {
                EXPECT_EQ(held.leaves, 0U);
                EXPECT_EQ(owned.window.margin(probe.model, placement), -kEndless);
                const BoundedDistance found = owned.window.distance(near, workspace);
                EXPECT_FALSE(found.is_complete);
                EXPECT_EQ(found.lower, 0);
                EXPECT_EQ(found.upper, kEndless);
                continue;
            }
            const double reach = std::min(held.radius, 4.0);
            ASSERT_EQ(near_pairs(near, reach, workspace), near_pairs(pair, reach, workspace));
            if (held.radius == radius) continue;
            ++shrunk;
            // A slightly larger radius would not have fitted.
            OwnedWindow larger = window_of(room);
            EXPECT_LT(larger.window.fill(pair, 1.13 * held.radius).radius, 1.13 * held.radius);
            if (radius == kEndless) {
                EXPECT_GE(held.radius, before * 0.9) << room;
                before = held.radius;
            }
        }
    }
    EXPECT_GT(shrunk, 10U);
    EXPECT_GT(before, 0.2);
}

// A probe across many leaves has no room for those that it touches.
TEST(Window, WithoutRoomForContactItIsEmpty) {
    const OpenModel all = open_tiny(large_mesh());
    OwnedWindow owned = window_of(4);
    const WindowFill held = owned.window.fill({all.model, all.model, shifted({0.01, 0, 0})}, 1);
    EXPECT_LT(held.radius, 0);
    EXPECT_EQ(held.leaves, 0U);
    EXPECT_EQ(owned.window.model().triangle_count(), 0U);
}

TEST(Window, AllLeavesAnswerForEver) {
    const OpenModel all = open_tiny(large_mesh()), probe = open_tiny(small_mesh());
    OwnedWindow owned = window_of(600);
    const WindowFill held =
        owned.window.fill({all.model, probe.model, shifted({9, 0, 0})}, kEndless);
    EXPECT_EQ(held.radius, kEndless);
    EXPECT_EQ(held.leaves, 600U);
    Workspace workspace;
    std::mt19937 random(5);
    for (int round = 0; round < 200; ++round) {
        const Placement placement = Placement::b_moves(random_pose(random, 3));
        EXPECT_EQ(owned.window.margin(probe.model, placement), kEndless);
        const BoundedDistance found =
            owned.window.distance({owned.window.model(), probe.model, placement}, workspace);
        EXPECT_TRUE(found.is_complete);
        const auto truth = distance({all.model, probe.model, placement}, workspace);
        EXPECT_EQ(found.upper, truth->upper);
        if (truth->upper > 0) expect_same(found.nearest, truth);
    }
}

TEST(Window, EmptyModelsAndBadRadii) {
    const OpenModel all = open_tiny(large_mesh()), probe = open_tiny(small_mesh());
    const OpenModel empty = open_tiny(std::span<const Double3>(), std::span<const Triangle>());
    const Placement placement = shifted({1, 0, 0.45});
    OwnedWindow owned = window_of(100);
    Window& window = owned.window;
    EXPECT_LT(window.filled().radius, 0);
    EXPECT_EQ(window.margin(probe.model, placement), -kEndless);
    EXPECT_EQ(window.fill({empty.model, probe.model, placement}, 2).radius, 2);
    EXPECT_EQ(window.margin(probe.model, placement), kEndless);
    Workspace workspace;
    const BoundedDistance none =
        window.distance({window.model(), probe.model, placement}, workspace);
    EXPECT_TRUE(none.is_complete);
    EXPECT_FALSE(none.nearest);
    EXPECT_EQ(window.fill({all.model, empty.model, placement}, 2).leaves, 0U);
    EXPECT_EQ(window.margin(empty.model, placement), kEndless);
    EXPECT_EQ(window.margin(probe.model, placement), -kEndless);
    for (const double bad : {-1.0, std::nan("")}) {
        EXPECT_GT(window.fill({all.model, probe.model, placement}, 0.2).leaves, 0U);
        EXPECT_LT(window.fill({all.model, probe.model, placement}, bad).radius, 0);
        EXPECT_EQ(window.model().triangle_count(), 0U);
        EXPECT_EQ(window.margin(probe.model, placement), -kEndless);
    }
}

// A probe that deformed, or another one, is not covered by the window.
TEST(Window, AnotherProbeHasNoMargin) {
    const OpenModel all = open_tiny(large_mesh()), other = open_tiny(icosphere(1));
    OwnedLive probe = live_of(small_mesh());
    OwnedWindow owned = window_of(300);
    const Placement placement = shifted({1, 0, 0.45});
    owned.window.fill({all.model, probe.object.model(), placement}, 0.2);
    EXPECT_GT(owned.window.margin(probe.object.model(), placement), 0.19);
    EXPECT_EQ(owned.window.margin(other.model, placement), -kEndless);
    TestMesh wider = moved_by(small_mesh(), 3, {});
    ASSERT_TRUE(probe.object.refit(wider.positions));
    EXPECT_EQ(owned.window.margin(probe.object.model(), placement), -kEndless);
    owned.window.fill({all.model, probe.object.model(), placement}, 0.2);
    EXPECT_GT(owned.window.margin(probe.object.model(), placement), 0.19);
}

// The window lacks the second ball, which is nearer than the first after the probe has moved.
TEST(Window, ALateAnswerBoundsWhatTheWindowLacks) {
    const TestMesh ball = icosphere(1);
    const OpenModel all = open_tiny(joined(ball, moved_by(ball, 1, {30, 0, 0})));
    const OpenModel probe = open_tiny(small_mesh());
    OwnedWindow owned = window_of(300);
    Workspace workspace;
    PairCache cache;
    owned.window.fill({all.model, probe.model, shifted({8, 0, 0})}, 12);
    const Placement moved = shifted({17, 0, 0});
    const double true_distance = distance({all.model, probe.model, moved}, workspace)->upper;
    const Pair near{owned.window.model(), probe.model, moved, {}, &cache};
    for (const double max_distance : {kEndless, 1.0}) {
        for (const std::uint64_t work : {std::uint64_t{0}, std::uint64_t{1}}) {
            const BoundedDistance found = owned.window.distance(
                near, workspace, {.max_distance = max_distance}, {.work = work});
            if (found.is_complete) continue;
            EXPECT_LE(found.lower, true_distance) << max_distance << ", " << work;
        }
    }
}

// The window keeps the shape that the model had.
TEST(Window, TheModelMayDeformAfterTheFill) {
    const TestMesh rest = large_mesh();
    OwnedLive all = live_of(rest);
    const OpenModel fixed = open_tiny(rest, {.double_precision = true});
    const OpenModel probe = open_tiny(small_mesh());
    OwnedWindow owned = window_of(300);
    Workspace workspace;
    PairCache cache;
    const Placement placement = shifted({1.02, 0.03, 0.45});
    owned.window.fill({all.object.model(), probe.model, placement}, 0.2);
    const Pair near{owned.window.model(), probe.model, placement, {}, &cache};
    for (const double scale : {1.5, 0.5, 1.0}) {
        ASSERT_TRUE(all.object.refit(moved_by(rest, scale, {}).positions));
        const BoundedDistance found = owned.window.distance(near, workspace);
        EXPECT_TRUE(found.is_complete);
        expect_same(found.nearest, distance({fixed.model, probe.model, placement}, workspace));
    }
    // After a fill with the same leaves of another shape, the cache's gap is not used.
    OwnedWindow whole = window_of(600);
    PairCache of_whole;
    const Pair same{whole.window.model(), probe.model, placement, {}, &of_whole};
    for (const bool touches : {false, true}) {
        const Double3 by = {0, 0, touches ? 0.2 : 0.0};
        ASSERT_TRUE(all.object.refit(moved_by(rest, 1, by).positions));
        whole.window.fill({all.object.model(), probe.model, placement}, kEndless);
        EXPECT_EQ(whole.window.distance(same, workspace).upper == 0, touches);
        EXPECT_EQ(collide(same, workspace).hit == Answer::yes, touches);
    }
}

// One window serves models of floats and of doubles in turn, and points near the probe.
TEST(Window, PointsAndShapesSeeItsTriangles) {
    const OpenModel floats = open_tiny(in_floats(large_mesh()));
    const OpenModel doubles = open_tiny(large_mesh(), {.double_precision = true});
    const OpenModel probe = open_tiny(small_mesh());
    OwnedWindow owned = window_of(300);
    const Model& window = owned.window.model();
    Workspace workspace;
    std::mt19937 random(11);
    for (int round = 0; round < 300; ++round) {
        const Model& all = round % 2 == 0 ? floats.model : doubles.model;
        const double angle = 0.1 * round;
        const Double3 at = {std::cos(angle), std::sin(angle), 0.42};
        owned.window.fill({all, probe.model, shifted(at)}, 0.3);
        EXPECT_EQ(window.has_exact_leaves(), round % 2 == 0);
        EXPECT_EQ(window.triangle_number_bound(), all.triangle_number_bound());
        const auto near = closest_point(window, at, workspace);
        const auto expected = closest_point(all, at, workspace);
        ASSERT_TRUE(near && expected);
        EXPECT_EQ(near->triangle, expected->triangle);
        EXPECT_EQ(near->point, expected->point);
        const Sphere ball = {at, 0.25};
        std::vector<std::uint32_t> touched(touching_triangles(all, ball, workspace, {}));
        std::vector<std::uint32_t> here(touched.size());
        EXPECT_EQ(touching_triangles(all, ball, workspace, touched), touched.size());
        EXPECT_EQ(touching_triangles(window, ball, workspace, here), touched.size());
        EXPECT_EQ(here, touched);
        EXPECT_GT(here.size(), 3U);
        const Ray down = {at, {0, 0, -1}};
        const auto hit = cast_ray(window, down, workspace, {.max_t = 0.2});
        const auto hit_of_all = cast_ray(all, down, workspace, {.max_t = 0.2});
        ASSERT_TRUE(hit && hit_of_all);
        EXPECT_EQ(hit->triangle, hit_of_all->triangle);
        EXPECT_EQ(hit->t, hit_of_all->t);
    }
}

// Whoever keeps answers compares hashes. The models have the same triangles at other places, so
// leaves of the same numbers hold others.
TEST(Window, TheHashTellsOneContentFromAnother) {
    const TestMesh sheet = grid_sheet(40, 40);
    const LiveLimits limits = {.triangles = 3800};
    std::array<OwnedLive, 3> live = {live_of(sheet, limits), live_of(sheet, limits),
                                     live_of(sheet, limits)};
    std::vector<std::uint32_t> added(400);
    std::iota(added.begin(), added.end(), static_cast<std::uint32_t>(sheet.triangles.size()));
    for (const std::uint32_t i : {1U, 2U}) {
        const std::vector<Triangle> more(400, sheet.triangles[i == 1 ? 5 : 3000]);
        ASSERT_TRUE(live[i].object.append(more));
        ASSERT_TRUE(live[i].object.remove(added));
    }
    const OpenModel probe = open_tiny(small_mesh());
    OwnedWindow owned = window_of(20);
    const Model& model = owned.window.model();
    int different = 0;
    for (int place = 0; place < 400; ++place) {
        const Placement placement = shifted({2.0 * (place % 20), 2.0 * (place / 20), 0});
        std::array<std::uint64_t, 3> hashes{};
        std::array<std::vector<std::uint32_t>, 3> contents;
        for (std::size_t i = 0; i < 3; ++i) {
            owned.window.fill({live[i].object.model(), probe.model, placement}, 0);
            hashes[i] = model.header().content_hash;
            const auto numbers = model.source().triangle;
            contents[i].assign(numbers.begin(), numbers.end());
        }
        for (std::size_t i = 0; i < 3; ++i) {
            if (contents[i] == contents[(i + 1) % 3]) continue;
            ++different;
            EXPECT_NE(hashes[i], hashes[(i + 1) % 3]) << place;
        }
    }
    EXPECT_GT(different, 400);
}

TEST(Window, ItServesSurfacesAlone) {
    OwnedWindow owned = window_of(3);
    const Model& model = owned.window.model();
    constexpr Ask kAsks = Ask::collide | Ask::overlap | Ask::distance | Ask::within | Ask::ray |
                          Ask::closest | Ask::touch;
    EXPECT_EQ(model.asks(), kAsks);
    EXPECT_TRUE(model.is_torn());
    EXPECT_FALSE(model.is_balanced());
    for (const Ask ask : {Ask::inside, Ask::solid, Ask::corners, Ask::contacts, Ask::pieces}) {
        ASSERT_TRUE(model.refusal(ask));
        EXPECT_NE(model.refusal(ask)->message.find("window"), std::string::npos);
    }
    EXPECT_FALSE(model.refusal(kAsks));
}

TEST(Window, BadRoomIsRefusedWithNumbers) {
    EXPECT_NE(Window::bytes({0}).error().message.find("0 leaves"), std::string::npos);
    EXPECT_FALSE(Window::bytes({kMostWindowLeaves + 1}));
    AlignedBytes memory(Window::bytes({5}).value());
    EXPECT_TRUE(Window::in(memory.span(), {5}));
    const auto small = Window::in(memory.span().first(memory.size() - 1), {5});
    ASSERT_FALSE(small);
    EXPECT_NE(small.error().message.find(std::to_string(memory.size() - 1)), std::string::npos);
    EXPECT_FALSE(Window::in(memory.span().subspan(8), {3}));
    EXPECT_FALSE(Window::in(memory.span(), {6}));
}

TEST(WindowDeathTest, AnotherModelStopsTheProgram) {
    const OpenModel cube = open_tiny(unit_cube());
    OwnedWindow owned = window_of(3);
    Workspace workspace;
    EXPECT_DEATH((void)owned.window.distance({cube.model, cube.model, shifted({})}, workspace),
                 "must be the model of the window");
}

// A fill reads its models while it overwrites the window. The C function refuses such a call.
TEST(WindowDeathTest, AFillFromItsOwnModelStopsTheProgram) {
    const OpenModel cube = open_tiny(unit_cube());
    OwnedWindow owned = window_of(3), other = window_of(3);
    const Model& own = owned.window.model();
    EXPECT_GT(owned.window.fill({cube.model, cube.model, shifted({})}, 5).leaves, 0U);
    EXPECT_DEATH((void)owned.window.fill({own, cube.model, shifted({})}, 5),
                 "may be the model of the window itself");
    EXPECT_DEATH((void)owned.window.fill({cube.model, own, shifted({})}, 5),
                 "may be the model of the window itself");
    EXPECT_GT(other.window.fill({own, own, shifted({})}, 5).leaves, 0U);
}

/// Two windows. One thread fills one of them while another thread reads the other.
class TwoWindows {
public:
    explicit TwoWindows(std::uint32_t leaves) : windows_{window_of(leaves), window_of(leaves)} {}

    /// Returns the window to fill, or null while the reader has not taken the last one.
    Window* to_fill() {
        const int ready = ready_.load();
        return taken_.load() == ready ? &windows_[static_cast<std::size_t>(1 - ready)].window
                                      : nullptr;
    }
    void hand_over() {
        ready_.store(1 - ready_.load());
    }
    /// Returns the window to read until the next call.
    const Window& to_read() {
        const int ready = ready_.load();
        taken_.store(ready);
        return windows_[static_cast<std::size_t>(ready)].window;
    }

private:
    std::array<OwnedWindow, 2> windows_;
    std::atomic<int> ready_ = 0;
    std::atomic<int> taken_ = 0;
};

#if defined(__linux__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
/// Runs `loop` where every system call but exit kills the process. Returns the wait status; the
/// exit status is 77 where that cannot be had.
template <class Loop>
int status_without_system_calls(Loop&& loop) {
    const pid_t child = fork();
    if (child == 0) {
        if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_STRICT) != 0) _exit(77);
        syscall(SYS_exit, loop() ? 0 : 1);  // _exit() would make another call
    }
    int status = -1;
    waitpid(child, &status, 0);
    return status;
}

TEST(Window, TheFastLoopMakesNoSystemCall) {
    const OpenModel all = open_tiny(large_mesh()), probe = open_tiny(small_mesh());
    Glide glide(7);
    std::vector<Placement> way;
    for (int step = 0; step < 1000; ++step) way.push_back(glide.next(0));
    OwnedWindow owned = window_of(300);
    owned.window.fill({all.model, probe.model, way[0]}, 0.2);
    Workspace workspace;
    PairCache cache;
    const int status = status_without_system_calls([&] {
        bool is_sound = true;
        for (const Placement& placement : way) {
            const Pair pair = {all.model, probe.model, placement, {}, &cache};
            const BoundedDistance whole = bounded_distance(pair, workspace, {}, {.work = 3000});
            const BoundedDistance near = owned.window.distance(
                {owned.window.model(), probe.model, placement, {}, &cache}, workspace);
            const bool hits = collide(pair, workspace).hit == Answer::yes;
            is_sound = is_sound && near.lower <= whole.upper && !(hits && near.lower > 0);
        }
        return is_sound;
    });
    if (WIFEXITED(status) && WEXITSTATUS(status) == 77) GTEST_SKIP() << "no seccomp here";
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
    const int caught = status_without_system_calls([] { return getppid() > 0; });
    EXPECT_TRUE(WIFSIGNALED(caught)) << caught;
}
#endif

// The slow thread fills windows where the probe is now. Every complete answer of the fast thread is
// compared with that of the whole model afterwards.
TEST(WindowThreads, ASlowAndAFastLoopAgreeWithTheWholeModel) {
    const OpenModel all = open_tiny(large_mesh()), probe = open_tiny(small_mesh());
    const int kSteps = rounds(40'000, 4);
    Glide glide(99);
    std::vector<Placement> way;
    for (int step = 0; step < kSteps; ++step) way.push_back(glide.next(0));
    std::vector<BoundedDistance> answers(way.size());
    TwoWindows two(300);
    std::atomic<std::size_t> now = 0;
    std::atomic<bool> ends = false;
    std::atomic<std::size_t> fills = 0;
    std::thread slow([&] {
        while (!ends.load()) {
            Window* const window = two.to_fill();
            if (window == nullptr) {
                std::this_thread::yield();
                continue;
            }
            window->fill({all.model, probe.model, way[now.load()]}, 0.1);
            two.hand_over();
            ++fills;
        }
    });
    std::thread fast([&] {
        Workspace workspace;
        PairCache cache;
        // On a busy machine a thread may sleep for long: a tenth of the way needs a window at
        // least.
        const std::size_t tenth = way.size() / 10;
        for (std::size_t step = 0; step < way.size(); ++step) {
            now.store(step);
            while (fills.load() < step / tenth) {
                static_cast<void>(two.to_read());
                std::this_thread::yield();
            }
            const Window& window = two.to_read();
            answers[step] =
                window.distance({window.model(), probe.model, way[step], {}, &cache}, workspace);
            if (step % 64 == 0) std::this_thread::yield();
        }
        ends.store(true);
    });
    fast.join();
    slow.join();
    Workspace workspace;
    std::size_t complete = 0;
    for (std::size_t step = 0; step < way.size(); ++step) {
        const auto truth = distance({all.model, probe.model, way[step]}, workspace);
        ASSERT_LE(answers[step].lower, truth->upper);
        ASSERT_GE(answers[step].upper, truth->lower);
        if (!answers[step].is_complete) continue;
        ++complete;
        ASSERT_EQ(answers[step].upper, truth->upper);
        if (truth->upper > 0) expect_same(answers[step].nearest, truth);
    }
    EXPECT_GT(fills, 5U);
    EXPECT_GT(complete, way.size() / 20);
}

}  // namespace
}  // namespace cdprep::test
