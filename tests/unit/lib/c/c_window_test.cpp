// SPDX-License-Identifier: MIT
// Windows and bounded distances through the C API: their answers, and what a caller can get wrong.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "cdprep/cdprep.h"
#include "support/aligned_bytes.h"
#include "support/c_lanes.h"
#include "support/c_mistakes.h"
#include "support/c_models.h"
#include "support/float_modes.h"
#include "support/meshes.h"
#include "support/tiny_baker.h"

namespace cdprep::test {
namespace {

AlignedBytes windowed_file(const TestMesh& mesh) {
    return bake_tiny(mesh.positions, mesh.triangles);
}

cdprep_window_options window_options(std::uint32_t leaves) {
    cdprep_window_options options;
    cdprep_window_options_init(&options, sizeof options);
    options.max_leaves = leaves;
    return options;
}

cdprep_pair pair_of(const cdprep_model* a, const cdprep_model* b, const Double3& at) {
    cdprep_pair pair;
    cdprep_pair_init(&pair, sizeof pair);
    pair.a = a;
    pair.b = b;
    pair.pose_b.rows[9] = at.x;
    pair.pose_b.rows[10] = at.y;
    pair.pose_b.rows[11] = at.z;
    return pair;
}

/// A torus, a ball beside it, and a window in memory of the heap.
class CWindow : public testing::Test {
protected:
    CWindow() {
        const cdprep_window_options options = window_options(200);
        EXPECT_EQ(cdprep_window_make(&options, nullptr, 0, &window_, nullptr), CDPREP_OK);
    }
    ~CWindow() override {
        cdprep_window_end(window_);
    }
    [[nodiscard]] cdprep_pair near(const Double3& at) const {
        return pair_of(cdprep_window_model(window_), probe_.get(), at);
    }
    [[nodiscard]] cdprep_pair whole(const Double3& at) const {
        return pair_of(all_.get(), probe_.get(), at);
    }
    cdprep_window_info fill(const Double3& at, double radius) {
        const cdprep_pair pair = whole(at);
        cdprep_window_info info{};
        EXPECT_EQ(cdprep_window_fill(window_, &pair, radius, &info, nullptr), CDPREP_OK);
        return info;
    }

