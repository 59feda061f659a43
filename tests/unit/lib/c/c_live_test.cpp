// SPDX-License-Identifier: MIT
// Live models through the C API: their answers, and what a caller can get wrong.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <string>
#include <vector>

#include "c/c_model.h"
#include "cdprep/cdprep.h"
#include "support/aligned_bytes.h"
#include "support/brute_force.h"
#include "support/c_lanes.h"
#include "support/c_mistakes.h"
#include "support/c_models.h"
#include "support/c_questions.h"
#include "support/meshes.h"
#include "support/tiny_baker.h"

namespace cdprep::test {
namespace {

constexpr std::uint32_t kServed = CDPREP_ASK_COLLIDE | CDPREP_ASK_OVERLAP | CDPREP_ASK_DISTANCE |
                                  CDPREP_ASK_WITHIN | CDPREP_ASK_INSIDE | CDPREP_ASK_RAY |
                                  CDPREP_ASK_CLOSEST | CDPREP_ASK_TOUCH | CDPREP_ASK_CORNERS |
                                  CDPREP_ASK_SOLID | CDPREP_ASK_CONTINUOUS | CDPREP_ASK_SELF |
                                  CDPREP_ASK_DEFORM | CDPREP_ASK_TEAR | CDPREP_ASK_HAPTIC;

cdprep_live_options options_for(const cdprep_model* base, std::uint32_t triangles = 0,
                                std::uint32_t vertices = 0) {
    cdprep_live_options options;
    cdprep_live_options_init(&options, sizeof options);
    options.model = base;
    options.max_triangles = triangles;
    options.max_vertices = vertices;
    return options;
}

/// A live model in memory of the heap. Ends the test program on failure.
class CLive {
public:
    explicit CLive(const cdprep_live_options& options) {
        cdprep_error error;
        if (cdprep_live_make(&options, nullptr, 0, &live_, &error) == CDPREP_OK) return;
        std::fprintf(stderr, "%s\n", error.message);
        std::abort();
    }
    CLive(const CLive&) = delete;
    CLive& operator=(const CLive&) = delete;
    ~CLive() {
        cdprep_live_end(live_);
    }
    [[nodiscard]] cdprep_live* get() const {
        return live_;
    }
    [[nodiscard]] const cdprep_model* model() const {
        return cdprep_live_model(live_);
    }
    [[nodiscard]] cdprep_live_info info() const {
        cdprep_live_info info;
        EXPECT_EQ(cdprep_live_describe(live_, &info, nullptr), CDPREP_OK);
        return info;
    }
    void move(const std::vector<std::uint32_t>& vertices, const std::vector<Double3>& to,
              cdprep_workspace* workspace) {
        cdprep_live_move move;
        cdprep_live_move_init(&move, sizeof move);
        move.vertices = vertices.empty() ? nullptr : vertices.data();
        move.positions = &to[0].x;
        move.count = to.size();
        cdprep_error error;
        EXPECT_EQ(cdprep_live_refit(live_, &move, workspace, &error), CDPREP_OK) << error.message;
    }

private:
    cdprep_live* live_ = nullptr;
};

AlignedBytes file_of(const TestMesh& mesh) {
    return bake_tiny(mesh.positions, mesh.triangles, {.double_precision = true});
}

void expect_same_answers(const cdprep_model* live, const cdprep_model* expected,
                         cdprep_workspace* workspace) {
    std::size_t answered = 0;
    for (const CQuestion& question : c_questions()) {
        const CAnswer answer = question.ask({live, live, 0.5, workspace});
        if ((question.needs & ~kServed) != 0) {
            EXPECT_EQ(answer.why, CDPREP_WHY_NOT_BAKED) << question.name;
            continue;
        }
        const CAnswer same = question.ask({expected, expected, 0.5, workspace});
        EXPECT_EQ(answer.code, same.code) << question.name;
        // Another order of the triangles may give another of several nearest ones, and lists
        // vertices in another order.
        const std::string name = question.name;
        const bool is_free = name.find("distance") != std::string::npos ||
                             name.find("impact") != std::string::npos || name == "model mesh";
        EXPECT_TRUE(is_free || answer.bytes == same.bytes) << question.name;
        ++answered;
    }
    EXPECT_GT(answered, 20u);
}

// With and without room for more triangles, as it is made and after its vertices moved.
TEST(CLiveModel, EveryQuestionGetsTheAnswerOfABake) {
    const CWorkspace workspace;
    for (const std::uint32_t room : {0U, 2000U}) {
        const TestMesh ball = icosphere(3);
        const AlignedBytes file = file_of(ball);
        const CModel base(file);
        CLive live(options_for(base.get(), room));
        EXPECT_EQ(live.info().triangles, ball.triangles.size());
        EXPECT_EQ(live.info().vertices, ball.positions.size());
        EXPECT_EQ(live.info().is_torn, std::uint32_t{CDPREP_NO});
        expect_same_answers(live.model(), base.get(), workspace.get());
        TestMesh shape = ball;
        for (Double3& p : shape.positions) p = {2 * p.x, p.y + 0.25 * p.z, p.z};
        live.move({}, shape.positions, workspace.get());
        const AlignedBytes moved = file_of(shape);
        const CModel expected(moved);
        cdprep_model_info info{};
        ASSERT_EQ(cdprep_model_describe(live.model(), &info, nullptr), CDPREP_OK);
        EXPECT_EQ(info.serves, kServed);
        EXPECT_EQ(info.triangles, ball.triangles.size());
        // Some vertices back to where they were.
        const std::vector<std::uint32_t> vertices = {0, 5, 9};
        std::vector<Double3> back;
        for (const std::uint32_t v : vertices) back.push_back(ball.positions[v]);
        live.move(vertices, back, workspace.get());
        for (std::size_t i = 0; i < 3; ++i) shape.positions[vertices[i]] = back[i];
        for (std::uint32_t i = 0; i < ball.triangles.size(); ++i) {
            cdprep_corners corners{};
            ASSERT_EQ(cdprep_model_corners(live.model(), &i, 1, &corners, nullptr), CDPREP_OK);
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t vertex = ball.triangles[i].vertex[k];
                EXPECT_EQ(corners.vertex[k], vertex);
                EXPECT_EQ(corners.point[k][0], shape.positions[vertex].x);
                EXPECT_EQ(corners.point[k][1], shape.positions[vertex].y);
            }
        }
    }
}

// Triangles move apart, and a rebuild gives them other places. Numbers and corners stay.
TEST(CLiveModel, ARebuildKeepsNumbersAndCorners) {
    const CWorkspace workspace;
    TestMesh cloud = random_soup(5, 2000, 0.02);
    const AlignedBytes file = file_of(cloud);
    const CModel base(file);
    CLive live(options_for(base.get()));
    std::uint32_t seed = 1;
    for (const Triangle& t : cloud.triangles) {
        seed = seed * 1664525U + 1013904223U;
        for (const std::uint32_t v : t.vertex) cloud.positions[v].x += (seed >> 24) / 200.0;
    }
    live.move({}, cloud.positions, workspace.get());
    std::uint32_t taken = 0;
    ASSERT_EQ(cdprep_live_rebuild(live.get(), 4096, &taken, nullptr), CDPREP_OK);
    EXPECT_EQ(taken, cloud.triangles.size());
    for (std::uint32_t i = 0; i < cloud.triangles.size(); ++i) {
        cdprep_corners corners{};
        ASSERT_EQ(cdprep_model_corners(live.model(), &i, 1, &corners, nullptr), CDPREP_OK);
        EXPECT_EQ(corners.vertex[2], cloud.triangles[i].vertex[2]);
        EXPECT_EQ(corners.point[2][0], cloud.positions[cloud.triangles[i].vertex[2]].x);
    }
}

/// Counts the rays from above that miss a strip or hit it elsewhere than at this height. Every run
/// of 64 leaves gets a ray or more.
std::size_t wrong_heights(const cdprep_model* strip, std::uint32_t length, double height,
                          cdprep_workspace* workspace) {
    std::vector<cdprep_ray> rays;
    for (std::uint32_t i = 0; i < length; i += 128) {
        rays.push_back({{0.25, i + 0.25, 100}, {0, 0, -1}, 1000});
    }
    std::vector<cdprep_ray_hit> hits(rays.size());
    cdprep_ray_query query;
    cdprep_ray_query_init(&query, sizeof query);
    query.model = strip;
    query.rays = rays.data();
    query.count = rays.size();
    EXPECT_EQ(cdprep_rays_cast(&query, workspace, hits.data(), nullptr), CDPREP_OK);
    return static_cast<std::size_t>(
        std::count_if(hits.begin(), hits.end(), [&](const cdprep_ray_hit& hit) {
            return hit.found == CDPREP_NO || hit.point[2] != height;
        }));
}

// The tasks of a move are more than the most lanes: one for 4,096 vertices or 4,096 triangles. The
// strip is flat, so its height is known everywhere. A `run` that skips tasks changes nothing.
TEST(CLiveModel, AMoveOfAMillionTrianglesReachesAllOfThem) {
    constexpr std::uint32_t kLength = 524'289;  // 1,048,578 triangles and 1,048,580 vertices
    TestMesh strip = grid_sheet(1, kLength);
    ASSERT_GT(strip.triangles.size(), 1U << 20);
    const CLanes one(1), three(3, run_badly);
    cdprep_build_options options = build_options_of(strip);
    options.ask = CDPREP_ASK_OVERLAP | CDPREP_ASK_CORNERS | CDPREP_ASK_DEFORM | CDPREP_ASK_RAY;
    const CBuilt base(options, one.get());
    CLive live(options_for(base.get()));
    std::vector<std::uint32_t> all(strip.positions.size());
    std::iota(all.begin(), all.end(), 0U);
    double height = 0;
    for (cdprep_workspace* const workspace : {one.get(), three.get()}) {
        for (const std::vector<std::uint32_t>& vertices : {std::vector<std::uint32_t>{}, all}) {
            height += 1;
            for (Double3& p : strip.positions) p.z = height;
            live.move(vertices, strip.positions, workspace);
            EXPECT_EQ(wrong_heights(live.model(), kLength, height, one.get()), 0U) << height;
        }
    }
}

/// Returns what cdprep_self_overlaps() lists; a visitor must see as much.
std::vector<TrianglePair> own_overlaps(const cdprep_model* model, cdprep_workspace* workspace,
                                       std::uint32_t overlap = CDPREP_CLOSED) {
    cdprep_self_query query;
    cdprep_self_query_init(&query, sizeof query);
    query.model = model;
    query.overlap = overlap;
    cdprep_overlap_list list = {nullptr, 0, 77};
    cdprep_error error;
    EXPECT_EQ(cdprep_self_overlaps(&query, workspace, &list, &error), CDPREP_OK) << error.message;
    std::vector<cdprep_overlap> items(list.count);
    list = {items.data(), items.size(), 77};
    EXPECT_EQ(cdprep_self_overlaps(&query, workspace, &list, &error), CDPREP_OK) << error.message;
    EXPECT_EQ(list.count, items.size());
    struct Seen {
        std::size_t count;
        std::size_t most;
    };
    const auto see = [](void* context, const cdprep_overlap* found) {
        auto& seen = *static_cast<Seen*>(context);
        EXPECT_LT(found->a, found->b);
        return ++seen.count < seen.most ? 1 : 0;
    };
    for (const std::size_t most : {SIZE_MAX, std::size_t{3}}) {
        Seen seen = {0, most};
        EXPECT_EQ(cdprep_self_overlaps_visit(&query, workspace, see, &seen, &error), CDPREP_OK);
        EXPECT_EQ(seen.count, std::min(most, items.size()));
    }
    std::vector<TrianglePair> pairs;
    for (const cdprep_overlap& item : items) pairs.push_back({item.a, item.b});
    return pairs;
}

// A sheet that is folded onto itself; then some of its triangles go. Brute force is the oracle.
TEST(CLiveModel, OverlapsWithItselfFollowItsShape) {
    const CWorkspace workspace;
    TestMesh sheet = grid_sheet(8, 8);
    const AlignedBytes file = file_of(sheet);
    const CModel base(file);
    CLive live(options_for(base.get(), 200));
    EXPECT_TRUE(own_overlaps(live.model(), workspace.get()).empty());
    for (Double3& p : sheet.positions) {
        p = {std::fabs(p.x - 3.5), p.y, 0.25 * (p.x - 3.5) * (p.y - 4)};
    }
    live.move({}, sheet.positions, workspace.get());
    std::vector<TrianglePair> expected = own_pairs(sheet);
    EXPECT_GT(expected.size(), 50U);
    EXPECT_EQ(own_overlaps(live.model(), workspace.get()), expected);
    EXPECT_LT(own_overlaps(live.model(), workspace.get(), CDPREP_PROPER).size(), expected.size());
    const std::vector<std::uint32_t> gone = {expected[0].a, expected[9].b};
    ASSERT_EQ(cdprep_live_remove(live.get(), gone.data(), gone.size(), nullptr), CDPREP_OK);
    std::erase_if(expected, [&](const TrianglePair& pair) {
        const auto is_gone = [&](std::uint32_t number) {
            return number == gone[0] || number == gone[1];
        };
        return is_gone(pair.a) || is_gone(pair.b);
    });
    EXPECT_EQ(own_overlaps(live.model(), workspace.get()), expected);
}

// While a task of the caller runs, no other call may change or describe the live model.
TEST(CLiveModel, AChangeRefusesAllOtherCalls) {
    const AlignedBytes file = file_of(icosphere(4));
    const CModel base(file);
    CLive live(options_for(base.get(), 6000));
    struct Intruder {
        cdprep_live* live;
        int refused = 0;
    } intruder{live.get()};
    cdprep_workspace_options options;
    cdprep_workspace_options_init(&options, sizeof options);
    options.lanes = 2;
    options.context = &intruder;
    options.run = [](void* context, std::size_t count, cdprep_task task, const void* of_task) {
        auto& self = *static_cast<Intruder*>(context);
        cdprep_error error;
        cdprep_live_info info;
        const std::uint32_t none = 0;
        std::uint32_t first = 0;
        self.refused += cdprep_live_remove(self.live, &none, 1, &error) != CDPREP_OK &&
                                error.why == CDPREP_WHY_BUSY
                            ? 1
                            : 0;
        self.refused += cdprep_live_append(self.live, &none, 0, &first, &error) != CDPREP_OK &&
                                error.why == CDPREP_WHY_BUSY
                            ? 1
                            : 0;
        self.refused += cdprep_live_describe(self.live, &info, &error) != CDPREP_OK ? 1 : 0;
        cdprep_live_triangle_list list = {nullptr, 0, 0};
        self.refused += cdprep_live_triangles(self.live, &list, &error) != CDPREP_OK &&
                                error.why == CDPREP_WHY_BUSY
                            ? 1
                            : 0;
        cdprep_live_end(self.live);
        for (std::size_t i = 0; i < count; ++i) task(of_task, i);
    };
    cdprep_workspace* workspace = nullptr;
    ASSERT_EQ(cdprep_workspace_make(&options, nullptr, 0, &workspace, nullptr), CDPREP_OK);
    live.move({}, icosphere(4).positions, workspace);
    EXPECT_GE(intruder.refused, 4);
    EXPECT_EQ(intruder.refused % 4, 0);
    cdprep_workspace_end(workspace);
    EXPECT_EQ(live.info().triangles, icosphere(4).triangles.size());
}

// Torn in two: the numbers of what is left stay, those of what comes are new.
TEST(CLiveModel, TrianglesComeAndGoByTheirNumbers) {
    const CWorkspace workspace;
    const TestMesh sheet = grid_sheet(8, 8);
    const AlignedBytes file = file_of(sheet);
    const CModel base(file);
    CLive live(options_for(base.get(), 200, 100));
    const auto count = static_cast<std::uint32_t>(sheet.triangles.size());
    const std::vector<std::uint32_t> gone = {3, 4, 3};
    ASSERT_EQ(cdprep_live_remove(live.get(), gone.data(), gone.size(), nullptr), CDPREP_OK);
    std::uint32_t first = 0;
    const std::array<std::uint32_t, 6> two = {0, 1, 99, 2, 99, 3};
    cdprep_error error;
    EXPECT_EQ(cdprep_live_append(live.get(), two.data(), 2, &first, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_EQ(first, CDPREP_NONE);
    live.move({99}, {{0.5, 0.5, 3}}, workspace.get());
    ASSERT_EQ(cdprep_live_append(live.get(), two.data(), 2, &first, &error), CDPREP_OK);
    EXPECT_EQ(first, count);
    EXPECT_EQ(live.info().triangles, count);
    EXPECT_EQ(live.info().number_bound, count + 2);
    EXPECT_EQ(live.info().vertices, 100u);
    EXPECT_EQ(live.info().is_torn, std::uint32_t{CDPREP_YES});

    // A ray from above meets the new triangle first.
    const Double3 &p = sheet.positions[0], &q = sheet.positions[1];
    const cdprep_ray ray = {{(p.x + q.x + 0.5) / 3, (p.y + q.y + 0.5) / 3, 9}, {0, 0, -1}, 99};
    cdprep_ray_query query;
    cdprep_ray_query_init(&query, sizeof query);
    query.model = live.model();
    query.rays = &ray;
    cdprep_ray_hit hit{};
    ASSERT_EQ(cdprep_rays_cast(&query, workspace.get(), &hit, &error), CDPREP_OK) << error.message;
    EXPECT_EQ(hit.triangle, first);

    std::vector<std::uint32_t> corners(3 * 200);
    std::vector<double> positions(3 * 100);
    cdprep_mesh mesh{};
    mesh.positions = positions.data();
    mesh.triangles = corners.data();
    mesh.vertex_room = 100;
    mesh.triangle_room = 200;
    ASSERT_EQ(cdprep_model_mesh(live.model(), &mesh, nullptr), CDPREP_OK);
    EXPECT_EQ(mesh.triangle_count, count);
    EXPECT_EQ(corners[3 * 3], sheet.triangles[5].vertex[0]);  // 3 and 4 are gone
    EXPECT_EQ(corners[3 * (count - 1) + 1], 99u);
    EXPECT_EQ(positions[3 * 99 + 2], 3);
    const std::array<std::uint32_t, 2> asked = {count + 1, 3};
    std::array<cdprep_corners, 2> facts{};
    EXPECT_EQ(cdprep_model_corners(live.model(), asked.data(), 1, facts.data(), nullptr),
              CDPREP_OK);
    EXPECT_EQ(facts[0].vertex[1], 99u);
    EXPECT_EQ(cdprep_model_corners(live.model(), asked.data(), 2, facts.data(), &error),
              CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "triangles[1]");
}

// By hand: 128 triangles, of which two go and one comes.
TEST(CLiveModel, ListsTheTrianglesThatThereAre) {
    const TestMesh sheet = grid_sheet(8, 8);
    const AlignedBytes file = file_of(sheet);
    const CModel base(file);
    CLive live(options_for(base.get(), 200));
    const auto count = static_cast<std::uint32_t>(sheet.triangles.size());
    const std::array<std::uint32_t, 2> gone = {0, 7};
    ASSERT_EQ(cdprep_live_remove(live.get(), gone.data(), gone.size(), nullptr), CDPREP_OK);
    std::uint32_t first = 0;
    const std::array<std::uint32_t, 3> corners = {0, 1, 2};
    ASSERT_EQ(cdprep_live_append(live.get(), corners.data(), 1, &first, nullptr), CDPREP_OK);
    std::vector<cdprep_live_triangle> all(count);
    cdprep_live_triangle_list list = {nullptr, 0, 77};
    ASSERT_EQ(cdprep_live_triangles(live.get(), &list, nullptr), CDPREP_OK);
    EXPECT_EQ(list.count, count - 1);
    list = {all.data(), all.size(), 77};
    ASSERT_EQ(cdprep_live_triangles(live.get(), &list, nullptr), CDPREP_OK);
    ASSERT_EQ(list.count, count - 1);
    for (std::uint32_t i = 0; i < count - 2; ++i) {
        const std::uint32_t number = i < 6 ? i + 1 : i + 2;
        ASSERT_EQ(all[i].number, number);
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_EQ(all[i].vertex[k], sheet.triangles[number].vertex[k]);
        }
    }
    EXPECT_EQ(all[count - 2].number, count);
    EXPECT_EQ(all[count - 2].vertex[2], 2u);
    std::array<cdprep_live_triangle, 3> few{};
    list = {few.data(), few.size(), 77};
    ASSERT_EQ(cdprep_live_triangles(live.get(), &list, nullptr), CDPREP_OK);
    EXPECT_EQ(list.count, count - 1);
    EXPECT_EQ(few[2].number, 3u);
}

// A copy of the bytes is a model by itself, with the answers of the live one.
TEST(CLiveModel, ItsBytesAreAModel) {
    const CWorkspace workspace;
    const TestMesh ball = icosphere(3);
    const AlignedBytes file = file_of(ball);
    const CModel base(file);
    CLive live(options_for(base.get()));
    std::vector<Double3> moved = ball.positions;
    for (Double3& p : moved) p = {2 * p.x, p.y + 0.25 * p.z, p.z};
    live.move({}, moved, workspace.get());
    cdprep_array image = {nullptr, 77, 77};
    cdprep_error error;
    ASSERT_EQ(cdprep_live_image(live.get(), &image, &error), CDPREP_OK) << error.message;
    ASSERT_EQ(image.stride, 1u);
    AlignedBytes copy(image.count);
    std::memcpy(copy.span().data(), image.data, image.count);
    const CModel opened(copy);
    expect_same_answers(live.model(), opened.get(), workspace.get());
    std::uint32_t first = 0;
    cdprep_corners corners{};
    ASSERT_EQ(cdprep_model_corners(opened.get(), &first, 1, &corners, nullptr), CDPREP_OK);
    EXPECT_EQ(corners.point[0][0], moved[ball.triangles[0].vertex[0]].x);
}

class CLiveHostile : public testing::Test {
protected:
    Outcome make(const cdprep_live_options* given) {
        cdprep_error error;
        std::size_t size = 77;
        const int sized = cdprep_live_size(given, &size, &error);
        const Outcome result{sized, error.why, error.argument, size == 0};
        auto* made = reinterpret_cast<cdprep_live*>(1);
        EXPECT_EQ(cdprep_live_make(given, nullptr, 0, &made, &error), sized);
        EXPECT_EQ(made == nullptr, sized != CDPREP_OK);
        cdprep_live_end(made);
        return result;
    }
    Outcome refit(const cdprep_live_move* given) {
        cdprep_error error;
        const int code = cdprep_live_refit(live_.get(), given, workspace_.get(), &error);
        return {code, error.why, error.argument, true};
    }

    CWorkspace workspace_;
    TestMesh ball_ = icosphere(1);
    AlignedBytes file_ = file_of(ball_);
    CModel base_{file_};
    CLive live_{options_for(base_.get(), 100, 60)};
};

TEST_F(CLiveHostile, OptionsAreCheckedFieldByField) {
    using O = cdprep_live_options;
    static const cdprep_allocator none = {nullptr, nullptr, nullptr};
    const CModel few(file_, CDPREP_ASK_RAY);
    std::vector<Mistake<O>> all = struct_mistakes<O>("options");
    all.push_back({"no base", [](O& o) { o.model = nullptr; }, CDPREP_WHY_NULL, "options.model"});
    all.push_back({"sections not opened", [&](O& o) { o.model = few.get(); }, CDPREP_WHY_NOT_OPENED,
                   "options.model"});
    all.push_back(
        {"few triangles", [](O& o) { o.max_triangles = 79; }, CDPREP_WHY_OUT_OF_RANGE, "options"});
    all.push_back(
        {"few vertices", [](O& o) { o.max_vertices = 41; }, CDPREP_WHY_OUT_OF_RANGE, "options"});
    all.push_back({"many triangles", [](O& o) { o.max_triangles = UINT32_MAX; },
                   CDPREP_WHY_OUT_OF_RANGE, "options"});
    all.push_back({"vertices alone", [](O& o) { o.max_triangles = 0; }, CDPREP_WHY_NO_MEANING,
                   "options.max_vertices"});
    all.push_back(
        {"no functions", [](O& o) { o.allocator = &none; }, CDPREP_WHY_NULL, "options.allocator"});
    expect_refused(options_for(base_.get(), 80, 42), all,
                   [&](const O* given) { return make(given); });
}

TEST_F(CLiveHostile, MovesAreCheckedFieldByField) {
    using M = cdprep_live_move;
    static std::vector<double> positions(180, 0.5);
    static const std::vector<float> floats(180, 0.5F);
    static std::vector<double> spoilt = positions, far = positions;
    spoilt[7] = kNan;
    far[5] = 0x1p1001;
    static const std::array<std::uint32_t, 3> vertices = {1, 2, 60};
    M right;
    cdprep_live_move_init(&right, sizeof right);
    right.positions = positions.data();
    right.count = 42;
    std::vector<Mistake<M>> all = struct_mistakes<M>("moved");
    all.push_back(
        {"no positions", [](M& m) { m.positions = nullptr; }, CDPREP_WHY_NULL, "moved.positions"});
    all.push_back({"both", [](M& m) { m.positions_f32 = floats.data(); }, CDPREP_WHY_NO_MEANING,
                   "moved.positions_f32"});
    all.push_back({"NaN", [](M& m) { m.positions = spoilt.data(); }, CDPREP_WHY_NOT_FINITE,
                   "moved.positions[2]"});
    all.push_back({"far", [](M& m) { m.positions = far.data(); }, CDPREP_WHY_OUT_OF_RANGE,
                   "moved.positions[1]"});
    all.push_back(
        {"many", [](M& m) { m.count = SIZE_MAX; }, CDPREP_WHY_OUT_OF_RANGE, "moved.count"});
    all.push_back({"few", [](M& m) { m.count = 41; }, CDPREP_WHY_OUT_OF_RANGE, "moved"});
    all.push_back({"no such vertex",
                   [](M& m) {
                       m.vertices = vertices.data();
                       m.count = 3;
                   },
                   CDPREP_WHY_OUT_OF_RANGE, "moved"});
    expect_refused(right, all, [&](const M* given) { return refit(given); });
}

TEST_F(CLiveHostile, TearsAreChecked) {
    cdprep_error error;
    std::uint32_t first = 0;
    const std::array<std::uint32_t, 3> corners = {0, 1, 60};
    const auto expect = [&](int code, int why, const char* argument) {
        EXPECT_EQ(code, CDPREP_BAD_ARGUMENT);
        EXPECT_EQ(error.why, why);
        EXPECT_STREQ(error.argument, argument);
    };
    cdprep_live* const live = live_.get();
    expect(cdprep_live_append(live, corners.data(), 1, &first, &error), CDPREP_WHY_OUT_OF_RANGE,
           "triangles");
    EXPECT_EQ(first, CDPREP_NONE);
    expect(cdprep_live_append(nullptr, corners.data(), 1, &first, &error), CDPREP_WHY_NULL, "live");
    expect(cdprep_live_append(live, nullptr, 1, &first, &error), CDPREP_WHY_NULL, "triangles");
    expect(cdprep_live_append(live, corners.data(), 1, nullptr, &error), CDPREP_WHY_NULL, "first");
    expect(cdprep_live_append(live, corners.data(), SIZE_MAX, &first, &error),
           CDPREP_WHY_OUT_OF_RANGE, "triangles");
    expect(cdprep_live_remove(nullptr, corners.data(), 1, &error), CDPREP_WHY_NULL, "live");
    expect(cdprep_live_remove(live, nullptr, 1, &error), CDPREP_WHY_NULL, "numbers");
    const std::array<std::uint32_t, 2> gone = {7, UINT32_MAX};
    expect(cdprep_live_remove(live, gone.data(), 2, &error), CDPREP_WHY_STALE, "numbers[1]");
    // A list in the memory of the live model itself would change while it is read.
    const std::span<const std::uint32_t> own = cdprep_live_model(live)->model.source().triangle;
    expect(cdprep_live_remove(live, own.data(), 2, &error), CDPREP_WHY_OUT_OF_RANGE, "numbers");
    EXPECT_EQ(live_.info().triangles, 80u);
    EXPECT_EQ(live_.info().is_torn, std::uint32_t{CDPREP_NO});
    CLive whole(options_for(base_.get()));
    expect(cdprep_live_remove(whole.get(), gone.data(), 1, &error), CDPREP_WHY_NO_MEANING, "live");
    expect(cdprep_live_append(whole.get(), corners.data(), 1, &first, &error),
           CDPREP_WHY_NO_MEANING, "live");
}

TEST_F(CLiveHostile, ListsAndImagesAreChecked) {
    cdprep_error error;
    const auto expect = [&](int code, int why, const char* argument) {
        EXPECT_EQ(code, CDPREP_BAD_ARGUMENT);
        EXPECT_EQ(error.why, why);
        EXPECT_STREQ(error.argument, argument);
    };
    CLive whole(options_for(base_.get()));
    cdprep_live_triangle_list list = {nullptr, 0, 77};
    expect(cdprep_live_triangles(nullptr, &list, &error), CDPREP_WHY_NULL, "live");
    EXPECT_EQ(list.count, 0u);
    expect(cdprep_live_triangles(live_.get(), nullptr, &error), CDPREP_WHY_NULL, "list");
    list = {nullptr, 1, 77};
    expect(cdprep_live_triangles(live_.get(), &list, &error), CDPREP_WHY_NULL, "list.items");
    EXPECT_EQ(list.count, 0u);
    list = {nullptr, 0, 77};
    expect(cdprep_live_triangles(whole.get(), &list, &error), CDPREP_WHY_NO_MEANING, "live");
    EXPECT_EQ(list.count, 0u);
    cdprep_array image = {&list, 77, 77};
    expect(cdprep_live_image(nullptr, &image, &error), CDPREP_WHY_NULL, "live");
    EXPECT_EQ(image.data, nullptr);
    expect(cdprep_live_image(whole.get(), nullptr, &error), CDPREP_WHY_NULL, "image");
    image = {&list, 77, 77};
    expect(cdprep_live_image(live_.get(), &image, &error), CDPREP_WHY_NO_MEANING, "live");
    EXPECT_EQ(image.data, nullptr);
    EXPECT_EQ(image.count, 0u);
    image = {&list, 77, 77};
    expect(cdprep_model_bytes(live_.model(), &image, &error), CDPREP_WHY_NO_MEANING, "model");
    EXPECT_EQ(image.data, nullptr);
}

TEST_F(CLiveHostile, NullAndMemoryAreChecked) {
    cdprep_error error;
    cdprep_live_options options = options_for(base_.get(), 90);
    std::size_t size = 0;
    ASSERT_EQ(cdprep_live_size(&options, &size, nullptr), CDPREP_OK);
    AlignedBytes memory(size + 64);
    std::byte* const start = memory.span().data();
    cdprep_live* made = nullptr;
    const auto why = [&](void* at, std::size_t room) {
        made = live_.get();
        (void)cdprep_live_make(&options, at, room, &made, &error);
        EXPECT_EQ(made == nullptr, error.code != CDPREP_OK);
        return error.why;
    };
    EXPECT_EQ(why(start, size - 1), CDPREP_WHY_TOO_SMALL);
    EXPECT_EQ(why(start + 32, size), CDPREP_WHY_OUT_OF_RANGE);
    EXPECT_EQ(why(nullptr, size), CDPREP_WHY_NULL);
    Blocks blocks;
    options.allocator = &blocks.allocator;
    EXPECT_EQ(why(start, size), CDPREP_WHY_NO_MEANING);
    EXPECT_EQ(why(nullptr, 0), 0);
    cdprep_live_end(made);
    EXPECT_EQ(blocks.given, 1u);
    EXPECT_EQ(blocks.taken, 1u);
    options.allocator = nullptr;
    EXPECT_EQ(why(start, size), 0);
    cdprep_live_end(made);
    const auto expect_null = [&](int code, const char* argument) {
        EXPECT_EQ(code, CDPREP_BAD_ARGUMENT);
        EXPECT_EQ(error.why, CDPREP_WHY_NULL);
        EXPECT_STREQ(error.argument, argument);
    };
    cdprep_live_move move;
    cdprep_live_move_init(&move, sizeof move);
    cdprep_live_info info;
    expect_null(cdprep_live_size(nullptr, &size, &error), "options");
    expect_null(cdprep_live_size(&options, nullptr, &error), "size");
    expect_null(cdprep_live_make(nullptr, nullptr, 0, &made, &error), "options");
    expect_null(cdprep_live_make(&options, nullptr, 0, nullptr, &error), "live");
    expect_null(cdprep_live_refit(nullptr, &move, workspace_.get(), &error), "live");
    expect_null(cdprep_live_refit(live_.get(), nullptr, workspace_.get(), &error), "moved");
    expect_null(cdprep_live_refit(live_.get(), &move, nullptr, &error), "workspace");
    expect_null(cdprep_live_describe(nullptr, &info, &error), "live");
    expect_null(cdprep_live_describe(live_.get(), nullptr, &error), "info");
    std::uint32_t taken = 9;
    expect_null(cdprep_live_rebuild(nullptr, 1, &taken, &error), "live");
    EXPECT_EQ(taken, 0u);
    expect_null(cdprep_live_rebuild(live_.get(), 1, nullptr, &error), "taken");
    EXPECT_EQ(cdprep_live_rebuild(live_.get(), 1000, &taken, &error), CDPREP_OK);
    EXPECT_EQ(cdprep_live_model(nullptr), nullptr);
    cdprep_model_close(const_cast<cdprep_model*>(live_.model()));  // is ended with the live model
    EXPECT_EQ(live_.info().triangles, 80u);
    options.allocator = &blocks.allocator;
    blocks.is_empty = true;
    EXPECT_EQ(cdprep_live_make(&options, nullptr, 0, &made, &error), CDPREP_OVER_BUDGET);
    EXPECT_EQ(made, nullptr);
    cdprep_live_end(nullptr);
    cdprep_live_options_init(nullptr, sizeof options);
    cdprep_live_move_init(nullptr, sizeof move);
}

}  // namespace
}  // namespace cdprep::test
