// SPDX-License-Identifier: MIT
#include "walk/triangles_at_vertex.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "support/meshes.h"
#include "support/open_tiny.h"

namespace cdprep::test {
namespace {

std::vector<std::uint32_t> by_brute_force(const Model& model, std::uint32_t vertex) {
    std::vector<std::uint32_t> found;
    for (std::uint32_t t = 0; t < model.triangle_count(); ++t) {
        const auto& corners = model.mesh().triangles[t].vertex;
        if (std::find(corners.begin(), corners.end(), vertex) != corners.end()) found.push_back(t);
    }
    return found;
}

TEST(TrianglesAtVertex, AreThoseOfBruteForce) {
    Workspace workspace;
    const TestMesh ring = torus(2, 0.5, 24, 12);
    const std::vector<TestMesh> meshes = {
        // the second in floats
        ring, in_floats(ring), moved_by(ring, 1, {0x1p20, -0x1p21, 0x1p19}),
        moved_by(ring, 0x1p-500, {0, 0, 0}), moved_by(ring, 0x1p500, {0, 0, 0})};
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        SCOPED_TRACE(i);
        const OpenModel open = open_tiny(meshes[i], {.double_precision = i != 1});
        for (std::uint32_t vertex = 0; vertex < open.model.vertex_count(); ++vertex) {
            std::vector<std::uint32_t> found;
            EXPECT_TRUE(visit_triangles_at(open.model, vertex, workspace.storage(),
                                           [&](std::uint32_t triangle) {
                                               found.push_back(triangle);
                                               return true;
                                           }));
            std::sort(found.begin(), found.end());
            ASSERT_EQ(found, by_brute_force(open.model, vertex)) << vertex;
        }
    }
}

TEST(TrianglesAtVertex, EndWhenTheVisitSaysSo) {
    Workspace workspace;
    const OpenModel open = open_tiny(torus(2, 0.5, 24, 12));
    int visits = 0;
    EXPECT_FALSE(visit_triangles_at(open.model, 0, workspace.storage(),
                                    [&](std::uint32_t) { return ++visits < 2; }));
    EXPECT_EQ(visits, 2);
}

}  // namespace
}  // namespace cdprep::test
