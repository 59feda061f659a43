// SPDX-License-Identifier: MIT
#include "repair/moved_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "unit/tools/repair_mesh_of.h"
#include "unit/tools/soup_of.h"

namespace cdprep::mesh {
namespace {

constexpr double kFar = 1073741824;     // 2^30
constexpr double kUlp = 1.0 / 4194304;  // 2^-22, the distance of doubles there

Double3 far_off(double x, double y, double z) {
    return {kFar + x * kUlp, kFar + y * kUlp, z * kUlp};
}

/// The largest distance from the segment to the valley, in steps of kUlp. Along z nothing changes.
double deepest_in_valley() {
    double most = 0;
    for (int i = 0; i <= 100'100; ++i) {
        const double x = i / 100.0, y = x / 1001;
        const double left = (100 * x + 500 * y) / std::hypot(100, 500);
        const double right = (100 * (1001 - x) + 501 * y) / std::hypot(100, 501);
        most = std::max(most, std::min(left, right));
    }
    return most;
}

// A flat triangle lies over a valley of two rectangles, and is dropped. Doubles are coarse here:
// the middles of its parts are rounded to one of few.
TEST(MovedDistance, TheBoundsHoldFarFromTheOrigin) {
    test::TestMesh valley;
    valley.positions = {far_off(0, 0, -4000),   far_off(500, -100, -4000), far_off(500, -100, 4000),
                        far_off(0, 0, 4000),    far_off(500, -100, -4000), far_off(1001, 0, -4000),
                        far_off(1001, 0, 4000), far_off(500, -100, 4000)};
    valley.triangles = {{{0, 1, 2}}, {{0, 2, 3}}, {{4, 5, 6}}, {{4, 6, 7}}};
    test::TestMesh input = valley;
    input.positions.push_back(far_off(0, 0, 0));
    input.positions.push_back(far_off(1001, 1, 0));
    input.triangles.push_back({{8, 9, 9}});
    const MovedDistances moved =
        find_moved_distances(test::soup_of(input), test::repair_mesh_of(valley));
    const double truth = deepest_in_valley() * kUlp;
    EXPECT_GE(moved.input_to_output.upper, truth);
    EXPECT_LE(moved.input_to_output.lower, truth * (1 + 1e-6));
    EXPECT_LE(moved.input_to_output.upper, truth + 100 * kUlp);
    EXPECT_GE(moved.input_to_output.lower, truth - 100 * kUlp);
    EXPECT_EQ(moved.output_to_input.upper, 0.0);
}

}  // namespace
}  // namespace cdprep::mesh
