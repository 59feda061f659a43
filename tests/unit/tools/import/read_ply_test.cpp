// SPDX-License-Identifier: MIT
#include "import/readers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "unit/tools/read_text.h"

namespace cdprep::import {
namespace {

using mesh::Double3;
using mesh::Triangle;
using mesh::TriangleSoup;
using test::kSquare;

constexpr test::TextReader kPlyReader(read_ply, "t.ply");

std::string header(const std::string& format, const std::string& elements) {
    return "ply\nformat " + format + " 1.0\ncomment made by hand\n" + elements + "end_header\n";
}

/// Appends a number as it lies in a binary file.
template <class T>
void put(std::string& bytes, T value, bool big_endian) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    if (big_endian) std::reverse(raw, raw + sizeof(T));
    bytes.append(raw, sizeof(T));
}

const std::string kFloats = "property float x\nproperty float y\nproperty float z\n";
const std::string kFaces = "property list uchar int vertex_indices\n";

std::string text_square() {
    return header("ascii", "element vertex 4\n" + kFloats + "element face 2\n" + kFaces) +
           "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n4 0 1 2 3\n";
}

TEST(ReadPly, ReadsText) {
    const TriangleSoup s = kPlyReader.soup(text_square());
    EXPECT_EQ(s.positions, kSquare);
    EXPECT_EQ(s.triangles, (std::vector<Triangle>{{{0, 1, 2}}, {{0, 1, 2}}, {{0, 2, 3}}}));
    EXPECT_EQ(s.face, (std::vector<std::uint32_t>{0, 1, 1}));
    EXPECT_TRUE(s.single_precision);
}

TEST(ReadPly, TextMayBeginWithAByteOrderMark) {
    const TriangleSoup s = kPlyReader.soup("\xef\xbb\xbf" + text_square());
    EXPECT_EQ(s.positions, kSquare);
    EXPECT_EQ(s.triangles.size(), 3u);
}

// Rows that do not match the header: a real exporter writes colours as lists.
TEST(ReadPly, TextRowsMayHoldMoreThanTheHeaderSays) {
    const TriangleSoup s = kPlyReader.soup(
        header("ascii",
               "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
               "element face 1\nproperty list uchar int vertex_indices\n"
               "property uchar red\n") +
        "0 0 0 9\n\n1 0 0\n0 1 0\r\n3 0 1 2 9 1 1 1 1 1 1 1 1 1\n");
    EXPECT_EQ(s.triangles, (std::vector<Triangle>{{{0, 1, 2}}}));
}

TEST(ReadPly, TextHasPropertiesInAnyOrderBetweenOtherElements) {
    const TriangleSoup s = kPlyReader.soup(
        header("ascii",
               "element material 2\nproperty list uchar float rgb\nproperty int id\n"
               "element vertex 3\nproperty list uchar int rings\nproperty float nx\n"
               "property double z\nproperty int y\nproperty uchar red\nproperty float x\n"
               "element face 2\nproperty uchar flags\nproperty list uchar float uv\n"
               "property list int uint vertex_index\nproperty int group\n"
               "element edge 1\nproperty int vertex1\nproperty int vertex2\n") +
        "3 1 1 1 7\n0 8\n"
        "2 5 5 9 3 2 255 1\n0 9 6 5 0 4\n1 1 9 9 8 0 7\n"
        "1 2 0.5 0.5 3 2 1 0 77\n1 0 3 0 1 2 78\n"
        "0 1\n");
    EXPECT_EQ(s.positions, (std::vector<Double3>{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}));
    EXPECT_EQ(s.triangles, (std::vector<Triangle>{{{2, 1, 0}}, {{0, 1, 2}}}));
}

// The quick way to read x, y, z takes three numbers in a row.
TEST(ReadPly, TextMayHaveAPropertyBetweenYAndZ) {
    for (const bool is_after : {false, true}) {
        const std::string other = "property float w\n";
        const std::string z = "property float z\n";
        const TriangleSoup s = kPlyReader.soup(
            header("ascii", "element vertex 3\nproperty float x\nproperty float y\n" +
                                (is_after ? z + other : other + z) + "element face 1\n" + kFaces) +
            (is_after ? "1 2 3 9\n4 5 6 9\n7 8 9 9\n" : "1 2 9 3\n4 5 9 6\n7 8 9 9\n") +
            "3 0 1 2\n");
        EXPECT_EQ(s.positions, (std::vector<Double3>{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}));
    }
}

/// A file with extra elements and properties, in either byte order.
std::string binary(bool big) {
    std::string bytes =
        header(big ? "binary_big_endian" : "binary_little_endian",
               "element extra 2\nproperty list uchar short stuff\nproperty char c\n"
               "element vertex 4\nproperty uchar red\nproperty float x\nproperty float y\n"
               "property float z\nelement face 3\nproperty short flags\n"
               "property list uchar ushort vertex_indices\nproperty double area\n"
               "element tail 1\nproperty int a\n");
    for (int i = 0; i < 2; ++i) {
        put<std::uint8_t>(bytes, std::uint8_t(i), big);
        for (int k = 0; k < i; ++k) put<std::int16_t>(bytes, 7, big);
        put<std::int8_t>(bytes, -1, big);
    }
    for (const Double3& p : kSquare) {
        put<std::uint8_t>(bytes, 9, big);
        put(bytes, static_cast<float>(p.x), big);
        put(bytes, static_cast<float>(p.y), big);
        put(bytes, static_cast<float>(p.z), big);
    }
    for (const int corners : {3, 4, 2}) {
        put<std::int16_t>(bytes, 1, big);
        put<std::uint8_t>(bytes, std::uint8_t(corners), big);
        for (int c = 0; c < corners; ++c) put<std::uint16_t>(bytes, std::uint16_t(c), big);
        put(bytes, 0.5, big);
    }
    put<std::int32_t>(bytes, 5, big);
    return bytes;
}

TEST(ReadPly, ReadsBinaryOfBothByteOrders) {
    for (const bool big : {false, true}) {
        const TriangleSoup s = kPlyReader.soup(binary(big));
        EXPECT_EQ(s.positions, kSquare);
        EXPECT_EQ(s.triangles, (std::vector<Triangle>{{{0, 1, 2}}, {{0, 1, 2}}, {{0, 2, 3}}}));
        EXPECT_EQ(s.face, (std::vector<std::uint32_t>{0, 1, 1}));
        EXPECT_TRUE(s.single_precision);
    }
}

template <class T>
void expect_type(const std::string& name, bool single) {
    for (const bool big : {false, true}) {
        std::string bytes =
            header(big ? "binary_big_endian" : "binary_little_endian",
                   "element vertex 3\nproperty " + name + " x\nproperty " + name + " y\nproperty " +
                       name + " z\nelement face 1\nproperty list " +
                       (name[0] == 'f' || name[0] == 'd' ? "int int" : name + " " + name) +
                       " vertex_indices\n");
        for (int i = 0; i < 9; ++i) put<T>(bytes, T(i + 1), big);
        if (name[0] == 'f' || name[0] == 'd') {
            for (const int i : {3, 2, 1, 0}) put<std::int32_t>(bytes, i, big);
        } else {
            for (const int i : {3, 2, 1, 0}) put<T>(bytes, T(i), big);
        }
        const TriangleSoup s = kPlyReader.soup(bytes);
        EXPECT_EQ(s.positions, (std::vector<Double3>{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}})) << name;
        EXPECT_EQ(s.triangles, (std::vector<Triangle>{{{2, 1, 0}}})) << name;
        EXPECT_EQ(s.single_precision, single) << name;
    }
}

