// SPDX-License-Identifier: MIT
#include "write/mesh_file.h"

#include <gtest/gtest.h>

#include <cmath>

#include "import/import_file.h"
#include "support/meshes.h"
#include "support/scratch_folder.h"

namespace cdprep::write {
namespace {

/// Numbers that need all their digits, subnormals and powers of two among them.
test::TestMesh hard_numbers(bool single) {
    test::TestMesh mesh = test::random_soup(7, 50, 0.3);
    mesh.positions[0] = {std::ldexp(1, -140), -std::ldexp(1, 100), 0.1};
    mesh.positions[1] = {1.0 / 3, -0.0, 123456789.125};
    return single ? test::in_floats(std::move(mesh)) : mesh;
}

void expect_reads_back(const char* name, MeshFormat format, bool single) {
    const test::ScratchFolder folder;
    const auto path = folder.path() / name;
    const test::TestMesh mesh = hard_numbers(single);
    ASSERT_TRUE(write_mesh_file(path, format, {mesh.positions, mesh.triangles, single}).ok());
    const auto soup = import::import_file(path);
    ASSERT_TRUE(soup.ok()) << soup.error().message;
    EXPECT_EQ(soup.value().positions, mesh.positions) << name;
    EXPECT_EQ(soup.value().triangles, mesh.triangles) << name;
    EXPECT_EQ(soup.value().single_precision, single) << name;
}

TEST(MeshFile, EveryBitIsReadBack) {
    for (const bool single : {false, true}) {
        expect_reads_back("mesh.obj", MeshFormat::obj, single);
        expect_reads_back("mesh.ply", MeshFormat::ply, single);
        expect_reads_back("mesh.off", MeshFormat::off, single);
    }
}

TEST(MeshFile, StlHoldsFloatsAndRefusesOthers) {
    const test::ScratchFolder folder;
    const test::TestMesh cube = test::unit_cube();
    const auto path = folder.path() / "cube.stl";
    ASSERT_TRUE(write_mesh_file(path, MeshFormat::stl, {cube.positions, cube.triangles, true}));
    const auto soup = import::import_file(path);
    ASSERT_TRUE(soup.ok());
    EXPECT_EQ(soup.value().triangles.size(), 12U);
    const auto refused = write_mesh_file(folder.path() / "other.stl", MeshFormat::stl,
                                         {cube.positions, cube.triangles, false});
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::bad_argument);
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "other.stl"));
}

TEST(MeshFile, TheExtensionNamesTheFormat) {
    EXPECT_EQ(mesh_format_of("a.OBJ"), MeshFormat::obj);
    EXPECT_EQ(mesh_format_of("a.b.ply"), MeshFormat::ply);
    EXPECT_EQ(mesh_format_of("a.glb"), std::nullopt);
}

}  // namespace
}  // namespace cdprep::write
