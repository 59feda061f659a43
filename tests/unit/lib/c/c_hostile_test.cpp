// SPDX-License-Identifier: MIT
// What a caller can get wrong, argument by argument and field by field: each is refused with a
// code, a reason and the name of what is wrong, and the answer says that nothing is known.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <new>
#include <random>
#include <string>
#include <vector>

#include "c/input.h"
#include "cdprep/ask.h"
#include "cdprep/cdprep.h"
#include "support/c_lanes.h"
#include "support/c_mistakes.h"
#include "support/c_models.h"
#include "support/c_questions.h"
#include "support/every_structure.h"
#include "support/float_modes.h"
#include "support/meshes.h"
#include "support/more_sections.h"
#include "support/random_pose.h"
#include "support/scratch_folder.h"
#include "support/tiny_baker.h"
#include "support/tiny_pieces.h"

namespace {
std::atomic<std::size_t> allocations = 0;
std::atomic<std::size_t> allocations_allowed = SIZE_MAX;

void* counted(std::size_t size) {
    if (++allocations > allocations_allowed) throw std::bad_alloc();
    if (void* memory = std::malloc(size)) return memory;
    throw std::bad_alloc();
}
}  // namespace

// Counts every allocation of this program.
void* operator new(std::size_t size) {
    return counted(size);
}
void* operator new[](std::size_t size) {
    return counted(size);
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete[](void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t /*unused*/) noexcept {
    std::free(memory);
}
void operator delete[](void* memory, std::size_t /*unused*/) noexcept {
    std::free(memory);
}

namespace cdprep::c {

/// A struct that has grown twice: at first it had `a`, then `b` too, now `c`.
struct Grown {
    cdprep_head head;
    std::uint32_t a, b;
    double c;
};

template <>
struct Input<Grown> {
    static const InputType type;
    static Grown defaults() noexcept {
        return {{}, 1, 2, 3};
    }
};
const InputType Input<Grown>::type = {"grown", 0x1234U, 12, sizeof(Grown), {}};

}  // namespace cdprep::c

namespace cdprep::test {
namespace {

class CHostile : public testing::Test {
protected:
    CHostile()
        : file_(
              with_hulls(with_every_structure(with_contacts(with_one_piece(baked(unit_cube())))))),
          model_(file_) {}

    static AlignedBytes baked(const TestMesh& mesh) {
        return bake_tiny(mesh.positions, mesh.triangles);
    }
    cdprep_pair pair() const {
        return pair_of({model_.get(), model_.get(), 0.5, nullptr});
    }

    AlignedBytes file_;
    CModel model_;
    CWorkspace workspace_;
};

std::vector<Mistake<cdprep_pair>> pair_mistakes() {
    using P = cdprep_pair;
    std::vector<Mistake<P>> all = struct_mistakes<P>("pair", offsetof(P, front));
    const auto word = [&](const char* name, std::uint32_t P::*field) {
        for (const std::uint32_t value : {7U, 77U, UINT32_MAX}) {
            all.push_back({name, [=](P& p) { p.*field = value; }, CDPREP_WHY_OUT_OF_RANGE, name});
        }
    };
    all.push_back({"a", [](P& p) { p.a = nullptr; }, CDPREP_WHY_NULL, "pair.a"});
    all.push_back({"b", [](P& p) { p.b = nullptr; }, CDPREP_WHY_NULL, "pair.b"});
    word("pair.moving", &P::moving);
    word("pair.body", &P::body);
    word("pair.overlap", &P::overlap);
    word("pair.degenerate", &P::degenerate);
    word("pair.through", &P::through);
    all.push_back(
        {"reserved", [](P& p) { p.reserved = 1; }, CDPREP_WHY_NEWER_FIELD, "pair.reserved"});
    for (const auto& [number, why] : bad_numbers()) {
        const double bad = number;
        all.push_back(
            {"a number", [bad](P& p) { p.pose_a.rows[11] = bad; }, why, "pair.pose_a[11]"});
        all.push_back({"a number", [bad](P& p) { p.pose_b.rows[0] = bad; }, why, "pair.pose_b[0]"});
    }
    const auto not_rigid = [&](const char* what, auto make) {
        all.push_back({what, make, CDPREP_WHY_NOT_RIGID, "pair.pose_b"});
    };
    not_rigid("zeros", [](P& p) { p.pose_b = {}; });
    not_rigid("scaled", [](P& p) { p.pose_b.rows[0] = 1 + 1e-11; });
    not_rigid("mirrored", [](P& p) { p.pose_b.rows[4] = -1; });
    not_rigid("sheared", [](P& p) { p.pose_b.rows[1] = 1e-9; });
    not_rigid("1e300", [](P& p) { p.pose_b.rows[1] = 1e300; });
    all.push_back({"too far apart",
                   [](P& p) {
                       p.pose_a.rows[9] = -0x1p1000;
                       p.pose_b.rows[9] = 0x1p1000;
                   },
                   CDPREP_WHY_OUT_OF_RANGE, "pair.pose_b"});
    return all;
}

TEST_F(CHostile, PairsAreCheckedFieldByField) {
    expect_refused(pair(), pair_mistakes(), [&](const cdprep_pair* given) {
        cdprep_collision found = {CDPREP_NO, 0, 0, 0, 0};
        cdprep_error error;
        const int code = cdprep_collide(given, workspace_.get(), &found, &error);
        return outcome(code, error, found.hit == CDPREP_UNKNOWN);
    });
    expect_refused(pair(), pair_mistakes(), [&](const cdprep_pair* given) {
        cdprep_overlap_list list = {nullptr, 0, 77};
        cdprep_error error;
        const int code = cdprep_overlaps(given, workspace_.get(), &list, &error);
        return outcome(code, error, list.count == 0);
    });
}

// A struct with a mistake is refused by every question that takes it, batches too.
TEST_F(CHostile, BatchesNameTheWrongPair) {
    for (const Mistake<cdprep_pair>& mistake : pair_mistakes()) {
        std::array<cdprep_pair, 3> pairs = {pair(), pair(), pair()};
        mistake.make(pairs[2]);
        std::array<cdprep_nearest, 3> nearest{};
        for (cdprep_nearest& answer : nearest) answer.found = CDPREP_YES;
        cdprep_error error;
        EXPECT_EQ(cdprep_distance_many(pairs.data(), 3, nullptr, workspace_.get(), nearest.data(),
                                       &error),
                  CDPREP_BAD_ARGUMENT);
        EXPECT_TRUE(std::string(error.argument).starts_with("pairs[2]")) << error.argument;
        for (const cdprep_nearest& answer : nearest) EXPECT_EQ(answer.found, CDPREP_NO);
    }
}

TEST_F(CHostile, FieldsThatAQuestionCannotUseAreRefused) {
    using P = cdprep_pair;
    const std::vector<std::pair<const char*, std::uint32_t P::*>> fields = {
        {"pair.body", &P::body},
        {"pair.overlap", &P::overlap},
        {"pair.degenerate", &P::degenerate},
        {"pair.through", &P::through}};
    for (const auto& [name, field] : fields) {
        P wrong = pair();
        wrong.*field = 1;
        std::uint32_t within = CDPREP_NO;
        cdprep_error error;
        EXPECT_EQ(cdprep_within(&wrong, 1, workspace_.get(), &within, &error), CDPREP_BAD_ARGUMENT);
        EXPECT_EQ(error.why, CDPREP_WHY_NO_MEANING) << name;
        EXPECT_STREQ(error.argument, name);
        EXPECT_EQ(within, std::uint32_t{CDPREP_UNKNOWN});
    }
    P solid = pair();
    solid.body = CDPREP_SOLID;
    cdprep_overlap_list list = {nullptr, 0, 77};
    cdprep_error error;
    EXPECT_EQ(cdprep_overlaps(&solid, workspace_.get(), &list, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_EQ(error.why, CDPREP_WHY_NO_MEANING);
}

TEST_F(CHostile, DistanceOptionsAreCheckedFieldByField) {
    using O = cdprep_distance_options;
    O right;
    cdprep_distance_options_init(&right, sizeof right);
    std::vector<Mistake<O>> all = struct_mistakes<O>("options");
    for (const auto& [number, why] : bad_numbers()) {
        const double bad = number;
        all.push_back(
            {"relative", [bad](O& o) { o.relative_error = bad; }, why, "options.relative_error"});
        all.push_back({"max", [bad](O& o) { o.max_distance = bad; }, why, "options.max_distance"});
    }
    all.push_back({"infinite", [](O& o) { o.absolute_error = kInfinity; }, CDPREP_WHY_NOT_FINITE,
                   "options.absolute_error"});
    all.push_back({"negative", [](O& o) { o.absolute_error = -1; }, CDPREP_WHY_OUT_OF_RANGE,
                   "options.absolute_error"});
    all.push_back({"negative", [](O& o) { o.max_distance = -1; }, CDPREP_WHY_OUT_OF_RANGE,
                   "options.max_distance"});
    const cdprep_pair given = pair();
    const auto ask = [&](const O* options) {
        cdprep_nearest nearest{};
        nearest.found = CDPREP_YES;
        cdprep_error error;
        const int code = cdprep_distance(&given, options, workspace_.get(), &nearest, &error);
        Outcome told = outcome(code, error, nearest.found == CDPREP_NO);
        if (options == nullptr) told.why = CDPREP_WHY_NULL;  // null stands for the defaults
        return told;
    };
    expect_refused(right, all, ask);
}

// A struct of zeros has max_distance 0: models 450 apart would count as not found.
TEST_F(CHostile, ZeroedOptionsAreNeverReadAsNothing) {
    cdprep_distance_options zeros{};
    zeros.head.size = sizeof zeros;
    zeros.relative_error = 0.01;
    const cdprep_pair given = pair();
    cdprep_nearest nearest{};
    cdprep_error error;
    EXPECT_EQ(cdprep_distance(&given, &zeros, workspace_.get(), &nearest, &error),
              CDPREP_BAD_ARGUMENT);
    EXPECT_EQ(error.why, CDPREP_WHY_NOT_INITIALISED);
}

TEST_F(CHostile, PointQueriesAreCheckedFieldByField) {
    using Q = cdprep_point_query;
    static double points[6] = {0.5, 0.5, 0.5, 2, 2, 2};
    Q right;
    cdprep_point_query_init(&right, sizeof right);
    right.model = model_.get();
    right.points = points;
    right.count = 2;
    std::vector<Mistake<Q>> all = struct_mistakes<Q>("query");
    all.push_back({"model", [](Q& q) { q.model = nullptr; }, CDPREP_WHY_NULL, "query.model"});
    all.push_back({"points", [](Q& q) { q.points = nullptr; }, CDPREP_WHY_NULL, "query.points"});
    all.push_back(
        {"through", [](Q& q) { q.through = 77; }, CDPREP_WHY_OUT_OF_RANGE, "query.through"});
    all.push_back({"through pieces", [](Q& q) { q.through = CDPREP_THROUGH_PIECES; },
                   CDPREP_WHY_NO_MEANING, "query.through"});
    all.push_back({"max_distance", [](Q& q) { q.max_distance = 1; }, CDPREP_WHY_NO_MEANING,
                   "query.max_distance"});
    for (const double bad : {kNan, kInfinity, -kInfinity, 1e302}) {
        static std::vector<std::array<double, 6>> kept;
        kept.reserve(8);
        kept.push_back({0.5, 0.5, 0.5, 2, bad, 2});
        const double* const at = kept.back().data();
        all.push_back({"a point", [at](Q& q) { q.points = at; },
                       std::isfinite(bad) ? CDPREP_WHY_OUT_OF_RANGE : CDPREP_WHY_NOT_FINITE,
                       "query.points[1]"});
    }
    expect_refused(right, all, [&](const Q* query) {
        std::array<cdprep_point_state, 2> states = {{{CDPREP_NO, 0, 0}, {CDPREP_NO, 0, 0}}};
        cdprep_error error;
        const int code = cdprep_points_inside(query, workspace_.get(), states.data(), &error);
        // Where the query itself is no query, how many answers there are is not known.
        const bool has_count = error.why != CDPREP_WHY_NOT_INITIALISED &&
                               error.why != CDPREP_WHY_NEWER_FIELD && query != nullptr;
        return outcome(code, error, !has_count || states[1].inside == CDPREP_UNKNOWN);
    });
}

TEST_F(CHostile, RaysAreChecked) {
    const auto ask = [&](const cdprep_ray& ray) {
        cdprep_ray_query query;
        cdprep_ray_query_init(&query, sizeof query);
        query.model = model_.get();
        query.rays = &ray;
        cdprep_ray_hit hit = {CDPREP_YES, 1, 1, {}};
        cdprep_error error;
        const int code = cdprep_rays_cast(&query, workspace_.get(), &hit, &error);
        EXPECT_TRUE(code == CDPREP_OK || hit.found == CDPREP_NO);
        return outcome(code, error, true);
    };
    const cdprep_ray right = {{-1, 0.5, 0.25}, {1, 0, 0}, kInfinity};
    EXPECT_EQ(ask(right).code, CDPREP_OK);
    for (const double bad : {kNan, kInfinity, -kInfinity, 0x1p1001}) {
        cdprep_ray origin = right, direction = right;
        origin.origin[1] = bad;
        direction.direction[2] = bad;
        EXPECT_EQ(ask(origin).argument, "query.rays[0]");
        EXPECT_EQ(ask(direction).argument, "query.rays[0]");
    }
    cdprep_ray still = right, backwards = right, endless = right;
    still.direction[0] = 0;
    backwards.max_t = -1;
    endless.max_t = kNan;
    EXPECT_EQ(ask(still).why, CDPREP_WHY_OUT_OF_RANGE);
    cdprep_ray short_one = right;  // t would be 1 / 2^-1074, which no double holds
    short_one.direction[0] = std::numeric_limits<double>::denorm_min();
    EXPECT_EQ(ask(short_one).why, CDPREP_WHY_OUT_OF_RANGE);
    short_one.direction[0] = 0x1p-1000;
    EXPECT_EQ(ask(short_one).code, CDPREP_OK);
    EXPECT_EQ(ask(backwards).why, CDPREP_WHY_OUT_OF_RANGE);
    EXPECT_EQ(ask(endless).why, CDPREP_WHY_NOT_FINITE);
}

int count_hit(void* hits, const cdprep_ray_hit* /*hit*/) {
    ++*static_cast<std::size_t*>(hits);
    return 1;
}

// A visitor is given one ray: of two or more rays it could not tell which one a hit belongs to.
TEST_F(CHostile, AVisitorOfRaysTakesOneRay) {
    cdprep_ray_query query = detail::rays_of({model_.get(), nullptr, 0, nullptr});
    std::size_t hits = 0;
    cdprep_error error;
    for (const std::size_t count : {std::size_t{0}, std::size_t{2}, std::size_t{1} << 20, SIZE_MAX,
                                    SIZE_MAX / sizeof(cdprep_ray)}) {
        query.count = count;
        EXPECT_EQ(cdprep_rays_visit(&query, workspace_.get(), count_hit, &hits, &error),
                  CDPREP_BAD_ARGUMENT);
        EXPECT_EQ(error.why, CDPREP_WHY_NO_MEANING) << count;
        EXPECT_STREQ(error.argument, "query.count");
    }
    EXPECT_EQ(hits, 0u);
    query.count = 1;
    EXPECT_EQ(cdprep_rays_visit(&query, workspace_.get(), nullptr, nullptr, &error),
              CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "visit");
    EXPECT_EQ(cdprep_rays_visit(&query, workspace_.get(), count_hit, &hits, nullptr), CDPREP_OK);
    EXPECT_EQ(hits, 2u) << "the ray enters and leaves the cube, beside its diagonals";
}

// No list is read before the number of rays and the rays themselves are known to be there.
TEST_F(CHostile, ListsOfRaysAreReadLast) {
    cdprep_ray_query query = detail::rays_of({model_.get(), nullptr, 0, nullptr});
    cdprep_ray_hit_list list = {nullptr, 1, 77};
    cdprep_error error;
    const auto refuse = [&] {
        EXPECT_EQ(cdprep_rays_all(&query, workspace_.get(), &list, &error), CDPREP_BAD_ARGUMENT);
        return std::string(error.argument);
    };
    EXPECT_EQ(refuse(), "lists[0].items");
    EXPECT_EQ(list.count, 0u);
    query.count = SIZE_MAX;
    list.room = 0;
    EXPECT_EQ(refuse(), "query.count");
    EXPECT_EQ(error.why, CDPREP_WHY_OUT_OF_RANGE);
    query.count = 1;
    query.rays = nullptr;
    list.room = 1;
    EXPECT_EQ(refuse(), "query.rays");
}

// The names are those of the parameters in the headers.
TEST_F(CHostile, TheGreatestToleranceOfAPoseIsInclusive) {
    const std::array<double, 16> identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    cdprep_pose pose;
    cdprep_error error;
    EXPECT_EQ(cdprep_pose_nearest(identity.data(), CDPREP_ROWS, 0.25, &pose, &error), CDPREP_OK);
    EXPECT_EQ(
        cdprep_pose_nearest(identity.data(), CDPREP_ROWS, std::nextafter(0.25, 1), &pose, &error),
        CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "tolerance");
    EXPECT_EQ(error.why, CDPREP_WHY_OUT_OF_RANGE);
}

// As B moves in a query. The poses are not changed if one is the result.
TEST_F(CHostile, RelativePosesAreThoseOfCpp) {
    std::mt19937 random(11);
    for (int i = 0; i < 300; ++i) {
        const Pose a = random_pose(random, 10), b = random_pose(random, 10);
        const cdprep_pose in_a = rows_in_c(a), in_b = rows_in_c(b);
        const cdprep_pose expected = rows_in_c(relative_pose(a, b));
        for (const FloatMode& mode : float_modes()) {
            cdprep_pose found{}, over_a = in_a, over_b = in_b;
            (void)run_in(mode, [&] {
                (void)cdprep_pose_relative(&in_a, &in_b, &found, nullptr);
                (void)cdprep_pose_relative(&over_a, &in_b, &over_a, nullptr);
                (void)cdprep_pose_relative(&in_a, &over_b, &over_b, nullptr);
            });
            EXPECT_EQ(std::memcmp(&found, &expected, sizeof found), 0) << mode.name;
            EXPECT_EQ(std::memcmp(&over_a, &expected, sizeof found), 0) << mode.name;
            EXPECT_EQ(std::memcmp(&over_b, &expected, sizeof found), 0) << mode.name;
        }
    }
}

TEST_F(CHostile, RelativePosesAreChecked) {
    const cdprep_pose right = pair().pose_a;
    cdprep_error error;
    const auto expect = [&](const cdprep_pose* a, const cdprep_pose* b, int why,
                            const char* argument) {
        cdprep_pose found = right;
        EXPECT_EQ(cdprep_pose_relative(a, b, &found, &error), CDPREP_BAD_ARGUMENT);
        EXPECT_EQ(error.why, why) << argument;
        EXPECT_STREQ(error.argument, argument);
        for (const double number : found.rows) EXPECT_EQ(number, 0);
    };
    expect(nullptr, &right, CDPREP_WHY_NULL, "world_from_a");
    expect(&right, nullptr, CDPREP_WHY_NULL, "world_from_b");
    EXPECT_EQ(cdprep_pose_relative(&right, &right, nullptr, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "a_from_b");
    cdprep_pose wrong = right;
    wrong.rows[9] = kNan;
    expect(&wrong, &right, CDPREP_WHY_NOT_FINITE, "world_from_a.rows[9]");
    expect(&right, &wrong, CDPREP_WHY_NOT_FINITE, "world_from_b.rows[9]");
    wrong = {};
    expect(&right, &wrong, CDPREP_WHY_NOT_RIGID, "world_from_b");
    cdprep_pose far = right, other = right;
    far.rows[9] = 0x1p1000;
    other.rows[9] = -0x1p1000;
    expect(&far, &other, CDPREP_WHY_OUT_OF_RANGE, "world_from_b");
    // Each is a pose; their product deviates by twice as much as a pose may, and is corrected.
    cdprep_pose drifted = right;
    drifted.rows[0] = drifted.rows[4] = drifted.rows[8] = 1 + 4.9e-13;
    cdprep_pose found{};
    ASSERT_EQ(cdprep_pose_relative(&drifted, &drifted, &found, &error), CDPREP_OK);
    EXPECT_NEAR(found.rows[0], 1, 1e-15);
}

// A built cube is sent, and opened again.
TEST_F(CHostile, BytesOfAModelAreOneAgain) {
    const TestMesh cube = unit_cube();
    const CBuilt built(build_options_of(cube), workspace_.get());
    for (const cdprep_model* model : {built.get(), model_.get()}) {
        cdprep_array bytes{};
        ASSERT_EQ(cdprep_model_bytes(model, &bytes, nullptr), CDPREP_OK);
        EXPECT_EQ(bytes.stride, 1u);
        AlignedBytes copy(bytes.count);
        std::memcpy(copy.span().data(), bytes.data, bytes.count);
        const CModel again(copy);
        std::size_t answered = 0;
        for (const CQuestion& question : c_questions()) {
            const CAnswer answer = question.ask({model, model, 0.5, workspace_.get()});
            const CAnswer same = question.ask({again.get(), again.get(), 0.5, workspace_.get()});
            EXPECT_EQ(answer.code, same.code) << question.name;
            EXPECT_EQ(answer.bytes, same.bytes) << question.name;
            answered += answer.code == CDPREP_OK;
        }
        EXPECT_GT(answered, 20u);
    }
    cdprep_error error;
    cdprep_array bytes = {&error, 77, 77};
    EXPECT_EQ(cdprep_model_bytes(nullptr, &bytes, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "model");
    EXPECT_EQ(bytes.data, nullptr);
    EXPECT_EQ(cdprep_model_bytes(built.get(), nullptr, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "bytes");
}

TEST_F(CHostile, EveryFeatureHasAName) {
    std::uint32_t named = 0;
    for (std::uint32_t bit = 0; bit < 32; ++bit) {
        const char* const name = cdprep_ask_name(1U << bit);
        if (name != nullptr) named |= 1U << bit;
    }
    EXPECT_EQ(named, static_cast<std::uint32_t>(known_asks()));
    EXPECT_STREQ(cdprep_ask_name(CDPREP_ASK_COLLIDE), "collide");
    EXPECT_STREQ(cdprep_ask_name(CDPREP_ASK_HULLS), "hull");
    EXPECT_EQ(cdprep_ask_name(0), nullptr);
    EXPECT_EQ(cdprep_ask_name(CDPREP_ASK_COLLIDE | CDPREP_ASK_RAY), nullptr);
    EXPECT_EQ(cdprep_ask_name(UINT32_MAX), nullptr);
}

TEST_F(CHostile, RefusalsNameTheParameter) {
    const cdprep_ray_query query = detail::rays_of({model_.get(), nullptr, 0, nullptr});
    cdprep_error error;
    EXPECT_EQ(cdprep_rays_cast(&query, workspace_.get(), nullptr, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "hits");
    EXPECT_EQ(cdprep_rays_any(&query, workspace_.get(), nullptr, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "hits");
    EXPECT_EQ(cdprep_rays_all(&query, workspace_.get(), nullptr, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "lists");
    alignas(CDPREP_ALIGNMENT) static std::byte block[CDPREP_ALIGNMENT];
    const cdprep_allocator misaligned = {
        [](void* /*context*/, std::size_t /*size*/, std::size_t /*alignment*/) -> void* {
            return block + 8;
        },
        [](void* /*context*/, void* /*memory*/, std::size_t /*size*/) {}, nullptr};
    cdprep_workspace_options options;
    cdprep_workspace_options_init(&options, sizeof options);
    options.allocator = &misaligned;
    cdprep_workspace* made = nullptr;
    EXPECT_EQ(cdprep_workspace_make(&options, nullptr, 0, &made, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "options.allocator");
}

// Bytes at a wrong address are no matter of what the file was baked for.
TEST_F(CHostile, MisalignedBytesAreRefusedWhateverIsAsked) {
    AlignedBytes moved(file_.size() + 1);
    std::memcpy(moved.span().data() + 1, std::as_const(file_).span().data(), file_.size());
    cdprep_open_options options;
    cdprep_open_options_init(&options, sizeof options);
    for (const std::uint32_t ask : {std::uint32_t{0}, std::uint32_t{CDPREP_ASK_COLLIDE}}) {
        options.ask = ask;
        options.mode = CDPREP_MAP;
        const std::byte* const begin = std::as_const(moved).span().data() + 1;
        cdprep_model* model = nullptr;
        cdprep_error error;
        EXPECT_EQ(cdprep_model_open_memory(begin, file_.size(), &options, &model, &error),
                  CDPREP_BAD_ARGUMENT);
        EXPECT_EQ(error.why, CDPREP_WHY_OUT_OF_RANGE);
        EXPECT_STREQ(error.argument, "bytes");
        options.mode = CDPREP_COPY;
        EXPECT_EQ(cdprep_model_open_memory(begin, file_.size(), &options, &model, &error),
                  CDPREP_OK);
        cdprep_model_close(model);
    }
}

// The expected refusals are those of the default environment. A trap would end the test.
TEST_F(CHostile, RefusalsAreTheSameInEveryFloatingPointEnvironment) {
    constexpr double kLeast = std::numeric_limits<double>::denorm_min();
    const double nan = kNan;
    cdprep_pair wrong = pair();
    std::memcpy(&wrong.pose_b.rows[10], &nan, sizeof nan);
    cdprep_shape_query empty = detail::shape_of({model_.get(), nullptr, 0, nullptr});
    empty.shape = CDPREP_BOX;
    for (std::size_t i = 0; i < 3; ++i) empty.a[i] = kLeast;
    for (std::size_t i = 0; i < 3; ++i) empty.b[i] = 0;
    const cdprep_ray ray = {{0, 0, 0}, {kLeast, 0, 0}, kInfinity};
    cdprep_ray_query short_ray = detail::rays_of({model_.get(), nullptr, 0, nullptr});
    short_ray.rays = &ray;
    const std::array<double, 16> identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    TestMesh cube = unit_cube();
    std::memcpy(&cube.positions[6].y, &nan, sizeof nan);
    const cdprep_build_options wrong_mesh = build_options_of(cube);
    TestMesh beyond = unit_cube();
    beyond.positions[5].x = 0x1.ffffff0000001p127;  // more than any float, and just so
    cdprep_build_options no_float = build_options_of(beyond);
    no_float.precision = CDPREP_SINGLE;
    std::vector<std::string> expected;
    for (const FloatMode& mode : float_modes()) {
        std::array<cdprep_error, 7> errors;
        (void)run_in(mode, [&] {
            cdprep_collision found;
            std::uint32_t touches = 0;
            cdprep_nearest nearest;
            cdprep_ray_hit hit;
            cdprep_pose pose;
            cdprep_collide(&wrong, workspace_.get(), &found, &errors[0]);
            cdprep_touch(&empty, workspace_.get(), &touches, &errors[1]);
            cdprep_rays_cast(&short_ray, workspace_.get(), &hit, &errors[2]);
            cdprep_shape_distance(&empty, workspace_.get(), &nearest, &errors[3]);
            cdprep_pose_nearest(identity.data(), CDPREP_ROWS, kLeast, &pose, &errors[4]);
            cdprep_model* built = nullptr;
            cdprep_model_build(&wrong_mesh, nullptr, 0, workspace_.get(), &built, &errors[5]);
            cdprep_model_build(&no_float, nullptr, 0, workspace_.get(), &built, &errors[6]);
        });
        std::vector<std::string> told;
        for (const cdprep_error& error : errors) {
            told.push_back(std::string(error.argument) + " " + error.message);
        }
        if (expected.empty()) expected = told;
        EXPECT_EQ(told, expected) << mode.name;
    }
    EXPECT_TRUE(expected[1].starts_with("query.b[0] ")) << expected[1];
    EXPECT_NE(expected[2].find("so short a direction"), std::string::npos) << expected[2];
    EXPECT_TRUE(expected[5].starts_with("options.positions[6] ")) << expected[5];
    EXPECT_TRUE(expected[6].starts_with("options.positions[5] ")) << expected[6];
}

TEST_F(CHostile, ShapesAreCheckedFieldByField) {
    using Q = cdprep_shape_query;
    const Q right = detail::shape_of({model_.get(), nullptr, 0, nullptr});
    std::vector<Mistake<Q>> all = struct_mistakes<Q>("query");
    all.push_back({"model", [](Q& q) { q.model = nullptr; }, CDPREP_WHY_NULL, "query.model"});
    for (const std::uint32_t shape : {0U, 5U, 77U}) {
        all.push_back(
            {"shape", [shape](Q& q) { q.shape = shape; }, CDPREP_WHY_OUT_OF_RANGE, "query.shape"});
    }
    all.push_back({"degenerate", [](Q& q) { q.degenerate = 77; }, CDPREP_WHY_OUT_OF_RANGE,
                   "query.degenerate"});
    for (const auto& [number, why] : bad_numbers()) {
        const double bad = number;
        all.push_back({"a", [bad](Q& q) { q.a[1] = bad; }, why, "query.a[1]"});
        all.push_back({"radius", [bad](Q& q) { q.radius = bad; }, why, "query.radius"});
        all.push_back({"pose", [bad](Q& q) { q.world_from_model.rows[3] = bad; }, why,
                       "query.world_from_model[3]"});
    }
    all.push_back({"radius", [](Q& q) { q.radius = -1; }, CDPREP_WHY_OUT_OF_RANGE, "query.radius"});
    all.push_back({"pose", [](Q& q) { q.world_from_model = {}; }, CDPREP_WHY_NOT_RIGID,
                   "query.world_from_model"});
    all.push_back({"max_distance", [](Q& q) { q.max_distance = 1; }, CDPREP_WHY_NO_MEANING,
                   "query.max_distance"});
    all.push_back({"an empty box",
                   [](Q& q) {
                       q.shape = CDPREP_BOX;
                       q.b[2] = -1;
                   },
                   CDPREP_WHY_OUT_OF_RANGE, "query.b[0]"});
    all.push_back({"a box that begins at infinity",
                   [](Q& q) {
                       q.shape = CDPREP_BOX;
                       q.a[0] = kInfinity;
                   },
                   CDPREP_WHY_NOT_FINITE, "query.a[0]"});
    expect_refused(right, all, [&](const Q* query) {
        std::uint32_t touches = CDPREP_NO;
        cdprep_error error;
        const int code = cdprep_touch(query, workspace_.get(), &touches, &error);
        return outcome(code, error, touches == CDPREP_UNKNOWN);
    });
}

// Spheres, capsules, boxes and triangles at many places, on one lane and on several.
TEST_F(CHostile, BatchesOfShapesGetTheAnswersOfSingleOnes) {
    constexpr std::size_t kCount = 100;
    std::vector<cdprep_shape_query> touched, measured;
    for (std::size_t i = 0; i < kCount; ++i) {
        cdprep_shape_query query = detail::shape_of({model_.get(), nullptr, 0, nullptr});
        query.shape = 1 + static_cast<std::uint32_t>(i % 4);
        const double x = 0.02 * static_cast<double>(i);
        query.a[0] = query.b[0] = query.c[0] = x;
        query.a[1] = query.b[1] = 0.25;
        query.b[2] = query.c[2] = 0.75;
        query.radius = 0.125;
        query.world_from_model.rows[9] = 0.5;
        if (i % 3 == 0) query.degenerate = CDPREP_SKIP_DEGENERATE;
        touched.push_back(query);
        query.degenerate = CDPREP_KEEP_DEGENERATE;
        if (i % 3 == 0) query.max_distance = 0.25;
        measured.push_back(query);
    }
    std::vector<std::uint32_t> touches(kCount);
    std::vector<cdprep_nearest> nearest(kCount);
    for (const std::uint32_t lanes : {1U, 4U}) {
        const CLanes workspace(lanes);
        std::fill(touches.begin(), touches.end(), 77U);
        std::fill(nearest.begin(), nearest.end(), cdprep_nearest{});
        cdprep_error error;
        ASSERT_EQ(
            cdprep_touch_many(touched.data(), kCount, workspace.get(), touches.data(), &error),
            CDPREP_OK)
            << error.message;
        ASSERT_EQ(cdprep_shape_distance_many(measured.data(), kCount, workspace.get(),
                                             nearest.data(), &error),
                  CDPREP_OK)
            << error.message;
        std::size_t touching = 0, found = 0;
        for (std::size_t i = 0; i < kCount; ++i) {
            std::uint32_t one = 77;
            cdprep_nearest single{};
            ASSERT_EQ(cdprep_touch(&touched[i], workspace_.get(), &one, nullptr), CDPREP_OK);
            ASSERT_EQ(cdprep_shape_distance(&measured[i], workspace_.get(), &single, nullptr),
                      CDPREP_OK);
            EXPECT_EQ(touches[i], one) << i;
            EXPECT_EQ(std::memcmp(&nearest[i], &single, sizeof single), 0) << i;
            touching += one == CDPREP_YES;
            found += single.found == CDPREP_YES;
        }
        EXPECT_GT(touching, kCount / 5);
        EXPECT_LT(touching, kCount * 4 / 5);
        EXPECT_GT(found, kCount / 2);
        EXPECT_LT(found, kCount);
    }
}

// No query of a batch runs if one is wrong; all answers are unknown, and the wrong one is named.
TEST_F(CHostile, BatchesOfShapesNameTheWrongQuery) {
    using Q = cdprep_shape_query;
    const Q right = detail::shape_of({model_.get(), nullptr, 0, nullptr});
    std::vector<Mistake<Q>> all = struct_mistakes<Q>("queries[2]");
    all.push_back({"model", [](Q& q) { q.model = nullptr; }, CDPREP_WHY_NULL, "queries[2].model"});
    all.push_back(
        {"radius", [](Q& q) { q.radius = kNan; }, CDPREP_WHY_NOT_FINITE, "queries[2].radius"});
    all.push_back({"pose", [](Q& q) { q.world_from_model = {}; }, CDPREP_WHY_NOT_RIGID,
                   "queries[2].world_from_model"});
    all.push_back({"max_distance", [](Q& q) { q.max_distance = 1; }, CDPREP_WHY_NO_MEANING,
                   "queries[2].max_distance"});
    all.push_back(
        {"another size", [](Q& q) { q.head.size += 8; }, CDPREP_WHY_NOT_INITIALISED, "queries[2]"});
    for (const Mistake<Q>& mistake : all) {
        std::array<Q, 3> queries = {right, right, right};
        mistake.make(queries[2]);
        std::array<std::uint32_t, 3> touches = {CDPREP_NO, CDPREP_NO, CDPREP_NO};
        cdprep_error error;
        EXPECT_EQ(cdprep_touch_many(queries.data(), 3, workspace_.get(), touches.data(), &error),
                  CDPREP_BAD_ARGUMENT);
        EXPECT_EQ(error.why, mistake.why) << mistake.what;
        EXPECT_STREQ(error.argument, mistake.argument) << mistake.what;
        for (const std::uint32_t one : touches) EXPECT_EQ(one, std::uint32_t{CDPREP_UNKNOWN});
    }
    std::uint32_t touches = 0;
    cdprep_nearest nearest{};
    cdprep_error error;
    const auto refuse = [&](int code) {
        EXPECT_EQ(code, CDPREP_BAD_ARGUMENT);
        return std::string(error.argument);
    };
    cdprep_workspace* const workspace = workspace_.get();
    EXPECT_EQ(refuse(cdprep_touch_many(nullptr, 1, workspace, &touches, &error)), "queries");
    EXPECT_EQ(refuse(cdprep_touch_many(&right, 1, nullptr, &touches, &error)), "workspace");
    EXPECT_EQ(refuse(cdprep_touch_many(&right, 1, workspace, nullptr, &error)), "touches");
    EXPECT_EQ(refuse(cdprep_touch_many(&right, SIZE_MAX, workspace, &touches, &error)), "count");
    EXPECT_EQ(refuse(cdprep_shape_distance_many(&right, 1, workspace, nullptr, &error)), "nearest");
    EXPECT_EQ(refuse(cdprep_shape_distance_many(&right, SIZE_MAX, workspace, &nearest, &error)),
              "count");
    Q skips = right;
    skips.degenerate = CDPREP_SKIP_DEGENERATE;
    EXPECT_EQ(refuse(cdprep_shape_distance_many(&skips, 1, workspace, &nearest, &error)),
              "queries[0].degenerate");
    EXPECT_EQ(cdprep_touch_many(nullptr, 0, workspace, nullptr, &error), CDPREP_OK);
    EXPECT_EQ(cdprep_shape_distance_many(nullptr, 0, workspace, nullptr, &error), CDPREP_OK);
}

TEST_F(CHostile, SelfQueriesAreCheckedFieldByField) {
    using Q = cdprep_self_query;
    const Q right = detail::self_of({model_.get(), nullptr, 0, nullptr});
    std::vector<Mistake<Q>> all = struct_mistakes<Q>("query");
    all.push_back({"model", [](Q& q) { q.model = nullptr; }, CDPREP_WHY_NULL, "query.model"});
    all.push_back(
        {"overlap", [](Q& q) { q.overlap = 2; }, CDPREP_WHY_OUT_OF_RANGE, "query.overlap"});
    all.push_back({"degenerate", [](Q& q) { q.degenerate = 77; }, CDPREP_WHY_OUT_OF_RANGE,
                   "query.degenerate"});
    expect_refused(right, all, [&](const Q* query) {
        cdprep_overlap_list list = {nullptr, 0, 77};
        cdprep_error error;
        const int code = cdprep_self_overlaps(query, workspace_.get(), &list, &error);
        return outcome(code, error, list.count == 0);
    });
    cdprep_overlap_list no_items = {nullptr, 5, 77};
    cdprep_error error;
    EXPECT_EQ(cdprep_self_overlaps(&right, workspace_.get(), &no_items, &error),
              CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "list.items");
    EXPECT_EQ(cdprep_self_overlaps(&right, nullptr, &no_items, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "workspace");
    EXPECT_EQ(cdprep_self_overlaps_visit(&right, workspace_.get(), nullptr, nullptr, &error),
              CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "visit");
}

TEST_F(CHostile, HullPairsAreCheckedFieldByField) {
    using P = cdprep_hull_pair;
    P right;
    cdprep_hull_pair_init(&right, sizeof right);
    right.a = right.b = {model_.get(), CDPREP_HULL_WHOLE, 0};
    std::vector<Mistake<P>> all = struct_mistakes<P>("pair");
    all.push_back({"model", [](P& p) { p.b.model = nullptr; }, CDPREP_WHY_NULL, "pair.b.model"});
    all.push_back({"scope", [](P& p) { p.a.scope = 77; }, CDPREP_WHY_OUT_OF_RANGE, "pair.a.scope"});
    all.push_back(
        {"number", [](P& p) { p.b.number = 77; }, CDPREP_WHY_OUT_OF_RANGE, "pair.b.number"});
    all.push_back({"moving", [](P& p) { p.moving = 3; }, CDPREP_WHY_OUT_OF_RANGE, "pair.moving"});
    all.push_back(
        {"pose", [](P& p) { p.pose_a.rows[0] = kNan; }, CDPREP_WHY_NOT_FINITE, "pair.pose_a[0]"});
    all.push_back({"pose", [](P& p) { p.pose_b = {}; }, CDPREP_WHY_NOT_RIGID, "pair.pose_b"});
    expect_refused(right, all, [&](const P* given) {
        std::uint32_t hit = CDPREP_NO;
        cdprep_error error;
        const int code = cdprep_hulls_collide(given, &hit, &error);
        return outcome(code, error, hit == CDPREP_UNKNOWN);
    });
}

TEST_F(CHostile, ContactOptionsAreCheckedFieldByField) {
    using O = cdprep_contact_options;
    O right;
    cdprep_contact_options_init(&right, sizeof right);
    std::vector<Mistake<O>> all = struct_mistakes<O>("options");
    for (const auto& [number, why] : bad_numbers()) {
        const double bad = number;
        all.push_back({"tolerance", [bad](O& o) { o.tolerance = bad; }, why, "options.tolerance"});
        all.push_back(
            {"cluster", [bad](O& o) { o.cluster_angle = bad; }, why, "options.cluster_angle"});
    }
    for (const std::uint32_t most : {0U, 257U}) {
        all.push_back(
            {"most", [most](O& o) { o.most = most; }, CDPREP_WHY_OUT_OF_RANGE, "options.most"});
    }
    for (const std::uint32_t points : {1U, 3U, 77U}) {
        all.push_back({"manifold", [points](O& o) { o.manifold = points; }, CDPREP_WHY_OUT_OF_RANGE,
                       "options.manifold"});
    }
    const cdprep_pair given = pair();
    expect_refused(right, all, [&](const O* options) {
        cdprep_contact_list list = {nullptr, 0, 77, CDPREP_YES, CDPREP_YES, 77, 77, 77};
        cdprep_error error;
        const int code = cdprep_contacts(&given, options, workspace_.get(), &list, &error);
        Outcome told = outcome(code, error,
                               list.count == 0 && list.complete == CDPREP_NO &&
                                   list.searched == CDPREP_NO && list.found == 0);
        if (options == nullptr) told.why = CDPREP_WHY_NULL;  // null stands for the defaults
        return told;
    });
}

TEST_F(CHostile, OptionsOfWorkspacesAndOpeningAreChecked) {
    using W = cdprep_workspace_options;
    W right;
    cdprep_workspace_options_init(&right, sizeof right);
    std::vector<Mistake<W>> all = struct_mistakes<W>("options");
    all.push_back({"lanes", [](W& w) { w.lanes = 0; }, CDPREP_WHY_OUT_OF_RANGE, "options.lanes"});
    all.push_back({"lanes", [](W& w) { w.lanes = 257; }, CDPREP_WHY_OUT_OF_RANGE, "options.lanes"});
    all.push_back({"nobody", [](W& w) { w.lanes = 2; }, CDPREP_WHY_NO_MEANING, "options.lanes"});
    all.push_back(
        {"counting", [](W& w) { w.counting = 2; }, CDPREP_WHY_OUT_OF_RANGE, "options.counting"});
    static const cdprep_allocator none = {nullptr, nullptr, nullptr};
    all.push_back(
        {"allocator", [](W& w) { w.allocator = &none; }, CDPREP_WHY_NULL, "options.allocator"});
    expect_refused(right, all, [&](const W* options) {
        cdprep_workspace* made = nullptr;
        cdprep_error error;
        const int code = cdprep_workspace_make(options, nullptr, 0, &made, &error);
        Outcome told = outcome(code, error, made == nullptr);
        cdprep_workspace_end(made);
        if (options == nullptr) told.why = CDPREP_WHY_NULL;  // null stands for the defaults
        return told;
    });
    using O = cdprep_open_options;
    O open;
    cdprep_open_options_init(&open, sizeof open);
    std::vector<Mistake<O>> wrong = struct_mistakes<O>("options");
    wrong.push_back({"mode", [](O& o) { o.mode = 77; }, CDPREP_WHY_OUT_OF_RANGE, "options.mode"});
    wrong.push_back(
        {"ask", [](O& o) { o.ask = 1U << 19; }, CDPREP_WHY_OUT_OF_RANGE, "options.ask"});
    wrong.push_back(
        {"ask", [](O& o) { o.ask = CDPREP_ASK_RESPONSE; }, CDPREP_WHY_NOT_BAKED, "options.ask"});
    wrong.push_back(
        {"mode", [](O& o) { o.mode = CDPREP_MAP_TRUSTED; }, CDPREP_WHY_NO_MEANING, "options.mode"});
    expect_refused(open, wrong, [&](const O* options) {
        cdprep_model* model = nullptr;
        cdprep_error error;
        const int code =
            cdprep_model_open_memory(file_.span().data(), file_.size(), options, &model, &error);
        Outcome told = outcome(code, error, model == nullptr);
        cdprep_model_close(model);
        if (options == nullptr) told.why = CDPREP_WHY_NULL;  // null stands for the defaults
        return told;
    });
}

TEST_F(CHostile, MemoryOfWorkspacesIsChecked) {
    std::size_t size = 0;
    ASSERT_EQ(cdprep_workspace_size(nullptr, &size, nullptr), CDPREP_OK);
    AlignedBytes memory(size + 1);
    std::byte* const at = memory.span().data();
    cdprep_workspace* made = nullptr;
    cdprep_error error;
    const auto refused = [&](void* start, std::size_t room) {
        const int code = cdprep_workspace_make(nullptr, start, room, &made, &error);
        EXPECT_EQ(made, nullptr);
        return code == CDPREP_BAD_ARGUMENT ? error.why : 0;
    };
    EXPECT_EQ(refused(at, size - 1), CDPREP_WHY_TOO_SMALL);
    EXPECT_EQ(refused(at, 0), CDPREP_WHY_TOO_SMALL);
    EXPECT_EQ(refused(at + 1, size), CDPREP_WHY_OUT_OF_RANGE);
    EXPECT_EQ(refused(nullptr, size), CDPREP_WHY_NULL);
    ASSERT_EQ(cdprep_workspace_make(nullptr, at, size, &made, nullptr), CDPREP_OK);
    cdprep_workspace_end(made);
}

std::vector<Mistake<cdprep_build_options>> build_mistakes() {
    using B = cdprep_build_options;
    static const std::array<double, 24> doubles = {};
    static const std::array<float, 24> floats = {};
    static std::vector<std::vector<double>> bad_positions;
    static std::vector<std::vector<float>> bad_floats;
    static const cdprep_allocator none = {nullptr, nullptr, nullptr};
    static const std::vector<std::uint32_t> bad_triangles = [] {
        std::vector<std::uint32_t> all(39, 1);
        all[38] = 8;
        return all;
    }();
    std::vector<Mistake<B>> all = struct_mistakes<B>("options");
    const auto add = [&](const char* what, auto make, int why, const char* argument) {
        all.push_back({what, make, why, argument});
    };
    add(
        "no positions", [](B& b) { b.positions = nullptr; }, CDPREP_WHY_NULL, "options.positions");
    add(
        "no triangles", [](B& b) { b.triangles = nullptr; }, CDPREP_WHY_NULL, "options.triangles");
    add(
        "both positions", [](B& b) { b.positions_f32 = floats.data(); }, CDPREP_WHY_NO_MEANING,
        "options.positions_f32");
    for (const std::uint32_t value : {2U, 77U, UINT32_MAX}) {
        add(
            "precision", [=](B& b) { b.precision = value; }, CDPREP_WHY_OUT_OF_RANGE,
            "options.precision");
    }
    for (const std::uint32_t bits : {1U << 19, 1U << 24, 1U << 31, UINT32_MAX}) {
        add(
            "unknown bits", [=](B& b) { b.ask = bits; }, CDPREP_WHY_OUT_OF_RANGE, "options.ask");
    }
    for (const int bit :
         {CDPREP_ASK_CONTACTS, CDPREP_ASK_RESPONSE, CDPREP_ASK_HULLS, CDPREP_ASK_PIECES,
          CDPREP_ASK_INACCESSIBLE, CDPREP_ASK_OCTREE, CDPREP_ASK_ADAPTIVE_OCTREE,
          CDPREP_ASK_TETRA_TREE, CDPREP_ASK_HASHED_OCTREE}) {
        const std::uint32_t bits = static_cast<std::uint32_t>(bit) | CDPREP_ASK_COLLIDE;
        add(
            "what no build serves", [=](B& b) { b.ask = bits; }, CDPREP_WHY_NOT_BAKED,
            "options.ask");
    }
    for (const std::size_t count : {std::size_t{1} << 31, SIZE_MAX / 24, SIZE_MAX}) {
        add(
            "vertices", [=](B& b) { b.vertex_count = count; }, CDPREP_WHY_OUT_OF_RANGE,
            "options.vertex_count");
        add(
            "triangles", [=](B& b) { b.triangle_count = count; }, CDPREP_WHY_OUT_OF_RANGE,
            "options.triangle_count");
    }
    add(
        "allocator", [](B& b) { b.allocator = &none; }, CDPREP_WHY_NULL, "options.allocator");
    bad_positions.reserve(8);
    bad_floats.reserve(8);
    for (const double bad : {kNan, kInfinity, -kInfinity, 0x1p1001}) {
        bad_positions.emplace_back(doubles.begin(), doubles.end());
        bad_positions.back()[23] = bad;
        const double* const at = bad_positions.back().data();
        add(
            "a position", [=](B& b) { b.positions = at; },
            std::isfinite(bad) ? CDPREP_WHY_OUT_OF_RANGE : CDPREP_WHY_NOT_FINITE,
            "options.positions[7]");
        if (std::isfinite(bad)) continue;
        bad_floats.emplace_back(floats.begin(), floats.end());
        bad_floats.back()[4] = static_cast<float>(bad);
        const float* const in_floats = bad_floats.back().data();
        add(
            "a float position",
            [=](B& b) {
                b.positions = nullptr;
                b.positions_f32 = in_floats;
            },
            CDPREP_WHY_NOT_FINITE, "options.positions_f32[1]");
    }
    bad_positions.emplace_back(doubles.begin(), doubles.end());
    bad_positions.back()[6] = -0x1p128;
    const double* const too_large = bad_positions.back().data();
    add(
        "no float",
        [=](B& b) {
            b.positions = too_large;
            b.precision = CDPREP_SINGLE;
        },
        CDPREP_WHY_OUT_OF_RANGE, "options.positions[2]");
    add(
        "a vertex that is not there",
        [](B& b) {
            b.triangles = bad_triangles.data();
            b.triangle_count = 13;
        },
        CDPREP_WHY_OUT_OF_RANGE, "options.triangles[12]");
    add(
        "too few vertices", [](B& b) { b.vertex_count = 7; }, CDPREP_WHY_OUT_OF_RANGE,
        "options.triangles[2]");
    add(
        "no vertices", [](B& b) { b.vertex_count = 0; }, CDPREP_WHY_OUT_OF_RANGE,
        "options.triangles[0]");
    return all;
}

TEST_F(CHostile, BuildOptionsAreCheckedFieldByField) {
    const TestMesh cube = unit_cube();
    const cdprep_build_options right = build_options_of(cube);
    expect_refused(right, build_mistakes(), [&](const cdprep_build_options* options) {
        auto* model = reinterpret_cast<cdprep_model*>(this);
        cdprep_error error;
        const int code = cdprep_model_build(options, nullptr, 0, workspace_.get(), &model, &error);
        const Outcome told = outcome(code, error, model == nullptr);
        cdprep_model_close(model);
        return told;
    });
    // What is wrong with the options alone is refused before there is any array.
    std::size_t sized = 0;
    for (const Mistake<cdprep_build_options>& mistake : build_mistakes()) {
        cdprep_build_options wrong = right;
        mistake.make(wrong);
        std::size_t size = 77;
        cdprep_error error;
        if (cdprep_model_build_size(&wrong, &size, &error) == CDPREP_OK) {
            EXPECT_NE(std::string(mistake.argument).find_first_of('['), std::string::npos);
            ++sized;
            continue;
        }
        EXPECT_EQ(error.why, mistake.why) << mistake.what;
        EXPECT_STREQ(error.argument, mistake.argument) << mistake.what;
        EXPECT_EQ(size, 0u);
    }
    EXPECT_EQ(sized, 11u);
}

// Each sentence names the field, what was found and what is allowed.
TEST_F(CHostile, RefusedBuildsSayWhatIsAllowed) {
    TestMesh cube = unit_cube();
    const auto said = [&](const cdprep_build_options& options) {
        cdprep_model* model = nullptr;
        cdprep_error error;
        (void)cdprep_model_build(&options, nullptr, 0, workspace_.get(), &model, &error);
        cdprep_model_close(model);
        return std::string(error.message);
    };
    cdprep_build_options options = build_options_of(cube);
    options.ask = CDPREP_ASK_OCTREE;
    EXPECT_EQ(said(options),
              "options.ask is 0x100000, but models built in memory do not serve octree. Bake the "
              "mesh with "
              "--structures octree.");
    options = build_options_of(cube);
    options.vertex_count = 5;
    EXPECT_EQ(said(options), "options.triangles[2] has vertex 5, but the mesh has 5 vertices.");
    cube.positions[3].y = 1e39;
    options = build_options_of(cube);
    options.precision = CDPREP_SINGLE;
    EXPECT_EQ(said(options),
              "options.positions[3] is 9.9999999999999994e+38; with CDPREP_SINGLE it must be at "
              "most 3.40282347e+38 in magnitude.");
    cube.positions[3].y = 0x1p1001;
    EXPECT_EQ(said(build_options_of(cube)),
              "options.positions[3] is 2.1430172143725346e+301; it must be a number of at most "
              "2^1000 in magnitude.");
}

// An empty mesh is one, and has no arrays.
TEST_F(CHostile, AnEmptyMeshIsBuilt) {
    cdprep_build_options options;
    cdprep_build_options_init(&options, sizeof options);
    const CBuilt built(options, workspace_.get());
    cdprep_model_info info{};
    ASSERT_EQ(cdprep_model_describe(built.get(), &info, nullptr), CDPREP_OK);
    EXPECT_EQ(info.triangles, 0u);
    cdprep_pair empty = pair();
    empty.a = built.get();
    cdprep_collision found{};
    ASSERT_EQ(cdprep_collide(&empty, workspace_.get(), &found, nullptr), CDPREP_OK);
    EXPECT_EQ(found.hit, std::uint32_t{CDPREP_NO});
}

TEST_F(CHostile, MemoryOfBuildsIsChecked) {
    const TestMesh cube = unit_cube();
    cdprep_build_options options = build_options_of(cube);
    std::size_t size = 0;
    ASSERT_EQ(cdprep_model_build_size(&options, &size, nullptr), CDPREP_OK);
    AlignedBytes memory(size + 64);
    std::byte* const at = memory.span().data();
    cdprep_error error;
    const auto refused = [&](void* start, std::size_t room) {
        auto* made = reinterpret_cast<cdprep_model*>(this);
        const int code = cdprep_model_build(&options, start, room, workspace_.get(), &made, &error);
        EXPECT_EQ(made, nullptr);
        return code == CDPREP_BAD_ARGUMENT ? error.why : 0;
    };
    EXPECT_EQ(refused(at, size - 1), CDPREP_WHY_TOO_SMALL);
    EXPECT_STREQ(error.argument, "size");
    EXPECT_EQ(refused(at, 0), CDPREP_WHY_TOO_SMALL);
    for (const std::size_t shift : {1U, 8U, 32U}) {
        EXPECT_EQ(refused(at + shift, size), CDPREP_WHY_OUT_OF_RANGE);
        EXPECT_STREQ(error.argument, "memory");
    }
    EXPECT_EQ(refused(nullptr, size), CDPREP_WHY_NULL);
    cdprep_allocator unused = {[](void*, std::size_t, std::size_t) -> void* { return nullptr; },
                               [](void*, void*, std::size_t) {}, nullptr};
    options.allocator = &unused;
    EXPECT_EQ(refused(at, size), CDPREP_WHY_NO_MEANING);
    EXPECT_STREQ(error.argument, "options.allocator");
    cdprep_model* made = nullptr;
    EXPECT_EQ(cdprep_model_build(&options, nullptr, 0, workspace_.get(), &made, nullptr),
              CDPREP_OVER_BUDGET);
    // Elsewhere than the block's own start, too.
    options.allocator = nullptr;
    ASSERT_EQ(cdprep_model_build(&options, at + 64, size, workspace_.get(), &made, nullptr),
              CDPREP_OK);
    cdprep_model_close(made);
    // Nulls are named as the header names the parameters.
    EXPECT_EQ(cdprep_model_build(&options, nullptr, 0, nullptr, &made, &error), 2);
    EXPECT_STREQ(error.argument, "workspace");
    EXPECT_EQ(cdprep_model_build(&options, nullptr, 0, workspace_.get(), nullptr, &error), 2);
    EXPECT_STREQ(error.argument, "model");
    EXPECT_EQ(cdprep_model_build_size(&options, nullptr, &error), 2);
    EXPECT_STREQ(error.argument, "size");
    EXPECT_EQ(cdprep_model_build(nullptr, nullptr, 0, nullptr, nullptr, nullptr), 2);
    EXPECT_EQ(cdprep_model_build_size(nullptr, nullptr, nullptr), 2);
    cdprep_build_options_init(nullptr, sizeof options);
}

// A visitor runs within its question, which is using the workspace.
TEST_F(CHostile, ABuildIsRefusedWhileItsWorkspaceIsInUse) {
    struct Within {
        cdprep_build_options options;
        cdprep_workspace* workspace;
        cdprep_model* model;
        int why;
    };
    const TestMesh cube = unit_cube();
    Within within = {build_options_of(cube), workspace_.get(), nullptr, 0};
    const cdprep_pair given = pair();
    const auto build = [](void* context, const cdprep_overlap* /*overlap*/) {
        auto* const w = static_cast<Within*>(context);
        cdprep_error error;
        (void)cdprep_model_build(&w->options, nullptr, 0, w->workspace, &w->model, &error);
        w->why = error.why;
        return 0;
    };
    ASSERT_EQ(cdprep_overlaps_visit(&given, workspace_.get(), build, &within, nullptr), CDPREP_OK);
    EXPECT_EQ(within.why, CDPREP_WHY_BUSY);
    EXPECT_EQ(within.model, nullptr);
    const CBuilt built(within.options, workspace_.get());
}

// Every question with a null for each of its arguments would be a page; the others share the code.
TEST_F(CHostile, NullsAreRefusedAndNamed) {
    const cdprep_pair given = pair();
    cdprep_error error;
    cdprep_collision found = {CDPREP_NO, 0, 0, 0, 0};
    EXPECT_EQ(cdprep_collide(nullptr, workspace_.get(), &found, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "pair");
    EXPECT_EQ(cdprep_collide(&given, nullptr, &found, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "workspace");
    EXPECT_EQ(found.hit, std::uint32_t{CDPREP_UNKNOWN});
    EXPECT_EQ(cdprep_collide(&given, workspace_.get(), nullptr, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "collision");
    EXPECT_EQ(cdprep_collide(nullptr, nullptr, nullptr, nullptr), CDPREP_BAD_ARGUMENT);
    cdprep_overlap_list list = {nullptr, 1, 77};
    EXPECT_EQ(cdprep_overlaps(&given, workspace_.get(), &list, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "list.items");
    EXPECT_EQ(list.count, 0u);
    EXPECT_EQ(cdprep_overlaps_visit(&given, workspace_.get(), nullptr, nullptr, &error),
              CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "visit");
    std::uint64_t bits = 0;
    cdprep_marks marks = {&bits, nullptr, 1, 1, 77};
    EXPECT_EQ(cdprep_overlaps_mark(&given, workspace_.get(), &marks, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "marks.bits_b");
    cdprep_model* model = nullptr;
    EXPECT_EQ(cdprep_model_open(nullptr, nullptr, &model, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_EQ(cdprep_model_open("no such file", nullptr, &model, &error), CDPREP_UNREADABLE);
    EXPECT_NE(std::string(error.message).find("no such file"), std::string::npos);
    const AlignedBytes bytes(64);
    const std::byte* const begin = bytes.span().data();
    EXPECT_EQ(cdprep_model_open_memory(begin, 5, nullptr, &model, &error), CDPREP_UNREADABLE);
    EXPECT_EQ(cdprep_model_open_memory(begin + 1, 5, nullptr, &model, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_EQ(model, nullptr);
    cdprep_model_close(nullptr);
    cdprep_workspace_end(nullptr);
    cdprep_version_get(nullptr);
    cdprep_pair_init(nullptr, sizeof(cdprep_pair));
}

// A caller may try the next file with the pointer of the last.
TEST_F(CHostile, AFailedOpenTakesTheOldModelFromThePointer) {
    cdprep_error error;
    auto* const old = reinterpret_cast<cdprep_model*>(&error);
    const AlignedBytes bytes(64);
    cdprep_model* model = old;
    EXPECT_EQ(cdprep_model_open("no such file", nullptr, &model, &error), CDPREP_UNREADABLE);
    EXPECT_EQ(model, nullptr);
    model = old;
    EXPECT_EQ(cdprep_model_open_memory(bytes.span().data(), 5, nullptr, &model, &error),
              CDPREP_UNREADABLE);
    EXPECT_EQ(model, nullptr);
}

struct Nested {
    const cdprep_pair* pair;
    cdprep_workspace* same;
    cdprep_workspace* other;
    int codes[3] = {-1, -1, -1};
    std::uint32_t hit = CDPREP_NO;
};

int ask_within_visitor(void* context, const cdprep_overlap* /*overlap*/) {
    auto* const nested = static_cast<Nested*>(context);
    cdprep_collision found = {CDPREP_NO, 0, 0, 0, 0};
    cdprep_error error;
    nested->codes[0] = cdprep_collide(nested->pair, nested->same, &found, &error);
    nested->codes[1] = error.why;
    nested->hit = found.hit;
    nested->codes[2] = cdprep_collide(nested->pair, nested->other, &found, nullptr);
    cdprep_workspace_end(nested->same);  // in use: does nothing
    return 0;
}

// A visitor runs within its question.
TEST_F(CHostile, AWorkspaceInUseIsRefusedAndAnotherIsNot) {
    const CWorkspace other;
    const cdprep_pair given = pair();
    Nested nested = {&given, workspace_.get(), other.get()};
    ASSERT_EQ(cdprep_overlaps_visit(&given, workspace_.get(), ask_within_visitor, &nested, nullptr),
              CDPREP_OK);
    EXPECT_EQ(nested.codes[0], CDPREP_BAD_ARGUMENT);
    EXPECT_EQ(nested.codes[1], CDPREP_WHY_BUSY);
    EXPECT_EQ(nested.hit, std::uint32_t{CDPREP_UNKNOWN});
    EXPECT_EQ(nested.codes[2], CDPREP_OK);
    cdprep_collision found{};
    EXPECT_EQ(cdprep_collide(&given, workspace_.get(), &found, nullptr), CDPREP_OK);
}

// The law of caches: any content gives the answer of none.
TEST_F(CHostile, RandomCachesChangeNoAnswer) {
    std::mt19937_64 random(20261122);
    std::size_t hits = 0;
    constexpr std::size_t kRounds = 2000;
    for (std::size_t round = 0; round < kRounds; ++round) {
        cdprep_pair given = pair();
        given.pose_b.rows[9] = static_cast<double>(random() % 32) / 16;
        cdprep_cache cache;
        if (round % 4 == 0) {
            std::memset(&cache, static_cast<int>(random() % 256), sizeof cache);
        } else if (round % 4 == 1) {  // what a question left, with one word changed
            cache = {};
            given.cache = &cache;
            cdprep_nearest ignored;
            ASSERT_EQ(cdprep_distance(&given, nullptr, workspace_.get(), &ignored, nullptr), 0);
            cache.words[random() % 32] ^= std::uint64_t{1} << random() % 64;
        } else {
            for (std::uint64_t& word : cache.words) word = random();
            if (round % 4 == 2) cache.words[0] &= 7;
        }
        cdprep_collision with{}, without{};
        cdprep_nearest nearest_with{}, nearest_without{};
        given.cache = nullptr;
        ASSERT_EQ(cdprep_collide(&given, workspace_.get(), &without, nullptr), CDPREP_OK);
        ASSERT_EQ(cdprep_distance(&given, nullptr, workspace_.get(), &nearest_without, nullptr), 0);
        given.cache = &cache;
        ASSERT_EQ(cdprep_collide(&given, workspace_.get(), &with, nullptr), CDPREP_OK);
        ASSERT_EQ(cdprep_distance(&given, nullptr, workspace_.get(), &nearest_with, nullptr), 0);
        EXPECT_EQ(with.hit, without.hit);
        EXPECT_EQ(nearest_with.upper, nearest_without.upper);
        hits += with.hit == CDPREP_YES;
    }
    EXPECT_GT(hits, kRounds * 3 / 10);
    EXPECT_LT(hits, kRounds * 7 / 10);
}

// A cache that says that the cubes are 2 apart, with one bit changed: a gap of 2^512 among them.
TEST_F(CHostile, ACacheWithAChangedBitIsANewOne) {
    cdprep_pair far = pair(), near = pair();
    far.pose_b.rows[9] = 3;
    cdprep_cache proved{};
    far.cache = &proved;
    cdprep_nearest ignored;
    for (int i = 0; i < 3; ++i) {
        ASSERT_EQ(cdprep_distance(&far, nullptr, workspace_.get(), &ignored, nullptr), CDPREP_OK);
    }
    for (std::size_t word = 0; word < 32; ++word) {
        for (std::size_t bit = 0; bit < 64; ++bit) {
            cdprep_cache changed = proved;
            changed.words[word] ^= std::uint64_t{1} << bit;
            near.cache = &changed;
            cdprep_collision found{};
            ASSERT_EQ(cdprep_collide(&near, workspace_.get(), &found, nullptr), CDPREP_OK);
            ASSERT_EQ(found.hit, std::uint32_t{CDPREP_YES}) << word << ", bit " << bit;
        }
    }
}

// A program of the first version has no front.
TEST_F(CHostile, APairOfTheFirstVersionIsTaken) {
    cdprep_pair older = pair();
    older.head.size = offsetof(cdprep_pair, front);
    older.front = reinterpret_cast<cdprep_front*>(this);  // beyond what the caller has
    older.through = CDPREP_THROUGH_PIECES;
    cdprep_cache cache{};
    older.cache = &cache;
    cdprep_nearest nearest{};
    EXPECT_EQ(cdprep_distance(&older, nullptr, workspace_.get(), &nearest, nullptr), CDPREP_OK);
    EXPECT_EQ(nearest.found, std::uint32_t{CDPREP_YES});
}

/// Asks for distances along a path, with a cache and a front; counts what a workspace did.
struct FrontPath {
    const cdprep_model* model;
    std::uint64_t box_pairs = 0;
    std::vector<cdprep_nearest> nearest = {};
    std::vector<std::uint32_t> within = {};

    /// `spoil(front, step)` may change the front before each step.
    template <class Spoil>
    void run(cdprep_cache* cache, cdprep_front* front, Spoil&& spoil) {
        cdprep_workspace_options options;
        cdprep_workspace_options_init(&options, sizeof options);
        options.counting = CDPREP_YES;
        cdprep_workspace* workspace = nullptr;
        ASSERT_EQ(cdprep_workspace_make(&options, nullptr, 0, &workspace, nullptr), CDPREP_OK);
        for (int step = 0; step < 60; ++step) {
            cdprep_pair pair;
            cdprep_pair_init(&pair, sizeof pair);
            pair.a = pair.b = model;
            pair.through = CDPREP_THROUGH_PIECES;
            pair.cache = cache;
            pair.front = front;
            const double angle = 0.002 * step;
            pair.pose_b.rows[0] = pair.pose_b.rows[4] = std::cos(angle);
            pair.pose_b.rows[3] = std::sin(angle);
            pair.pose_b.rows[1] = -pair.pose_b.rows[3];
            pair.pose_b.rows[9] = 2.1 - 0.0005 * step;
            pair.pose_b.rows[10] = 0.1;
            pair.pose_b.rows[11] = 0.05;
            spoil(front, step);
            cdprep_nearest found{};
            ASSERT_EQ(cdprep_distance(&pair, nullptr, workspace, &found, nullptr), CDPREP_OK);
            nearest.push_back(found);
            std::uint32_t is_near = 77;
            ASSERT_EQ(cdprep_within(&pair, 0.1, workspace, &is_near, nullptr), CDPREP_OK);
            within.push_back(is_near);
        }
        cdprep_counts counts;
        ASSERT_EQ(cdprep_workspace_counts(workspace, &counts, nullptr), CDPREP_OK);
        box_pairs = counts.n[CDPREP_COUNT_BOX_PAIRS];
        cdprep_workspace_end(workspace);
    }
};

// The law of fronts: any content gives the answer of none. A front saves most of the box pairs.
TEST_F(CHostile, FrontsChangeNoAnswer) {
    const AlignedBytes file = with_piece_tree(baked(icosphere(2)));
    const CModel ball(file);
    const auto leave = [](cdprep_front* /*front*/, int /*step*/) {};
    FrontPath without = {ball.get()}, with_cache = {ball.get()}, with = {ball.get()};
    cdprep_cache cache{}, other_cache{};
    const auto front = std::make_unique<cdprep_front>();
    without.run(nullptr, nullptr, leave);
    with_cache.run(&other_cache, nullptr, leave);
    with.run(&cache, front.get(), leave);
    std::mt19937_64 random(4);
    FrontPath hostile = {ball.get()};
    const auto spoilt = std::make_unique<cdprep_front>();
    hostile.run(&cache, spoilt.get(), [&](cdprep_front* words, int step) {
        if (step % 4 == 0) words->words[random() % 3600] ^= std::uint64_t{1} << random() % 64;
        if (step % 4 == 1) words->words[4] = random();
        if (step % 4 == 2) std::memset(words, static_cast<int>(random() % 256), sizeof *words);
    });
    std::size_t near = 0;
    for (std::size_t i = 0; i < without.nearest.size(); ++i) {
        for (const FrontPath* path : {&with_cache, &with, &hostile}) {
            EXPECT_EQ(std::memcmp(&path->nearest[i], &without.nearest[i], sizeof(cdprep_nearest)),
                      0)
                << i;
            EXPECT_EQ(path->within[i], without.within[i]) << i;
        }
        near += without.within[i] == CDPREP_YES;
    }
    EXPECT_GT(near, 10u);
    EXPECT_LT(near, 50u);
    EXPECT_LT(2 * with.box_pairs, without.box_pairs);
    EXPECT_LT(with.box_pairs, hostile.box_pairs);
}

// Every bit of a front in use: a changed one is a new front, and no answer changes.
TEST_F(CHostile, AFrontWithAChangedBitIsANewOne) {
    const AlignedBytes file = with_piece_tree(baked(icosphere(2)));
    const CModel ball(file);
    cdprep_pair given = pair_of({ball.get(), ball.get(), 2.125, nullptr});
    given.through = CDPREP_THROUGH_PIECES;
    cdprep_cache cache{};
    const auto front = std::make_unique<cdprep_front>();
    given.cache = &cache;
    given.front = front.get();
    cdprep_nearest expected{};
    for (int i = 0; i < 3; ++i) {
        ASSERT_EQ(cdprep_distance(&given, nullptr, workspace_.get(), &expected, nullptr),
                  CDPREP_OK);
    }
    EXPECT_NE(front->words[3599], 0u) << "the seal";
    EXPECT_NE(front->words[2] & 0xffffffffU, 0u) << "the number of planes";
    const cdprep_front kept = *front;
    const cdprep_cache kept_cache = cache;
    for (std::size_t word = 0; word < 3600; word += word < 64 ? 1 : 13) {
        for (const std::size_t bit : {0U, 31U, 32U, 62U}) {
            *front = kept;
            cache = kept_cache;
            front->words[word] ^= std::uint64_t{1} << bit;
            cdprep_nearest found{};
            ASSERT_EQ(cdprep_distance(&given, nullptr, workspace_.get(), &found, nullptr),
                      CDPREP_OK);
            ASSERT_EQ(std::memcmp(&found, &expected, sizeof found), 0) << word << ", bit " << bit;
        }
    }
}

// What is left out of an older struct is at its default; below the first version it is no struct.
TEST(CInput, OlderStructsAreFilledUp) {
    c::Call call(nullptr);
    for (const std::uint32_t size : {12U, 16U, 24U}) {
        const c::Grown given = {{size, 0x1234U}, 10, 20, 30};
        c::Grown read{};
        ASSERT_EQ(c::read_input(call, {"grown"}, &given, read), CDPREP_OK) << size;
        EXPECT_EQ(read.a, 10u);
        EXPECT_EQ(read.b, size >= 16 ? 20u : 2u);
        EXPECT_EQ(read.c, size >= 24 ? 30 : 3);
    }
    const c::Grown given = {{11, 0x1234U}, 10, 20, 30};
    c::Grown read{};
    EXPECT_EQ(c::read_input(call, {"grown"}, &given, read), CDPREP_BAD_ARGUMENT);
}

TEST(CInput, AnInitialiserWritesWhatTheCallerHas) {
    struct {
        cdprep_pair known;
        std::uint64_t more;
    } longer;
    std::memset(static_cast<void*>(&longer), 0xff, sizeof longer);
    cdprep_pair_init(&longer.known, sizeof longer);
    EXPECT_EQ(longer.known.head.size, sizeof longer);
    EXPECT_EQ(longer.more, 0u) << "what is unknown is 0";
    cdprep_pair none;
    std::memset(static_cast<void*>(&none), 0, sizeof none);
    cdprep_pair_init(&none, 0);
    cdprep_pair_init(&none, 4);
    cdprep_pair_init(&none, SIZE_MAX);
    EXPECT_EQ(none.head.size, 0u) << "nothing is written where the size is none";
}

TEST_F(CHostile, AllocatorsGetBackWhatTheyGave) {
    Blocks blocks;
    cdprep_open_options open;
    cdprep_open_options_init(&open, sizeof open);
    open.allocator = &blocks.allocator;
    open.mode = CDPREP_COPY;
    cdprep_model* model = nullptr;
    ASSERT_EQ(cdprep_model_open_memory(file_.span().data(), file_.size(), &open, &model, nullptr),
              CDPREP_OK);
    cdprep_workspace_options options;
    cdprep_workspace_options_init(&options, sizeof options);
    options.allocator = &blocks.allocator;
    cdprep_workspace* workspace = nullptr;
    ASSERT_EQ(cdprep_workspace_make(&options, nullptr, 0, &workspace, nullptr), CDPREP_OK);
    EXPECT_GE(blocks.given, 3u);
    cdprep_model_close(model);
    cdprep_workspace_end(workspace);
    EXPECT_EQ(blocks.taken, blocks.given);
    blocks.is_empty = true;
    EXPECT_EQ(cdprep_model_open_memory(file_.span().data(), file_.size(), &open, &model, nullptr),
              CDPREP_OVER_BUDGET);
    EXPECT_EQ(cdprep_workspace_make(&options, nullptr, 0, &workspace, nullptr), CDPREP_OVER_BUDGET);
    EXPECT_EQ(blocks.taken, blocks.given);
}

// Opening a copy fails at each of the library's own allocations in turn.
TEST_F(CHostile, FailedOpeningsGiveBackTheirCopy) {
    Blocks blocks;
    cdprep_open_options open;
    cdprep_open_options_init(&open, sizeof open);
    open.allocator = &blocks.allocator;
    open.mode = CDPREP_COPY;
    const ScratchFolder folder;
    const std::filesystem::path path = folder.path() / "cube.cdprep";
    {
        std::ofstream file(path, std::ios::binary);
        const auto bytes = std::as_const(file_).span();
        file.write(reinterpret_cast<const char*>(bytes.data()),
                   static_cast<std::streamsize>(bytes.size()));
    }
    const std::string name = path.string();
    const std::span<const std::byte> bytes = std::as_const(file_).span();
    for (const bool from_file : {false, true}) {
        int code = CDPREP_OVER_BUDGET;
        for (std::size_t allowed = 0; code != CDPREP_OK; ++allowed) {
            ASSERT_LT(allowed, 1000u);
            cdprep_model* model = nullptr;
            allocations_allowed = allocations + allowed;
            code = from_file ? cdprep_model_open(name.c_str(), &open, &model, nullptr)
                             : cdprep_model_open_memory(bytes.data(), bytes.size(), &open, &model,
                                                        nullptr);
            allocations_allowed = SIZE_MAX;
            EXPECT_EQ(model != nullptr, code == CDPREP_OK) << allowed;
            cdprep_model_close(model);
            EXPECT_EQ(blocks.taken, blocks.given) << allowed;
        }
        EXPECT_GT(blocks.given, 3u);
    }
}

/// Every task, here: an exception that a task threw into it would end the program.
void run_here(void* /*context*/, std::size_t count, cdprep_task task, const void* work) noexcept {
    for (std::size_t i = count; i-- > 0;) task(work, i);
}

// A build fails at its allocations in turn, of which some are made in tasks. 5,120 triangles are
// two tasks and more.
TEST_F(CHostile, FailedBuildsGiveEverythingBack) {
    const TestMesh ball = icosphere(4);
    Blocks blocks;
    cdprep_build_options options = build_options_of(ball);
    options.allocator = &blocks.allocator;
    cdprep_workspace_options lanes;
    cdprep_workspace_options_init(&lanes, sizeof lanes);
    lanes.lanes = 4;
    lanes.run = run_here;
    cdprep_workspace* four = nullptr;
    ASSERT_EQ(cdprep_workspace_make(&lanes, nullptr, 0, &four, nullptr), CDPREP_OK);
    for (cdprep_workspace* const workspace : {workspace_.get(), four}) {
        std::size_t failed = 0;
        int code = CDPREP_OVER_BUDGET;
        for (std::size_t allowed = 0; code != CDPREP_OK; allowed += 1 + allowed / 64) {
            ASSERT_LT(allowed, 100000u);
            cdprep_model* model = nullptr;
            cdprep_error error;
            allocations_allowed = allocations + allowed;
            code = cdprep_model_build(&options, nullptr, 0, workspace, &model, &error);
            allocations_allowed = SIZE_MAX;
            EXPECT_EQ(model != nullptr, code == CDPREP_OK) << allowed;
            EXPECT_TRUE(code == CDPREP_OK || code == CDPREP_OVER_BUDGET) << error.message;
            failed += code != CDPREP_OK;
            cdprep_model_close(model);
            EXPECT_EQ(blocks.taken, blocks.given) << allowed;
        }
        EXPECT_GT(failed, 20u);
    }
    EXPECT_GE(blocks.given, 2u);
    cdprep_workspace_end(four);
}

TEST_F(CHostile, NoQuestionAllocates) {
    for (const CQuestion& question : c_questions()) {
        const CScene scene = {model_.get(), model_.get(), 0.5, workspace_.get()};
        (void)question.ask(scene);  // its own room is made
        cdprep_model_info info{};
        const std::size_t begin = allocations;
        const int code = cdprep_model_describe(model_.get(), &info, nullptr);
        EXPECT_EQ(code, CDPREP_OK);
        EXPECT_EQ(allocations, begin);
    }
    cdprep_pair given = pair();
    cdprep_cache cache{};
    given.cache = &cache;
    const cdprep_self_query itself = detail::self_of({model_.get(), nullptr, 0, nullptr});
    std::vector<cdprep_overlap> overlaps(200);
    std::vector<cdprep_contact> contacts(20);
    std::vector<cdprep_crossing> crossings(200);
    std::uint32_t triangle = 3, yes = 0;
    const std::size_t before = allocations;
    for (int i = 0; i < 20; ++i) {
        given.pose_b.rows[9] = 0.1 * i;
        cdprep_collision collision;
        cdprep_nearest nearest;
        cdprep_overlap_list list = {overlaps.data(), overlaps.size(), 0};
        cdprep_contact_list found = {contacts.data(), contacts.size(), 0, 0, 0, 0, 0, 0};
        cdprep_crossing_list crossed = {crossings.data(), crossings.size(), 0};
        cdprep_corners corners;
        cdprep_workspace* const scratch = workspace_.get();
        EXPECT_EQ(cdprep_collide(&given, scratch, &collision, nullptr), CDPREP_OK);
        EXPECT_EQ(cdprep_distance(&given, nullptr, scratch, &nearest, nullptr), CDPREP_OK);
        EXPECT_EQ(cdprep_within(&given, 0.5, scratch, &yes, nullptr), CDPREP_OK);
        EXPECT_EQ(cdprep_overlaps(&given, scratch, &list, nullptr), CDPREP_OK);
        EXPECT_EQ(cdprep_overlaps_split(&given, scratch, &list, nullptr), CDPREP_OK);
        EXPECT_EQ(cdprep_self_overlaps(&itself, scratch, &list, nullptr), CDPREP_OK);
        EXPECT_EQ(cdprep_pairs_within(&given, 0.5, scratch, &list, nullptr), CDPREP_OK);
        EXPECT_EQ(cdprep_contacts(&given, nullptr, scratch, &found, nullptr), CDPREP_OK);
        EXPECT_EQ(cdprep_crossings(&given, scratch, &crossed, nullptr), CDPREP_OK);
        EXPECT_EQ(cdprep_collide_many(&given, 1, scratch, &collision, nullptr), CDPREP_OK);
        EXPECT_EQ(cdprep_model_corners(model_.get(), &triangle, 1, &corners, nullptr), CDPREP_OK);
        const cdprep_shape_query shape = detail::shape_of({model_.get(), nullptr, 0, nullptr});
        const std::uint32_t what =
            CDPREP_DRAW_SURFACE | CDPREP_DRAW_HULLS | CDPREP_DRAW_PIECES | CDPREP_DRAW_BOXES;
        cdprep_draw draw;
        cdprep_draw_init(&draw, sizeof draw);
        draw.what = what;
        draw.line = [](void*, const double*, const double*, std::uint32_t) { return 1; };
        draw.triangle = [](void*, const double*, std::uint32_t) { return 1; };
        cdprep_pose relative;
        cdprep_world_box around;
        cdprep_array bytes;
        EXPECT_EQ(cdprep_touch_many(&shape, 1, scratch, &yes, nullptr), CDPREP_OK);
        EXPECT_EQ(cdprep_shape_distance_many(&shape, 1, scratch, &nearest, nullptr), CDPREP_OK);
        EXPECT_EQ(cdprep_model_draw(model_.get(), &given.pose_b, &draw, nullptr), CDPREP_OK);
        EXPECT_EQ(cdprep_pose_relative(&given.pose_a, &given.pose_b, &relative, nullptr),
                  CDPREP_OK);
        EXPECT_EQ(cdprep_model_box(model_.get(), &given.pose_b, 1, nullptr, &around, nullptr),
                  CDPREP_OK);
        EXPECT_EQ(cdprep_model_bytes(model_.get(), &bytes, nullptr), CDPREP_OK);
    }
    EXPECT_EQ(allocations, before);
}

TEST(CVersion, SaysWhatRuns) {
    cdprep_version version{};
    cdprep_version_get(&version);
    EXPECT_EQ(version.minor, std::uint32_t{CDPREP_VERSION_MINOR});
    EXPECT_GE(version.newest_format, version.oldest_format);
    EXPECT_NE(std::string(version.kernels), "");
    EXPECT_STREQ(cdprep_code_name(CDPREP_UNREADABLE), "CDPREP_UNREADABLE");
    EXPECT_STREQ(cdprep_code_name(77), "CDPREP_UNKNOWN_CODE");
}

// Counts are sums of what questions did: boxes were compared, and none without counting.
TEST_F(CHostile, CountsAreThoseOfAllQuestions) {
    cdprep_workspace_options options;
    cdprep_workspace_options_init(&options, sizeof options);
    options.counting = CDPREP_YES;
    cdprep_workspace* counting = nullptr;
    ASSERT_EQ(cdprep_workspace_make(&options, nullptr, 0, &counting, nullptr), CDPREP_OK);
    const cdprep_pair given = pair();
    cdprep_overlap_list list = {nullptr, 0, 0};
    cdprep_counts once{}, twice{};
    ASSERT_EQ(cdprep_overlaps(&given, counting, &list, nullptr), CDPREP_OK);
    ASSERT_EQ(cdprep_workspace_counts(counting, &once, nullptr), CDPREP_OK);
    ASSERT_EQ(cdprep_overlaps(&given, counting, &list, nullptr), CDPREP_OK);
    ASSERT_EQ(cdprep_workspace_counts(counting, &twice, nullptr), CDPREP_OK);
    EXPECT_GT(once.n[CDPREP_COUNT_TRIANGLE_PAIRS], 0u);
    for (std::size_t i = 0; i < 32; ++i) EXPECT_EQ(twice.n[i], 2 * once.n[i]) << i;
    cdprep_workspace_end(counting);
    struct Within {
        cdprep_workspace* workspace;
        int why;
    } within = {workspace_.get(), 0};
    const auto ask_for_counts = [](void* context, const cdprep_overlap* /*overlap*/) {
        auto* const asked = static_cast<Within*>(context);
        cdprep_counts counts;
        cdprep_error refused;
        (void)cdprep_workspace_counts(asked->workspace, &counts, &refused);
        asked->why = refused.why;
        return 0;
    };
    ASSERT_EQ(cdprep_overlaps_visit(&given, workspace_.get(), ask_for_counts, &within, nullptr),
              CDPREP_OK);
    EXPECT_EQ(within.why, CDPREP_WHY_NO_MEANING) << "of a workspace that is in use, too";
    cdprep_error error;
    EXPECT_EQ(cdprep_workspace_counts(workspace_.get(), &once, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_EQ(error.why, CDPREP_WHY_NO_MEANING);
}

}  // namespace
}  // namespace cdprep::test
