// SPDX-License-Identifier: MIT
// Models that are built from arrays through the C API, beside bakes of the same arrays.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "cdprep/cdprep.h"
#include "support/aligned_heap.h"
#include "support/c_lanes.h"
#include "support/c_models.h"
#include "support/c_questions.h"
#include "support/float_modes.h"
#include "support/meshes.h"
#include "support/tiny_baker.h"

namespace cdprep::test {
namespace {

constexpr std::uint32_t kBuildable = CDPREP_ASK_COLLIDE | CDPREP_ASK_OVERLAP | CDPREP_ASK_DISTANCE |
                                     CDPREP_ASK_WITHIN | CDPREP_ASK_INSIDE | CDPREP_ASK_RAY |
                                     CDPREP_ASK_CLOSEST | CDPREP_ASK_TOUCH | CDPREP_ASK_CORNERS |
                                     CDPREP_ASK_SOLID | CDPREP_ASK_CONTINUOUS | CDPREP_ASK_SELF |
                                     CDPREP_ASK_DEFORM | CDPREP_ASK_TEAR | CDPREP_ASK_HAPTIC;

/// All that a model holds: equal models have equal bytes.
std::string contents(const cdprep_model* model) {
    std::string bytes;
    cdprep_model_info info{};
    EXPECT_EQ(cdprep_model_describe(model, &info, nullptr), CDPREP_OK);
    detail::append(bytes, info);
    for (std::uint32_t section = 0; section < 64; ++section) {
        cdprep_array array{};
        if (cdprep_model_section(model, section, &array, nullptr) != CDPREP_OK) continue;
        detail::append(bytes, section);
        detail::append(bytes, array.count);
        bytes.append(static_cast<const char*>(array.data), array.count * array.stride);
    }
    return bytes;
}

/// Meshes of every kind: solid and open, of several components, degenerate, empty.
std::vector<TestMesh> meshes() {
    TestMesh flat = unit_cube(), unused = icosphere(2);
    for (Double3& p : flat.positions) p.z = 0;
    unused.positions.insert(unused.positions.begin(), {9, 9, 9});
    for (Triangle& triangle : unused.triangles) {
        for (std::uint32_t& vertex : triangle.vertex) ++vertex;
    }
    return {unit_cube(),
            icosphere(3),
            joined(unit_cube(), moved_by(unit_cube(), 0.25, {0.375, 0.375, 0.375})),
            upper_half(icosphere(3)),
            coarse_grid_soup(3, 100, 2),
            copies_of_one_triangle(9),
            flat,
            unused,
            TestMesh{}};
}

// The law: what a build serves is answered as by a bake, and all else is refused.
TEST(CBuild, EveryQuestionGetsTheAnswerOfABakeOrIsRefused) {
    const CWorkspace workspace;
    std::size_t answered = 0, refused = 0;
    for (const TestMesh& mesh : meshes()) {
        const AlignedBytes file =
            bake_tiny(mesh.positions, mesh.triangles, {.double_precision = true});
        const CModel baked(file);
        const CBuilt built(build_options_of(mesh), workspace.get());
        cdprep_model_info info{};
        ASSERT_EQ(cdprep_model_describe(built.get(), &info, nullptr), CDPREP_OK);
        EXPECT_EQ(info.serves, kBuildable);
        EXPECT_EQ(info.triangles, mesh.triangles.size());
        EXPECT_EQ(info.stores_f64, std::uint32_t{CDPREP_YES});
        for (const CQuestion& question : c_questions()) {
            const CAnswer answer = question.ask({built.get(), built.get(), 0.5, workspace.get()});
            const CAnswer expected = question.ask({baked.get(), baked.get(), 0.5, workspace.get()});
            EXPECT_EQ(answer.code, expected.code) << question.name;
            EXPECT_EQ(answer.why, expected.why) << question.name;
            EXPECT_TRUE(answer.bytes == expected.bytes) << question.name;
            if ((question.needs & ~kBuildable) != 0) {
                EXPECT_EQ(answer.why, CDPREP_WHY_NOT_BAKED) << question.name;
                EXPECT_TRUE(answer.is_unknown) << question.name;
            }
            (answer.code == CDPREP_OK ? answered : refused) += 1;
        }
    }
    EXPECT_GT(answered, 9u * 20u);
    EXPECT_GT(refused, 9u * 15u);
}

// Answers have the numbers of the arrays: of the vertices, and of the triangles.
TEST(CBuild, AnswersHaveTheNumbersOfTheArrays) {
    const CWorkspace workspace;
    for (const TestMesh& mesh : meshes()) {
        const CBuilt built(build_options_of(mesh), workspace.get());
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
            cdprep_corners corners{};
            ASSERT_EQ(cdprep_model_corners(built.get(), &i, 1, &corners, nullptr), CDPREP_OK);
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t vertex = mesh.triangles[i].vertex[k];
                EXPECT_EQ(corners.vertex[k], vertex);
                EXPECT_EQ(corners.point[k][0], mesh.positions[vertex].x);
                EXPECT_EQ(corners.point[k][2], mesh.positions[vertex].z);
            }
        }
    }
}

