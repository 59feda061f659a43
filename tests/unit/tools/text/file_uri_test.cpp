// SPDX-License-Identifier: MIT
#include "text/file_uri.h"

#include <gtest/gtest.h>

namespace cdprep::report {
namespace {

// By RFC 3986: everything but letters, digits and -._~ is written as its bytes.
TEST(FileUri, IsRelativeBelowTheFolder) {
    EXPECT_EQ(file_uri("a/b.obj", "/meshes"), "a/b.obj");
    EXPECT_EQ(file_uri("./a/../b.obj", "/meshes"), "b.obj");
    EXPECT_EQ(file_uri("/meshes/a/b.obj", "/meshes"), "a/b.obj");
    EXPECT_EQ(file_uri("/meshes/a/b.obj", "/meshes/"), "a/b.obj");
    EXPECT_EQ(file_uri("a b%#?:.obj", "/meshes"), "a%20b%25%23%3F%3A.obj");
    EXPECT_EQ(file_uri("\xc3\xa9\xff.obj", "/meshes"), "%C3%A9%FF.obj");
    EXPECT_EQ(file_uri("..a/b.obj", "/meshes"), "..a/b.obj");
}

TEST(FileUri, IsWholeElsewhere) {
    EXPECT_EQ(file_uri("../b.obj", "/meshes/here"), "file:///meshes/b.obj");
    EXPECT_EQ(file_uri("/else where/b.obj", "/meshes"), "file:///else%20where/b.obj");
    EXPECT_EQ(file_uri("/meshesx/b.obj", "/meshes"), "file:///meshesx/b.obj");
    EXPECT_EQ(file_uri("/meshes", "/meshes"), "file:///meshes");
}

}  // namespace
}  // namespace cdprep::report
