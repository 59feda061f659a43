// SPDX-License-Identifier: MIT
#include "import/join_chunks.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace cdprep::import {
namespace {

/// A triangle, and a comb with teeth of two corners each, as faces of one chunk.
PolygonChunk triangle_and_comb(int teeth) {
    PolygonChunk chunk;
    chunk.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, -1, 0}, {2.0 * teeth, -1, 0}};
    for (int i = 2 * teeth; i-- > 0;) chunk.positions.push_back({1.0 * i, i % 2 ? 0.0 : 5.0, 0});
    for (std::uint32_t i = 0; i < chunk.positions.size(); ++i) {
        chunk.corners.push_back(PolygonChunk::kFromChunkStart | i);
        if (i == 2) chunk.end_face(3);
    }
    chunk.end_face(chunk.positions.size() - 3);
    return chunk;
}

Result<mesh::TriangleSoup> joined(std::uint64_t max_polygon_steps) {
    std::vector<PolygonChunk> chunks(1, triangle_and_comb(10));
    return join_chunks(SourceFile("comb.obj", {}), std::move(chunks),
                       {.max_polygon_steps = max_polygon_steps});
}

// A fan instead would be a surface that the file does not describe.
TEST(JoinChunks, RefusesAPolygonThatTakesTooManySteps) {
    const Result<mesh::TriangleSoup> refused = joined(100);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::over_budget);
    EXPECT_EQ(refused.error().message,
              "comb.obj: face 1, whose first triangle is 1, has 22 corners, and cutting it into "
              "triangles takes more than the 100 steps allowed. Split it into smaller faces to "
              "read it.");
    const Result<mesh::TriangleSoup> read = joined(100'000);
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_EQ(read->triangles.size(), 21U);
}

// The order of the faces decides, not that of the threads.
TEST(JoinChunks, NamesTheFirstOfSeveralFacesThatTakeTooManySteps) {
    std::vector<PolygonChunk> chunks;
    for (int i = 0; i < 3; ++i) chunks.push_back(triangle_and_comb(i == 0 ? 1 : 10 + i));
    const Result<mesh::TriangleSoup> refused =
        join_chunks(SourceFile("comb.obj", {}), std::move(chunks), {.max_polygon_steps = 500});
    ASSERT_FALSE(refused.ok());
    EXPECT_NE(refused.error().message.find("face 3, whose first triangle is 4, has 24 corners"),
              std::string::npos)
        << refused.error().message;
}

}  // namespace
}  // namespace cdprep::import