// The law of lanes. A ball of 20,480 triangles is work for several.
TEST(CBuild, LanesAndMemoryChangeNoByte) {
    const TestMesh ball = icosphere(5);
    const cdprep_build_options options = build_options_of(ball);
    const CWorkspace one;
    CLanes four(4), many(256);
    const std::string expected = contents(CBuilt(options, one.get()).get());
    EXPECT_GT(expected.size(), 20480u * 60u);
    EXPECT_TRUE(contents(CBuilt(options, four.get()).get()) == expected);
    EXPECT_GT(four.threads.calls, 5u);
    EXPECT_EQ(four.threads.most, 4u) << "no more tasks than lanes";
    EXPECT_TRUE(contents(CBuilt(options, many.get()).get()) == expected);
    std::size_t size = 0;
    ASSERT_EQ(cdprep_model_build_size(&options, &size, nullptr), CDPREP_OK);
    AlignedBytes memory(size);
    cdprep_model* built = nullptr;
    for (const unsigned char before : {0x00, 0xff}) {
        std::memset(memory.span().data(), before, size);
        ASSERT_EQ(
            cdprep_model_build(&options, memory.span().data(), size, four.get(), &built, nullptr),
            CDPREP_OK);
        EXPECT_TRUE(contents(built) == expected);
        cdprep_model_close(built);
    }
}

// The same law, whatever the caller's threads do.
TEST(CBuild, TasksThatAreLeftOutOrRepeatedChangeNothing) {
    const TestMesh ball = icosphere(4);
    const CLanes lanes(3, run_badly);
    const CWorkspace one;
    const cdprep_build_options options = build_options_of(ball);
    EXPECT_TRUE(contents(CBuilt(options, lanes.get()).get()) ==
                contents(CBuilt(options, one.get()).get()));
}

// The same law, whatever mode the caller's threads are in. A trap would end the test.
TEST(CBuild, NoFloatingPointEnvironmentChangesAByte) {
    TestMesh ball = turned(icosphere(3), 0.7);
    const CWorkspace workspace;
    const CLanes lanes(2);
    for (const std::uint32_t precision : {CDPREP_AS_GIVEN, CDPREP_SINGLE}) {
        cdprep_build_options options = build_options_of(ball);
        options.precision = precision;
        const std::string expected = contents(CBuilt(options, workspace.get()).get());
        for (const FloatMode& mode : float_modes()) {
            for (cdprep_workspace* const scratch : {workspace.get(), lanes.get()}) {
                cdprep_model* built = nullptr;
                const std::uint64_t left = run_in(mode, [&] {
                    (void)cdprep_model_build(&options, nullptr, 0, scratch, &built, nullptr);
                });
                ASSERT_NE(built, nullptr) << mode.name;
                EXPECT_EQ(left, control_bits(mode.control)) << mode.name;
                EXPECT_TRUE(contents(built) == expected) << mode.name;
                cdprep_model_close(built);
            }
        }
    }
}

