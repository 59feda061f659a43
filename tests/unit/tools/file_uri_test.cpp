// SPDX-License-Identifier: MIT
#include "report/file_uri.h"

#include <gtest/gtest.h>

namespace cdprep::report {
namespace {

// By RFC 3986: everything but letters, digits and -._~ is written as its bytes.
TEST(FileUri, IsRelativeBelowTheFolder) {
    EXPECT_EQ(file_uri("a/b.obj", "/work"), "a/b.obj");
    EXPECT_EQ(file_uri("./a/../b.obj", "/work"), "b.obj");
    EXPECT_EQ(file_uri("/work/a/b.obj", "/work"), "a/b.obj");
    EXPECT_EQ(file_uri("/work/a/b.obj", "/work/"), "a/b.obj");
    EXPECT_EQ(file_uri("a b%#?:.obj", "/work"), "a%20b%25%23%3F%3A.obj");
    EXPECT_EQ(file_uri("\xc3\xa9\xff.obj", "/work"), "%C3%A9%FF.obj");
    EXPECT_EQ(file_uri("..a/b.obj", "/work"), "..a/b.obj");
}

TEST(FileUri, IsWholeElsewhere) {
    EXPECT_EQ(file_uri("../b.obj", "/work/here"), "file:///work/b.obj");
    EXPECT_EQ(file_uri("/else where/b.obj", "/work"), "file:///else%20where/b.obj");
    EXPECT_EQ(file_uri("/workshop/b.obj", "/work"), "file:///workshop/b.obj");
    EXPECT_EQ(file_uri("/work", "/work"), "file:///work");
}

}  // namespace
}  // namespace cdprep::report