// Binary doubles stay doubles; integers that a float holds are floats.
TEST(ReadPly, ReadsEveryNumberType) {
    expect_type<std::int8_t>("char", true);
    expect_type<std::int8_t>("int8", true);
    expect_type<std::uint8_t>("uchar", true);
    expect_type<std::uint8_t>("uint8", true);
    expect_type<std::int16_t>("short", true);
    expect_type<std::int16_t>("int16", true);
    expect_type<std::uint16_t>("ushort", true);
    expect_type<std::uint16_t>("uint16", true);
    expect_type<std::int32_t>("int", true);
    expect_type<std::int32_t>("int32", true);
    expect_type<std::uint32_t>("uint", true);
    expect_type<std::uint32_t>("uint32", true);
    expect_type<float>("float", true);
    expect_type<float>("float32", true);
    expect_type<double>("double", false);
    expect_type<double>("float64", false);
}

TEST(ReadPly, ReadsTriangleStrips) {
    const std::string elements = "element vertex 4\n" + kFloats +
                                 "element tristrips 1\nproperty list int int vertex_indices\n";
    const std::vector<Triangle> expected = {{{0, 1, 2}}, {{2, 1, 3}}, {{3, 2, 1}}};
    const TriangleSoup text = kPlyReader.soup(header("ascii", elements) +
                                              "0 0 0\n1 0 0\n1 1 0\n0 1 0\n8 0 1 2 3 -1 3 2 1\n");
    EXPECT_EQ(text.triangles, expected);
    std::string bytes = header("binary_little_endian", elements);
    for (const Double3& p : kSquare) {
        for (const double x : {p.x, p.y, p.z}) put(bytes, static_cast<float>(x), false);
    }
    for (const int i : {8, 0, 1, 2, 3, -1, 3, 2, 1}) put<std::int32_t>(bytes, i, false);
    EXPECT_EQ(kPlyReader.soup(bytes).triangles, expected);
}