    CWorkspace workspace_;
    AlignedBytes file_ = windowed_file(torus(1, 0.3, 60, 40));
    AlignedBytes of_probe_ = windowed_file(moved_by(icosphere(1), 0.1, {}));
    CModel all_{file_};
    CModel probe_{of_probe_};
    cdprep_window* window_ = nullptr;
};

TEST_F(CWindow, CompleteAnswersAreThoseAboutTheWholeModel) {
    int complete = 0, late = 0;
    cdprep_cache cache{};
    for (int step = 0; step < 500; ++step) {
        const double angle = 0.004 * step;
        const Double3 at = {std::cos(angle), std::sin(angle), 0.45};
        if (step % 50 == 0) {
            const cdprep_window_info info = fill(at, 0.15);
            EXPECT_EQ(info.radius, 0.15);
            EXPECT_GT(info.leaves, 5U);
            EXPECT_EQ(info.is_empty, std::uint32_t{CDPREP_NO});
        }
        cdprep_pair pair = near(at);
        pair.cache = &cache;
        const cdprep_pair of_all = whole(at);
        cdprep_bounded found{};
        cdprep_nearest truth{};
        double margin = 0;
        ASSERT_EQ(cdprep_window_distance(&pair, nullptr, step % 5 == 0 ? 6 : 0, workspace_.get(),
                                         &found, nullptr),
                  CDPREP_OK);
        ASSERT_EQ(cdprep_window_margin(&pair, &margin, nullptr), CDPREP_OK);
        ASSERT_EQ(cdprep_distance(&of_all, nullptr, workspace_.get(), &truth, nullptr), CDPREP_OK);
        EXPECT_LE(found.lower, truth.upper);
        EXPECT_LE(margin, 0.15);
        if (found.complete == CDPREP_YES) {
            ++complete;
            EXPECT_EQ(std::memcmp(&found.nearest, &truth, sizeof truth), 0);
            EXPECT_LE(found.nearest.upper, margin);
            cdprep_bounded again{};
            ASSERT_EQ(
                cdprep_distance_bounded(&of_all, nullptr, 0, workspace_.get(), &again, nullptr),
                CDPREP_OK);
            EXPECT_EQ(again.complete, std::uint32_t{CDPREP_YES});
            EXPECT_EQ(std::memcmp(&again.nearest, &truth, sizeof truth), 0);
        } else {
            ++late;
            if (found.nearest.found == CDPREP_YES) {
                EXPECT_GE(found.nearest.upper, truth.lower);
            }
        }
    }
    EXPECT_GT(complete, 100);
    EXPECT_GT(late, 50);
}

TEST_F(CWindow, NumbersStayFinite) {
    const cdprep_pair pair = near({1, 0, 0.45});
    double margin = 0;
    ASSERT_EQ(cdprep_window_margin(&pair, &margin, nullptr), CDPREP_OK);
    EXPECT_EQ(margin, -0x1p1000);
    cdprep_bounded found{};
    ASSERT_EQ(cdprep_window_distance(&pair, nullptr, 0, workspace_.get(), &found, nullptr),
              CDPREP_OK);
    EXPECT_EQ(found.complete, std::uint32_t{CDPREP_NO});
    EXPECT_EQ(found.lower, 0);
    EXPECT_EQ(found.nearest.found, std::uint32_t{CDPREP_NO});
    const cdprep_window_options options = window_options(600);
    cdprep_window* large = nullptr;
    ASSERT_EQ(cdprep_window_make(&options, nullptr, 0, &large, nullptr), CDPREP_OK);
    const cdprep_pair of_all = whole({1, 0, 0.45});
    cdprep_window_info info{};
    ASSERT_EQ(cdprep_window_fill(large, &of_all, kInfinity, &info, nullptr), CDPREP_OK);
    EXPECT_EQ(info.radius, 0x1p1000);
    EXPECT_EQ(info.leaves, 600U);
    const cdprep_pair in_large = pair_of(cdprep_window_model(large), probe_.get(), {9, 0, 0});
    ASSERT_EQ(cdprep_window_margin(&in_large, &margin, nullptr), CDPREP_OK);
    EXPECT_EQ(margin, 0x1p1000);
    cdprep_window_end(large);
    const AlignedBytes nothing = windowed_file({});
    const CModel empty(nothing);
    const cdprep_pair none = pair_of(all_.get(), empty.get(), {});
    ASSERT_EQ(cdprep_distance_bounded(&none, nullptr, 0, workspace_.get(), &found, nullptr),
              CDPREP_OK);
    EXPECT_EQ(found.lower, 0x1p1000);
}

TEST_F(CWindow, ItServesSurfacesAloneAndIsNotBalanced) {
    fill({1, 0, 0.45}, 0.1);
    const cdprep_model* const model = cdprep_window_model(window_);
    cdprep_error error;
    for (const std::uint32_t ask :
         {CDPREP_ASK_INSIDE, CDPREP_ASK_SOLID, CDPREP_ASK_CORNERS, CDPREP_ASK_CONTACTS}) {
        EXPECT_EQ(cdprep_model_serves(model, ask, &error), CDPREP_BAD_ARGUMENT);
        EXPECT_EQ(error.why, CDPREP_WHY_NOT_BAKED);
        EXPECT_NE(std::string(error.message).find("window"), std::string::npos);
    }
    EXPECT_EQ(cdprep_model_prefetch(model, CDPREP_ASK_DISTANCE, nullptr), CDPREP_OK);
    const std::uint32_t none = 0;
    cdprep_corners corners{};
    EXPECT_EQ(cdprep_model_corners(model, &none, 1, &corners, &error), CDPREP_BAD_ARGUMENT);
    cdprep_model_info info{};
    ASSERT_EQ(cdprep_model_describe(model, &info, nullptr), CDPREP_OK);
    EXPECT_EQ(info.balanced, std::uint32_t{CDPREP_NO});
    cdprep_model_close(const_cast<cdprep_model*>(model));
    EXPECT_EQ(cdprep_model_serves(cdprep_window_model(window_), CDPREP_ASK_TOUCH, nullptr),
              CDPREP_OK);
}

// By hand: a box around all of a small model, whose leaves hold its corners or not.
TEST_F(CWindow, IsDescribedByItsTriangles) {
    for (const double scale : {1.0, 0.1}) {
        const AlignedBytes file = windowed_file(moved_by(unit_cube(), scale, {}));
        const CModel cube(file);
        const cdprep_pair pair = pair_of(cube.get(), probe_.get(), {});
        cdprep_window_info filled{};
        ASSERT_EQ(cdprep_window_fill(window_, &pair, 10, &filled, nullptr), CDPREP_OK);
        cdprep_model_info info{}, of_all{};
        ASSERT_EQ(cdprep_model_describe(cdprep_window_model(window_), &info, nullptr), CDPREP_OK);
        ASSERT_EQ(cdprep_model_describe(cube.get(), &of_all, nullptr), CDPREP_OK);
        EXPECT_EQ(info.triangles, 12U);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            EXPECT_EQ(info.lower[axis], of_all.lower[axis]);
            EXPECT_EQ(info.upper[axis], of_all.upper[axis]);
        }
    }
}

TEST_F(CWindow, OptionsAreCheckedFieldByField) {
    using O = cdprep_window_options;
    static const cdprep_allocator none = {nullptr, nullptr, nullptr};
    std::vector<Mistake<O>> all = struct_mistakes<O>("options");
    all.push_back({"no leaves", [](O& o) { o.max_leaves = 0; }, CDPREP_WHY_OUT_OF_RANGE,
                   "options.max_leaves"});
    all.push_back({"many leaves", [](O& o) { o.max_leaves = UINT32_MAX; }, CDPREP_WHY_OUT_OF_RANGE,
                   "options.max_leaves"});
    all.push_back(
        {"reserved", [](O& o) { o.reserved = 1; }, CDPREP_WHY_NEWER_FIELD, "options.reserved"});
    all.push_back(
        {"no functions", [](O& o) { o.allocator = &none; }, CDPREP_WHY_NULL, "options.allocator"});
    expect_refused(window_options(5), all, [&](const O* given) -> Outcome {
        cdprep_error error;
        std::size_t size = 77;
        const int sized = cdprep_window_size(given, &size, &error);
        const Outcome result{sized, error.why, error.argument, size == 0};
        auto* made = reinterpret_cast<cdprep_window*>(1);
        EXPECT_EQ(cdprep_window_make(given, nullptr, 0, &made, &error), sized);
        EXPECT_EQ(made == nullptr, sized != CDPREP_OK);
        cdprep_window_end(made);
        return result;
    });
}

TEST_F(CWindow, MemoryIsChecked) {
    cdprep_error error;
    cdprep_window_options options = window_options(7);
    std::size_t size = 0;
    ASSERT_EQ(cdprep_window_size(&options, &size, nullptr), CDPREP_OK);
    AlignedBytes memory(size + 64);
    std::byte* const start = memory.span().data();
    cdprep_window* made = nullptr;
    const auto why = [&](void* at, std::size_t room) {
        made = window_;
        (void)cdprep_window_make(&options, at, room, &made, &error);
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
    cdprep_window_end(made);
    EXPECT_EQ(blocks.given, 1u);
    EXPECT_EQ(blocks.taken, 1u);
    options.allocator = nullptr;
    EXPECT_EQ(why(start, size), 0);
    cdprep_window_end(made);
}

// Gaps below the range of normal doubles: no mode traps them or takes them for 0.
TEST_F(CWindow, FloatModesChangeNothing) {
    const TestMesh cube = moved_by(unit_cube(), 0x1p-1050, {});
    const AlignedBytes file = bake_tiny(cube.positions, cube.triangles, {.double_precision = true});
    const CModel speck(file);
    const cdprep_pair of_all = pair_of(speck.get(), speck.get(), {0x1p-1048, 0, 0});
    const cdprep_pair pair = pair_of(cdprep_window_model(window_), speck.get(), {0x1p-1048, 0, 0});
    struct Answers {
        cdprep_bounded whole, near;
        cdprep_window_info held;
        double margin;
    };
    const auto ask = [&](const FloatMode& mode) {
        Answers answers{};
        (void)run_in(mode, [&] {
            cdprep_workspace* const workspace = workspace_.get();
            (void)cdprep_distance_bounded(&of_all, nullptr, 0, workspace, &answers.whole, nullptr);
            (void)cdprep_window_fill(window_, &of_all, 0x1p-1040, &answers.held, nullptr);
            (void)cdprep_window_margin(&pair, &answers.margin, nullptr);
            (void)cdprep_window_distance(&pair, nullptr, 0, workspace, &answers.near, nullptr);
        });
        return answers;
    };
    const Answers expected = ask(float_modes()[0]);
    EXPECT_GT(expected.whole.lower, 0);
    EXPECT_LT(expected.whole.lower, std::numeric_limits<double>::min());
    EXPECT_EQ(expected.whole.nearest.triangle_a, expected.near.nearest.triangle_a);
    EXPECT_EQ(expected.held.leaves, 2U);
    for (const FloatMode& mode : float_modes()) {
        const Answers answers = ask(mode);
        EXPECT_EQ(std::memcmp(&answers, &expected, sizeof answers), 0) << mode.name;
    }
}

TEST_F(CWindow, ArgumentsAreChecked) {
    fill({1, 0, 0.45}, 0.1);
    cdprep_error error;
    const auto expect = [&](int code, int why, const char* argument) {
        EXPECT_EQ(code, CDPREP_BAD_ARGUMENT);
        EXPECT_EQ(error.why, why) << argument;
        EXPECT_STREQ(error.argument, argument);
    };
    const cdprep_pair of_all = whole({1, 0, 0.45}), pair = near({1, 0, 0.45});
    cdprep_pair mine = pair_of(all_.get(), cdprep_window_model(window_), {});
    cdprep_window_info info{};
    expect(cdprep_window_fill(nullptr, &of_all, 1, &info, &error), CDPREP_WHY_NULL, "window");
    expect(cdprep_window_fill(window_, nullptr, 1, &info, &error), CDPREP_WHY_NULL, "pair");
    expect(cdprep_window_fill(window_, &of_all, 1, nullptr, &error), CDPREP_WHY_NULL, "info");
    expect(cdprep_window_fill(window_, &pair, 1, &info, &error), CDPREP_WHY_OUT_OF_RANGE, "pair.a");
    expect(cdprep_window_fill(window_, &mine, 1, &info, &error), CDPREP_WHY_OUT_OF_RANGE, "pair.b");
    expect(cdprep_window_fill(window_, &of_all, -1, &info, &error), CDPREP_WHY_OUT_OF_RANGE,
           "radius");
    expect(cdprep_window_fill(window_, &of_all, kNan, &info, &error), CDPREP_WHY_NOT_FINITE,
           "radius");
    EXPECT_EQ(info.leaves, 0U);
    cdprep_pair solid = of_all;
    solid.body = CDPREP_SOLID;
    expect(cdprep_window_fill(window_, &solid, 1, &info, &error), CDPREP_WHY_NO_MEANING,
           "pair.body");
    double margin = 7;
    expect(cdprep_window_margin(nullptr, &margin, &error), CDPREP_WHY_NULL, "pair");
    EXPECT_EQ(margin, 0);
    expect(cdprep_window_margin(&pair, nullptr, &error), CDPREP_WHY_NULL, "margin");
    expect(cdprep_window_margin(&of_all, &margin, &error), CDPREP_WHY_OUT_OF_RANGE, "pair.a");
    cdprep_bounded found{};
    cdprep_workspace* const workspace = workspace_.get();
    expect(cdprep_window_distance(nullptr, nullptr, 0, workspace, &found, &error), CDPREP_WHY_NULL,
           "pair");
    EXPECT_EQ(found.complete, std::uint32_t{CDPREP_UNKNOWN});
    expect(cdprep_window_distance(&pair, nullptr, 0, nullptr, &found, &error), CDPREP_WHY_NULL,
           "workspace");
    expect(cdprep_window_distance(&pair, nullptr, 0, workspace, nullptr, &error), CDPREP_WHY_NULL,
           "bounded");
    expect(cdprep_window_distance(&of_all, nullptr, 0, workspace, &found, &error),
           CDPREP_WHY_OUT_OF_RANGE, "pair.a");
    cdprep_pair through = of_all;
    through.through = CDPREP_THROUGH_PIECES;
    expect(cdprep_distance_bounded(&through, nullptr, 0, workspace, &found, &error),
           CDPREP_WHY_NO_MEANING, "pair.through");
    expect(cdprep_distance_bounded(&of_all, nullptr, 0, workspace, nullptr, &error),
           CDPREP_WHY_NULL, "bounded");
    cdprep_distance_options options;
    cdprep_distance_options_init(&options, sizeof options);
    options.max_distance = kNan;
    expect(cdprep_distance_bounded(&of_all, &options, 0, workspace, &found, &error),
           CDPREP_WHY_NOT_FINITE, "options.max_distance");
    // A refused fill left the window as it was.
    EXPECT_EQ(cdprep_window_margin(&pair, &margin, &error), CDPREP_OK);
    EXPECT_GT(margin, 0.09);
    EXPECT_EQ(cdprep_window_model(nullptr), nullptr);
    cdprep_window_end(nullptr);
}

}  // namespace
}  // namespace cdprep::test
