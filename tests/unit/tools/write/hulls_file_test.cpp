// SPDX-License-Identifier: MIT
#include "write/hulls_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "support/scratch_folder.h"
#include "unit/tools/image_sections.h"

namespace cdprep::write {
namespace {

using format::Double3;

constexpr std::array<Double3, 4> kCorners = {{{0, 0, 0}, {1, 0, 0}, {0, 0.1, 0}, {0, 0, -1e-7}}};
constexpr std::array<std::array<std::uint32_t, 3>, 4> kFacets = {
    {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}};
constexpr std::array<std::array<std::uint32_t, 3>, 2> kBothSides = {{{0, 1, 2}, {0, 2, 1}}};

/// A tetrahedron and a triangle.
std::vector<HullArrays> solid_and_flat() {
    return {{"solid", kCorners, kFacets, 3}, {"flat", std::span(kCorners).first(3), kBothSides, 2}};
}

std::size_t count(const std::string& text, const std::string& word) {
    std::size_t found = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
        ++found;
    }
    return found;
}

TEST(HullsFile, FormatsAreTheirExtensionsInAnyCase) {
    EXPECT_EQ(hulls_format_of("a.OBJ"), HullsFormat::obj);
    EXPECT_EQ(hulls_format_of("a.b.Glb"), HullsFormat::glb);
    EXPECT_EQ(hulls_format_of("a.xml"), HullsFormat::mjcf);
    EXPECT_EQ(hulls_format_of("a.mjcf"), HullsFormat::mjcf);
    EXPECT_EQ(hulls_format_of("a.urdf"), HullsFormat::urdf);
    EXPECT_EQ(hulls_format_of("a.sdf"), HullsFormat::sdf);
    EXPECT_FALSE(hulls_format_of("obj"));
    EXPECT_FALSE(hulls_format_of("a.stl"));
}

// Read back as doubles, coordinates are the same to the last bit.
TEST(HullsFile, AnObjHasEveryBit) {
    const test::ScratchFolder folder;
    const auto path = folder.path() / "x.obj";
    ASSERT_EQ(write_hulls(path, HullsFormat::obj, solid_and_flat())->left_out, 0U);
    std::istringstream lines(test::content_of(path.string()));
    std::vector<Double3> points;
    std::size_t facets = 0;
    for (std::string word; lines >> word;) {
        Double3 p;
        if (word == "v" && lines >> p.x >> p.y >> p.z) points.push_back(p);
        facets += word == "f" ? 1 : 0;
    }
    ASSERT_EQ(points.size(), 7U);
    EXPECT_EQ(facets, 6U);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Double3& wanted = kCorners[i % 4];
        EXPECT_TRUE(points[i].x == wanted.x && points[i].y == wanted.y && points[i].z == wanted.z);
    }
}

// A reader for volumes gets no flat hull, and the caller is told how many were left out.
TEST(HullsFile, FlatHullsAreLeftOutWhereAVolumeIsWanted) {
    const test::ScratchFolder folder;
    for (const HullsFormat format : {HullsFormat::urdf, HullsFormat::sdf, HullsFormat::mjcf}) {
        const auto path = folder.path() / "x.xml";
        ASSERT_EQ(write_hulls(path, format, solid_and_flat())->left_out, 1U);
        const std::string text = test::content_of(path.string());
        EXPECT_EQ(count(text, "flat"), 0U);
        EXPECT_GE(count(text, "solid"), 1U);
        EXPECT_EQ(count(text, "inertia"), 0U);
        EXPECT_EQ(count(text, "visual"), 0U);
    }
}

