// SPDX-License-Identifier: MIT
#include "import/import_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cdprep/format/checksum.h"
#include "support/scratch_folder.h"
#include "support/shared_models.h"

namespace cdprep::import {
namespace {

using mesh::BadNumber;
using mesh::TriangleSoup;

class ImportFile : public testing::Test {
protected:
    std::filesystem::path write(const std::string& name, const std::string& bytes) const {
        return scratch_.write(name, bytes);
    }

    const test::ScratchFolder scratch_;
};

const std::string kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const std::string kOff = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const std::string kStl =
    "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
    "endfacet\nendsolid\n";
const std::string kPly =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

void expect_one_triangle(const Result<TriangleSoup>& result, const std::string& name) {
    ASSERT_TRUE(result.ok()) << name << ": " << result.error().message;
    EXPECT_EQ(result.value().triangles.size(), 1u) << name;
    EXPECT_EQ(result.value().positions.size(), 3u) << name;
}

TEST_F(ImportFile, TheContentDecidesWhereTheEndingIsUnknown) {
    for (const std::string& content : {kObj, kOff, kStl, kPly}) {
        for (const char* name : {"a.txt", "a", "a.dat", ".obj"}) {
            expect_one_triangle(import_file(write(name, content)), name);
        }
    }
}

TEST_F(ImportFile, AByteOrderMarkHidesNoFormat) {
    for (const std::string& content : {kObj, kOff, kStl, kPly}) {
        for (const char* name : {"a.txt", "a"}) {
            expect_one_triangle(import_file(write(name, "\xef\xbb\xbf" + content)), name);
        }
    }
}

TEST_F(ImportFile, AKnownEndingWinsOverContentThatIsNoFormatsOwn) {
    expect_one_triangle(import_file(write("a.OBJ", kObj)), "a.OBJ");
    for (const std::string& content : {kOff, kStl}) {
        const auto result = import_file(write("a.obj", content));
        ASSERT_FALSE(result.ok());
        EXPECT_EQ(result.error().code, ErrorCode::unreadable);
    }
    expect_one_triangle(import_file(write("a.obj", kPly)), "a PLY named a.obj");
    // Its first line, a lone v, is OBJ too.
    const auto nff = import_file(
        write("a.nff",
              "v\nfrom 0 3 10\nat 0 0 0\nup 0 1 0\nangle 60\nhither 0\nresolution 64 48\n"
              "f 1 1 1 .8 .8 20 0 1\np 4\n-7 -1 -7\n-7 -1 7\n7 -1 7\n7 -1 -7\n"));
    ASSERT_TRUE(nff.ok()) << nff.error().message;
    EXPECT_EQ(nff->triangles.size(), 2u);
}

TEST_F(ImportFile, WithoutATriangleNothingIsReadUnlessAllowed) {
    const std::filesystem::path points = write("points.obj", "v 0 0 0\nv 1 0 0\n");
    const auto refused = import_file(points);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::unreadable);
    EXPECT_NE(refused.error().message.find("no triangles, only 2 vertices"), std::string::npos)
        << refused.error().message;
    ImportOptions options;
    options.allow_empty = true;
    const auto accepted = import_file(points, options);
    ASSERT_TRUE(accepted.ok());
    EXPECT_EQ(accepted->positions.size(), 2u);
}

TEST_F(ImportFile, SaysWhatAFileIsThatIsNoMesh) {
    const std::map<std::string, std::string> said_of = {
        {"version https://git-lfs.github.com/spec/v1\noid sha256:1\n", "Git LFS"},
        {"\n <!doctype HTML><html></html>", "web page"},
        {"<HTML><body/></HTML>", "web page"},
        {std::string(4096, 'x') + "\x89HDF\r\n\x1a\n", "baked model"},
        {"#usda 1.0\n", "USD"},
        {"#VRML V2.0 utf8\n", "VRML"}};
    for (const auto& [content, said] : said_of) {
        for (const char* name : {"a.obj", "a.stl", "a.gltf", "a"}) {
            const auto result = import_file(write(name, content));
            ASSERT_FALSE(result.ok()) << name;
            EXPECT_NE(result.error().message.find(said), std::string::npos)
                << result.error().message;
        }
    }
    const auto usd = import_file(write("a.usdz", "PK rubbish"));
    ASSERT_FALSE(usd.ok());
    EXPECT_NE(usd.error().message.find("USD"), std::string::npos) << usd.error().message;
}

TEST_F(ImportFile, UnitAndUpAxisAreThoseGiven) {
    ImportOptions options;
    options.metres_per_unit = 0.001;
    options.up_axis = format::UpAxis::z;
    const std::filesystem::path path = write("a.obj", kObj);
    const auto given = import_file(path, options);
    const auto unknown = import_file(path);
    ASSERT_TRUE(given.ok() && unknown.ok());
    EXPECT_EQ(given->metres_per_unit, 0.001);
    EXPECT_EQ(given->up_axis, format::UpAxis::z);
    EXPECT_EQ(given->positions, unknown->positions);
    EXPECT_EQ(unknown->metres_per_unit, 0);
    EXPECT_EQ(unknown->up_axis, format::UpAxis::unknown);
}

TEST_F(ImportFile, TheSourceHashIsThatOfTheBytes) {
    const auto first = import_file(write("a.obj", kObj));
    const auto second = import_file(write("b.obj", kObj + "\n"));
    ASSERT_TRUE(first.ok() && second.ok());
    EXPECT_EQ(first->source_hash,
              format::checksum(std::as_bytes(std::span(kObj.data(), kObj.size()))));
    EXPECT_NE(second->source_hash, first->source_hash);
    EXPECT_TRUE(first->other_files.empty());
}

TEST_F(ImportFile, WhatIsNoReadableFileIsOneSentence) {
    const auto missing = import_file(scratch_.path() / "none.obj");
    ASSERT_FALSE(missing.ok());
    EXPECT_EQ(missing.error().code, ErrorCode::unreadable);
    EXPECT_EQ(missing.error().message, (scratch_.path() / "none.obj").string() +
                                           ": cannot be opened: No such file or directory.");
    EXPECT_FALSE(import_file(scratch_.path()).ok());
    EXPECT_FALSE(import_file(write("empty.obj", "")).ok());
    ASSERT_EQ(::mkfifo((scratch_.path() / "pipe.obj").c_str(), 0600), 0);
    EXPECT_FALSE(import_file(scratch_.path() / "pipe.obj").ok());
}

TEST_F(ImportFile, AFileThatIsTooLargeIsOverBudget) {
    ImportOptions options;
    options.file_bytes = kObj.size();
    EXPECT_TRUE(import_file(write("a.obj", kObj), options).ok());
    options.file_bytes = kObj.size() - 1;
    const auto result = import_file(write("a.obj", kObj), options);
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().code, ErrorCode::over_budget);
}

