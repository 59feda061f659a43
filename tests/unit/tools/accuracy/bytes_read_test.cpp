// SPDX-License-Identifier: MIT
#include "accuracy/bytes_read.h"

#include <gtest/gtest.h>

#include "cdprep/pairs.h"
#include "study/memory_model.h"
#include "unit/tools/soup_of.h"

namespace cdprep::study {
namespace {

// By hand: a node is 192 bytes and 384 more with tight bounds, a leaf 320, a triangle three
// numbers of 4 bytes and three corners of three doubles.
TEST(BytesRead, AreCountedByWhatIsRead) {
    const mesh::Mesh cube = test::mesh_of(test::unit_cube());
    const MemoryModel plain =
        make_memory_model(cube, {.bounds = build::BvhBounds::aligned}).value();
    const MemoryModel tight = make_memory_model(cube).value();
    const double corner = plain.model.mesh().positions_f64.empty() ? 12 : 24;
    const auto of = [&](const QueryCounts& counts) {
        return bytes_read(counts, plain.model, tight.model);
    };
    EXPECT_EQ(of({}), 0);
    EXPECT_EQ(of({.node_pairs = 3}), 3 * (192 + 192 + 384));
    EXPECT_EQ(of({.leaf_pairs = 5}), 5 * 2 * 320);
    EXPECT_EQ(of({.by_kernel = 9, .by_filter = 1, .measured = 1}), 2 * 2 * (12 + 3 * corner));
}

// The cube has 12 triangles, so two leaves below one node: a collision reads that of both.
TEST(BytesRead, OfCasesAreTheMean) {
    const MemoryModel cube = make_memory_model(test::mesh_of(test::unit_cube())).value();
    Workspace workspace;
    const auto ask = [&](std::size_t number) {
        const double x = number == 0 ? 0.5 : 9;  // the other one is far away and reads nothing
        const Pose pose = Pose::from_quaternion(1, 0, 0, 0, {x, 0.25, 0.125}).value();
        static_cast<void>(collide({cube.model, cube.model, Placement::b_moves(pose)}, workspace));
    };
    const double one = mean_bytes_read(cube.model, cube.model, workspace, 1, ask);
    EXPECT_GE(one, 2 * (192 + 384) + 2 * 320);
    EXPECT_LE(mean_bytes_read(cube.model, cube.model, workspace, 2, ask), one / 2 + 192 + 384);
    EXPECT_EQ(mean_bytes_read(cube.model, cube.model, workspace, 0, ask), 0);
}

}  // namespace
}  // namespace cdprep::study
