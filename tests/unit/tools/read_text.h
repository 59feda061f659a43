// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "import/source_file.h"
#include "mesh/mesh.h"

namespace cdprep::test {

inline const std::vector<mesh::Double3> kSquare = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

/// Reads texts in one format.
template <class Reader>
class TextReader {
public:
    constexpr TextReader(Reader reader, const char* name) : reader_(reader), name_(name) {}

    /// Reads from an allocation of exactly the text's size.
    [[nodiscard]] Result<mesh::TriangleSoup> read(const std::string& text,
                                                  const import::ImportOptions& options = {}) const {
        const std::vector<char> exact(text.begin(), text.end());
        return reader_(import::SourceFile(name_, {exact.data(), exact.size()}), options);
    }
    /// What is read from a text that has to be sound.
    [[nodiscard]] mesh::TriangleSoup soup(const std::string& text) const {
        Result<mesh::TriangleSoup> result = read(text);
        EXPECT_TRUE(result.ok()) << text << (result.ok() ? "" : result.error().message);
        return result.ok() ? std::move(result).value() : mesh::TriangleSoup{};
    }
    /// Why a text cannot be read.
    [[nodiscard]] std::string refusal(const std::string& text) const {
        const Result<mesh::TriangleSoup> result = read(text);
        EXPECT_FALSE(result.ok());
        if (result.ok()) return {};
        EXPECT_EQ(result.error().code, ErrorCode::unreadable);
        return result.error().message;
    }

private:
    Reader reader_;
    const char* name_;
};

}  // namespace cdprep::test
