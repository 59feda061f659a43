// SPDX-License-Identifier: MIT
#include "text/nearest_word.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace cdprep::report {
namespace {

const std::array<std::string, 5> kWords = {"bake", "validate", "collide", "closest", "-o"};

TEST(NearestWord, IsTheOneOfFewestMistakes) {
    EXPECT_EQ(suggestion("bakee", kWords), " Did you mean 'bake'?");
    EXPECT_EQ(suggestion("bkae", kWords), " Did you mean 'bake'?");  // two exchanged: one mistake
    EXPECT_EQ(suggestion("vlaidate", kWords), " Did you mean 'validate'?");
    EXPECT_EQ(suggestion("colide", kWords), " Did you mean 'collide'?");
    EXPECT_EQ(suggestion("clsest", kWords), " Did you mean 'closest'?");
    EXPECT_EQ(suggestion("collide", kWords), " Did you mean 'collide'?");
}

TEST(NearestWord, IsNoneWhereAThirdOfTheLettersAreWrong) {
    EXPECT_EQ(suggestion("ba", kWords), "");  // two missing of a word of two
    EXPECT_EQ(suggestion("bakery", kWords), " Did you mean 'bake'?");  // two of six
    EXPECT_EQ(suggestion("bakeryx", kWords), "");                      // three of seven
    EXPECT_EQ(suggestion("frobnicate", kWords), "");
    EXPECT_EQ(suggestion("", kWords), "");
    EXPECT_EQ(suggestion("-p", kWords), "");  // every letter is one mistake away
    EXPECT_EQ(suggestion("x", {}), "");
}

TEST(NearestWord, IsTheFirstOfSeveral) {
    const std::array<std::string, 3> words = {"cat", "car", "bar"};
    EXPECT_EQ(suggestion("caz", words), " Did you mean 'cat'?");
}

}  // namespace
}  // namespace cdprep::report