TEST_F(ImportFile, BinaryRubbishInATextFormatIsUnreadable) {
    std::string rubbish;
    for (int i = 0; i < 5000; ++i) rubbish += static_cast<char>(i * 7919 >> 3);
    for (const char* name : {"a.obj", "a.off", "a.stl", "a.ply", "a.glb", "a.fbx"}) {
        const auto result = import_file(write(name, rubbish));
        ASSERT_FALSE(result.ok()) << name;
        EXPECT_EQ(result.error().code, ErrorCode::unreadable) << name;
    }
}

// ------------------------------------------------- the models that are not ours

std::optional<std::filesystem::path> hard_models() {
    const auto folder = test::shared_models("hard");
    if (!folder) return std::nullopt;
    return *folder / "hard";
}

/// Triangles of each file, from the tables of PROVENANCE.md.
std::map<std::string, std::size_t> measured_triangles(const std::filesystem::path& folder) {
    std::map<std::string, std::size_t> result;
    std::ifstream table(folder / "PROVENANCE.md");
    for (std::string line; std::getline(table, line);) {
        std::vector<std::string> cells;
        for (std::size_t at = 0; (at = line.find('|', at)) != std::string::npos;) {
            const std::size_t end = line.find('|', at + 1);
            if (end == std::string::npos) break;
            cells.push_back(line.substr(at + 1, end - at - 1));
            at = end;
        }
        if (cells.size() < 5) continue;
        std::string name;
        std::string digits;
        for (const char c : cells[0]) name += c == ' ' ? std::string() : std::string(1, c);
        for (const char c : cells[4]) digits += c >= '0' && c <= '9' ? std::string(1, c) : "";
        if (!digits.empty()) result[name] = std::stoul(digits);
    }
    return result;
}

