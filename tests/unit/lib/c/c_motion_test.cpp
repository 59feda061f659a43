// SPDX-License-Identifier: MIT
// Times of impact through the C API: their answers, and what a caller can get wrong.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "cdprep/cdprep.h"
#include "support/c_mistakes.h"
#include "support/c_models.h"
#include "support/float_modes.h"
#include "support/meshes.h"
#include "support/tiny_baker.h"

namespace cdprep::test {
namespace {

class CMotion : public testing::Test {
protected:
    CMotion() : file_(bake_tiny(unit_cube().positions, unit_cube().triangles)), model_(file_) {}

    /// The second cube comes from x = 3 and goes to x = -1.
    [[nodiscard]] cdprep_moving_pair pair() const {
        cdprep_moving_pair pair;
        cdprep_moving_pair_init(&pair, sizeof pair);
        pair.a = pair.b = model_.get();
        pair.motion_b.start.rows[9] = 3;
        pair.motion_b.end.rows[9] = -1;
        return pair;
    }
    Outcome ask(const cdprep_moving_pair* given) {
        cdprep_error error;
        const int code = cdprep_time_of_impact(given, workspace_.get(), &impact_, &error);
        return outcome(code, error, impact_.kind == CDPREP_IMPACT_UNKNOWN);
    }

