// SPDX-License-Identifier: MIT
#include "mesh/turn_up.h"

#include <gtest/gtest.h>

#include <array>

namespace cdprep::mesh {
namespace {

using format::UpAxis;

constexpr std::array kAxes = {UpAxis::x, UpAxis::y, UpAxis::z};

Double3 turned_point(Double3 p, UpAxis from, UpAxis to) {
    turn_up({&p, 1}, from, to);
    return p;
}

Double3 unit_of(UpAxis axis) {
    return {axis == UpAxis::x ? 1.0 : 0.0, axis == UpAxis::y ? 1.0 : 0.0,
            axis == UpAxis::z ? 1.0 : 0.0};
}

TEST(TurnUp, TakesOneAxisToTheOther) {
    for (const UpAxis from : kAxes) {
        for (const UpAxis to : kAxes) {
            const Double3 up = turned_point(unit_of(from), from, to);
            const Double3 wanted = unit_of(to);
            EXPECT_TRUE(up.x == wanted.x && up.y == wanted.y && up.z == wanted.z);
        }
    }
}

// A rotation keeps the determinant of three points; there and back is where it began.
TEST(TurnUp, IsARotationWithAnInverse) {
    for (const UpAxis from : kAxes) {
        for (const UpAxis to : kAxes) {
            std::array<Double3, 3> p = {{{2, 0.5, 1}, {-1, 3, 0.25}, {4, -2, 8}}};
            const auto determinant = [&] {
                return p[0].x * (p[1].y * p[2].z - p[1].z * p[2].y) -
                       p[0].y * (p[1].x * p[2].z - p[1].z * p[2].x) +
                       p[0].z * (p[1].x * p[2].y - p[1].y * p[2].x);
            };
            const double before = determinant();
            const auto first = p;
            turn_up(p, from, to);
            EXPECT_EQ(determinant(), before);
            turn_up(p, to, from);
            EXPECT_EQ(p, first);
        }
    }
}

TEST(TurnUp, LeavesAnUnknownAxisAlone) {
    const Double3 p = {1, 2, 3};
    EXPECT_EQ(turned_point(p, UpAxis::unknown, UpAxis::y), p);
    EXPECT_EQ(turned_point(p, UpAxis::z, UpAxis::unknown), p);
}

}  // namespace
}  // namespace cdprep::mesh
