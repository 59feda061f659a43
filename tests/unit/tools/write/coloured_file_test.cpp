// SPDX-License-Identifier: GPL-3.0-or-later
#include "write/coloured_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <vector>

#include "import/import_file.h"
#include "support/meshes.h"
#include "support/scratch_folder.h"

namespace cdprep::write {
namespace {

using std::string_literals::operator""s;

const std::vector<Shade> kShades = {{"free", {200, 200, 200}}, {"hidden", {255, 0, 51}}};

std::string text_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// The cube with triangles 3 and 7 hidden.
struct Cube {
    test::TestMesh mesh = test::unit_cube();
    std::vector<std::uint8_t> shade_of = std::vector<std::uint8_t>(mesh.triangles.size());
    Cube() {
        shade_of[3] = shade_of[7] = 1;
    }
    [[nodiscard]] MeshArrays arrays() const {
        return {mesh.positions, mesh.triangles, true};
    }
};

TEST(ColouredFile, PlyGivesEachFaceItsColour) {
    const test::ScratchFolder folder;
    const auto path = folder.path() / "cube.ply";
    const Cube cube;
    ASSERT_TRUE(write_coloured_mesh(path, cube.arrays(), kShades, cube.shade_of));
    const std::string text = text_of(path);
    const std::size_t body = text.find("end_header\n") + 11;
    EXPECT_NE(text.find("property list uchar int vertex_indices\nproperty uchar red\n"),
              std::string::npos);
    constexpr std::size_t kVertex = 12;
    constexpr std::size_t kFace = 16;
    ASSERT_EQ(text.size(), body + 8 * kVertex + 12 * kFace);
    for (std::size_t i = 0; i < 12; ++i) {
        const std::size_t red = body + 8 * kVertex + i * kFace + 13;
        EXPECT_EQ(text.substr(red, 3), i == 3 || i == 7 ? "\xff\0\x33"s : "\xc8\xc8\xc8"s) << i;
    }
    const auto read = import::import_file(path, {});
    ASSERT_TRUE(read);
    EXPECT_EQ(read.value().triangles, cube.mesh.triangles);
    EXPECT_EQ(read.value().positions, cube.mesh.positions);
}

TEST(ColouredFile, ObjNamesMaterials) {
    const test::ScratchFolder folder;
    const Cube cube;
    ASSERT_TRUE(
        write_coloured_mesh(folder.path() / "cube.obj", cube.arrays(), kShades, cube.shade_of));
    EXPECT_EQ(text_of(folder.path() / "cube.mtl"),
              "# written by cdprep\nnewmtl free\nKd 0.78431374 0.78431374 0.78431374\nnewmtl "
              "hidden\nKd 1 0 0.2\n");
    const std::string text = text_of(folder.path() / "cube.obj");
    EXPECT_EQ(text.substr(0, 16), "mtllib cube.mtl\n");
    const auto read = import::import_file(folder.path() / "cube.obj", {});
    ASSERT_TRUE(read);
    EXPECT_EQ(read.value().triangles.size(), 12U);
    EXPECT_EQ(read.value().materials.names, (std::vector<std::string>{"free", "hidden"}));
    EXPECT_EQ(read.value().materials.runs[1].triangle_count, 2U);
}

// No argument names the file of the materials.
TEST(ColouredFile, MaterialsOfOthersStay) {
    const test::ScratchFolder folder;
    const Cube cube;
    const auto write = [&] {
        return write_coloured_mesh(folder.path() / "cube.obj", cube.arrays(), kShades,
                                   cube.shade_of);
    };
    ASSERT_TRUE(write());
    ASSERT_TRUE(write()) << "its own file is replaced";
    std::filesystem::remove(folder.path() / "cube.obj");
    std::ofstream(folder.path() / "cube.mtl") << "newmtl stone\n";
    const Result<Done> again = write();
    ASSERT_FALSE(again);
    EXPECT_EQ(again.error().code, ErrorCode::bad_argument);
    EXPECT_EQ(text_of(folder.path() / "cube.mtl"), "newmtl stone\n");
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "cube.obj"));
}

TEST(ColouredFile, PointsHaveTheirColours) {
    const test::ScratchFolder folder;
    const std::vector<format::Double3> points = {{0.5, 1, -2}, {0.1, 0, 0}};
    const std::vector<std::uint8_t> shade_of = {1, 0};
    ASSERT_TRUE(write_coloured_points(folder.path() / "p.obj", points, kShades, shade_of));
    EXPECT_EQ(text_of(folder.path() / "p.obj"),
              "v 0.5 1 -2 1 0 0.2\np 1\nv 0.1 0 0 0.78431374 0.78431374 0.78431374\np 2\n");
    ASSERT_TRUE(write_coloured_points(folder.path() / "p.ply", points, kShades, shade_of));
    const std::string text = text_of(folder.path() / "p.ply");
    EXPECT_EQ(text.find("element face"), std::string::npos);
    EXPECT_EQ(text.size(), text.find("end_header\n") + 11 + 2 * (24 + 3));
}

TEST(ColouredFile, OtherFormatsAreRefused) {
    const test::ScratchFolder folder;
    const Cube cube;
    const auto refused =
        write_coloured_mesh(folder.path() / "cube.stl", cube.arrays(), kShades, cube.shade_of);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::bad_argument);
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "cube.stl"));
}

}  // namespace
}  // namespace cdprep::write
