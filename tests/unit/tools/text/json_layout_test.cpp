// SPDX-License-Identifier: MIT
#include "text/json_layout.h"

#include <gtest/gtest.h>

#include <string>

namespace cdprep::report {
namespace {

std::string nested(std::size_t levels) {
    return std::string(levels, '[') + std::string(levels, ']');
}

TEST(Parsed, ReturnsTheValue) {
    EXPECT_EQ(compact(parsed(R"({"b": [1, 2], "a": "x"})")), R"({"b":[1,2],"a":"x"})");
    EXPECT_EQ(compact(parsed(nested(100))), nested(100));
    EXPECT_TRUE(parsed("[1").is_discarded());
    EXPECT_TRUE(parsed("").is_discarded());
}

// Printing such a value would overflow the stack.
TEST(Parsed, DiscardsADeepValue) {
    EXPECT_TRUE(parsed(nested(3'000'000)).is_discarded());
    EXPECT_TRUE(parsed(R"({"a":)" + nested(1'000) + "}").is_discarded());
    EXPECT_TRUE(parsed<nlohmann::json>(nested(1'000)).is_discarded());
}

}  // namespace
}  // namespace cdprep::report