TEST(ReadPly, ReadsHeadersWithCarriageReturns) {
    std::string text = text_square();
    std::string crlf;
    for (const char c : text) crlf += c == '\n' ? "\r\n" : std::string(1, c);
    EXPECT_EQ(kPlyReader.soup(crlf).triangles.size(), 3u);
}

TEST(ReadPly, BadIndicesAndNumbersAreData) {
    const TriangleSoup s = kPlyReader.soup(
        header("ascii", "element vertex 3\n" + kFloats + "element face 3\n" + kFaces) +
        "0 0 0\ninf 0 0\n0 1 0\n3 0 1 2\n3 0 1 3\n3 -1 1 2\n");
    ASSERT_EQ(s.bad_number_count, 3u);
    EXPECT_EQ(s.bad_numbers[0].vertex, 1u);
    EXPECT_EQ(s.bad_numbers[1].found, 3);
    EXPECT_EQ(s.bad_numbers[2].found, -1);
    std::string bytes = header("binary_little_endian", "element vertex 1\n" + kFloats +
                                                           "element face 2\nproperty list uchar "
                                                           "uint vertex_indices\n");
    for (int i = 0; i < 3; ++i) put(bytes, i == 1 ? NAN : 0.0f, false);
    for (const unsigned bad : {0xffffffffu, 0u}) {
        put<std::uint8_t>(bytes, 3, false);
        for (const unsigned c : {0u, 0u, bad}) put<std::uint32_t>(bytes, c, false);
    }
    const TriangleSoup b = kPlyReader.soup(bytes);
    ASSERT_EQ(b.bad_number_count, 2u);
    EXPECT_EQ(b.bad_numbers[1].found, 4294967295);
    EXPECT_EQ(b.bad_numbers[1].triangle, 0u);
}

TEST(ReadPly, CountsThatTheFileIsTooShortForAreUnreadable) {
    EXPECT_EQ(
        kPlyReader.refusal(header("ascii", "element vertex 999999999999\n" + kFloats) + "0 0 0\n"),
        "t.ply: the file ends after 1 of the 999999999999 lines that the header declares for "
        "element 'vertex'.");
    EXPECT_EQ(kPlyReader.refusal(
                  header("binary_little_endian", "element vertex 999999999999\n" + kFloats) +
                  "0123456789ab"),
              "t.ply: the header declares 999999999999 of element 'vertex', which take at least "
              "12 bytes each, but only 12 bytes follow.");
    std::string bytes = header("binary_big_endian", "element vertex 0\n" + kFloats +
                                                        "element face 1\nproperty list int int "
                                                        "vertex_indices\n");
    const std::size_t body = bytes.size();
    std::string huge = bytes;
    put<std::int32_t>(huge, 0x7fffffff, true);
    EXPECT_EQ(kPlyReader.refusal(huge),
              "t.ply: byte " + std::to_string(body) +
                  ": a list has 2147483647 entries, but only 0 bytes follow, in "
                  "record 0 of the 1 of element 'face'.");
    std::string negative = bytes;
    put<std::int32_t>(negative, -1, true);
    EXPECT_EQ(kPlyReader.refusal(negative),
              "t.ply: byte " + std::to_string(body) +
                  ": a list has -1 entries, in record 0 of the 1 of element "
                  "'face'.");
}

