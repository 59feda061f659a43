// SPDX-License-Identifier: MIT
// samples/game.c, whose main() is sample_game_main() here.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "cdprep/cdprep.h"
#include "support/counted_memory.h"
#include "support/meshes.h"
#include "support/more_sections.h"
#include "support/scratch_folder.h"
#include "support/tiny_baker.h"

namespace cdprep::test {
namespace {

std::atomic<std::size_t> allocations = 0;  // else the compiler knows that malloc() leaves it alone
std::size_t at_first_step = 0;
std::size_t at_end = 0;
int steps = 0;

std::string write_model(const ScratchFolder& folder, const char* name, const TestMesh& mesh) {
    const AlignedBytes file =
        with_contacts(with_one_piece(bake_tiny(mesh.positions, mesh.triangles)));
    const std::string path = (folder.path() / name).string();
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(file.span().data()),
               static_cast<std::streamsize>(file.size()));
    return path;
}

}  // namespace
}  // namespace cdprep::test

// The linker sends the calls of every object to these (--wrap).
extern "C" {
// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming)
int sample_game_main(int argc, char** argv);
void* __real_malloc(std::size_t size);
void* __real_calloc(std::size_t count, std::size_t size);
void* __real_realloc(void* memory, std::size_t size);
int __real_cdprep_scene_step(cdprep_scene* scene, cdprep_workspace* workspace, cdprep_step* step,
                             cdprep_error* error);
void __real_cdprep_scene_end(cdprep_scene* scene);

void* __wrap_malloc(std::size_t size) {
    ++cdprep::test::allocations;
    return __real_malloc(size);
}
void* __wrap_calloc(std::size_t count, std::size_t size) {
    ++cdprep::test::allocations;
    return __real_calloc(count, size);
}
void* __wrap_realloc(void* memory, std::size_t size) {
    ++cdprep::test::allocations;
    return __real_realloc(memory, size);
}
#ifndef _WIN32  // CMakeLists.txt says why
void* __real_aligned_alloc(std::size_t alignment, std::size_t size);
int __real_posix_memalign(void** memory, std::size_t alignment, std::size_t size);
void* __wrap_aligned_alloc(std::size_t alignment, std::size_t size) {
    ++cdprep::test::allocations;
    return __real_aligned_alloc(alignment, size);
}
int __wrap_posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
    ++cdprep::test::allocations;
    return __real_posix_memalign(memory, alignment, size);
}
#endif
int __wrap_cdprep_scene_step(cdprep_scene* scene, cdprep_workspace* workspace, cdprep_step* step,
                             cdprep_error* error) {
    if (cdprep::test::steps++ == 0) cdprep::test::at_first_step = cdprep::test::allocations;
    return __real_cdprep_scene_step(scene, workspace, step, error);
}
void __wrap_cdprep_scene_end(cdprep_scene* scene) {
    cdprep::test::at_end = cdprep::test::allocations;
    __real_cdprep_scene_end(scene);
}
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)
}

namespace cdprep::test {
namespace {

// By hand: a cube of side 1 comes to rest on the level, whose top is z = 0, and another on the
// first. Between two frames a body falls by 1 / 3600 of 9.81, 0.003, and is pushed back.
TEST(CGame, BodiesComeToRestAndNothingAllocatesAfterLoading) {
    const ScratchFolder folder;
    std::string level = write_model(folder, "level.cdp.h5", moved_by(unit_cube(), 4, {-2, -2, -4}));
    std::string body = write_model(folder, "body.cdp.h5", unit_cube());
    std::string name = "sample_game";
    std::array<char*, 4> arguments = {name.data(), level.data(), body.data(), body.data()};
    testing::internal::CaptureStdout();
    const int code = sample_game_main(4, arguments.data());
    std::fflush(stdout);
    const std::string output = testing::internal::GetCapturedStdout();
    EXPECT_EQ(code, 0);
    EXPECT_EQ(steps, 120);
    EXPECT_EQ(at_end - at_first_step, 0U);

    const std::size_t last = output.find("frame 119: ");
    ASSERT_NE(last, std::string::npos) << output;
    unsigned contacts = 0, lines = 0;
    double first = 1, second = 0;
    ASSERT_EQ(
        std::sscanf(output.c_str() + last, "frame 119: %u contacts, %u lines, heights %lf %lf",
                    &contacts, &lines, &first, &second),
        4)
        << output;
    EXPECT_GE(contacts, 2U);
    EXPECT_GE(lines, 24U);  // of two pairs of faces
    EXPECT_NEAR(first, 0, 0.01);
    EXPECT_NEAR(second, 1, 0.01);
}

// The counter sees what the test must not miss.
TEST(CGame, AllocationsAreCounted) {
    const std::size_t before = allocations;
    static void* volatile seen = nullptr;  // else the compiler leaves both out
    seen = std::malloc(10);
    std::free(seen);
    seen = new int(3);
    delete static_cast<int*>(seen);
    EXPECT_EQ(allocations - before, 2U);
}

TEST(CGame, AFileThatIsNotThereIsNamed) {
    std::string name = "sample_game", file = "nothing.cdp.h5";
    std::array<char*, 4> arguments = {name.data(), file.data(), file.data(), file.data()};
    testing::internal::CaptureStderr();
    EXPECT_EQ(sample_game_main(4, arguments.data()), CDPREP_UNREADABLE);
    EXPECT_EQ(testing::internal::GetCapturedStderr(),
              "nothing.cdp.h5 cannot be read into the arena.\n");
}

}  // namespace
}  // namespace cdprep::test