std::vector<float> numbers_of(const TestMesh& mesh) {
    std::vector<float> floats;
    for (const Double3& p : mesh.positions) {
        for (const double x : {p.x, p.y, p.z}) floats.push_back(static_cast<float>(x));
    }
    return floats;
}

// Rounding to floats is what the caller would have done.
TEST(CBuild, FloatsAndRoundedDoublesMakeOneModel) {
    const TestMesh mesh = turned(icosphere(3), 0.7);
    const std::vector<float> floats = numbers_of(mesh);
    const CWorkspace workspace;
    cdprep_build_options options = build_options_of(mesh);
    const CBuilt doubles(options, workspace.get());
    options.precision = CDPREP_SINGLE;
    const CBuilt rounded(options, workspace.get());
    options.positions = nullptr;
    options.positions_f32 = floats.data();
    const CBuilt kept(options, workspace.get());
    options.precision = CDPREP_AS_GIVEN;
    const CBuilt given(options, workspace.get());
    EXPECT_TRUE(contents(rounded.get()) == contents(kept.get()));
    EXPECT_TRUE(contents(given.get()) == contents(kept.get()));
    EXPECT_FALSE(contents(doubles.get()) == contents(kept.get()));
    cdprep_model_info info{};
    ASSERT_EQ(cdprep_model_describe(kept.get(), &info, nullptr), CDPREP_OK);
    EXPECT_EQ(info.stores_f64, std::uint32_t{CDPREP_NO});
}

/// An allocator that counts, for one block at a time.
struct OneBlock {
    std::size_t given = 0;
    std::size_t taken = 0;
    std::size_t bytes = 0;

    static void* give(void* blocks, std::size_t size, std::size_t alignment) {
        auto* const self = static_cast<OneBlock*>(blocks);
        ++self->given;
        self->bytes = size;
        return test::aligned_heap(size, alignment);
    }
    static void take(void* blocks, void* memory, std::size_t size) {
        auto* const self = static_cast<OneBlock*>(blocks);
        ++self->taken;
        EXPECT_EQ(size, self->bytes);
        test::free_aligned(memory);
    }
};

// One block, of no more than what is said to be enough, for any mesh.
TEST(CBuild, TheSizeIsEnoughForAnyMesh) {
    const CWorkspace workspace;
    std::vector<TestMesh> all = meshes();
    for (int count = 1; count < 70; ++count) all.push_back(random_soup(7, count, 0.3));
    for (const TestMesh& mesh : all) {
        for (const std::uint32_t ask : {0, int{CDPREP_ASK_COLLIDE}, int{CDPREP_ASK_RAY}}) {
            for (const std::uint32_t precision : {CDPREP_AS_GIVEN, CDPREP_SINGLE}) {
                cdprep_build_options options = build_options_of(mesh);
                OneBlock blocks;
                const cdprep_allocator allocator = {OneBlock::give, OneBlock::take, &blocks};
                options.ask = ask;
                options.precision = precision;
                options.allocator = &allocator;
                std::size_t size = 0;
                ASSERT_EQ(cdprep_model_build_size(&options, &size, nullptr), CDPREP_OK);
                EXPECT_EQ(blocks.given, 0u);
                { const CBuilt built(options, workspace.get()); }
                EXPECT_EQ(blocks.given, 1u);
                EXPECT_EQ(blocks.taken, 1u);
                EXPECT_LE(blocks.bytes, size);
                options.allocator = nullptr;
                // Of exactly that size: a sanitizer sees one byte too many.
                AlignedBytes memory(size);
                cdprep_model* built = nullptr;
                cdprep_error error;
                ASSERT_EQ(cdprep_model_build(&options, memory.span().data(), size, workspace.get(),
                                             &built, &error),
                          CDPREP_OK)
                    << error.message;
                cdprep_model_close(built);
            }
        }
    }
}