// glTF requires points, and so does every reader of an object.
TEST(HullsFile, HullsWithoutPointsAreLeftOut) {
    const test::ScratchFolder folder;
    std::vector<HullArrays> hulls = solid_and_flat();
    hulls.push_back({"nothing", {}, {}, -1});
    hulls.push_back({"empty", {}, {}, 3});
    for (const HullsFormat format : {HullsFormat::obj, HullsFormat::glb, HullsFormat::urdf,
                                     HullsFormat::sdf, HullsFormat::mjcf}) {
        const auto path = folder.path() / "x.xml";
        const Result<WrittenHulls> written = write_hulls(path, format, hulls);
        ASSERT_TRUE(written);
        EXPECT_EQ(written->left_out, has_mass(format) ? 3U : 2U);
        const std::string text = test::content_of(path.string());
        EXPECT_EQ(count(text, "nothing") + count(text, "empty"), 0U);
    }
    EXPECT_TRUE(
        write_hulls(folder.path() / "x.glb", HullsFormat::glb, {}, {.visual = MeshArrays{}}));
}

// Its chunks fill the file, begin at multiples of 4, and bounds are those of the floats.
TEST(HullsFile, AGlbIsAsLongAsItSays) {
    const test::ScratchFolder folder;
    const auto path = folder.path() / "x.glb";
    ASSERT_EQ(write_hulls(path, HullsFormat::glb, solid_and_flat())->left_out, 0U);
    const std::string bytes = test::content_of(path.string());
    const auto word = [&](std::size_t at) {
        std::uint32_t value = 0;
        std::memcpy(&value, bytes.data() + at, sizeof value);
        return value;
    };
    ASSERT_GE(bytes.size(), 28U);
    EXPECT_EQ(bytes.substr(0, 4), "glTF");
    EXPECT_EQ(word(4), 2U);
    EXPECT_EQ(word(8), bytes.size());
    const std::size_t json = word(12);
    EXPECT_EQ(json % 4, 0U);
    // 7 points of 3 floats, 6 facets of 3 numbers.
    ASSERT_EQ(word(20 + json), 7U * 12 + 6U * 12);
    EXPECT_EQ(28 + json + word(20 + json), bytes.size());
    EXPECT_EQ(count(bytes.substr(20, json), "\"name\":\"flat\""), 2U);
    EXPECT_EQ(count(bytes.substr(20, json), "\"min\":[0.0,0.0,-1.0000000116860974e-07]"), 1U);
}

constexpr std::array<format::Triangle, 1> kShown = {{{{0, 1, 2}}}};

/// Options that show a triangle of the first three corners.
HullsFileOptions showing() {
    HullsFileOptions options;
    options.visual = MeshArrays{std::span(kCorners).first(3), kShown, false};
    return options;
}

// An infinite corner is none: no reader takes it, and JSON has no number for its bounds.
TEST(HullsFile, AGlbHasNoCoordinateBeyondTheFloats) {
    const test::ScratchFolder folder;
    const auto path = folder.path() / "x.glb";
    constexpr double kMost = std::numeric_limits<float>::max();
    const auto written_with = [&](double x, const HullsFileOptions& options) {
        std::vector<Double3> corners(kCorners.begin(), kCorners.begin() + 4);
        corners[1].x = x;
        const std::vector<HullArrays> hulls = {{"large", corners, kFacets, 3}};
        return write_hulls(path, HullsFormat::glb, hulls, options);
    };
    EXPECT_TRUE(written_with(kMost, {}).ok());
    const auto refused = written_with(-1e160, {});
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::bad_argument);
    EXPECT_NE(refused.error().message.find("a coordinate is 1e+160 in size"), std::string::npos);
    const std::array<Double3, 3> shown = {{{0, 0, 0}, {1, 0, 0}, {0, 0x1p128, 0}}};
    HullsFileOptions options;
    options.visual = MeshArrays{shown, kShown, false};
    EXPECT_FALSE(written_with(1, options).ok());
}

/// The document of a GLB.
nlohmann::json document_of(const std::string& bytes) {
    std::uint32_t size = 0;
    std::memcpy(&size, bytes.data() + 12, sizeof size);
    return nlohmann::json::parse(bytes.substr(20, size));
}

