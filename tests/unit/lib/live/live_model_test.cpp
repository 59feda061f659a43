// SPDX-License-Identifier: MIT
#include "cdprep/live_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <random>

#include "cdprep/advanced/refit_bvh.h"
#include "cdprep/format/find_damage.h"
#include "cdprep/format/sections.h"
#include "cdprep/pairs.h"
#include "cdprep/points.h"
#include "support/brute_force.h"
#include "support/changed_sections.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"
#include "support/same_distance.h"

namespace cdprep::test {
namespace {

using build::build_model;
using build::ModelArrays;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A live model and its memory.
struct Running {
    AlignedBytes memory;
    LiveModel object;

    [[nodiscard]] const Model& model() const {
        return object.model();
    }
};

template <class Base>
Running run(const Base& base) {
    AlignedBytes memory(LiveModel::bytes(base).value());
    auto made = LiveModel::in(memory.span(), base);
    return {std::move(memory), std::move(made).value()};
}

ModelArrays arrays_of(const TestMesh& mesh) {
    return build_model(mesh.positions, mesh.triangles, {.bounds = build::BvhBounds::aligned})
        .value();
}

TestMesh sheared(TestMesh mesh, double by) {
    for (Double3& p : mesh.positions) p.x += by * p.z;
    return mesh;
}

TestMesh flattened(TestMesh mesh) {
    for (Double3& p : mesh.positions) p = {p.x, 0, 0};
    return mesh;
}

/// A mesh, and shapes that it takes one after the other.
struct Motion {
    TestMesh start;
    std::vector<TestMesh> shapes;
};

std::vector<Motion> motions() {
    const TestMesh ball = icosphere(3);
    const TestMesh soup = random_soup(1, 300, 0.3);
    const TestMesh two = joined(icosphere(1), moved_by(icosphere(2), 2, {9, 0, 0}));
    return {{ball, {sheared(ball, 0.5), in_floats(ball), moved_by(ball, 1000, {1e6, 0, -1e6})}},
            {soup, {sheared(soup, 1), flattened(soup), soup}},
            {flattened(soup), {soup}},
            {two, {moved_by(two, 0x1p-1000, {}), moved_by(two, 0x1p900, {}), sheared(two, 2)}},
            {coarse_grid_soup(2, 65, 3), {coarse_grid_soup(5, 65, 3)}},
            {fan(1), {moved_by(fan(1), 3, {1, 1, 1})}}};
}

/// The model of a shape, in the order of an earlier one, made without LiveModel's refit.
Running made_anew(const ModelArrays& start, const TestMesh& shape) {
    build::Bvh bvh = start.bvh;
    build::refit_bvh(bvh, shape.positions, shape.triangles, {.bounds = build::BvhBounds::aligned});
    return run(build::arrange_model(shape.positions, shape.triangles, std::move(bvh),
                                    build::Precision::double_precision));
}

// refit_bvh() and arrange_model() come to the same bytes on another way: with them to the same
// answers. The deep check of the format proves boxes and marks by itself.
TEST(LiveModel, ARefittedImageIsThatOfAModelMadeAnew) {
    for (const Motion& motion : motions()) {
        const ModelArrays arrays = arrays_of(motion.start);
        Running moving = run(arrays);
        for (const TestMesh& shape : motion.shapes) {
            ASSERT_TRUE(moving.object.refit(shape.positions));
            Running expected = made_anew(arrays, shape);
            const auto image = moving.object.image().value();
            EXPECT_TRUE(std::ranges::equal(image, expected.object.image().value()));
            EXPECT_FALSE(format::find_deep_damage(image));
            EXPECT_TRUE(Model::open(image));
        }
    }
}

void expect_same_answers(const Model& moving, const Model& fresh, const Model& other,
                         const Placement& placement) {
    Workspace workspace;
    auto pairs = all_pairs(moving, other, placement, workspace);
    auto expected = all_pairs(fresh, other, placement, workspace);
    std::ranges::sort(pairs);
    std::ranges::sort(expected);
    EXPECT_EQ(pairs, expected);
    for (const Body as : {Body::surface, Body::solid}) {
        const Collision one = collide({moving, other, placement, {.body = as}}, workspace);
        const Collision two = collide({fresh, other, placement, {.body = as}}, workspace);
        EXPECT_EQ(one.hit, two.hit);
        EXPECT_EQ(one.containment.answer, two.containment.answer);
        EXPECT_EQ(one.containment.winding, two.containment.winding);
    }
    const auto near = distance({moving, other, placement}, workspace);
    const auto exact = distance({fresh, other, placement}, workspace);
    ASSERT_EQ(near.has_value(), exact.has_value());
    if (near) {  // both intervals hold the exact distance
        EXPECT_LE(near->lower, exact->upper);
        EXPECT_LE(exact->lower, near->upper);
    }
}

void expect_same_points(const Model& moving, const Model& fresh, std::uint32_t seed) {
    Workspace workspace;
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0, 1);
    const auto point = [&] { return Double3{normal(random), normal(random), normal(random)}; };
    for (int i = 0; i < 30; ++i) {
        const Ray ray{point(), point()};
        const auto hit = cast_ray(moving, ray, workspace);
        const auto expected = cast_ray(fresh, ray, workspace);
        ASSERT_EQ(hit.has_value(), expected.has_value());
        if (hit) {
            EXPECT_EQ(hit->t, expected->t);
        }
        EXPECT_EQ(ray_hits(moving, ray, workspace), expected.has_value());
        const Double3 at = point();
        const auto near = closest_point(moving, at, workspace);
        const auto nearest = closest_point(fresh, at, workspace);
        ASSERT_TRUE(near && nearest);
        EXPECT_LE(near->lower, nearest->upper);
        EXPECT_LE(nearest->lower, near->upper);
        const Inclusion inside = points_inside(moving, at, workspace);
        const Inclusion expected_inside = points_inside(fresh, at, workspace);
        EXPECT_EQ(inside.answer, expected_inside.answer);
        EXPECT_EQ(inside.on_surface, expected_inside.on_surface);
    }
}

// The truth is a model that is baked of the moved mesh, with an order and boxes of its own.
TEST(LiveModel, AnswersAreThoseOfABakeOfTheMovedMesh) {
    const OpenModel other = open_tiny(torus(1, 0.3, 24, 12), {.double_precision = true});
    const TestMesh ball = icosphere(3);
    const TestMesh soup = random_soup(7, 400, 0.4);
    const TestMesh in_hole = moved_by(icosphere(2), 0.1, {1, 0, 0});  // inside the other's tube
    for (const TestMesh& mesh : {ball, soup, in_hole}) {
        Running moving = run(arrays_of(mesh));
        for (const double by : {0.0, 0.3, -1.5}) {
            const TestMesh shape = sheared(mesh, by);
            ASSERT_TRUE(moving.object.refit(shape.positions));
            const OpenModel fresh = open_tiny(shape, {.double_precision = true});
            std::mt19937 random(3);
            for (int i = 0; i < 8; ++i) {
                const Placement placement =
                    Placement::b_moves(i == 0 ? Pose() : random_pose(random, 1));
                expect_same_answers(moving.model(), fresh.model, other.model, placement);
            }
            expect_same_points(moving.model(), fresh.model, 5);
        }
    }
}

TEST(LiveModel, FloatsAreKeptAsFloats) {
    const TestMesh ball = in_floats(icosphere(3));
    Running moving = run(build_model(floats_of(ball), ball.triangles).value());
    const TestMesh shape = in_floats(sheared(ball, 0.7));
    ASSERT_TRUE(moving.object.refit(floats_of(shape)));
    EXPECT_TRUE(moving.model().has_exact_leaves());
    const OpenModel fresh = open_tiny(shape);
    const OpenModel other = open_tiny(in_floats(torus(1, 0.3, 24, 12)));
    expect_same_answers(moving.model(), fresh.model, other.model, Placement::b_moves({}));
    EXPECT_EQ(moving.object.refit(shape.positions).error().code, ErrorCode::bad_argument);
}

// A float is a double: the model of doubles comes to the same bytes.
TEST(LiveModel, AModelOfDoublesTakesFloats) {
    const TestMesh ball = in_floats(icosphere(2));
    const ModelArrays arrays = arrays_of(icosphere(2));
    Running floats = run(arrays);
    Running doubles = run(arrays);
    ASSERT_TRUE(floats.object.refit(floats_of(ball)));
    ASSERT_TRUE(doubles.object.refit(ball.positions));
    EXPECT_TRUE(std::ranges::equal(floats.object.image().value(), doubles.object.image().value()));
}

TEST(LiveModel, ABakedModelIsABaseToo) {
    const TestMesh ball = icosphere(3);
    const OpenModel baked =
        open_tiny(ball, {.double_precision = true, .bounds = build::BvhBounds::oriented_and_swept});
    Running moving = run(baked.model);
    EXPECT_TRUE(moving.model().bvh().oriented.empty());
    EXPECT_TRUE(moving.model().bvh().swept.empty());
    EXPECT_EQ(moving.object.position_count(), ball.positions.size());
    const TestMesh shape = sheared(ball, -0.4);
    ASSERT_TRUE(moving.object.refit(shape.positions));
    const OpenModel other = open_tiny(torus(1, 0.3, 24, 12), {.double_precision = true});
    const OpenModel fresh = open_tiny(shape, {.double_precision = true});
    expect_same_answers(moving.model(), fresh.model, other.model, Placement::b_moves({}));
}

TEST(LiveModel, ABaseThatLacksASectionIsRefusedByItsName) {
    const TestMesh ball = icosphere(1);
    for (const SectionId id :
         {SectionId::triangles, SectionId::source_triangle, SectionId::source_vertex,
          SectionId::bvh_nodes, SectionId::bvh_leaves}) {
        const AlignedBytes bytes = bake_tiny(ball.positions, ball.triangles);
        SectionSet wanted = SectionSet::all();
        wanted.erase(id);
        const auto base = Model::open(bytes.span(), wanted);
        ASSERT_TRUE(base);
        const auto size = LiveModel::bytes(base.value());
        ASSERT_FALSE(size) << format::section_name(id);
        EXPECT_NE(size.error().message.find(format::section_name(id)), std::string::npos);
        AlignedBytes memory(1 << 20);
        EXPECT_FALSE(LiveModel::in(memory.span(), base.value()));
    }
    const AlignedBytes bytes = bake_tiny(ball.positions, ball.triangles);
    const auto blind = Model::open(
        bytes.span(), {SectionId::triangles, SectionId::source_triangle, SectionId::source_vertex,
                       SectionId::bvh_nodes, SectionId::bvh_leaves});
    EXPECT_NE(LiveModel::bytes(blind.value()).error().message.find("positions"), std::string::npos);
}

// No position of the imported file stands for such a vertex.
TEST(LiveModel, VerticesThatARepairMadeAreRefused) {
    const TestMesh ball = icosphere(1);
    const AlignedBytes bytes =
        with(bake_tiny(ball.positions, ball.triangles), SectionId::source_vertex,
             4 * sizeof(std::uint32_t), format::kMadeByRepair);
    const auto base = Model::open(bytes.span());
    ASSERT_TRUE(base);
    EXPECT_NE(LiveModel::bytes(base.value()).error().message.find("vertex 4 was made by"),
              std::string::npos);
}

TEST(LiveModel, BadPositionsAreRefusedByNumberAndChangeNothing) {
    const TestMesh ball = icosphere(2);
    Running moving = run(arrays_of(ball));
    ASSERT_TRUE(moving.object.refit(sheared(ball, 0.3).positions));
    const AlignedBytes before(moving.memory.span());
    for (const double bad : {kNan, std::numeric_limits<double>::infinity(), -0x1.1p1000}) {
        TestMesh shape = sheared(ball, 0.5);
        shape.positions[17].z = bad;
        shape.positions[40].x = kNan;
        const auto refused = moving.object.refit(shape.positions);
        ASSERT_FALSE(refused);
        EXPECT_EQ(refused.error().code, ErrorCode::bad_argument);
        EXPECT_EQ(refused.error().message.find("Vertex 17 cannot be used: its z"), 0U);
    }
    std::vector<Float3> floats = floats_of(ball);
    floats[3].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(moving.object.refit(floats).error().message.find("Vertex 3 "), 0U);
    const std::span<const Double3> few = std::span(ball.positions).first(ball.positions.size() - 1);
    EXPECT_EQ(moving.object.refit(few).error().message,
              "The live model has 162 positions, and 161 were given.");
    const std::span<const Double3> own = moving.object.model().mesh().positions_f64;
    EXPECT_EQ(
        moving.object.refit(own).error().message.find("The positions point into the live model"),
        0U);
    EXPECT_TRUE(std::ranges::equal(before.span(), moving.memory.span()));
}

TEST(LiveModel, MemoryThatDoesNotFitIsRefused) {
    const ModelArrays arrays = arrays_of(icosphere(1));
    const std::size_t size = LiveModel::bytes(arrays).value();
    AlignedBytes memory(size + 64);
    EXPECT_FALSE(LiveModel::in(memory.span().first(size - 1), arrays));
    EXPECT_FALSE(LiveModel::in(memory.span().subspan(8), arrays));
    EXPECT_TRUE(LiveModel::in(memory.span(), arrays));
}

/// The frame of a model with these stays when all else moves within.
TestMesh with_anchors(const TestMesh& mesh) {
    return joined(joined(mesh, moved_by(fan(1), 0.1, {-50, -50, -50})),
                  moved_by(fan(1), 0.1, {50, 50, 50}));
}

// With one cache through all shapes, and shared with another model of the same mesh that has
// other shapes: each answer is that without a cache. Shapes come near and go, so that gaps
// are proved and given up; only positions tell them apart.
TEST(LiveModel, CachesAreNotFooledByARefit) {
    const OpenModel other = open_tiny(icosphere(3), {.double_precision = true});
    const TestMesh ball = icosphere(3);
    const auto shape_at = [&](double x) {
        return with_anchors(moved_by(ball, 1, {x, 0, 0})).positions;
    };
    const ModelArrays arrays = arrays_of(with_anchors(ball));
    Running first = run(arrays);
    Running second = run(arrays);
    Workspace workspace;
    PairCache cache;
    const Placement placement = Placement::b_moves({});
    std::size_t hits = 0;
    for (int i = 0; i < 60; ++i) {
        const double gap = 0.05 * (i % 7) - 0.1;
        ASSERT_TRUE(first.object.refit(shape_at(2 + gap)));
        ASSERT_TRUE(second.object.refit(shape_at(2 - gap)));
        EXPECT_EQ(first.model().header().frame_exponent, second.model().header().frame_exponent);
        EXPECT_EQ(first.model().header().frame_origin, second.model().header().frame_origin);
        EXPECT_EQ(first.model().header().content_hash == second.model().header().content_hash,
                  std::fabs(gap) < 1e-12);
        for (const Model* model : {&first.model(), &second.model(), &first.model()}) {
            const bool plain =
                collide({*model, other.model, placement}, workspace).hit == Answer::yes;
            EXPECT_EQ(
                collide({*model, other.model, placement, {}, &cache}, workspace).hit == Answer::yes,
                plain);
            const auto exact = distance({*model, other.model, placement}, workspace);
            expect_same(distance({*model, other.model, placement, {}, &cache}, workspace), exact);
            hits += plain ? 1 : 0;
        }
    }
    EXPECT_GT(hits, 40U);
    EXPECT_LT(hits, 160U);
}

// A flat triangle has the bit that skips it only while it is flat.
TEST(LiveModel, TrianglesAreMarkedDegenerateAsTheyBecomeIt) {
    const TestMesh sheet = grid_sheet(3, 3);
    const OpenModel wall = open_tiny(turned(grid_sheet(3, 3), 0.7), {.double_precision = true});
    Running moving = run(arrays_of(sheet));
    Workspace workspace;
    const PairOptions skip{.degenerate = Degenerate::skip};
    const Placement placement = Placement::b_moves({});
    const auto count = [&] {
        return all_pairs(moving.model(), wall.model, placement, workspace, skip).size();
    };
    const std::size_t whole = count();
    EXPECT_GT(whole, 0U);
    ASSERT_TRUE(moving.object.refit(flattened(sheet).positions));
    EXPECT_EQ(count(), 0U);
    ASSERT_TRUE(moving.object.refit(sheet.positions));
    EXPECT_EQ(count(), whole);
}

TEST(LiveModel, AModelOfNothingIsRefitted) {
    Running moving = run(arrays_of({}));
    ASSERT_TRUE(moving.object.refit(std::span<const Double3>()));
    ASSERT_TRUE(moving.object.refit(std::span<const std::uint32_t>(), std::span<const Double3>()));
    EXPECT_EQ(moving.object.surface_cost(), 0);
    EXPECT_EQ(moving.model().triangle_count(), 0U);
}

TEST(LiveModel, TheCostRisesWhenNeighboursPart) {
    const TestMesh ball = icosphere(4);
    Running moving = run(arrays_of(ball));
    const double before = moving.object.surface_cost();
    TestMesh torn = ball;
    for (std::size_t i = 0; i < torn.positions.size(); i += 2) torn.positions[i].x += 5;
    ASSERT_TRUE(moving.object.refit(torn.positions));
    EXPECT_GT(moving.object.surface_cost(), 2 * before);
}

/// Moves some vertices of a shape at random; returns their numbers.
std::vector<std::uint32_t> move_some(TestMesh& shape, std::mt19937& random, std::size_t count,
                                     double by) {
    std::uniform_int_distribution<std::uint32_t> any(
        0, static_cast<std::uint32_t>(shape.positions.size() - 1));
    std::normal_distribution<double> normal(0, by);
    std::vector<std::uint32_t> vertices;
    for (std::size_t i = 0; i < count; ++i) {
        vertices.push_back(any(random));
        Double3& p = shape.positions[vertices.back()];
        p = {p.x + normal(random), p.y + normal(random), p.z + normal(random)};
    }
    return vertices;
}

std::vector<Double3> positions_at(const TestMesh& shape, std::span<const std::uint32_t> vertices) {
    std::vector<Double3> positions;
    for (const std::uint32_t vertex : vertices) positions.push_back(shape.positions[vertex]);
    return positions;
}

// One model takes all positions, another only those that changed: the bytes are equal after each
// step. Large moves make vertices leave the frame, and a shrunk model gets a smaller one.
TEST(LiveModel, AMoveOfSomeVerticesEqualsAMoveOfAll) {
    for (const double by : {1e-3, 0.1, 3.0}) {
        for (const bool in_parallel : {false, true}) {
            const TestMesh ball = joined(icosphere(4), random_soup(3, 100, 0.3));
            const ModelArrays arrays = arrays_of(ball);
            Running whole = run(arrays);
            Running some = run(arrays);
            TestMesh shape = ball;
            std::mt19937 random(11);
            const auto reversed = [](std::size_t count, Task task) {
                for (std::size_t i = count; i-- > 0;) task(i);
            };
            for (int step = 0; step < 40; ++step) {
                if (step == 20) shape = moved_by(ball, 0x1p-9, {1, 2, 3});
                std::vector<std::uint32_t> vertices = move_some(shape, random, 1 << (step % 8), by);
                if (step == 20) {
                    vertices.resize(shape.positions.size());
                    std::iota(vertices.begin(), vertices.end(), 0U);
                }
                const std::vector<Double3> positions = positions_at(shape, vertices);
                ASSERT_TRUE(whole.object.refit(shape.positions));
                ASSERT_TRUE(in_parallel ? some.object.refit(vertices, positions, reversed)
                                        : some.object.refit(vertices, positions));
                const auto image = [](const Running& of) { return of.model().bytes(); };
                ASSERT_TRUE(std::ranges::equal(image(whole), image(some))) << by << ' ' << step;
            }
            EXPECT_TRUE(
                std::ranges::equal(whole.object.image().value(), some.object.image().value()));
            EXPECT_FALSE(format::find_deep_damage(some.object.image().value()));
        }
    }
}

// The same of models that keep floats, and of a vertex that is listed twice: far away, then near.
TEST(LiveModel, AMoveOfSomeFloatsEqualsAMoveOfAll) {
    const TestMesh ball = in_floats(icosphere(4));
    const ModelArrays arrays = build_model(floats_of(ball), ball.triangles).value();
    Running whole = run(arrays);
    Running some = run(arrays);
    TestMesh shape = ball;
    std::mt19937 random(12);
    for (int step = 0; step < 10; ++step) {
        std::vector<std::uint32_t> vertices = move_some(shape, random, 30, 0.2);
        shape = in_floats(shape);
        std::vector<Float3> positions;
        const std::vector<Float3> all = floats_of(shape);
        for (const std::uint32_t vertex : vertices) positions.push_back(all[vertex]);
        vertices.insert(vertices.begin(), vertices.back());
        positions.insert(positions.begin(), {1e9F, 0, 0});
        ASSERT_TRUE(whole.object.refit(all));
        ASSERT_TRUE(some.object.refit(vertices, positions));
        ASSERT_TRUE(std::ranges::equal(whole.model().bytes(), some.model().bytes())) << step;
    }
}

// Coordinates that are floats, then one that is not, then floats again: the leaves change their
// kind and back.
TEST(LiveModel, LeavesStayExactAsLongAsAllCoordinatesAreFloats) {
    const TestMesh ball = in_floats(icosphere(3));
    Running moving = run(arrays_of(ball));
    const auto move_to = [&](double x) {
        const std::array<std::uint32_t, 1> vertex = {5};
        const std::array<Double3, 1> position = {Double3{x, 0.25, 0.5}};
        ASSERT_TRUE(moving.object.refit(vertex, position));
    };
    EXPECT_TRUE(moving.model().has_exact_leaves());
    move_to(0.1);
    EXPECT_FALSE(moving.model().has_exact_leaves());
    move_to(0.125);
    EXPECT_TRUE(moving.model().has_exact_leaves());
    TestMesh shape = ball;
    shape.positions[5] = {0.125, 0.25, 0.5};
    Running whole = run(arrays_of(ball));
    ASSERT_TRUE(whole.object.refit(shape.positions));
    EXPECT_TRUE(std::ranges::equal(whole.model().bytes(), moving.model().bytes()));
}

// The answers of a model whose vertices move a few at a time are those of brute force.
TEST(LiveModel, AnswersAfterManySmallMovesAreThoseOfBruteForce) {
    const TestMesh fixed = torus(1, 0.3, 18, 12);
    const OpenModel other = open_tiny(fixed, {.double_precision = true});
    TestMesh shape = icosphere(3);
    Running moving = run(arrays_of(shape));
    Workspace workspace;
    PairCache cache;
    std::mt19937 random(5);
    const Placement placement = Placement::b_moves({});
    std::size_t found = 0;
    for (int step = 0; step < 200; ++step) {
        const std::vector<std::uint32_t> vertices = move_some(shape, random, 20, 0.05);
        ASSERT_TRUE(moving.object.refit(vertices, positions_at(shape, vertices)));
        const bool touch =
            collide({moving.model(), other.model, placement, {}, &cache}, workspace).hit ==
            Answer::yes;
        if (step % 10 != 0) continue;
        auto pairs = all_pairs(moving.model(), other.model, placement, workspace);
        auto expected = brute_force_pairs(shape, fixed, placement);
        std::ranges::sort(pairs);
        std::ranges::sort(expected);
        EXPECT_EQ(pairs, expected);
        EXPECT_EQ(touch, !expected.empty());
        found += expected.size();
    }
    EXPECT_GT(found, 1000U);
}

TEST(LiveModel, ARefusalAsksForNoBake) {
    const TestMesh ball = icosphere(2);
    const Running moving = run(build_model(floats_of(ball), ball.triangles).value());
    for (const Ask ask : {Ask::contacts, Ask::pieces, Ask::response}) {
        const auto refusal = moving.object.model().refusal(ask);
        ASSERT_TRUE(refusal);
        EXPECT_NE(refusal->message.find("a live model serves no query that needs pieces"),
                  std::string::npos);
        EXPECT_EQ(refusal->message.find("Bake"), std::string::npos) << refusal->message;
    }
    EXPECT_FALSE(moving.object.model().refusal(
        Ask::collide | Ask::overlap | Ask::distance | Ask::within | Ask::continuous | Ask::self |
        Ask::haptic | Ask::inside | Ask::ray | Ask::closest | Ask::touch));
}

// A rebuild changes no answer and makes the tree better, a part at a time; then it rests.
TEST(LiveModel, ARebuildMakesBoxesSmallerAndChangesNoAnswer) {
    const TestMesh cloud = random_soup(5, 9000, 0.02);
    const OpenModel other = open_tiny(icosphere(3), {.double_precision = true});
    Running moving = run(arrays_of(cloud));
    EXPECT_EQ(moving.object.rebuild(1'000'000), 0U);
    TestMesh shape = cloud;  // former neighbours are far apart
    std::mt19937 random(8);
    std::normal_distribution<double> normal(0, 0.2);
    for (const format::Triangle& t : cloud.triangles) {
        const Double3 by = {normal(random), normal(random), normal(random)};
        for (const std::uint32_t v : t.vertex) {
            const Double3& p = cloud.positions[v];
            shape.positions[v] = {p.x + by.x, p.y + by.y, p.z + by.z};
        }
    }
    ASSERT_TRUE(moving.object.refit(shape.positions));
    const double cost = moving.object.surface_cost();
    Workspace workspace;
    const auto pairs_of = [&] {
        auto pairs = all_pairs(moving.model(), other.model, Placement::b_moves({}), workspace);
        std::ranges::sort(pairs);
        return pairs;
    };
    const auto before = pairs_of();
    EXPECT_GT(before.size(), 100U);
    EXPECT_EQ(moving.object.rebuild(800), 0U);  // less than any subtree
    std::uint32_t calls = 0;
    for (; moving.object.rebuild(4096) > 0; ++calls) EXPECT_EQ(pairs_of(), before);
    EXPECT_GE(calls, 2U);
    EXPECT_LT(calls, 5U);
    EXPECT_LT(moving.object.surface_cost(), 0.8 * cost);
    EXPECT_EQ(moving.object.rebuild(1'000'000), 0U);
    // Moves of some and of all vertices find their leaves in the new order.
    const std::vector<std::uint32_t> vertices = {1, 400, 7000};
    ASSERT_TRUE(moving.object.refit(vertices, positions_at(cloud, vertices)));
    TestMesh changed = shape;
    for (const std::uint32_t v : vertices) changed.positions[v] = cloud.positions[v];
    const AlignedBytes some(moving.memory.span());
    ASSERT_TRUE(moving.object.refit(changed.positions));
    EXPECT_TRUE(std::ranges::equal(some.span(), moving.memory.span()));
    EXPECT_FALSE(format::find_deep_damage(moving.object.image().value()));
}

/// The triangles of a soup, each moved by its vector, which is scaled by `by(number)`.
template <class By>
TestMesh scattered(const TestMesh& soup, By&& by) {
    TestMesh moved = soup;
    std::mt19937 random(9);
    std::normal_distribution<double> normal;
    for (std::size_t i = 0; i < soup.triangles.size(); ++i) {
        const Double3 d = {normal(random), normal(random), normal(random)};
        const double factor = by(i);
        for (const std::uint32_t v : soup.triangles[i].vertex) {
            const Double3& p = soup.positions[v];
            moved.positions[v] = {p.x + factor * d.x, p.y + factor * d.y, p.z + factor * d.z};
        }
    }
    return moved;
}

// All boxes grow by less than begins a rebuild. Then some grow by more: the others are rebuilt too,
// since they have grown by more than ends it.
TEST(LiveModel, ARebuildGoesOnBelowTheGrowthThatBeginsIt) {
    const TestMesh soup = random_soup(6, 60'000, 0.05);
    Running moving = run(arrays_of(soup));
    const double cost = moving.object.surface_cost();
    double little = 0;
    while (moving.object.surface_cost() < 1.33 * cost) {
        little += 0.001;
        ASSERT_TRUE(
            moving.object.refit(scattered(soup, [&](std::size_t) { return little; }).positions));
    }
    EXPECT_EQ(moving.object.rebuild(1'000'000), 0U);
    std::uint32_t moved_more = 0;
    const TestMesh uneven = scattered(soup, [&](std::size_t i) {
        const Double3& p = soup.positions[soup.triangles[i].vertex[0]];
        const bool is_corner = p.x < -0.4 && p.y < -0.4 && p.z < -0.4;
        moved_more += is_corner ? 1 : 0;
        return is_corner ? 10 * little : little;
    });
    ASSERT_TRUE(moving.object.refit(uneven.positions));
    const std::uint32_t rebuilt = moving.object.rebuild(1'000'000);
    EXPECT_GT(moved_more, 500U);
    EXPECT_LT(moved_more, 6'000U);
    EXPECT_GT(rebuilt, 50'000U);
    EXPECT_EQ(moving.object.rebuild(1'000'000), 0U);
}

TEST(LiveModel, BadMovesAreRefusedByNumberAndChangeNothing) {
    const TestMesh ball = icosphere(2);
    Running moving = run(arrays_of(ball));
    const AlignedBytes before(moving.memory.span());
    const std::vector<std::uint32_t> vertices = {3, 90, 41};
    std::vector<Double3> positions = positions_at(ball, vertices);
    positions[1].y = kNan;
    EXPECT_EQ(moving.object.refit(vertices, positions).error().message,
              "Vertex 90 cannot be used: its y coordinate is NaN.");
    positions[1].y = 0;
    EXPECT_EQ(moving.object.refit(vertices, std::span(positions).first(2)).error().message,
              "3 vertices and 2 positions were given.");
    const std::vector<std::uint32_t> beyond = {3, 162, 41};
    EXPECT_EQ(moving.object.refit(beyond, positions).error().message,
              "Vertex 162 does not exist: there are 162, numbered from 0.");
    const std::span<const Double3> own = moving.model().mesh().positions_f64;
    EXPECT_FALSE(moving.object.refit(vertices, own.first(3)));
    EXPECT_TRUE(std::ranges::equal(before.span(), moving.memory.span()));
}

}  // namespace
}  // namespace cdprep::test