TEST(HardModels, HaveTheTrianglesThatWereMeasured) {
    const auto folder = hard_models();
    if (!folder) GTEST_SKIP() << "no test models beside the checkout (set CDPREP_SHARED)";
    const auto measured = measured_triangles(*folder);
    int read = 0;
    for (const auto& entry : std::filesystem::directory_iterator(*folder)) {
        const std::string name = entry.path().filename();
        if (!entry.is_regular_file() || !measured.contains(name)) continue;
        const auto result = import_file(entry.path());
        ASSERT_TRUE(result.ok()) << result.error().message;
        EXPECT_EQ(result.value().triangles.size(), measured.at(name)) << name;
        EXPECT_EQ(result.value().bad_number_count, 0u) << name;
        ++read;
    }
    EXPECT_EQ(read, 30);
}

TEST(HardModels, ScenesKeepTheirInstances) {
    const auto folder = hard_models();
    if (!folder) GTEST_SKIP() << "no test models beside the checkout (set CDPREP_SHARED)";
    struct Expected {
        const char* name;
        std::size_t nodes;  // that use a mesh
        std::size_t mirrored;
        double metres_per_unit;
        format::UpAxis up_axis;
    };
    for (const Expected& e :
         {Expected{"2CylinderEngine.glb", 67, 0, 1, format::UpAxis::y},
          Expected{"boolean.glb", 28, 0, 1, format::UpAxis::y},
          Expected{"anims_with_full_rotations_between_keys.DAE", 64, 0, 1, format::UpAxis::z},
          Expected{"illformated_mesh.dae", 3, 0, 1, format::UpAxis::z},
          Expected{"cubes_with_mirroring_and_pivot.fbx", 4, 2, 1, format::UpAxis::y}}) {
        const auto result = import_file(*folder / e.name);
        ASSERT_TRUE(result.ok()) << result.error().message;
        const TriangleSoup& s = result.value();
        EXPECT_EQ(s.instance_names.size(), e.nodes) << e.name;
        std::size_t mirrored = 0;
        std::uint32_t next = 0;
        for (const format::Instance& instance : s.instances) {
            EXPECT_EQ(instance.first_triangle, next);
            next += instance.triangle_count;
            mirrored += (instance.flags & format::instance_mirrored) != 0;
        }
        EXPECT_EQ(next, s.triangles.size());
        EXPECT_EQ(mirrored, e.mirrored) << e.name;
        EXPECT_EQ(s.metres_per_unit, e.metres_per_unit) << e.name;
        EXPECT_EQ(s.up_axis, e.up_axis) << e.name;
    }
}

TEST(HardModels, MalformedFilesGiveWhatTheyHoldOrOneSentence) {
    const auto folder = hard_models();
    if (!folder) GTEST_SKIP() << "no test models beside the checkout (set CDPREP_SHARED)";
    const auto measured = measured_triangles(*folder);
    struct Expected {
        const char* name;
        std::uint64_t not_finite;
        std::uint64_t out_of_range;
    };
    for (const Expected& e :
         {Expected{"AllIndicesOutOfRange.gltf", 0, 12}, Expected{"BoxWithInfinites.glb", 24, 0},
          Expected{"IndexOutOfRange.gltf", 0, 1}, Expected{"malformed.obj", 0, 3},
          Expected{"concave_polygon.obj", 0, 0}, Expected{"degtri_sliding.off", 0, 0},
          Expected{"fuze_ascii.ply", 0, 0}, Expected{"regr_3429812.obj", 0, 0},
          Expected{"soup.stl", 0, 0}, Expected{"wallhole.obj", 0, 0},
          Expected{"whitespace.off", 0, 0}}) {
        const auto result = import_file(*folder / "malformed" / e.name);
        ASSERT_TRUE(result.ok()) << result.error().message;
        const TriangleSoup& s = result.value();
        EXPECT_EQ(s.triangles.size(), measured.at(std::string("malformed/") + e.name)) << e.name;
        std::uint64_t not_finite = 0;
        for (const BadNumber& bad : s.bad_numbers) {
            not_finite += bad.kind == BadNumber::Kind::not_finite;
        }
        EXPECT_EQ(not_finite, e.not_finite) << e.name;
        EXPECT_EQ(s.bad_number_count - not_finite, e.out_of_range) << e.name;
    }
    for (const char* name : {"OutOfMemory.off", "RecursiveNodes.gltf"}) {
        const auto result = import_file(*folder / "malformed" / name);
        ASSERT_FALSE(result.ok()) << name;
        EXPECT_EQ(result.error().code, ErrorCode::unreadable);
        EXPECT_NE(result.error().message.find(name), std::string::npos);
        EXPECT_EQ(result.error().message.back(), '.');
    }
}

}  // namespace
}  // namespace cdprep::import
