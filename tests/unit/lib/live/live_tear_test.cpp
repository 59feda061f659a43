// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

#include "cdprep/live_model.h"
#include "cdprep/pairs.h"
#include "cdprep/points.h"
#include "support/brute_force.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"

namespace cdprep::test {
namespace {

using format::Triangle;

build::ModelArrays tearable_arrays(const TestMesh& mesh) {
    return build::build_model(mesh.positions, mesh.triangles, {.bounds = build::BvhBounds::aligned})
        .value();
}

/// A live model that can tear, and what it should hold.
struct Torn {
    AlignedBytes memory;
    LiveModel object;
    std::vector<Double3> positions;
    std::map<std::uint32_t, Triangle> triangles;

    [[nodiscard]] const Model& model() const {
        return object.model();
    }
    /// Returns the triangles by rising number, and these numbers.
    [[nodiscard]] std::pair<TestMesh, std::vector<std::uint32_t>> mesh() const {
        TestMesh mesh{positions, {}};
        std::vector<std::uint32_t> numbers;
        for (const auto& [number, triangle] : triangles) {
            mesh.triangles.push_back(triangle);
            numbers.push_back(number);
        }
        return {mesh, numbers};
    }

    void append(const std::vector<Triangle>& added) {
        const auto first = object.append(added);
        ASSERT_TRUE(first) << first.error().message;
        for (std::size_t i = 0; i < added.size(); ++i) {
            triangles[static_cast<std::uint32_t>(first.value() + i)] = added[i];
        }
    }
    void remove(const std::vector<std::uint32_t>& numbers) {
        const auto done = object.remove(numbers);
        ASSERT_TRUE(done) << done.error().message;
        for (const std::uint32_t number : numbers) triangles.erase(number);
    }
    void move(const std::vector<std::uint32_t>& vertices, const std::vector<Double3>& to) {
        const auto done = object.refit(vertices, to);
        ASSERT_TRUE(done) << done.error().message;
        for (std::size_t i = 0; i < vertices.size(); ++i) positions[vertices[i]] = to[i];
    }
};

Torn tear(const TestMesh& mesh, const LiveLimits& limits) {
    const build::ModelArrays arrays = tearable_arrays(mesh);
    AlignedBytes memory(LiveModel::bytes(arrays, limits).value());
    auto made = LiveModel::in(memory.span(), arrays, limits);
    Torn torn{std::move(memory), std::move(made).value(), mesh.positions, {}};
    torn.positions.resize(std::max<std::size_t>(limits.vertices, mesh.positions.size()));
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) torn.triangles[i] = mesh.triangles[i];
    return torn;
}

/// The numbers of a fresh model's answer, as the live model gives them.
template <class Item, class Number>
void rename(std::vector<Item>& items, const std::vector<std::uint32_t>& numbers, Number number) {
    for (Item& item : items) number(item) = numbers[number(item)];
}

/// Returns the number of pairs.
std::size_t expect_same_pairs(const Torn& torn, const Model& other, const TestMesh& of_other,
                              const Placement& placement, Workspace& workspace) {
    const auto [mesh, numbers] = torn.mesh();
    std::vector<TrianglePair> expected = brute_force_pairs(mesh, of_other, placement);
    rename(expected, numbers, [](TrianglePair& pair) -> std::uint32_t& { return pair.a; });
    std::ranges::sort(expected);
    std::vector<TrianglePair> pairs = all_pairs(torn.model(), other, placement, workspace);
    EXPECT_EQ(pairs, expected);
    std::vector<TrianglePair> turned =
        all_pairs(other, torn.model(), Placement::a_moves(placement.pose_b()), workspace);
    for (TrianglePair& pair : turned) pair = {pair.b, pair.a};
    std::ranges::sort(turned);
    EXPECT_EQ(turned, expected);
    std::vector<Crossing> crossed(expected.size() + 1);
    EXPECT_EQ(crossings({torn.model(), other, placement}, workspace, crossed), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(crossed[i].pair, expected[i]);
    std::vector<std::uint64_t> marks((torn.model().triangle_number_bound() + 63) / 64);
    const Pair pair{torn.model(), other, placement};
    EXPECT_EQ(mark_overlaps(pair, workspace, marks, {}), expected.size());
    for (std::uint32_t number = 0; number < torn.model().triangle_number_bound(); ++number) {
        const bool is_expected = std::ranges::any_of(
            expected, [&](const TrianglePair& each) { return each.a == number; });
        EXPECT_EQ(((marks[number / 64] >> (number % 64)) & 1) != 0, is_expected);
    }
    return expected.size();
}

/// Returns the number of pairs of the model itself.
std::size_t expect_same_own_pairs(const Torn& torn, Workspace& workspace) {
    const auto [mesh, numbers] = torn.mesh();
    std::vector<TrianglePair> expected = own_pairs(mesh);
    for (TrianglePair& pair : expected) pair = {numbers[pair.a], numbers[pair.b]};
    EXPECT_EQ(all_own_pairs(torn.model(), workspace), expected);
    return expected.size();
}

void expect_same_distances(const Torn& torn, const Model& other, const Placement& placement,
                           Workspace& workspace, PairCache& cache) {
    const auto [mesh, numbers] = torn.mesh();
    const OpenModel fresh = open_tiny(mesh, {.double_precision = true});
    const Pair pair{torn.model(), other, placement};
    const Pair anew{fresh.model, other, placement};
    const bool touches = collide(anew, workspace).hit == Answer::yes;
    EXPECT_EQ(collide(pair, workspace).hit == Answer::yes, touches);
    const Pair cached{torn.model(), other, placement, {}, &cache};
    EXPECT_EQ(collide(cached, workspace).hit == Answer::yes, touches);
    const auto exact = distance(anew, workspace);
    for (const Pair& each : {pair, cached}) {
        const auto near = distance(each, workspace);
        ASSERT_EQ(near.has_value(), exact.has_value());
        if (!near) continue;
        EXPECT_LE(near->lower, exact->upper);
        EXPECT_LE(exact->lower, near->upper);
        EXPECT_TRUE(torn.triangles.contains(near->triangle_a));
    }
    const double tolerance = exact ? exact->upper + 0.05 : 0.05;
    std::vector<TrianglePair> expected(pairs_within(anew, tolerance, workspace, {}));
    EXPECT_EQ(pairs_within(anew, tolerance, workspace, expected), expected.size());
    rename(expected, numbers, [](TrianglePair& each) -> std::uint32_t& { return each.a; });
    std::vector<TrianglePair> within_it(pairs_within(pair, tolerance, workspace, {}));
    EXPECT_EQ(pairs_within(pair, tolerance, workspace, within_it), within_it.size());
    EXPECT_EQ(within_it, expected);
    // A tolerance beyond all: nothing is left out and nothing else is listed.
    EXPECT_EQ(pairs_within(pair, 1e9, workspace, {}),
              torn.triangles.size() * other.triangle_count());
}

void expect_same_points(const Torn& torn, Workspace& workspace, std::mt19937& random) {
    const auto [mesh, numbers] = torn.mesh();
    const OpenModel fresh = open_tiny(mesh, {.double_precision = true});
    std::normal_distribution<double> normal(0, 1);
    const auto point = [&] { return Double3{normal(random), normal(random), normal(random)}; };
    for (int i = 0; i < 10; ++i) {
        const Ray ray{point(), point()};
        std::vector<RayHit> hits(100), expected(100);
        hits.resize(all_ray_hits(torn.model(), ray, workspace, hits));
        expected.resize(all_ray_hits(fresh.model, ray, workspace, expected));
        rename(expected, numbers, [](RayHit& hit) -> std::uint32_t& { return hit.triangle; });
        ASSERT_EQ(hits.size(), expected.size());
        for (std::size_t k = 0; k < hits.size(); ++k) {
            EXPECT_EQ(hits[k].t, expected[k].t);
            EXPECT_EQ(hits[k].triangle, expected[k].triangle);
        }
        const auto first = cast_ray(torn.model(), ray, workspace);
        ASSERT_EQ(first.has_value(), !expected.empty());
        if (first) {
            EXPECT_EQ(first->triangle, expected[0].triangle);
        }
        EXPECT_EQ(ray_hits(torn.model(), ray, workspace), !expected.empty());
        const Double3 at = point();
        const auto near = closest_point(torn.model(), at, workspace);
        const auto nearest = closest_point(fresh.model, at, workspace);
        ASSERT_EQ(near.has_value(), nearest.has_value());
        if (near) {
            EXPECT_EQ(near->upper, nearest->upper);
            EXPECT_EQ(near->triangle, numbers[nearest->triangle]);
        }
        const Sphere ball{at, std::fabs(normal(random))};
        const Capsule rod{at, point(), 0.1};
        const TriangleShape sail{{at, point(), point()}};
        EXPECT_EQ(touches(torn.model(), rod, workspace), touches(fresh.model, rod, workspace));
        EXPECT_EQ(touches(torn.model(), sail, workspace), touches(fresh.model, sail, workspace));
        const auto to_rod = shape_distance(torn.model(), rod, workspace);
        const auto expected_to_rod = shape_distance(fresh.model, rod, workspace);
        ASSERT_EQ(to_rod.has_value(), expected_to_rod.has_value());
        if (to_rod) {
            EXPECT_EQ(to_rod->upper == 0, expected_to_rod->upper == 0);
            EXPECT_LE(to_rod->lower, expected_to_rod->upper);
            EXPECT_LE(expected_to_rod->lower, to_rod->upper);
        }
        const Box whole{{-90, -90, -90}, {90, 90, 90}};
        std::vector<std::uint32_t> touched(torn.triangles.size()), all = touched, same = touched;
        touched.resize(touching_triangles(torn.model(), ball, workspace, touched));
        same.resize(touching_triangles(fresh.model, ball, workspace, same));
        for (std::uint32_t& number : same) number = numbers[number];
        EXPECT_EQ(touched, same);
        all.resize(touching_triangles(torn.model(), whole, workspace, all));
        EXPECT_EQ(all, numbers);
        EXPECT_EQ(points_inside(torn.model(), at, workspace).on_surface,
                  points_inside(fresh.model, at, workspace).on_surface);
    }
}

/// Removes, appends and moves at random.
void change(Torn& torn, std::mt19937& random, std::size_t most) {
    std::normal_distribution<double> normal(0, 0.05);
    const auto size = static_cast<std::uint32_t>(torn.positions.size());
    std::vector<std::uint32_t> removed;
    for (const auto& [number, triangle] : torn.triangles) {
        if (random() % 20 == 0) removed.push_back(number);
    }
    torn.remove(removed);
    // New vertices near old ones, so that new triangles crowd in few leaves.
    std::vector<std::uint32_t> vertices;
    std::vector<Double3> to;
    const Double3& about = torn.positions[random() % torn.object.position_count()];
    for (int i = 0; i < 40; ++i) {
        vertices.push_back(random() % size);
        to.push_back(
            {about.x + normal(random), about.y + normal(random), about.z + normal(random)});
    }
    torn.move(vertices, to);
    std::vector<Triangle> added;
    const std::size_t room = most - torn.triangles.size();
    for (std::size_t i = 0; i < std::min<std::size_t>(room, random() % 80); ++i) {
        const auto any = [&] { return vertices[random() % vertices.size()]; };
        added.push_back({{any(), any(), any()}});
    }
    torn.append(added);
}

TEST(LiveTear, AnswersAreThoseOfBruteForceAfterEachChange) {
    const TestMesh ring = torus(1, 0.3, 12, 8);
    const OpenModel other = open_tiny(ring, {.double_precision = true});
    std::mt19937 random(3);
    for (const std::uint32_t room : {320U, 350U, 900U}) {
        Torn torn = tear(icosphere(2), {.triangles = room, .vertices = 500});
        Workspace workspace;
        PairCache cache;
        std::size_t found = 0, own = 0;
        for (int step = 0; step < 40; ++step) {
            change(torn, random, room);
            if (step % 5 == 4) static_cast<void>(torn.object.rebuild(1'000'000));
            ASSERT_EQ(torn.object.triangle_count(), torn.triangles.size());
            const Placement placement = Placement::b_moves(random_pose(random, 0.5));
            found += expect_same_pairs(torn, other.model, ring, placement, workspace);
            own += expect_same_own_pairs(torn, workspace);
            if (step % 8 != 0) continue;
            expect_same_distances(torn, other.model, placement, workspace, cache);
            expect_same_points(torn, workspace, random);
        }
        EXPECT_GT(found, 1000U);
        EXPECT_GT(own, 1000U);
        // Against itself, moved: both sides have free places.
        const Placement aside = Placement::b_moves(random_pose(random, 0.1));
        const auto [mesh, numbers] = torn.mesh();
        std::vector<TrianglePair> expected = brute_force_pairs(mesh, mesh, aside);
        for (TrianglePair& pair : expected) pair = {numbers[pair.a], numbers[pair.b]};
        EXPECT_GT(expected.size(), 100U);
        EXPECT_EQ(all_pairs(torn.model(), torn.model(), aside, workspace), expected);
        std::vector<LiveTriangle> listed(torn.triangles.size());
        EXPECT_EQ(torn.object.triangles(listed), listed.size());
        EXPECT_TRUE(std::ranges::equal(listed, torn.triangles, {}, &LiveTriangle::number,
                                       [](const auto& each) { return each.first; }));
        EXPECT_TRUE(std::ranges::equal(listed, torn.triangles, {}, &LiveTriangle::vertex,
                                       [](const auto& each) { return each.second.vertex; }));
    }
}

// Before it tears, a model with room for more answers as its base, solids included.
TEST(LiveTear, AModelWithRoomAnswersAsItsBaseUntilItTears) {
    const TestMesh ball = icosphere(3);
    const TestMesh inner = moved_by(icosphere(1), 0.2, {0.1, 0, 0});
    const OpenModel small = open_tiny(inner, {.double_precision = true});
    Torn torn = tear(ball, {.triangles = 5000, .vertices = 700});
    Workspace workspace;
    const Pair solids{torn.model(), small.model, Placement::b_moves({}), {.body = Body::solid}};
    EXPECT_FALSE(torn.model().is_torn());
    EXPECT_EQ(collide(solids, workspace).hit, Answer::yes);
    EXPECT_EQ(points_inside(torn.model(), {0, 0, 0}, workspace).answer, Answer::yes);
    torn.remove({7});
    EXPECT_TRUE(torn.model().is_torn());
    EXPECT_FALSE(torn.model().is_balanced());
    EXPECT_EQ(collide(solids, workspace).hit, Answer::unknown);
    EXPECT_EQ(points_inside(torn.model(), {0, 0, 0}, workspace).answer, Answer::unknown);
    EXPECT_EQ(points_inside(torn.model(), {5, 0, 0}, workspace).answer, Answer::no);
    // As the contained body too: its pieces may lie anywhere in its box.
    Torn inside = tear(inner, {.triangles = 100});
    const OpenModel whole = open_tiny(ball, {.double_precision = true});
    const Pair held{inside.model(), whole.model, Placement::b_moves({}), {.body = Body::solid}};
    EXPECT_EQ(collide(held, workspace).hit, Answer::yes);
    inside.remove({0});
    EXPECT_EQ(collide(held, workspace).hit, Answer::unknown);
    const auto away = Pose::from_rows({1, 0, 0, 0, 1, 0, 0, 0, 1, 9, 0, 0});
    const Pair apart{inside.model(), whole.model, Placement::b_moves(*away), {.body = Body::solid}};
    EXPECT_EQ(collide(apart, workspace).hit, Answer::no);
}

// All triangles go, and others come, far away from where the first were.
TEST(LiveTear, AModelMayBecomeEmptyAndFillAgain) {
    const TestMesh ball = icosphere(2);
    const OpenModel other = open_tiny(ball, {.double_precision = true});
    Torn torn = tear(ball, {.triangles = 400});
    Workspace workspace;
    std::vector<std::uint32_t> all(ball.triangles.size());
    std::iota(all.begin(), all.end(), 0U);
    torn.remove(all);
    const Pair pair{torn.model(), other.model, Placement::b_moves({})};
    EXPECT_EQ(torn.model().triangle_count(), 0U);
    EXPECT_EQ(overlaps(pair, workspace, {}), 0U);
    EXPECT_EQ(self_overlaps(torn.model(), workspace, {}), 0U);
    EXPECT_FALSE(distance(pair, workspace));
    EXPECT_FALSE(closest_point(torn.model(), {0, 0, 0}, workspace));
    std::vector<Double3> far;
    for (const Double3& p : ball.positions) far.push_back({p.x + 1e6, p.y, p.z});
    std::vector<std::uint32_t> vertices(far.size());
    std::iota(vertices.begin(), vertices.end(), 0U);
    torn.move(vertices, far);
    torn.append(ball.triangles);
    const auto near = distance(pair, workspace);
    ASSERT_TRUE(near);
    EXPECT_NEAR(near->upper, 1e6 - 2, 0.1);
    EXPECT_GE(near->triangle_a, ball.triangles.size());
}

TEST(LiveTear, AMoveOfSomeVerticesEqualsAMoveOfAll) {
    const TestMesh ball = icosphere(3);
    Torn some = tear(ball, {.triangles = 1500, .vertices = 700});
    Torn all = tear(ball, {.triangles = 1500, .vertices = 700});
    for (Torn* each : {&some, &all}) {  // from here on, every number has a position
        for (std::uint32_t vertex = 0; vertex < 700; ++vertex) {
            each->move({vertex}, {each->positions[vertex]});
        }
    }
    std::mt19937 random(9);
    std::mt19937 again(9);
    for (int step = 0; step < 20; ++step) {
        change(some, random, 1500);
        change(all, again, 1500);
        std::vector<std::uint32_t> vertices;
        std::vector<Double3> to;
        for (int i = 0; i < 50; ++i) {
            vertices.push_back(random() % 700);
            again();
            to.push_back({0.01 * i, 0.02 * step, step == 10 ? 40.0 : 0.5});
        }
        some.move(vertices, to);
        for (std::size_t i = 0; i < vertices.size(); ++i) all.positions[vertices[i]] = to[i];
        ASSERT_TRUE(all.object.refit(all.positions));
        ASSERT_TRUE(std::ranges::equal(some.model().bytes(), all.model().bytes())) << step;
    }
}

TEST(LiveTear, WhatCannotBeDoneIsRefusedByNumberAndChangesNothing) {
    const TestMesh ball = icosphere(1);  // 42 vertices, 80 triangles
    Torn torn = tear(ball, {.triangles = 82, .vertices = 50});
    torn.remove({3, 3});
    EXPECT_EQ(torn.object.triangle_count(), 79U);
    const AlignedBytes before(torn.memory.span());
    LiveModel& object = torn.object;
    const auto sentence = [](const auto& result) { return result.error().message; };
    const std::vector<Triangle> four(4, Triangle{{0, 1, 2}});
    EXPECT_EQ(sentence(object.append(four)),
              "The live model has 79 triangles and room for 82; 4 more do not fit.");
    const std::vector<Triangle> blind = {{{0, 1, 2}}, {{0, 45, 2}}};
    EXPECT_EQ(sentence(object.append(blind)),
              "Triangle 1 uses vertex 45, which has no position: give it one with refit().");
    const std::vector<Triangle> beyond = {{{0, 1, 50}}};
    EXPECT_EQ(sentence(object.append(beyond)),
              "Triangle 0 uses vertex 50 of 50: vertices are numbered from 0.");
    const std::vector<std::uint32_t> gone = {5, 3}, never = {0xffffffff};
    EXPECT_EQ(sentence(object.remove(gone)), "Triangle 3 was removed before.");
    EXPECT_EQ(sentence(object.remove(never)), "Triangle 4294967295 was never appended.");
    const Model& own = object.model();
    EXPECT_EQ(sentence(object.append(own.mesh().triangles.first(1))).find("The triangles point in"),
              0U);
    EXPECT_EQ(sentence(object.remove(own.source().triangle.first(1))).find("The numbers point in"),
              0U);
    EXPECT_EQ(sentence(object.image()).find("A live model that can tear has places"), 0U);
    EXPECT_TRUE(std::ranges::equal(before.span(), torn.memory.span()));

    AlignedBytes memory(LiveModel::bytes(tearable_arrays(ball)).value());
    auto whole = LiveModel::in(memory.span(), tearable_arrays(ball));
    const std::vector<std::uint32_t> first = {0};
    for (const std::string& each :
         {sentence(whole.value().append(four)), sentence(whole.value().remove(first))}) {
        EXPECT_EQ(each,
                  "This live model cannot tear: make it with a limit of triangles (LiveLimits).");
    }
}

// A gap was proved, then a triangle closes it and nothing moves: the cache is not believed.
TEST(LiveTear, CachesAreNotFooledByATear) {
    const OpenModel other = open_tiny(icosphere(2), {.double_precision = true});
    Torn torn = tear(moved_by(icosphere(2), 1, {4, 0, 0}), {.triangles = 400, .vertices = 200});
    torn.move({162, 163, 164}, {{0, 0, -3}, {0, 0.1, 3}, {0, -0.1, 3}});
    Workspace workspace;
    PairCache cache;
    const Pair pair{torn.model(), other.model, Placement::b_moves({}), {}, &cache};
    for (int round = 0; round < 5; ++round) {
        for (int i = 0; i < 4; ++i) EXPECT_EQ(collide(pair, workspace).hit, Answer::no);
        EXPECT_NEAR(distance(pair, workspace)->upper, 2, 0.1);
        torn.append({{{162, 163, 164}}});
        EXPECT_EQ(collide(pair, workspace).hit, Answer::yes);
        EXPECT_EQ(distance(pair, workspace)->upper, 0);
        static_cast<void>(torn.object.rebuild(1'000'000));
        EXPECT_EQ(collide(pair, workspace).hit, Answer::yes);
        torn.remove({torn.triangles.rbegin()->first});
    }
}

// Whoever keeps answers compares hashes. Two models have the same triangles at other places: each
// was given others that have been removed since.
TEST(LiveTear, TheHashTellsWhatHasMovedTriangles) {
    const TestMesh sheet = grid_sheet(40, 40);
    const LiveLimits limits = {.triangles = 3800};
    Torn first = tear(sheet, limits), second = tear(sheet, limits);
    const auto hash_of = [](const Torn& torn) { return torn.model().header().content_hash; };
    EXPECT_EQ(hash_of(first), hash_of(second));
    const std::uint64_t whole = hash_of(first);
    std::vector<std::uint32_t> added(400);
    std::iota(added.begin(), added.end(), static_cast<std::uint32_t>(sheet.triangles.size()));
    first.append(std::vector(400, sheet.triangles[5]));
    second.append(std::vector(400, sheet.triangles[3000]));
    first.remove(added);
    second.remove(added);
    std::size_t different = 0;
    for (const auto& [number, triangle] : first.triangles) {
        different += first.object.place_of(number) != second.object.place_of(number) ? 1 : 0;
    }
    ASSERT_GT(different, 1000U);
    EXPECT_NE(hash_of(first), whole);
    EXPECT_NE(hash_of(second), whole);
    EXPECT_NE(hash_of(first), hash_of(second));
}

// By hand: a torn model is no longer known to be closed, even if it has all its triangles again.
TEST(LiveTear, TheHashTellsATornModelFromAWholeOne) {
    const TestMesh ball = icosphere(2);
    Torn torn = tear(ball, {.triangles = 400});
    const std::uint64_t whole = torn.model().header().content_hash;
    torn.append({ball.triangles[0]});
    torn.remove({static_cast<std::uint32_t>(ball.triangles.size())});
    EXPECT_TRUE(torn.model().is_torn());
    EXPECT_NE(torn.model().header().content_hash, whole);
}

// A base without triangles, and one that was opened without its components.
TEST(LiveTear, ABaseMayBeEmptyOrLackComponents) {
    const TestMesh ball = icosphere(2);
    const OpenModel whole = open_tiny(ball, {.double_precision = true});
    Torn torn = tear({}, {.triangles = 400, .vertices = 200});
    Workspace workspace;
    const Pair solids{torn.model(), whole.model, Placement::b_moves({}), {.body = Body::solid}};
    EXPECT_EQ(collide(solids, workspace).hit, Answer::no);
    std::vector<std::uint32_t> vertices(ball.positions.size());
    std::iota(vertices.begin(), vertices.end(), 0U);
    torn.move(vertices, ball.positions);
    torn.append(ball.triangles);
    EXPECT_EQ(collide(solids, workspace).hit, Answer::yes);

    const AlignedBytes bytes =
        bake_tiny(ball.positions, ball.triangles, {.double_precision = true});
    const auto base = Model::open(bytes.span(), {.asks = Ask::overlap});
    ASSERT_TRUE(base);
    const LiveLimits limits = {.triangles = 400};
    AlignedBytes memory(LiveModel::bytes(base.value(), limits).value());
    const auto live = LiveModel::in(memory.span(), base.value(), limits);
    ASSERT_TRUE(live) << live.error().message;
    EXPECT_TRUE(live.value().model().serves(Ask::overlap));
    EXPECT_EQ(live.value().model().serves(Ask::solid), base.value().serves(Ask::solid));
}

TEST(LiveTear, LimitsThatDoNotFitAreRefused) {
    const build::ModelArrays arrays = tearable_arrays(icosphere(1));
    const auto refused = [&](const LiveLimits& limits) {
        return LiveModel::bytes(arrays, limits).error().message;
    };
    EXPECT_EQ(refused({.triangles = 79}), "The limit of 79 triangles is too low: the base has 80.");
    EXPECT_EQ(refused({.triangles = 80, .vertices = 41}),
              "The limit of 41 vertices is too low: the base has 42.");
    EXPECT_EQ(refused({.vertices = 50}),
              "A limit of vertices has no meaning without a limit of triangles.");
    EXPECT_EQ(refused({.triangles = 2'000'000'000}).find("The limit of 2000000000 triangles is "),
              0U);
    EXPECT_EQ(refused({.triangles = 80, .vertices = 0xffffffff}).find("The limit of 4294967295 v"),
              0U);
}

// Triangles come and go for long: the numbers rise, and the places are used again.
TEST(LiveTear, ManyTearsKeepWithinTheRoom) {
    const TestMesh sheet = grid_sheet(24, 24);
    const auto count = static_cast<std::uint32_t>(sheet.triangles.size());
    const OpenModel wall = open_tiny(turned(grid_sheet(6, 6), 0.7), {.double_precision = true});
    Torn torn = tear(sheet, {.triangles = count});
    Workspace workspace;
    std::mt19937 random(4);
    for (int frame = 0; frame < 300; ++frame) {
        // A hole, closed again by equal triangles with new numbers.
        std::vector<std::uint32_t> numbers;
        std::vector<Triangle> again;
        const auto first =
            std::next(torn.triangles.begin(), static_cast<std::ptrdiff_t>(random() % (count - 60)));
        for (auto it = first; numbers.size() < 60; ++it) {
            numbers.push_back(it->first);
            again.push_back(it->second);
        }
        torn.remove(numbers);
        torn.append(again);
        ASSERT_EQ(torn.object.triangle_count(), count);
    }
    EXPECT_EQ(torn.triangles.rbegin()->first, count + 300 * 60 - 1);
    expect_same_pairs(torn, wall.model, turned(grid_sheet(6, 6), 0.7), Placement::b_moves({}),
                      workspace);
    // The tree is still one of neighbours.
    Torn fresh = tear(sheet, {.triangles = count});
    EXPECT_LT(torn.object.surface_cost(), 1.5 * fresh.object.surface_cost());
}

}  // namespace
}  // namespace cdprep::test
