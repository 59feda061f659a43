// SPDX-License-Identifier: MIT
#include "study/rigid_truth.h"

#include <gtest/gtest.h>

#include "study/memory_model.h"
#include "unit/tools/soup_of.h"

namespace cdprep::study {
namespace {

Pose shifted(double x, double y, double z) {
    return Pose::from_quaternion(1, 0, 0, 0, {x, y, z}).value();
}

MemoryModel cube() {
    return make_memory_model(test::mesh_of(test::unit_cube())).value();
}

// By hand: the second cube's corner is well inside of the first.
TEST(RigidTruth, ACrossingThatNoRoundingUndoesIsProved) {
    const MemoryModel model = cube();
    const SourceTriangles of(model.model);
    Workspace workspace;
    EXPECT_TRUE(crosses_when_rigid(of, of, shifted(0.5, 0.25, 0.375), workspace));
}

// By hand: faces in one plane touch, and part when either moves by the least.
TEST(RigidTruth, ATouchThatRoundingMayUndoIsNotProved) {
    const MemoryModel model = cube();
    const SourceTriangles of(model.model);
    Workspace workspace;
    EXPECT_FALSE(crosses_when_rigid(of, of, shifted(1, 0.25, 0.375), workspace));
    EXPECT_FALSE(crosses_when_rigid(of, of, shifted(3, 0, 0), workspace));
}

// The cube reaches 1 along each axis and is 4 away: 16 units of the last place of 3 + 4.
TEST(RigidTruth, AGapIsProvedWhenItIsLargerThanTheRounding) {
    const MemoryModel model = cube();
    const double rounding = rounding_of_pose(model.model, shifted(4, 0, 0));
    EXPECT_EQ(rounding, 16 * 0x1p-53 * 7);
    EXPECT_TRUE(is_apart_when_rigid(model.model, shifted(4, 0, 0), 3));
    EXPECT_TRUE(is_apart_when_rigid(model.model, shifted(4, 0, 0), 1e-13));
    EXPECT_FALSE(is_apart_when_rigid(model.model, shifted(4, 0, 0), 1e-15));
}

}  // namespace
}  // namespace cdprep::study
