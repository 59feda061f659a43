// SPDX-License-Identifier: MIT
#include "cells/octree_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace cdprep {
namespace {

/// The cell by definition: the last whose first plane is not above x.
std::uint32_t cell_by_planes(double origin, double step, double x, std::uint32_t near) {
    std::uint32_t i = std::min(near + 3, kOctreeSteps - 1);
    while (i > 0 && x < octree_plane(origin, step, i)) --i;
    return i;
}

// Quotients are rounded, so points beside a plane may seem to lie on its other side.
TEST(OctreeCells, PointsBesidePlanesAreInTheCellOfTheDefinition) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    std::size_t rounded_up = 0;
    for (int round = 0; round < 20000; ++round) {
        const double origin = std::ldexp(unit(random) - 0.5, static_cast<int>(random() % 20));
        const double step = std::ldexp(1 + unit(random), -static_cast<int>(random() % 20));
        const std::uint32_t last = kOctreeSteps - 1;
        for (const std::uint32_t plane :
             {0U, 1U, last, last - 1, static_cast<std::uint32_t>(random()) % last}) {
            const double at = octree_plane(origin, step, plane);
            for (const double x :
                 {std::nextafter(at, -HUGE_VAL), at, std::nextafter(at, HUGE_VAL)}) {
                EXPECT_EQ(octree_cell(origin, step, x), cell_by_planes(origin, step, x, plane));
                rounded_up += plane == last && x < at && (x - origin) / step >= last ? 1 : 0;
            }
        }
    }
    EXPECT_GT(rounded_up, 100U);
}

}  // namespace
}  // namespace cdprep