// Written by hand: triangles that share no vertex, one of them a point. It is the worst mesh.
TEST(CBuild, TheWorstMeshTakesAllOfTheSize) {
    TestMesh worst = random_soup(1, 100, 0.3);
    for (std::size_t i = 297; i < 300; ++i) worst.positions[i] = {1, 2, 3};
    cdprep_build_options options = build_options_of(worst);
    OneBlock blocks;
    const cdprep_allocator allocator = {OneBlock::give, OneBlock::take, &blocks};
    options.allocator = &allocator;
    std::size_t size = 0;
    ASSERT_EQ(cdprep_model_build_size(&options, &size, nullptr), CDPREP_OK);
    const CWorkspace workspace;
    { const CBuilt built(options, workspace.get()); }
    EXPECT_EQ(blocks.bytes, size);
}

// The arrays and the options may go, and the block may be used again once the model is closed.
TEST(CBuild, AModelNeedsItsMemoryAlone) {
    const CWorkspace workspace;
    TestMesh mesh = icosphere(3);
    cdprep_build_options options = build_options_of(mesh);
    std::size_t size = 0;
    ASSERT_EQ(cdprep_model_build_size(&options, &size, nullptr), CDPREP_OK);
    AlignedBytes memory(size);
    const std::string expected = contents(CBuilt(options, workspace.get()).get());
    for (int round = 0; round < 3; ++round) {
        TestMesh copy = mesh;
        cdprep_build_options other = build_options_of(copy);
        cdprep_model* built = nullptr;
        ASSERT_EQ(cdprep_model_build(&other, memory.span().data(), size, workspace.get(), &built,
                                     nullptr),
                  CDPREP_OK);
        std::ranges::fill(copy.positions, Double3{7, 7, 7});
        std::ranges::fill(copy.triangles, Triangle{{7, 7, 7}});
        std::memset(static_cast<void*>(&other), 0xcd, sizeof other);
        EXPECT_TRUE(contents(built) == expected);
        cdprep_model_close(built);
    }
}

// Whatever a build can serve may be asked for alone.
TEST(CBuild, EachQueryCanBeBuiltFor) {
    const TestMesh mesh = icosphere(1);
    const CWorkspace workspace;
    for (std::uint32_t ask = 1; ask != 0; ask <<= 1) {
        if ((kBuildable & ask) == 0) continue;
        cdprep_build_options options = build_options_of(mesh);
        options.ask = ask;
        const CBuilt built(options, workspace.get());
        EXPECT_EQ(cdprep_model_serves(built.get(), ask, nullptr), CDPREP_OK) << ask;
    }
}

// A build that is asked for one thing has the sections of that alone.
TEST(CBuild, WhatIsNotAskedForIsNotBuilt) {
    const TestMesh mesh = icosphere(3);
    const CWorkspace workspace;
    cdprep_build_options options = build_options_of(mesh);
    std::size_t all = 0, rays = 0;
    ASSERT_EQ(cdprep_model_build_size(&options, &all, nullptr), CDPREP_OK);
    options.ask = CDPREP_ASK_RAY;
    ASSERT_EQ(cdprep_model_build_size(&options, &rays, nullptr), CDPREP_OK);
    EXPECT_LT(rays, all / 2);
    const CBuilt built(options, workspace.get());
    cdprep_error error;
    EXPECT_EQ(cdprep_model_serves(built.get(), CDPREP_ASK_RAY, &error), CDPREP_OK);
    EXPECT_EQ(cdprep_model_serves(built.get(), CDPREP_ASK_COLLIDE, &error), CDPREP_BAD_ARGUMENT);
    EXPECT_EQ(error.why, CDPREP_WHY_NOT_BAKED);
    EXPECT_TRUE(
        std::string(error.message).starts_with("built model: collide needs section bvh_leaves"))
        << error.message;
}

}  // namespace
}  // namespace cdprep::test