    AlignedBytes file_;
    CModel model_;
    CWorkspace workspace_;
    cdprep_impact impact_{};
};

TEST_F(CMotion, FindsTheTimeOfImpact) {
    const cdprep_moving_pair given = pair();
    ASSERT_EQ(ask(&given).code, CDPREP_OK);
    EXPECT_EQ(impact_.kind, static_cast<std::uint32_t>(CDPREP_IMPACT_TOUCHING));
    EXPECT_GT(impact_.steps, 0U);
    EXPECT_LE(impact_.lower, 0.5);
    EXPECT_GE(impact_.upper, 0.5);
    EXPECT_LE(impact_.upper - impact_.lower, 1e-11);
    EXPECT_EQ(impact_.nearest.found, static_cast<std::uint32_t>(CDPREP_YES));
    EXPECT_NEAR(impact_.nearest.on_a[0], 1, 1e-9);
    EXPECT_NEAR(impact_.nearest.on_b[0], 1, 1e-9);
}

TEST_F(CMotion, TakesVelocitiesAndLimits) {
    cdprep_moving_pair given = pair();
    given.motion_b.end = given.motion_a.end;
    given.motion_b.given_by = CDPREP_MOTION_VELOCITY;
    given.motion_b.shift[0] = -4;
    ASSERT_EQ(ask(&given).code, CDPREP_OK);
    EXPECT_EQ(impact_.kind, static_cast<std::uint32_t>(CDPREP_IMPACT_TOUCHING));
    EXPECT_NEAR(impact_.upper, 0.5, 1e-11);
    given.most_steps = 0;
    ASSERT_EQ(ask(&given).code, CDPREP_OK);
    EXPECT_EQ(impact_.kind, static_cast<std::uint32_t>(CDPREP_IMPACT_UNFINISHED));
    given.most_steps = 256;
    given.motion_b.shift[0] = 4;
    ASSERT_EQ(ask(&given).code, CDPREP_OK);
    EXPECT_EQ(impact_.kind, static_cast<std::uint32_t>(CDPREP_IMPACT_NONE));
    EXPECT_EQ(impact_.lower, 1);
    EXPECT_EQ(impact_.upper, std::numeric_limits<double>::infinity());
    EXPECT_EQ(impact_.nearest.found, static_cast<std::uint32_t>(CDPREP_NO));
}

TEST_F(CMotion, HasAPoseAtEachTime) {
    cdprep_motion motion = pair().motion_b;
    cdprep_pose pose;
    cdprep_error error;
    ASSERT_EQ(cdprep_motion_pose(&motion, 0.25, &pose, &error), CDPREP_OK) << error.message;
    EXPECT_EQ(pose.rows[9], 2);
    ASSERT_EQ(cdprep_motion_pose(&motion, 1, &pose, &error), CDPREP_OK);
    EXPECT_EQ(pose.rows[9], -1);
    for (const double time : {-0.5, 1.5, kNan, kInfinity}) {
        EXPECT_EQ(cdprep_motion_pose(&motion, time, &pose, &error), CDPREP_BAD_ARGUMENT);
        EXPECT_STREQ(error.argument, "time");
        EXPECT_EQ(pose.rows[0], 0);
    }
    motion.reserved = 1;
    EXPECT_EQ(cdprep_motion_pose(&motion, 0, &pose, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error.argument, "motion.reserved");
    EXPECT_EQ(cdprep_motion_pose(nullptr, 0, &pose, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_EQ(cdprep_motion_pose(&motion, 0, nullptr, &error), CDPREP_BAD_ARGUMENT);
}

// Small numbers are numbers in every mode, and none of them is trapped.
TEST_F(CMotion, FloatModesChangeNothing) {
    const cdprep_motion motion = pair().motion_b;
    cdprep_motion wrong = motion;
    wrong.shift[2] = 0x1p-1060;
    cdprep_pose expected;
    ASSERT_EQ(cdprep_motion_pose(&motion, 0x1p-1060, &expected, nullptr), CDPREP_OK);
    for (const FloatMode& mode : float_modes()) {
        cdprep_pose found, none;
        cdprep_error error;
        int code = CDPREP_INTERNAL, refused = CDPREP_INTERNAL;
        (void)run_in(mode, [&] {
            code = cdprep_motion_pose(&motion, 0x1p-1060, &found, nullptr);
            refused = cdprep_motion_pose(&wrong, 0, &none, &error);
        });
        EXPECT_EQ(code, CDPREP_OK) << mode.name;
        EXPECT_EQ(std::memcmp(&found, &expected, sizeof found), 0) << mode.name;
        EXPECT_EQ(refused, CDPREP_BAD_ARGUMENT) << mode.name;
        EXPECT_EQ(error.why, CDPREP_WHY_NO_MEANING) << mode.name;
    }
}

TEST_F(CMotion, RefusesEveryMistake) {
    using P = cdprep_moving_pair;
    std::vector<Mistake<P>> all = struct_mistakes<P>("pair");
    const auto add = [&](const char* argument, int why, auto make) {
        all.push_back({argument, make, why, argument});
    };
    add("pair.a", CDPREP_WHY_NULL, [](P& p) { p.a = nullptr; });
    add("pair.b", CDPREP_WHY_NULL, [](P& p) { p.b = nullptr; });
    add("pair.body", CDPREP_WHY_OUT_OF_RANGE, [](P& p) { p.body = 2; });
    add("pair.motion_a.given_by", CDPREP_WHY_OUT_OF_RANGE, [](P& p) { p.motion_a.given_by = 2; });
    add("pair.motion_b.given_by", CDPREP_WHY_OUT_OF_RANGE,
        [](P& p) { p.motion_b.given_by = UINT32_MAX; });
    add("pair.motion_a.reserved", CDPREP_WHY_NEWER_FIELD, [](P& p) { p.motion_a.reserved = 1; });
    add("pair.tolerance", CDPREP_WHY_OUT_OF_RANGE, [](P& p) { p.tolerance = -1; });
    for (const auto& [number, why] : bad_numbers()) {
        const double bad = number;
        add("pair.tolerance", why, [bad](P& p) { p.tolerance = bad; });
        add("pair.motion_a.start[3]", why, [bad](P& p) { p.motion_a.start.rows[3] = bad; });
        add("pair.motion_b.end[11]", why, [bad](P& p) { p.motion_b.end.rows[11] = bad; });
        add("pair.motion_b.centre[2]", why, [bad](P& p) { p.motion_b.centre[2] = bad; });
        add("pair.motion_a.shift[0]", why, [bad](P& p) { p.motion_a.shift[0] = bad; });
        add("pair.motion_a.turn[1]", why, [bad](P& p) { p.motion_a.turn[1] = bad; });
    }
    add("pair.motion_a.start", CDPREP_WHY_NOT_RIGID, [](P& p) { p.motion_a.start.rows[0] = 2; });
    add("pair.motion_b.end", CDPREP_WHY_NOT_RIGID, [](P& p) { p.motion_b.end.rows[4] = -1; });
    add("pair.motion_a.shift", CDPREP_WHY_NO_MEANING, [](P& p) { p.motion_a.shift[2] = 1; });
    add("pair.motion_a.turn", CDPREP_WHY_NO_MEANING, [](P& p) { p.motion_a.turn[2] = 1; });
    add("pair.motion_b.end", CDPREP_WHY_NO_MEANING,
        [](P& p) { p.motion_b.given_by = CDPREP_MOTION_VELOCITY; });
    add("pair.motion_a", CDPREP_WHY_OUT_OF_RANGE, [](P& p) {
        p.motion_a.given_by = CDPREP_MOTION_VELOCITY;
        p.motion_a.turn[2] = 1001;
    });
    add("pair.motion_b", CDPREP_WHY_OUT_OF_RANGE, [](P& p) {
        p.motion_b.start.rows[9] = 0x1p1000;
        p.motion_b.centre[0] = 0x1p999;
    });
    expect_refused(pair(), all, [&](const P* given) { return ask(given); });
}

/// A live cube, and its sweep in memory of the heap.
class CSweep : public CMotion {
protected:
    CSweep() {
        cdprep_live_options options;
        cdprep_live_options_init(&options, sizeof options);
        options.model = model_.get();
        EXPECT_EQ(cdprep_live_make(&options, nullptr, 0, &live_, nullptr), CDPREP_OK);
        EXPECT_EQ(
            cdprep_sweep_make(cdprep_live_model(live_), nullptr, nullptr, 0, &sweep_, &error_),
            CDPREP_OK)
            << error_.message;
    }
    ~CSweep() override {
        cdprep_sweep_end(sweep_);
        cdprep_live_end(live_);
    }
    CSweep(const CSweep&) = delete;
    CSweep& operator=(const CSweep&) = delete;

    /// Moves the cube along x in a step.
    void move(double x) {
        EXPECT_EQ(cdprep_sweep_start_step(sweep_, &error_), CDPREP_OK);
        refit(x);
        EXPECT_EQ(cdprep_sweep_finish_step(sweep_, &error_), CDPREP_OK);
    }
    void refit(double x) {
        std::vector<float> positions;
        for (const Double3& p : unit_cube().positions) {
            positions.insert(positions.end(), {static_cast<float>(p.x + x), static_cast<float>(p.y),
                                               static_cast<float>(p.z)});
        }
        cdprep_live_move moved;
        cdprep_live_move_init(&moved, sizeof moved);
        moved.positions_f32 = positions.data();
        moved.count = positions.size() / 3;
        EXPECT_EQ(cdprep_live_refit(live_, &moved, workspace_.get(), &error_), CDPREP_OK)
            << error_.message;
    }
    /// Asks about a cube at x.
    std::uint32_t may_touch(double x) {
        cdprep_motion motion = pair().motion_a;
        motion.start.rows[9] = motion.end.rows[9] = x;
        std::uint32_t answer = 77;
        EXPECT_EQ(cdprep_sweep_may_touch(sweep_, model_.get(), &motion, workspace_.get(), &answer,
                                         &error_),
                  CDPREP_OK)
            << error_.message;
        cdprep_overlap_list list = {nullptr, 0, 77};
        EXPECT_EQ(
            cdprep_sweep_pairs(sweep_, model_.get(), &motion, workspace_.get(), &list, &error_),
            CDPREP_OK);
        EXPECT_EQ(list.count > 0, answer == CDPREP_YES);
        return answer;
    }

    cdprep_live* live_ = nullptr;
    cdprep_sweep* sweep_ = nullptr;
    cdprep_error error_{};
};

TEST_F(CSweep, FindsWhatTheModelJumpsOver) {
    EXPECT_EQ(may_touch(5), static_cast<std::uint32_t>(CDPREP_NO));
    move(10);
    EXPECT_EQ(may_touch(5), static_cast<std::uint32_t>(CDPREP_YES));
    EXPECT_EQ(may_touch(11.5), static_cast<std::uint32_t>(CDPREP_NO));
    move(12);
    EXPECT_EQ(may_touch(5), static_cast<std::uint32_t>(CDPREP_NO));
}

TEST_F(CSweep, RefusesEveryMistake) {
    const cdprep_motion motion = pair().motion_a;
    std::uint32_t answer = 77;
    const auto ask = [&](const cdprep_sweep* sweep, const cdprep_model* other,
                         const cdprep_motion* by, cdprep_workspace* workspace) {
        answer = 77;
        const int code = cdprep_sweep_may_touch(sweep, other, by, workspace, &answer, &error_);
        return std::pair(code, std::string(error_.argument));
    };
    const auto refused = [](const char* argument) {
        return std::pair(static_cast<int>(CDPREP_BAD_ARGUMENT), std::string(argument));
    };
    EXPECT_EQ(ask(nullptr, model_.get(), &motion, workspace_.get()), refused("sweep"));
    EXPECT_EQ(ask(sweep_, nullptr, &motion, workspace_.get()), refused("other"));
    EXPECT_EQ(ask(sweep_, model_.get(), nullptr, workspace_.get()), refused("motion"));
    EXPECT_EQ(ask(sweep_, model_.get(), &motion, nullptr), refused("workspace"));
    EXPECT_EQ(answer, static_cast<std::uint32_t>(CDPREP_UNKNOWN));
    cdprep_motion wrong = motion;
    wrong.given_by = 2;
    EXPECT_EQ(ask(sweep_, model_.get(), &wrong, workspace_.get()), refused("motion.given_by"));
    cdprep_overlap_list list = {nullptr, 4, 77};
    EXPECT_EQ(cdprep_sweep_pairs(sweep_, model_.get(), &motion, workspace_.get(), &list, &error_),
              CDPREP_BAD_ARGUMENT);
    EXPECT_STREQ(error_.argument, "list.items");
    EXPECT_EQ(list.count, 0U);
    EXPECT_EQ(cdprep_sweep_start_step(nullptr, nullptr), CDPREP_BAD_ARGUMENT);
    EXPECT_EQ(cdprep_sweep_finish_step(nullptr, nullptr), CDPREP_BAD_ARGUMENT);
    cdprep_sweep_end(nullptr);
}

TEST_F(CSweep, RefusesAModelThatHasChanged) {
    const cdprep_motion motion = pair().motion_a;
    const auto expect_stale = [&] {
        std::uint32_t answer = 77;
        EXPECT_EQ(cdprep_sweep_may_touch(sweep_, model_.get(), &motion, workspace_.get(), &answer,
                                         &error_),
                  CDPREP_BAD_ARGUMENT);
        EXPECT_EQ(error_.why, CDPREP_WHY_STALE);
        EXPECT_STREQ(error_.argument, "sweep");
        EXPECT_EQ(answer, static_cast<std::uint32_t>(CDPREP_UNKNOWN));
    };
    EXPECT_EQ(cdprep_sweep_start_step(sweep_, &error_), CDPREP_OK);
    expect_stale();
    EXPECT_EQ(cdprep_sweep_finish_step(sweep_, &error_), CDPREP_OK);
    refit(3);
    expect_stale();
    EXPECT_EQ(cdprep_sweep_finish_step(sweep_, &error_), CDPREP_OK);
    EXPECT_EQ(may_touch(5), static_cast<std::uint32_t>(CDPREP_NO));
}

TEST_F(CSweep, TakesMemoryOfTheCaller) {
    std::size_t size = 77;
    ASSERT_EQ(cdprep_sweep_size(model_.get(), &size, &error_), CDPREP_OK);
    AlignedBytes memory(size);
    cdprep_sweep* sweep = nullptr;
    EXPECT_EQ(
        cdprep_sweep_make(model_.get(), nullptr, memory.span().data(), size - 1, &sweep, &error_),
        CDPREP_BAD_ARGUMENT);
    EXPECT_EQ(error_.why, CDPREP_WHY_TOO_SMALL);
    EXPECT_EQ(sweep, nullptr);
    const cdprep_allocator unused = {
        [](void* /*context*/, std::size_t /*size*/, std::size_t /*alignment*/) -> void* {
            return nullptr;
        },
        [](void* /*context*/, void* /*memory*/, std::size_t /*size*/) {}, nullptr};
    EXPECT_EQ(cdprep_sweep_make(model_.get(), &unused, memory.span().data(), size, &sweep, &error_),
              CDPREP_BAD_ARGUMENT);
    EXPECT_EQ(error_.why, CDPREP_WHY_NO_MEANING);
    EXPECT_STREQ(error_.argument, "allocator");
    ASSERT_EQ(cdprep_sweep_make(model_.get(), nullptr, memory.span().data(), size, &sweep, &error_),
              CDPREP_OK);
    EXPECT_EQ(cdprep_sweep_finish_step(sweep, &error_), CDPREP_OK);
    cdprep_sweep_end(sweep);
    EXPECT_EQ(cdprep_sweep_size(nullptr, &size, &error_), CDPREP_BAD_ARGUMENT);
    EXPECT_EQ(size, 0U);
}

}  // namespace
}  // namespace cdprep::test