// The shown mesh is the first node, and the hulls are below a node of their own.
TEST(HullsFile, AGlbShowsTheMeshBesideTheHulls) {
    const test::ScratchFolder folder;
    const auto path = folder.path() / "bolt.glb";
    HullsFileOptions options = showing();
    ASSERT_TRUE(write_hulls(path, HullsFormat::glb, solid_and_flat(), options).ok());
    nlohmann::json document = document_of(test::content_of(path.string()));
    EXPECT_EQ(document["scenes"][0]["nodes"], nlohmann::json({0, 1, 2}));
    EXPECT_EQ(document["nodes"][0]["name"], "bolt");
    EXPECT_EQ(document["nodes"][1]["name"], "solid");
    EXPECT_EQ(document["accessors"][0]["count"], 3);
    EXPECT_EQ(document["accessors"][1]["count"], 3);
    EXPECT_FALSE(document["meshes"][0]["primitives"][0].contains("mode"));

    options.hulls_node = "colliders";
    ASSERT_TRUE(write_hulls(path, HullsFormat::glb, solid_and_flat(), options).ok());
    document = document_of(test::content_of(path.string()));
    EXPECT_EQ(document["scenes"][0]["nodes"], nlohmann::json({0, 3}));
    EXPECT_EQ(document["nodes"][3]["name"], "colliders");
    EXPECT_EQ(document["nodes"][3]["children"], nlohmann::json({1, 2}));
    EXPECT_FALSE(document["nodes"][3].contains("mesh"));
}

// PhysX drops points by an absolute height from hulls smaller than 1, and Unity cooks the stored
// mesh.
TEST(HullsFile, SmallHullsMayBeStoredLarger) {
    const test::ScratchFolder folder;
    const auto path = folder.path() / "bolt.glb";
    HullsFileOptions options;
    options.stores_hulls_large = true;
    for (const double size : {1e-9, 0.034, 0.49, 0.51, 0.7, 1.01, 40.0}) {
        // Half the sum of the sides of this tetrahedron is its size.
        const double side = 2 * size / 3;
        const std::array<Double3, 4> corners = {
            {{0, 0, 0}, {side, 0, 0}, {0, side, 0}, {0, 0, side}}};
        const std::array<HullArrays, 1> hulls = {{{"solid", corners, kFacets, 3}}};
        ASSERT_TRUE(write_hulls(path, HullsFormat::glb, hulls, options).ok());
        const nlohmann::json document = document_of(test::content_of(path.string()));
        const nlohmann::json& node = document["nodes"][0];
        const double scale = node.contains("scale") ? node["scale"][0].get<double>() : 1;
        const double stored = document["accessors"][0]["max"][0].get<double>();
        EXPECT_EQ(static_cast<float>(scale * stored), static_cast<float>(side)) << size;
        EXPECT_EQ(std::exp2(std::round(std::log2(scale))), scale) << "no power of two";
        EXPECT_GE(1.5 * stored, 0.999999) << size;
        EXPECT_EQ(node.contains("scale"), size < 0.99) << size;
        if (size > 0.99) continue;
        EXPECT_LT(1.5 * stored, 2) << size;
        EXPECT_EQ(node["scale"], nlohmann::json({scale, scale, scale}));
    }
    // A node above them does not scale them.
    const std::array<Double3, 4> corners = {{{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}, {0, 0, 0.01}}};
    const std::array<HullArrays, 1> small = {{{"small", corners, kFacets, 3}}};
    options.stores_hulls_large = false;
    options.hulls_node = "colliders";
    ASSERT_TRUE(write_hulls(path, HullsFormat::glb, small, options).ok());
    const nlohmann::json document = document_of(test::content_of(path.string()));
    ASSERT_FALSE(document["nodes"].empty());
    for (const auto& node : document["nodes"]) {
        EXPECT_FALSE(node.contains("scale"));
    }
}