TEST(ReadPly, SaysWhatIsWrongWithTheHeader) {
    EXPECT_EQ(kPlyReader.refusal("plx\n"),
              "t.ply: line 1: a PLY file begins with 'ply', not with 'plx'.");
    EXPECT_EQ(kPlyReader.refusal("ply\nformat ascii 1.0\nelement vertex 3\n"),
              "t.ply: line 4: the file ends inside the PLY header.");
    EXPECT_EQ(kPlyReader.refusal("ply\nformat utf7 1.0\n"),
              "t.ply: line 2: unknown PLY format 'utf7'.");
    EXPECT_EQ(kPlyReader.refusal("ply\nformat ascii 1.0\nelement vertex x\n"),
              "t.ply: line 3: 'x' is not a count.");
    EXPECT_EQ(kPlyReader.refusal("ply\nproperty float x\n"),
              "t.ply: line 2: a property comes before the first element.");
    EXPECT_EQ(kPlyReader.refusal("ply\nelement vertex 1\nproperty quad x\n"),
              "t.ply: line 3: a property has an unknown type.");
    EXPECT_EQ(kPlyReader.refusal("ply\nelephant\n"),
              "t.ply: line 2: the PLY header has an invalid line that begins with 'elephant'.");
    EXPECT_EQ(kPlyReader.refusal(
                  header("ascii", "element vertex 1\nproperty float x\nproperty float y\n")),
              "t.ply: line 7: the vertices lack x, y or z.");
    EXPECT_EQ(kPlyReader.refusal(header("ascii", "")),
              "t.ply: line 4: the PLY header has 0 elements 'vertex'; expected 1.");
    EXPECT_EQ(
        kPlyReader.refusal(header("ascii", "element vertex 0\n" + kFloats +
                                               "element face 0\nproperty list uchar float "
                                               "vertex_indices\n")),
        "t.ply: line 10: the vertex numbers of element 'face' are not a list of whole numbers.");
}

TEST(ReadPly, SaysWhichRowIsBroken) {
    const std::string start =
        header("ascii", "element vertex 1\n" + kFloats + "element face 1\n" + kFaces);
    EXPECT_EQ(kPlyReader.refusal(start + "0 0\n3 0 0 0\n"),
              "t.ply: line 11: found the end of the line; expected 'z' of element 'vertex'.");
    EXPECT_EQ(kPlyReader.refusal(start + "0 0 0\n3 0 0\n"),
              "t.ply: line 12: found the end of the line; expected 'vertex_indices' of element "
              "'face'.");
    EXPECT_EQ(kPlyReader.refusal(start + "0 0 0\n3 0 a 0\n"),
              "t.ply: line 12: found 'a'; expected 'vertex_indices' of element 'face'.");
}

TEST(ReadPly, EveryTruncationIsASentence) {
    for (const std::string& bytes : {text_square(), binary(false), binary(true)}) {
        for (std::size_t size = 0; size < bytes.size(); ++size) {
            const bool only_line_feed_missing = bytes[size] == '\n' && size + 1 == bytes.size();
            EXPECT_EQ(kPlyReader.read(bytes.substr(0, size)).ok(), only_line_feed_missing) << size;
        }
    }
}

TEST(ReadPly, EveryFlippedBitIsASoupOrASentence) {
    for (const std::string& bytes : {text_square(), binary(false), binary(true)}) {
        int soups = 0;
        for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
            std::string flipped = bytes;
            flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
            const Result<TriangleSoup> result = kPlyReader.read(flipped);
            if (!result.ok()) continue;
            ++soups;
            for (const Triangle& t : result.value().triangles) {
                for (const std::uint32_t v : t.vertex) {
                    ASSERT_LT(v, result.value().positions.size());
                }
            }
        }
        EXPECT_GT(soups, 50);
    }
}

// Past one block of records, all triangles, then one quad in the second block.
TEST(ReadPly, LongFacesAreReadInBlocks) {
    for (const bool with_quad : {false, true}) {
        std::string bytes = header("binary_little_endian", "element vertex 4\n" + kFloats +
                                                               "element face 40000\n" + kFaces);
        for (const Double3& p : kSquare) {
            for (const double x : {p.x, p.y, p.z}) put(bytes, static_cast<float>(x), false);
        }
        for (int i = 0; i < 40'000; ++i) {
            const int corners = with_quad && i == 20'000 ? 4 : 3;
            put<std::uint8_t>(bytes, std::uint8_t(corners), false);
            for (int c = 0; c < corners; ++c) put<std::int32_t>(bytes, (i + c) % 4, false);
        }
        const TriangleSoup s = kPlyReader.soup(bytes);
        ASSERT_EQ(s.triangles.size(), with_quad ? 40'001u : 40'000u);
        EXPECT_EQ(s.triangles[39'999 + with_quad], (Triangle{{3, 0, 1}}));
        EXPECT_EQ(s.face.empty(), !with_quad);
        EXPECT_EQ(s.face.empty() ? 39'999u : s.face.back(), 39'999u);
    }
}

}  // namespace
}  // namespace cdprep::import
