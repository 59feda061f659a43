// SPDX-License-Identifier: MIT
#include "import/readers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "unit/tools/read_text.h"

namespace cdprep::import {
namespace {

using mesh::BadNumber;
using mesh::Double3;
using mesh::Triangle;
using mesh::TriangleSoup;

constexpr test::TextReader kObjReader(read_obj, "t.obj");

const std::string kFour = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
const std::vector<Triangle> kOne = {{{0, 1, 2}}};

TEST(ReadObj, ReadsVerticesAndFacesInFileOrder) {
    const TriangleSoup s = kObjReader.soup("v 1 2.5 -3e1\nv .5 0 0\nv 7 8 9\nf 3 1 2\n");
    EXPECT_EQ(s.positions, (std::vector<Double3>{{1, 2.5, -30}, {0.5, 0, 0}, {7, 8, 9}}));
    EXPECT_EQ(s.triangles, (std::vector<Triangle>{{{2, 0, 1}}}));
    EXPECT_TRUE(s.single_precision);
    EXPECT_TRUE(s.face.empty());
    EXPECT_TRUE(s.instances.empty());
    EXPECT_EQ(s.bad_number_count, 0u);
    EXPECT_EQ(s.metres_per_unit, 0);
}

TEST(ReadObj, ReadsEverySpellingOfACorner) {
    for (const char* face :
         {"f 1 2 3",     "f 1/1 2/2 3/3", "f 1//1 2//2 3//3",     "f 1/1/1 2/2/2 3/3/3",
          "f 1/ 2/ 3/",  "f 1// 2// 3//", "f -4 -3 -2",           "f -4/-4/-1 -3/1 -2",
          "f +1 +2 +3",  "f  1\t2   3  ", "f\\\n1 2 3",           "f\\\r\n 1 2 3",
          "\t f 1 2 3",  "f 1 2 3\r",     "f 1 2 3 # a triangle", "f 1 2 3#c",
          "f 1 \\\n2 3", "f 1 2\\\r\n 3", "f 1 2 3 \\\n",         "f 01 002 3"}) {
        EXPECT_EQ(kObjReader.soup(kFour + face + "\n").triangles, kOne) << face;
        EXPECT_EQ(kObjReader.soup(kFour + face).triangles, kOne)
            << face << " at the end of the file";
    }
}

TEST(ReadObj, SkipsWhatIsNoSurface) {
    const TriangleSoup s = kObjReader.soup(
        "# v 9 9 9\nmtllib a b.mtl\n" + kFour +
        "vt 0 0\nvn 0 0 1\nvp 1\np 1 2\nl 1 2 3\ns off\ncstype bezier\ncurv 0 1 1 2\nend\n"
        "\n  \t \n\xff\xfe junk\nf 1 2 3\nf\nf 1\nf 1 2\n");
    EXPECT_EQ(s.triangles, kOne);
    EXPECT_EQ(s.positions.size(), 4u);
}

TEST(ReadObj, IgnoresColoursAndWeights) {
    const TriangleSoup s =
        kObjReader.soup("v 1 2 3 0.1 0.2 0.3\nv 4 5 6 1.0\nv 7 8 9 nonsense\nf 1 2 3");
    EXPECT_EQ(s.positions, (std::vector<Double3>{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}));
}

TEST(ReadObj, JoinsContinuedVertexLines) {
    EXPECT_EQ(kObjReader.soup("v 1 \\\n2 \\\r\n3\n").positions, (std::vector<Double3>{{1, 2, 3}}));
    EXPECT_EQ(kObjReader.soup("v\\\n1 2 3\nv\\\r\n4 5 6").positions,
              (std::vector<Double3>{{1, 2, 3}, {4, 5, 6}}));
    EXPECT_EQ(kObjReader.soup("v \\\n1 2 3 \\\n0.5\nv 4 5 6").positions,
              (std::vector<Double3>{{1, 2, 3}, {4, 5, 6}}));
}

TEST(ReadObj, AByteOrderMarkHidesNothing) {
    const TriangleSoup s = kObjReader.soup("\xef\xbb\xbf" + kFour + "f 1 2 3\n");
    EXPECT_EQ(s.positions, kObjReader.soup(kFour).positions);
    EXPECT_EQ(s.triangles, kOne);
    EXPECT_TRUE(
        looks_like_obj("\xef\xbb\xbf"
                       "v 0 0 0\n"));
    EXPECT_TRUE(kObjReader.soup("\xef\xbb\xbf").positions.empty());
}

TEST(ReadObj, RelativeIndicesCountFromTheLastVertexSoFar) {
    const TriangleSoup s =
        kObjReader.soup("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -1 -2 -3\nv 5 5 5\nf -1 -2 -4\n");
    EXPECT_EQ(s.triangles, (std::vector<Triangle>{{{2, 1, 0}}, {{3, 2, 0}}}));
}

TEST(ReadObj, FacesMayUseVerticesThatFollow) {
    EXPECT_EQ(kObjReader.soup("f 1 2 3\n" + kFour).triangles, kOne);
}

TEST(ReadObj, NumbersFacesWhenOneIsNoTriangle) {
    const TriangleSoup s = kObjReader.soup(kFour + "f 1 2 3\nf 1 2 3 4\nf 1 2\nf 2 3 4\n");
    EXPECT_EQ(s.triangles,
              (std::vector<Triangle>{{{0, 1, 2}}, {{0, 1, 2}}, {{0, 2, 3}}, {{1, 2, 3}}}));
    EXPECT_EQ(s.face, (std::vector<std::uint32_t>{0, 1, 1, 3}));
}

// An arrow head whose fan from its first corner would lie outside.
TEST(ReadObj, CutsConcavePolygonsWhereTheyAre) {
    const TriangleSoup s = kObjReader.soup("v 0 0 0\nv 2 1 0\nv 0 2 0\nv 1 1 0\nf 1 2 3 4\n");
    ASSERT_EQ(s.triangles.size(), 2u);
    for (const Triangle& t : s.triangles) {
        EXPECT_TRUE(t.vertex[0] == 3 || t.vertex[1] == 3 || t.vertex[2] == 3);
    }
}

TEST(ReadObj, IndicesOutOfRangeAreDataWithTheirPlace) {
    const TriangleSoup s = kObjReader.soup(
        kFour + "f 1 2 5\nf 1 2 3\nf 0 1 2\nf -5 1 2\nf 1 2 99999999999\nf 1 2 4294967297\n");
    EXPECT_EQ(s.triangles.size(), 6u);
    EXPECT_EQ(s.bad_number_count, 5u);
    ASSERT_EQ(s.bad_numbers.size(), 5u);
    const std::vector<std::int64_t> found = {5, 0, -5, 99999999999, 4294967297};
    const std::vector<std::uint32_t> triangle = {0, 2, 3, 4, 5};
    for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_EQ(s.bad_numbers[i].kind, BadNumber::Kind::index_out_of_range);
        EXPECT_EQ(s.bad_numbers[i].found, found[i]);
        EXPECT_EQ(s.bad_numbers[i].limit, 4);
        EXPECT_EQ(s.bad_numbers[i].triangle, triangle[i]);
        EXPECT_EQ(s.triangles[triangle[i]], (Triangle{{0, 0, 0}}));
    }
    EXPECT_EQ(s.triangles[1], kOne[0]);
}

// A bad corner of a polygon spoils the fan's triangles that use it, no others.
TEST(ReadObj, APolygonWithABadCornerIsAFan) {
    const TriangleSoup s = kObjReader.soup(kFour + "f 1 2 3 9 4\n");
    EXPECT_EQ(s.triangles, (std::vector<Triangle>{{{0, 1, 2}}, {{0, 0, 0}}, {{0, 0, 0}}}));
    EXPECT_EQ(s.bad_number_count, 2u);
}

TEST(ReadObj, NonFiniteCoordinatesAreDataWithTheirPlace) {
    const TriangleSoup s =
        kObjReader.soup("v 0 0 0\nv nan 0 0\nv 0 -inf 0\nv 0 0 1e999\nv 0 0x1p3 0\nf 1 2 3");
    EXPECT_EQ(s.bad_number_count, 4u);
    ASSERT_EQ(s.bad_numbers.size(), 4u);
    for (std::uint32_t i = 0; i < 4; ++i) {
        EXPECT_EQ(s.bad_numbers[i].kind, BadNumber::Kind::not_finite);
        EXPECT_EQ(s.bad_numbers[i].vertex, i + 1);
    }
    EXPECT_EQ(s.positions[2].y, -INFINITY);
    EXPECT_FALSE(s.single_precision);
}

TEST(ReadObj, ListsAThousandBadNumbersAndAllTrianglesOutOfRange) {
    std::string text = kFour;
    for (int i = 0; i < 700; ++i) text += "v nan 0 0\n";
    for (int i = 0; i < 900; ++i) text += "f 1 2 9999\n";
    const TriangleSoup s = kObjReader.soup(text);
    EXPECT_EQ(s.bad_number_count, 1600u);
    ASSERT_EQ(s.bad_numbers.size(), 1000u);
    EXPECT_EQ(s.bad_numbers[699].kind, BadNumber::Kind::not_finite);
    EXPECT_EQ(s.bad_numbers[700].kind, BadNumber::Kind::index_out_of_range);
    EXPECT_EQ(s.bad_numbers[999].triangle, 299u);
    ASSERT_EQ(s.out_of_range.size(), 900u);
    EXPECT_EQ(s.out_of_range.front().triangle, 0u);
    EXPECT_EQ(s.out_of_range.back().triangle, 899u);
    EXPECT_EQ(s.out_of_range.back().found, 9999);
}

// 0.1 as a float is 0.100000001490116; as a double it is nearer.
TEST(ReadObj, OneDoubleKeepsAllPositionsDouble) {
    const TriangleSoup floats = kObjReader.soup("v 0.1 0.2 0.3\n");
    EXPECT_TRUE(floats.single_precision);
    EXPECT_EQ(floats.positions[0].x, static_cast<double>(0.1f));
    for (int count = 1; count < 20; ++count) {
        std::string text;
        for (int i = 0; i < count; ++i) text += "v 0.1 0.2 0.3\n";
        for (const Double3& p : kObjReader.soup(text).positions) {
            EXPECT_EQ(p, (Double3{0.1f, 0.2f, 0.3f})) << count;
        }
    }
    const TriangleSoup doubles = kObjReader.soup("v 0.1 0.2 0.3\nv 0 0 0.1234567890123\n");
    EXPECT_FALSE(doubles.single_precision);
    EXPECT_EQ(doubles.positions[0].x, 0.1);
    EXPECT_EQ(doubles.positions[1].z, 0.1234567890123);
}

TEST(ReadObj, GroupsAndMaterialsAreRunsOverTriangles) {
    const TriangleSoup s =
        kObjReader.soup(kFour +
                        "f 1 2 3\no body\nusemtl red paint \r\nf 1 2 3 4\ng left  arm\n"
                        "g right\nf 1 2 3\nusemtl red paint\nf 1 2 3\ng\nf 1 2 3\n");
    const auto run = [](const format::NamedRun& r) {
        return std::vector<std::uint32_t>{r.first_triangle, r.triangle_count, r.name};
    };
    ASSERT_EQ(s.groups.runs.size(), 4u);
    EXPECT_EQ(s.groups.names, (std::vector<std::string>{"default", "body", "right"}));
    EXPECT_EQ(run(s.groups.runs[0]), (std::vector<std::uint32_t>{0, 1, 0}));
    EXPECT_EQ(run(s.groups.runs[1]), (std::vector<std::uint32_t>{1, 2, 1}));
    EXPECT_EQ(run(s.groups.runs[2]), (std::vector<std::uint32_t>{3, 2, 2}));
    EXPECT_EQ(run(s.groups.runs[3]), (std::vector<std::uint32_t>{5, 1, 0}));
    EXPECT_EQ(s.materials.names, (std::vector<std::string>{"", "red paint"}));
    ASSERT_EQ(s.materials.runs.size(), 2u);
    EXPECT_EQ(run(s.materials.runs[1]), (std::vector<std::uint32_t>{1, 5, 1}));
    EXPECT_TRUE(kObjReader.soup(kFour + "f 1 2 3").groups.runs.empty());
}

TEST(ReadObj, NamesBecomeUtf8) {
    const TriangleSoup s = kObjReader.soup(kFour + "g na\xc3\xafve \xff\x01\nf 1 2 3\n");
    EXPECT_EQ(s.groups.names, (std::vector<std::string>{"na\xc3\xafve \xef\xbf\xbd\xef\xbf\xbd"}));
}

TEST(ReadObj, SaysWhichLineIsBroken) {
    EXPECT_EQ(kObjReader.refusal("v 0 0 0\nv 1 2\n"),
              "t.obj: line 2: a vertex has 2 coordinates; expected 3.");
    EXPECT_EQ(kObjReader.refusal("v 0 0 0\nv\n"),
              "t.obj: line 2: a vertex has 0 coordinates; expected 3.");
    EXPECT_EQ(kObjReader.refusal("v 0 0 0\r\n\r\nv 1 x 2\n"),
              "t.obj: line 3: 'x' is not a number.");
    EXPECT_EQ(kObjReader.refusal(kFour + "f 1 2 three\n"),
              "t.obj: line 5: 'three' is not a corner of a face.");
    EXPECT_EQ(kObjReader.refusal(kFour + "f 1 2 3.5\n"),
              "t.obj: line 5: '3.5' is not a corner of a face.");
    EXPECT_EQ(kObjReader.refusal(kFour + "f 1 2 /3\n"),
              "t.obj: line 5: '/3' is not a corner of a face.");
    EXPECT_EQ(kObjReader.refusal("f 1 2 3\n"), "t.obj: has 1 triangles but no vertices.");
    EXPECT_EQ(kObjReader.refusal(std::string("v 0 0 0\n\0\0", 10)),
              "t.obj: byte 8 is zero: the file is not OBJ text.");
}

TEST(ReadObj, AFileWithoutTrianglesIsAnEmptySoup) {
    for (const char* text : {"# nothing\n", "\n", "v 1 2 3\n", "v 1 2 3\np 1\n"}) {
        EXPECT_TRUE(kObjReader.soup(text).triangles.empty()) << text;
    }
}

TEST(ReadObj, EveryTruncationIsASoupOrASentence) {
    const std::string text =
        "# box\nmtllib m\no a\n" + kFour +
        "v -1.5e-3 0.25 1e2\nvn 0 0 1\ng g1\nusemtl m1\nf 1//1 2//1 3//1 \\\r\n4//1\n"
        "f -1 -2 -3\nl 1 2\nf 1/1/1 2/2/2 5/5/5\n";
    int soups = 0;
    for (std::size_t size = 0; size <= text.size(); ++size) {
        const Result<TriangleSoup> result = kObjReader.read(text.substr(0, size));
        soups += result.ok();
        if (result.ok()) continue;
        EXPECT_EQ(result.error().message.back(), '.');
    }
    EXPECT_GT(soups, 20);
    EXPECT_LT(soups, static_cast<int>(text.size()));
}

TEST(ReadObj, EveryFlippedBitIsASoupOrASentence) {
    int asked = 0;
    const std::string text = kFour + "g g1\nf 1//1 2//1 3//1 \\\n4//1\nf -1 -2 -3\nusemtl x\n";
    for (std::size_t bit = 0; bit < 8 * text.size(); ++bit) {
        std::string flipped = text;
        flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
        const Result<TriangleSoup> result = kObjReader.read(flipped);
        if (!result.ok()) continue;
        ++asked;
        for (const Triangle& t : result.value().triangles) {
            for (const std::uint32_t v : t.vertex) ASSERT_LT(v, result.value().positions.size());
        }
    }
    EXPECT_GT(asked, 200);
}

/// A long text whose soup is known, with every kind of line.
struct Long {
    std::string text;
    std::vector<Double3> positions;
    std::vector<std::array<long, 3>> triangles;
};

Long make_long() {
    std::mt19937 random(42);
    Long result;
    while (result.text.size() < 3'000'000) {
        const auto n = static_cast<long>(result.positions.size());
        const auto any = [&] { return static_cast<long>(random()) % n; };
        switch (n < 3 ? 0 : random() % 6) {
            case 0:
            case 1: {
                const double x = static_cast<double>(random() % 1000) / 8;
                result.text += "v " + std::to_string(x) + " \\\n 2 3\n";
                result.positions.push_back({x, 2, 3});
                break;
            }
            case 2: {
                const std::array<long, 3> t = {any(), any(), any()};
                result.text += "f";
                for (const long v : t) result.text += ' ' + std::to_string(v + 1) + "/7";
                result.text += "\n";
                result.triangles.push_back(t);
                break;
            }
            case 3: {
                const std::array<long, 3> t = {any(), any(), any()};
                result.text += "f";
                for (const long v : t) result.text += ' ' + std::to_string(v - n) + "\\\r\n";
                result.text += "\n";
                result.triangles.push_back(t);
                break;
            }
            case 4:
                result.text += "# a comment with v 1 2 3 in it\n";
                break;
            case 5:
                result.text += "vn 0 0 1\n";
                break;
        }
    }
    return result;
}

// Longer than several chunks, whose order of reading must not matter.
TEST(ReadObj, ChunksJoinToTheSameSoupInAnyOrder) {
    const Long expected = make_long();
    const auto last_first = [](std::size_t count, Task task) {
        for (std::size_t i = count; i-- > 0;) task(i);
    };
    ImportOptions backwards;
    backwards.parallel_for = last_first;
    for (const ImportOptions& options : {ImportOptions{}, backwards}) {
        const Result<TriangleSoup> result = kObjReader.read(expected.text, options);
        ASSERT_TRUE(result.ok()) << result.error().message;
        const TriangleSoup& s = result.value();
        EXPECT_EQ(s.positions, expected.positions);
        ASSERT_EQ(s.triangles.size(), expected.triangles.size());
        for (std::size_t i = 0; i < s.triangles.size(); ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                ASSERT_EQ(s.triangles[i].vertex[k], expected.triangles[i][k]) << i;
            }
        }
        EXPECT_EQ(s.bad_number_count, 0u);
    }
}

TEST(ReadObj, NeverUsesMoreMemoryThanAllowed) {
    ImportOptions small;
    small.memory_bytes = 100;
    const Result<TriangleSoup> result = kObjReader.read(kFour + "f 1 2 3\n", small);
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().code, ErrorCode::over_budget);
}

TEST(LooksLikeObj, KnowsVerticesFromOtherText) {
    EXPECT_TRUE(looks_like_obj("# c\n\nmtllib x\nv 1 2 3\n"));
    EXPECT_TRUE(looks_like_obj("v 1 2 3"));
    EXPECT_FALSE(looks_like_obj("solid x\nv 1 2 3\n"));
    EXPECT_FALSE(looks_like_obj("# only a comment\n"));
    EXPECT_FALSE(looks_like_obj(""));
}

}  // namespace
}  // namespace cdprep::import