TEST(HullsFile, AnMjcfShowsTheMeshAndFloats) {
    const test::ScratchFolder folder;
    const auto path = folder.path() / "bolt.xml";
    HullsFileOptions options;
    ASSERT_TRUE(write_hulls(path, HullsFormat::mjcf, solid_and_flat(), options).ok());
    std::string text = test::content_of(path.string());
    EXPECT_EQ(count(text, "freejoint"), 0U);
    EXPECT_EQ(count(text, "contype"), 0U);
    EXPECT_EQ(count(text, "group"), 0U);
    EXPECT_EQ(folder.names().size(), 1U);

    options = showing();
    options.is_floating = true;
    ASSERT_TRUE(write_hulls(path, HullsFormat::mjcf, solid_and_flat(), options).ok());
    text = test::content_of(path.string());
    EXPECT_EQ(count(text, "<freejoint />"), 1U);
    EXPECT_EQ(count(text, R"(file="bolt_visual.obj")"), 1U);
    EXPECT_EQ(count(text, R"(contype="0" conaffinity="0" group="2" mass="0")"), 1U);
    EXPECT_EQ(count(text, R"(group="3")"), 1U);
    EXPECT_EQ(folder.names(), (std::set<std::string>{"bolt.xml", "bolt_visual.obj"}));
}

// The folder in place of the last file cannot be replaced: no other file appears.
TEST(HullsFile, AllFilesAppearOrNone) {
    const test::ScratchFolder folder;
    std::filesystem::create_directory(folder.path() / "x.urdf");
    const auto done =
        write_hulls(folder.path() / "x.urdf", HullsFormat::urdf, solid_and_flat(), showing());
    ASSERT_FALSE(done.ok());
    EXPECT_EQ(done.error().code, ErrorCode::unwritable);
    EXPECT_EQ(folder.names(), (std::set<std::string>{"x.urdf"}));
}

// Floats are 8 apart at 1e8: an edge of 2 would vanish or become 8 long.
TEST(HullsFile, AGlbFarFromTheOriginIsRefused) {
    const test::ScratchFolder folder;
    const auto path = folder.path() / "x.glb";
    const auto written_at = [&](double x) {
        std::vector<Double3> corners(kCorners.begin(), kCorners.end());
        for (Double3& p : corners) p.x = 2 * p.x + x;
        const std::vector<HullArrays> hulls = {{"far", corners, kFacets, 3}};
        return write_hulls(path, HullsFormat::glb, hulls);
    };
    const auto refused = written_at(1e8 + 3);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::bad_argument);
    EXPECT_NE(refused.error().message.find("would move a corner by 3"), std::string::npos)
        << refused.error().message;
    EXPECT_FALSE(std::filesystem::exists(path));
    // Here floats are 2^-10 apart.
    const auto near = written_at(1e4 + 0x1p-12);
    ASSERT_TRUE(near.ok());
    EXPECT_GE(near->rounding, 0x1p-12);
    EXPECT_LE(near->rounding, 0x1p-11);
}

TEST(HullsFile, OnlyAGlbRounds) {
    const test::ScratchFolder folder;
    for (const char* name : {"x.obj", "x.urdf", "x.sdf", "x.xml"}) {
        const auto path = folder.path() / name;
        EXPECT_EQ(write_hulls(path, *hulls_format_of(path), solid_and_flat())->rounding, 0) << name;
    }
    const auto written = write_hulls(folder.path() / "x.glb", HullsFormat::glb, solid_and_flat());
    const double moved = std::fabs(0.1 - static_cast<double>(0.1F));
    EXPECT_GE(written->rounding, moved);
    EXPECT_LE(written->rounding, 1.001 * moved);
}

