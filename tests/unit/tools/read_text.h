// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "import/source_file.h"
#include "mesh/mesh.h"

namespace cdprep::test {

/// Reads from an allocation of exactly the text's size.
template <class Reader>
Result<mesh::TriangleSoup> read_text(Reader reader, const char* name, const std::string& text,
                                     const import::ImportOptions& options = {}) {
    const std::vector<char> exact(text.begin(), text.end());
    return reader(import::SourceFile(name, {exact.data(), exact.size()}), options);
}

/// What was read from `text`, which has to be sound.
inline mesh::TriangleSoup sound(Result<mesh::TriangleSoup> result, const std::string& text) {
    EXPECT_TRUE(result.ok()) << text << (result.ok() ? "" : result.error().message);
    return result.ok() ? std::move(result).value() : mesh::TriangleSoup{};
}

/// Why it could not be read.
inline std::string refusal(const Result<mesh::TriangleSoup>& result) {
    EXPECT_FALSE(result.ok());
    if (result.ok()) return {};
    EXPECT_EQ(result.error().code, ErrorCode::unreadable);
    return result.error().message;
}

}  // namespace cdprep::test
