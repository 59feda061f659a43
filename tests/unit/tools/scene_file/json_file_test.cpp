// SPDX-License-Identifier: MIT
#include "scene_file/json_file.h"

#include <gtest/gtest.h>

#include <string>

namespace cdprep::scenes {
namespace {

std::string refusal_of(const std::string& text) {
    const Result<JsonFile> file = parse_json_file("f", text);
    EXPECT_FALSE(file.ok()) << text;
    if (file) return "";
    EXPECT_EQ(file.error().code, ErrorCode::unreadable);
    return file.error().message;
}

// The lines can be counted by hand: numbers, which end with a look at the next character, stand
// before line ends.
TEST(JsonFile, KnowsTheLineOfEachValue) {
    const Result<JsonFile> file = parse_json_file(
        "f", "\n{\n\"a\": 1\n,\"b\": [2,\n3\n],\n\"c/~\": {\"d\":\nnull}, \"e\": \"x\"\n}");
    ASSERT_TRUE(file);
    const std::unordered_map<std::string, std::size_t> expected = {
        {"", 2},     {"/a", 3},     {"/b", 4},       {"/b/0", 4},
        {"/b/1", 5}, {"/c~1~0", 7}, {"/c~1~0/d", 8}, {"/e", 8}};
    EXPECT_EQ(file->lines, expected);
    EXPECT_EQ(file->root["b"][1], 3);
    for (const auto& [pointer, line] : file->lines) {
        EXPECT_TRUE(file->root.contains(nlohmann::json::json_pointer(pointer))) << pointer;
    }
}

TEST(JsonFile, ReadsALoneNumber) {
    const Result<JsonFile> file = parse_json_file("f", "\n\n7");
    ASSERT_TRUE(file);
    EXPECT_EQ(file->root, 7);
    EXPECT_EQ(file->lines.at(""), 3u);
}

TEST(JsonFile, NamesTheLineOfASyntaxError) {
    EXPECT_EQ(refusal_of("{\n\"a\": 1,\n\"b\" 2}").substr(0, 45),
              "f: line 3: this is not JSON: syntax error whi");
    EXPECT_NE(refusal_of("").find("f: line 1: this is not JSON"), std::string::npos);
    EXPECT_NE(refusal_of("{\n}\n}").find("f: line 3: this is not JSON"), std::string::npos);
    EXPECT_NE(refusal_of("[1,\n1e999]").find("f: line 2: this is not JSON: number overflow"),
              std::string::npos);
}

TEST(JsonFile, RefusesAKeyThatStandsTwice) {
    EXPECT_EQ(refusal_of("{\"a\": 1,\n\"a\": 1}"),
              "f: line 2: the key 'a' occurs twice in one object.");
}

// A hostile file: its pointers would take quadratic memory.
TEST(JsonFile, RefusesDeepNesting) {
    EXPECT_TRUE(parse_json_file("f", std::string(128, '[') + std::string(128, ']')));
    EXPECT_EQ(refusal_of(std::string(1'000'000, '[')),
              "f: line 1: values are nested deeper than 128 levels.");
}

}  // namespace
}  // namespace cdprep::scenes