// The source of a robot is often named LINK_visual.obj.
TEST(HullsFile, AMeshFileOfAnotherProgramStays) {
    const test::ScratchFolder folder;
    for (const char* name : {"x.urdf", "x.sdf", "x.xml"}) {
        const auto path = folder.path() / name;
        const auto format = *hulls_format_of(path);
        ASSERT_TRUE(write_hulls(path, format, solid_and_flat(), showing()).ok());
        EXPECT_TRUE(write_hulls(path, format, solid_and_flat(), showing()).ok()) << "replaced";
        const std::string visual = folder.file("x_visual.obj");
        std::ofstream(visual) << "v 0 0 0\n";
        const auto refused = write_hulls(path, format, solid_and_flat(), showing());
        ASSERT_FALSE(refused.ok());
        EXPECT_EQ(refused.error().code, ErrorCode::bad_argument);
        EXPECT_NE(refused.error().message.find(
                      "x_visual.obj: would be replaced, but does not begin with '# written by "
                      "cdprep': another program or an older cdprep wrote it. "),
                  std::string::npos)
            << refused.error().message;
        EXPECT_EQ(test::content_of(visual), "v 0 0 0\n");
        EXPECT_EQ(find_foreign_mesh(path, format, "visual").has_value(), has_mesh_files(format));
        std::filesystem::remove(visual);
    }
}

// Names of meshes need no escape, and no two files of a folder share them.
TEST(HullsFile, MeshesAreNamedPlainly) {
    const test::ScratchFolder folder;
    std::vector<std::string> names;
    for (const char* stem : {"a b", "a_b", "a&b", "a\"b"}) {
        const auto path = folder.path() / (std::string(stem) + ".urdf");
        ASSERT_TRUE(write_hulls(path, HullsFormat::urdf, solid_and_flat()).ok());
        const std::string text = test::content_of(path.string());
        const std::size_t at = text.find("filename=\"") + 10;
        const std::string name = text.substr(at, text.find('"', at) - at);
        EXPECT_TRUE(std::filesystem::exists(folder.path() / name)) << name;
        EXPECT_EQ(std::count(names.begin(), names.end(), name), 0) << name;
        EXPECT_TRUE(may_replace(path, HullsFormat::urdf, folder.path() / name));
        EXPECT_FALSE(may_replace(path, HullsFormat::obj, folder.path() / name));
        EXPECT_FALSE(may_replace(path, HullsFormat::sdf, folder.path() / "other.obj"));
        names.push_back(name);
    }
}

TEST(HullsFile, NothingIsWrittenWhereThereIsNoFolder) {
    const test::ScratchFolder folder;
    for (const char* name : {"x.obj", "x.glb", "x.urdf", "x.sdf", "x.mjcf"}) {
        const auto path = folder.path() / "none" / name;
        const auto done = write_hulls(path, *hulls_format_of(path), solid_and_flat());
        ASSERT_FALSE(done.ok());
        EXPECT_EQ(done.error().code, ErrorCode::unwritable);
    }
}

// A body is what it is told to be: numbers stand where each format has them.
TEST(HullsFile, MassStandsInEveryFormatThatHasIt) {
    const test::ScratchFolder folder;
    HullsFileOptions options;
    options.mass = BodyMass{7, {1, 2, 3}, {11, 22, 33, 12, 23, 31}};
    const auto text_of = [&](HullsFormat format) {
        const auto path = folder.path() / "m.xml";
        EXPECT_TRUE(write_hulls(path, format, solid_and_flat(), options).ok());
        return test::content_of(path.string());
    };
    EXPECT_EQ(count(text_of(HullsFormat::urdf),
                    R"(ixx="11" ixy="12" ixz="31" iyy="22" iyz="23" izz="33")"),
              1U);
    EXPECT_EQ(count(text_of(HullsFormat::sdf), "<ixz>31</ixz>"), 1U);
    EXPECT_EQ(count(text_of(HullsFormat::sdf), "<iyy>22</iyy>"), 1U);
    EXPECT_EQ(count(text_of(HullsFormat::mjcf), R"(fullinertia="11 22 33 12 31 23")"), 1U);
}

}  // namespace
}  // namespace cdprep::write
