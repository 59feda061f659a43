// SPDX-License-Identifier: MIT
#include "import/readers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "unit/tools/read_text.h"

namespace cdprep::import {
namespace {

using mesh::BadNumber;
using mesh::Double3;
using mesh::Triangle;
using mesh::TriangleSoup;

constexpr test::TextReader kStlReader(read_stl, "t.stl");

/// A binary file; triangle i has the corners (i, 0, 0), (0, 1, 0), (0, 0, 1).
std::string binary(std::uint32_t claimed, std::uint32_t written, std::string header = "") {
    header.resize(80, ' ');
    std::string bytes = header;
    bytes.append(reinterpret_cast<const char*>(&claimed), 4);
    for (std::uint32_t i = 0; i < written; ++i) {
        const float x[12] = {9, 9, 9, static_cast<float>(i), 0, 0, 0, 1, 0, 0, 0, 1};
        bytes.append(reinterpret_cast<const char*>(x), sizeof x);
        bytes.append("\x7f\x7f");
    }
    return bytes;
}

const std::string kFacet =
    " facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1e0 0 0\n"
    "   vertex 0 1.5 0\n  endloop\n endfacet\n";
const std::vector<Double3> kCorners = {{0, 0, 0}, {1, 0, 0}, {0, 1.5, 0}};

TEST(ReadStl, BinaryTrianglesHaveThreeVerticesEach) {
    const TriangleSoup s = kStlReader.soup(binary(2, 2));
    EXPECT_EQ(s.positions, (std::vector<Double3>{
                               {0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
    EXPECT_EQ(s.triangles, (std::vector<Triangle>{{{0, 1, 2}}, {{3, 4, 5}}}));
    EXPECT_TRUE(s.single_precision);
    EXPECT_TRUE(s.groups.runs.empty());
}

TEST(ReadStl, ABinaryFileMayBeginWithSolid) {
    EXPECT_EQ(kStlReader.soup(binary(3, 3, "solid facet normal")).triangles.size(), 3u);
}

TEST(ReadStl, ManyBinaryTrianglesComeInAnyOrderOfBlocks) {
    const auto last_first = [](std::size_t count, Task task) {
        for (std::size_t i = count; i-- > 0;) task(i);
    };
    ImportOptions backwards;
    backwards.parallel_for = last_first;
    const auto result = kStlReader.read(binary(50'000, 50'000), backwards);
    ASSERT_TRUE(result.ok());
    for (std::uint32_t i = 0; i < 50'000; ++i) {
        ASSERT_EQ(result.value().positions[3 * i].x, i);
        ASSERT_EQ(result.value().triangles[i], (Triangle{{3 * i, 3 * i + 1, 3 * i + 2}}));
    }
}

TEST(ReadStl, ABinaryCountThatDisagreesWithTheLengthIsUnreadable) {
    EXPECT_EQ(
        kStlReader.refusal(binary(4, 3)),
        "t.stl: the header declares 4 triangles, which take 284 bytes, but the file has 234.");
    EXPECT_EQ(
        kStlReader.refusal(binary(2, 3)),
        "t.stl: the header declares 2 triangles, which take 184 bytes, but the file has 234.");
    EXPECT_EQ(kStlReader.refusal(binary(0xffffffff, 1)),
              "t.stl: the header declares 4294967295 triangles, which take 214748364834 bytes, but "
              "the file has 134.");
}

// Three positions of doubles and a triangle each: 84 bytes.
TEST(ReadStl, MemoryMayBeAllThatIsAllowed) {
    ImportOptions options;
    options.memory_bytes = std::size_t{84} * 5;
    EXPECT_TRUE(kStlReader.read(binary(5, 5), options));
    --options.memory_bytes;
    const auto refused = kStlReader.read(binary(5, 5), options);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::over_budget);
}

TEST(ReadStl, NonFiniteBinaryCoordinatesAreData) {
    std::string bytes = binary(2, 2);
    const float bad = NAN;
    std::memcpy(bytes.data() + 84 + 50 + 12 + 16, &bad, 4);  // triangle 1, corner 1, y
    const TriangleSoup s = kStlReader.soup(bytes);
    ASSERT_EQ(s.bad_number_count, 1u);
    EXPECT_EQ(s.bad_numbers[0].kind, BadNumber::Kind::not_finite);
    EXPECT_EQ(s.bad_numbers[0].vertex, 4u);
}

TEST(ReadStl, ReadsText) {
    const TriangleSoup s = kStlReader.soup("solid a part\n" + kFacet + "endsolid a part\n");
    EXPECT_EQ(s.positions, kCorners);
    EXPECT_EQ(s.triangles, (std::vector<Triangle>{{{0, 1, 2}}}));
    EXPECT_EQ(s.groups.names, (std::vector<std::string>{"a part"}));
    EXPECT_TRUE(s.single_precision);
}

TEST(ReadStl, ReadsTextOfAnyCaseAndLayout) {
    for (const std::string text :
         {"SOLID\r\n FACET NORMAL 0 0 1\r\nOUTER LOOP\r\nVERTEX 0 0 0\r\nVERTEX 1 0 0\r\n"
          "VERTEX 0 1.5 0\r\nENDLOOP\r\nENDFACET\r\nENDSOLID\r\n",
          "solid\nfacet normal nan nan nan outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1.5 0 "
          "endloop endfacet\nendsolid",
          "  solid x\nfacet outer loop\nvertex\n0\n0\n0 vertex 1 0 0 vertex 0 1.5 0 endloop\n"
          "endfacet endsolid x"}) {
        EXPECT_EQ(kStlReader.soup(text).positions, kCorners) << text;
    }
}

TEST(ReadStl, SolidsAreGroups) {
    const TriangleSoup s = kStlReader.soup(
        "solid a\n" + kFacet + kFacet + "endsolid a\nsolid vertex 1 2\n" + kFacet + "endsolid\n");
    ASSERT_EQ(s.groups.runs.size(), 2u);
    EXPECT_EQ(s.groups.names, (std::vector<std::string>{"a", "vertex 1 2"}));
    EXPECT_EQ(s.groups.runs[1].first_triangle, 2u);
    EXPECT_EQ(s.groups.runs[1].triangle_count, 1u);
}

/// A facet on one line, at a place in x.
std::string facet_at(int x) {
    const std::string place = std::to_string(x);
    return "facet normal 0 0 1 outer loop vertex " + place + " 0 0 vertex " + place +
           " 1 0 vertex " + place + " 0 1 endloop endfacet";
}

TEST(ReadStl, SolidsMayShareALine) {
    const std::string a = "solid a " + facet_at(0) + " endsolid a";
    const std::string b = "solid b " + facet_at(5) + " " + facet_at(6) + " endsolid b";
    for (const std::string& text :
         {a + "\n" + b + "\n", a + " " + b, "solid a\n" + facet_at(0) + "\nendsolid a " + b,
          a + "\nsolid b\n" + facet_at(5) + "\n" + facet_at(6) + "\nendsolid b\n",
          "solid a\r" + facet_at(0) + "\rendsolid a\r" + b + "\r"}) {
        const TriangleSoup s = kStlReader.soup(text);
        ASSERT_EQ(s.triangles.size(), 3u) << text;
        EXPECT_EQ(s.positions[3].x, 5) << text;
        EXPECT_EQ(s.groups.names, (std::vector<std::string>{"a", "b"})) << text;
        ASSERT_EQ(s.groups.runs.size(), 2u) << text;
        EXPECT_EQ(s.groups.runs[1].first_triangle, 1u) << text;
    }
}

// If each solid looked for the end of the line, this would take minutes.
TEST(ReadStl, ALineMayHaveManySolids) {
    constexpr std::size_t kSolids = 40'000;
    std::string text;
    for (std::size_t i = 0; i < kSolids; ++i) {
        text += (i % 2 == 0 ? "solid a " : "solid b ") + facet_at(0) + " endsolid ";
    }
    text += std::string(std::size_t{32} << 20, ' ');
    const TriangleSoup s = kStlReader.soup(text);
    EXPECT_EQ(s.triangles.size(), kSolids);
    EXPECT_EQ(s.groups.runs.size(), kSolids);
}

TEST(ReadStl, NamesMayHaveAnyWords) {
    for (const std::string name : {"vertex 1 2", "facet", "my facet normal", "solid endsolid",
                                   "facet endfacet", "endfacet facet vertex 1", "solid solid"}) {
        const TriangleSoup s = kStlReader.soup("solid " + name + "\n" + kFacet + "endsolid " +
                                               name + "\nsolid b\n" + kFacet + "endsolid b\n");
        EXPECT_EQ(s.triangles.size(), 2u) << name;
        EXPECT_EQ(s.groups.names, (std::vector<std::string>{name, "b"}));
    }
    const TriangleSoup line =
        kStlReader.soup("solid my facet part " + facet_at(0) + " endsolid my facet part\n");
    EXPECT_EQ(line.triangles.size(), 1u);
    EXPECT_EQ(line.groups.names, (std::vector<std::string>{"my facet part"}));
}

TEST(ReadStl, TextMayBeginWithAByteOrderMark) {
    const TriangleSoup s = kStlReader.soup("\xef\xbb\xbfsolid a\n" + kFacet + "endsolid a\n");
    EXPECT_EQ(s.positions, kCorners);
    EXPECT_EQ(s.groups.names, (std::vector<std::string>{"a"}));
}

TEST(ReadStl, TextKeepsDoubles) {
    const TriangleSoup s = kStlReader.soup(
        "solid\nfacet normal 0 0 1\nouter loop\nvertex 0.1234567890123 0 0\nvertex 1 0 0\n"
        "vertex 0 0.1 inf\nendloop\nendfacet\nendsolid\n");
    EXPECT_FALSE(s.single_precision);
    EXPECT_EQ(s.positions[0].x, 0.1234567890123);
    EXPECT_EQ(s.positions[2].y, 0.1);
    EXPECT_EQ(s.bad_number_count, 1u);
}

TEST(ReadStl, SaysWhichFacetIsBroken) {
    const std::string start = "solid\n" + kFacet;
    EXPECT_EQ(kStlReader.refusal(start +
                                 "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nendloop\nendfacet\n"
                                 "endsolid\n"),
              "t.stl: line 9: a facet has 1 vertices; expected 3.");
    EXPECT_EQ(kStlReader.refusal(start +
                                 "facet normal 0 0 1\nouter loop\nvertex 0 0\nendloop\nendfacet\n"),
              "t.stl: line 12: 'endloop' is not a number.");
    EXPECT_EQ(kStlReader.refusal(start),
              "t.stl: line 9: the file ends without endsolid: it is cut off.");
    EXPECT_EQ(kStlReader.refusal(start + "vertex 1 2 3\nendsolid\n"),
              "t.stl: line 11: a vertex that belongs to no facet.");
    EXPECT_EQ(kStlReader.refusal(start + "endfacet\nendsolid\n"),
              "t.stl: line 9: an endfacet without its facet.");
}

TEST(ReadStl, AnEmptySolidIsAnEmptySoup) {
    EXPECT_TRUE(kStlReader.soup("solid nothing\nendsolid nothing\n").triangles.empty());
    EXPECT_TRUE(kStlReader.soup(binary(0, 0)).triangles.empty());
}

TEST(ReadStl, EveryTruncationIsASoupOrASentence) {
    const std::string text = "solid a\n" + kFacet + kFacet + "endsolid a\n";
    for (std::size_t size = 0; size < text.size(); ++size) {
        const Result<TriangleSoup> result = kStlReader.read(text.substr(0, size));
        // Only the name behind endsolid may be missing.
        EXPECT_EQ(result.ok(), size >= text.size() - 3) << size;
    }
    const std::string bytes = binary(3, 3);
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        EXPECT_FALSE(kStlReader.read(bytes.substr(0, size)).ok()) << size;
    }
}

TEST(ReadStl, LongTextIsReadInChunks) {
    std::string text = "solid a\n";
    for (int i = 0; i < 20'000; ++i) text += kFacet;
    text += "endsolid a\n";
    const TriangleSoup s = kStlReader.soup(text);
    ASSERT_EQ(s.triangles.size(), 20'000u);
    for (std::uint32_t i = 0; i < 60'000; ++i) ASSERT_EQ(s.positions[i], kCorners[i % 3]);
    EXPECT_EQ(s.triangles.back(), (Triangle{{59'997, 59'998, 59'999}}));
    EXPECT_EQ(s.groups.runs.size(), 1u);
    EXPECT_FALSE(kStlReader.read(text.substr(0, 1'000'000)).ok());
}

}  // namespace
}  // namespace cdprep::import
