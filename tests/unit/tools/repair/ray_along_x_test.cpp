// SPDX-License-Identifier: MIT
#include "repair/ray_along_x.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/meshes.h"

namespace cdprep::mesh {
namespace {

// Twice such a coordinate is no double. The cube reaches from -max to max along each axis.
TEST(RayAlongX, PointsNearTheLargestDoubleHaveTheirWindingNumber) {
    constexpr double kMost = std::numeric_limits<double>::max();
    const test::TestMesh cube = test::unit_cube();
    const auto at = [](const Double3& p) {
        const auto far = [](double x) { return x > 0 ? kMost : -kMost; };
        return Double3{far(p.x), far(p.y), far(p.z)};
    };
    for (const double x : {-kMost, -1e308, -7e307, 0.0, 7e307, 1e308, kMost}) {
        int winding = 0;
        bool on_surface = false;
        for (const test::Triangle& t : cube.triangles) {
            const auto& v = t.vertex;
            const WindingTerm term = winding_term_along_x(
                {x, 1e300, 2e300},
                {at(cube.positions[v[0]]), at(cube.positions[v[1]]), at(cube.positions[v[2]])});
            winding += term.crossings;
            on_surface |= term.on_surface;
        }
        EXPECT_EQ(on_surface, x == kMost || x == -kMost) << x;
        EXPECT_EQ(winding, on_surface ? winding : 1) << x;
    }
    const Corners before = {Double3{-1, -1, 0}, {-1, 1, -1}, {-1, 1, 1}};
    EXPECT_EQ(winding_term_along_x({-kMost, 0, 0}, before).crossings, 0);
}

}  // namespace
}  // namespace cdprep::mesh
