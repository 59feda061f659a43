// SPDX-License-Identifier: MIT
#include "c_face.h"

#include <gtest/gtest.h>

#include <fstream>

#include "cdprep/collide.h"
#include "support/meshes.h"
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
