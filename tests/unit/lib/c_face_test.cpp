// SPDX-License-Identifier: MIT
#include "c_face.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <fstream>

#include "cdprep/cdprep.h"
#include "cdprep/collide.h"
#include "support/meshes.h"
#include "support/more_sections.h"
#include "support/run_threads.h"
#include "support/scratch_folder.h"
#include "support/tiny_baker.h"

namespace cdprep::test {
namespace {

TEST(CFace, AProgramInC99GetsTheAnswers) {
    const TestMesh cube = unit_cube();
    const AlignedBytes file = bake_tiny(cube.positions, cube.triangles);
    const ScratchFolder folder;
    const std::filesystem::path path = folder.path() / "cube.cdp.h5";
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(file.span().data()),
               static_cast<std::streamsize>(file.size()));
    const char* wrong = ask_everything(file.span().data(), file.size(), path.c_str());
    EXPECT_EQ(wrong, nullptr) << wrong;
}

// Written by hand: what C reads must be what was stored.
TEST(CFace, ReadsWhatWasFoundWhenAModelWasBaked) {
    const format::Verdict stored{
        format::verdict_closed, format::promise_simple_solid, 2, 0, 3, -4, 5, 0, 6.5, 7.5};
    const std::array<std::uint32_t, 2> from = {7, format::kMadeByRepair};
    const auto verdict = std::as_bytes(std::span(&stored, 1));
    const auto numbers = std::as_bytes(std::span(from));
    format::FileHeader facts{};
    facts.triangle_count = 2;
    const AlignedBytes file =
        assemble(facts, {{SectionId::verdicts, {verdict.begin(), verdict.end()}},
                         {SectionId::repaired_from, {numbers.begin(), numbers.end()}}});
    cdprep_model* model = nullptr;
    ASSERT_EQ(cdprep_open_memory(file.span().data(), file.size(), "two", &model, nullptr), 0);
    cdprep_verdict read{};
    ASSERT_EQ(cdprep_verdict_count(model), 1u);
    EXPECT_EQ(cdprep_read_verdict(model, 1, &read), 0);
    EXPECT_EQ(cdprep_read_verdict(model, 0, nullptr), 0);
    ASSERT_EQ(cdprep_read_verdict(model, 0, &read), 1);
    EXPECT_EQ(read.promises, static_cast<std::uint32_t>(CDPREP_PROMISE_SIMPLE_SOLID));
    EXPECT_EQ(read.euler, -4);
    EXPECT_EQ(read.volume, 7.5);
    EXPECT_EQ(cdprep_repaired_from(model)[1], UINT32_MAX);
    cdprep_close(model);
}

/// A thread for every task, as a C program has them; counts the tasks.
void run_on_threads(void* tasks, std::size_t count, cdprep_task task, const void* work) {
    *static_cast<std::size_t*>(tasks) += count;
    run_threads(count, [&](std::size_t i) { task(work, i); });
}

TEST(CFace, ManyThreadsGetTheAnswersOfOne) {
    const TestMesh ball = icosphere(4), ring = torus(0.3, 0.1, 120, 60);
    const AlignedBytes a = bake_tiny(ball.positions, ball.triangles);
    const AlignedBytes b = bake_tiny(ring.positions, ring.triangles);
    std::size_t tasks = 0;
    const cdprep_parallel_for threads = {sizeof threads, run_on_threads, &tasks};
    const char* wrong = ask_many(a.span().data(), a.size(), b.span().data(), b.size(), &threads);
    EXPECT_EQ(wrong, nullptr) << wrong;
    EXPECT_GT(tasks, 8u * 7u);
}

TEST(CFace, HullsOfACubeAreAsFarApartAsItIsMoved) {
    const TestMesh cube = unit_cube();
    const AlignedBytes file = with_hulls(bake_tiny(cube.positions, cube.triangles));
    const char* wrong = ask_hulls(file.span().data(), file.size());
    EXPECT_EQ(wrong, nullptr) << wrong;
}

// By hand: faces, edges and corners of cubes of side 1.
TEST(CFace, ContactsOfCubesAreWhereTheyAreMoved) {
    const TestMesh cube = unit_cube();
    const AlignedBytes file =
        with_contacts(with_one_piece(bake_tiny(cube.positions, cube.triangles)));
    AlignedBytes memory(cdprep_workspace_size());
    const char* wrong =
        ask_contacts(file.span().data(), file.size(), memory.span().data(), memory.size());
    EXPECT_EQ(wrong, nullptr) << wrong;
}

TEST(Workspace, MayLiveInTheCallersMemory) {
    const TestMesh cube = unit_cube();
    const AlignedBytes file = bake_tiny(cube.positions, cube.triangles);
    const auto model = Model::open(file.span());
    ASSERT_TRUE(model);
    AlignedBytes memory(Workspace::size());
    ASSERT_EQ(reinterpret_cast<std::uintptr_t>(memory.span().data()) % Workspace::alignment(), 0u);
    EXPECT_FALSE(Workspace::in(memory.span().first(Workspace::size() - 1)));
    EXPECT_FALSE(Workspace::in(memory.span().subspan(1)));
    auto workspace = Workspace::in(memory.span());
    ASSERT_TRUE(workspace);
    const Placement still = Placement::b_moves(Pose());
    EXPECT_TRUE(collide(model.value(), model.value(), still, *workspace).hit);
}

}  // namespace
}  // namespace cdprep::test
