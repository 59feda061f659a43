// SPDX-License-Identifier: MIT
#include "import/readers.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "unit/tools/read_text.h"

namespace cdprep::import {
namespace {

using mesh::Double3;
using mesh::Triangle;
using mesh::TriangleSoup;
using test::kSquare;

constexpr test::TextReader kOffReader(read_off, "t.off");

const std::string kBody = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n4 0 1 2 3\n";
const std::vector<Triangle> kThree = {{{0, 1, 2}}, {{0, 1, 2}}, {{0, 2, 3}}};

TEST(ReadOff, ReadsEverySpellingOfTheHeader) {
    for (const char* header :
         {"OFF\n4 2 0\n", "OFF 4 2 0\n", "OFF4 2 0\n", "\t  OFF4 2 0 # or nah\n",
          "# c\n\nOFF # c\n# c\n4 # v\n2 0\n", "4 2 0\n", "OFF\r\n4 2 0\r\n", "COFF\n4 2 0\n",
          "STCNOFF\n4 2 0\n", "OFF\n4 2\n", "\xef\xbb\xbfOFF\n4 2 0\n",
          "\xef\xbb\xbf"
          "4 2 0\n"}) {
        const TriangleSoup s = kOffReader.soup(header + kBody);
        EXPECT_EQ(s.positions, kSquare) << header;
        EXPECT_EQ(s.triangles, kThree) << header;
        EXPECT_EQ(s.face, (std::vector<std::uint32_t>{0, 1, 1})) << header;
    }
}

TEST(ReadOff, SkipsCommentsBlankLinesAndWhatFollowsTheNumbers) {
    const TriangleSoup s = kOffReader.soup(
        "NCOFF\n4 2 0\n\n# first\n0 0 0 0 0 1 255 0 0 255\n1 0 0 # c\r\n\n 1 1 0 9 9 9\n\t0 1 0\n"
        "# faces\n3 0 1 2 0.5 0.5 0.5\n\n4  0 1 2 3  255 255 255#c\n\n");
    EXPECT_EQ(s.positions, kSquare);
    EXPECT_EQ(s.triangles, kThree);
}

TEST(ReadOff, IgnoresWhatFollowsTheLastFace) {
    EXPECT_EQ(kOffReader.soup("OFF\n4 2 0\n" + kBody + "3 1 2 3\nrubbish\n").triangles, kThree);
}

TEST(ReadOff, RowsMayBeWrappedOrJoined) {
    for (const char* text : {"OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n4 0 1\n2 3\n",
                             "OFF\n4 2 0\n0 0\n0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n4\n0 1\n# c\n2 3",
                             "OFF\n4 2 0\n0 0 0 1 0 0 1 1 0 0 1 0\n3 0 1 2 4 0 1 2 3\n"}) {
        const TriangleSoup s = kOffReader.soup(text);
        EXPECT_EQ(s.positions, kSquare) << text;
        EXPECT_EQ(s.triangles, kThree) << text;
        EXPECT_TRUE(s.single_precision) << text;
    }
}

// Wrapped rows are read only where every number has its place: a number too many or too few
// anywhere would move all that follow.
TEST(ReadOff, WrappedRowsThatDoNotAddUpAreUnreadable) {
    const std::string wrapped = "OFF\n4 2 0\n0 0\n0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n4 0 1 2";
    EXPECT_EQ(kOffReader.soup(wrapped + " 3\n").triangles, kThree);
    EXPECT_NE(kOffReader.refusal(wrapped), "");
    EXPECT_NE(kOffReader.refusal(wrapped + " 3 7\n"), "");
    EXPECT_NE(kOffReader.refusal(wrapped + " x\n"), "");
    EXPECT_NE(kOffReader.refusal("C" + wrapped + " 3\n"), "");
}

// The count is that of a real file; nothing may be allocated by it.
TEST(ReadOff, CountsThatTheFileIsTooShortForAreUnreadable) {
    EXPECT_EQ(kOffReader.refusal("OFF\n353535235358 6 0\n" + kBody),
              "t.off: the file has 6 lines after the header, which declares 353535235358 "
              "vertices and 6 faces; the file is cut off, or its header is wrong.");
    EXPECT_EQ(
        kOffReader.refusal("OFF\n4 3 0\n" + kBody),
        "t.off: the file ends after face 2 of 3; the file is cut off, or its header is wrong.");
    EXPECT_FALSE(kOffReader.read("OFF\n4 999999999999999999 0\n" + kBody).ok());
}

TEST(ReadOff, SaysWhatIsWrongAndWhere) {
    EXPECT_EQ(kOffReader.refusal("OFF\n4 x 0\n"),
              "t.off: line 2: 'x' is not a count of an OFF header.");
    EXPECT_EQ(kOffReader.refusal("OFF\n4 -2 0\n"),
              "t.off: line 2: '-2' is not a count of an OFF header.");
    EXPECT_EQ(kOffReader.refusal("OFF\n"), "t.off: line 2: the file ends inside the OFF header.");
    EXPECT_EQ(kOffReader.refusal("OFF\n2 0 0\n0 0 0\n1 0\n"),
              "t.off: line 4: found the end of the line; expected a coordinate of a vertex.");
    EXPECT_EQ(kOffReader.refusal("OFF\n1 1 0\n0 0 0\n3 0 0 z\n"),
              "t.off: line 4: found 'z'; expected corner 3 of 3 of a face.");
    EXPECT_EQ(kOffReader.refusal("OFF\n1 1 0\n0 0 0\n3 0 0\n"),
              "t.off: line 4: found the end of the line; expected corner 3 of 3 of a face.");
    EXPECT_EQ(kOffReader.refusal("OFF\n1 1 0\n0 0 0\n-3 0 0\n"),
              "t.off: line 4: found '-3'; expected the number of corners of a face.");
    EXPECT_EQ(kOffReader.refusal("4OFF\n1 1 0\n"),
              "t.off: line 2: the dimension of the OFF file is not 3.");
    EXPECT_EQ(kOffReader.refusal("OFF BINARY\n"),
              "t.off: line 1: binary OFF files are not supported. Save the file as text.");
}

TEST(ReadOff, BadIndicesAndNumbersAreData) {
    const TriangleSoup s =
        kOffReader.soup("OFF\n3 3 0\n0 0 0\n1 nan 0\n0 0 1\n3 0 1 3\n3 0 1 2\n3 0 -1 2\n");
    ASSERT_EQ(s.bad_number_count, 3u);
    EXPECT_EQ(s.bad_numbers[0].vertex, 1u);
    EXPECT_EQ(s.bad_numbers[1].triangle, 0u);
    EXPECT_EQ(s.bad_numbers[1].found, 3);
    EXPECT_EQ(s.bad_numbers[1].limit, 3);
    EXPECT_EQ(s.bad_numbers[2].triangle, 2u);
    EXPECT_EQ(s.bad_numbers[2].found, -1);
}

TEST(ReadOff, EveryTruncationIsASoupOrASentence) {
    const std::string text = "COFF # c\n4 2 0\n" + kBody;
    for (std::size_t size = 0; size < text.size(); ++size) {
        // Without the last line feed nothing is missing yet.
        EXPECT_EQ(kOffReader.read(text.substr(0, size)).ok(), size + 1 >= text.size()) << size;
    }
}

TEST(ReadOff, LongFilesAreReadInChunks) {
    const int count = 100'000;
    std::string text = "OFF\n" + std::to_string(count) + " " + std::to_string(count) + " 0\n";
    for (int i = 0; i < count; ++i) text += std::to_string(i) + " 0.5 0\n";
    for (int i = 0; i < count; ++i) {
        text += i % 10 == 0 ? "# c\n\n3 " : "3 ";
        text += std::to_string(i) + " 0 " + std::to_string(count - 1 - i) + "\n";
    }
    const TriangleSoup s = kOffReader.soup(text);
    ASSERT_EQ(s.positions.size(), 100'000u);
    ASSERT_EQ(s.triangles.size(), 100'000u);
    for (std::uint32_t i = 0; i < 100'000; ++i) {
        ASSERT_EQ(s.positions[i], (Double3{double(i), 0.5, 0}));
        ASSERT_EQ(s.triangles[i], (Triangle{{i, 0, 99'999 - i}}));
    }
    EXPECT_TRUE(s.face.empty());
}

TEST(LooksLikeOff, KnowsItsKeyword) {
    for (const char* text : {"OFF\n", "COFF\n", "# c\n  STNOFF 1", "OFF8 6 12"}) {
        EXPECT_TRUE(looks_like_off(text)) << text;
    }
    for (const char* text : {"", "OFFICE\n", "off\n", "8 6 12\n", "XOFF\n", "ply\n"}) {
        EXPECT_FALSE(looks_like_off(text)) << text;
    }
}

}  // namespace
}  // namespace cdprep::import
