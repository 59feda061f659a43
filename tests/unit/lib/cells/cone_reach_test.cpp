// SPDX-License-Identifier: MIT
#include "cells/cone_reach.h"

#include <gtest/gtest.h>

#include "cells/tetra_cones.h"

namespace cdprep {
namespace {

/// The distances within the whole octant of a corner with positive coordinates.
ConeReach reach_of(const Corners& t) {
    ConeReach reach;
    for (std::uint32_t octant = 8; octant < 16; ++octant) {
        const ConeFaces faces = cone_faces(tetra_cone(octant));
        if (faces.sign != std::array{1.0, 1.0, 1.0}) continue;
        add_reach(faces, seen_triangle({0, 0, 0}, t, 1), reach);
    }
    return reach;
}

// By hand: the sums of the coordinates are 3, 4 and 5.
TEST(AddReach, OfATriangleInsideIsThatOfItsCorners) {
    const ConeReach reach = reach_of({{{1, 1, 1}, {2, 1, 1}, {1, 3, 1}}});
    EXPECT_NEAR(reach.least, 3, 1e-12);
    EXPECT_NEAR(reach.greatest, 5, 1e-12);
    EXPECT_GE(reach.least, 3);
    EXPECT_LE(reach.greatest, 5);
}

// By hand: the part where x > 0 goes from (0, 1, 1) and (0, 2, 1), of sums 2 and 3, to (2, 1, 1).
TEST(AddReach, OfATriangleAcrossAPlaneIsThatOfThePartInside) {
    const ConeReach reach = reach_of({{{-2, 1, 1}, {2, 1, 1}, {-2, 3, 1}}});
    EXPECT_NEAR(reach.least, 2, 1e-5);
    EXPECT_GT(reach.least, 2);
    EXPECT_NEAR(reach.greatest, 4, 1e-12);
}

TEST(AddReach, OfATriangleOutsideIsNothing) {
    const ConeReach reach = reach_of({{{-2, 1, 1}, {-1, 1, 1}, {-2, 3, 1}}});
    EXPECT_GT(reach.least, reach.greatest);
}

TEST(ConeReach, OfBothIsTheWiderOne) {
    ConeReach reach = {2, 3};
    reach.add({1, 2.5});
    EXPECT_EQ(reach.least, 1);
    EXPECT_EQ(reach.greatest, 3);
    reach.add({1.5, 4});
    EXPECT_EQ(reach.least, 1);
    EXPECT_EQ(reach.greatest, 4);
    reach.add({});
    EXPECT_EQ(reach.greatest, 4);
}

}  // namespace
}  // namespace cdprep
