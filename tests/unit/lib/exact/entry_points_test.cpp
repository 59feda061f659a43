// SPDX-License-Identifier: MIT
// The public functions of <cdprep/exact/...> beside the private ones, which have oracles of their
// own, and in every floating-point environment.
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "cdprep/exact/predicates.h"
#include "cdprep/exact/triangles.h"
#include "cdprep/exact/winding.h"
#include "exact/exact_within.h"
#include "exact/point_triangle_distance.h"
#include "exact/predicates.h"
#include "exact/triangle_contact.h"
#include "exact/winding.h"
#include "support/answer_bytes.h"
#include "support/float_modes.h"

namespace cdprep {
namespace {

struct Case {
    Corners a;
    Corners b;
};

/// Corners on a coarse grid, where signs are often 0, from everyday sizes to subnormal ones.
std::vector<Case> cases() {
    std::mt19937 random(83);
    std::uniform_int_distribution<int> place(-2, 2);
    std::vector<Case> made;
    for (const double scale : {1.0, 0.1, 0x1p-1060, 0x1p300}) {
        const auto point = [&] {
            return Double3{place(random) * scale, place(random) * scale, place(random) * scale};
        };
        for (int i = 0; i < 300; ++i) {
            made.push_back({{point(), point(), point()}, {point(), point(), point()}});
        }
    }
    return made;
}

/// Everything that the public functions say of a pair of triangles.
void add_answers(const Case& pair, test::AnswerBytes& bytes) {
    const auto& [a, b] = pair;
    bytes.add(exact::orient2d({a[0].x, a[0].y}, {a[1].x, a[1].y}, {b[0].x, b[0].y}));
    bytes.add(exact::orient3d(a[0], a[1], a[2], b[0]));
    const exact::Plane plane(a[0], a[1], a[2]);
    for (const int sign : exact::plane_signs(a, b)) bytes.add(sign);
    for (const Double3& p : b) {
        bytes.add(plane.side(p));
        bytes.add(plane.height(p));
        const PointTriangleDistance distance = exact::point_triangle_distance(p, a);
        bytes.add(distance.lower);
        bytes.add(distance.upper);
        bytes.add(exact::winding_term(exact::before_along_x(p, 1), p, a).crossings);
    }
    bytes.add(exact::triangles_touch(a, b));
    bytes.add(exact::classify_contact(a, b));
    bytes.add(exact::contact_without_filter(a, b));
    bytes.add(exact::is_degenerate(a));
    bytes.add(exact::crossing_ends(a, b).has_value());
    bytes.add(exact::is_within(b, a, 1));
}

TEST(ExactEntryPoints, AnswerAsThePrivateFunctions) {
    std::size_t touching = 0, zeros = 0;
    for (const auto& [a, b] : cases()) {
        const int sign = orient3d(a[0], a[1], a[2], b[0]);
        zeros += sign == 0 ? 1 : 0;
        ASSERT_EQ(exact::orient3d(a[0], a[1], a[2], b[0]), sign);
        const exact::Plane plane(a[0], a[1], a[2]);
        for (std::size_t i = 0; i < 3; ++i) {
            ASSERT_EQ(plane.side(b[i]), orient3d(a[0], a[1], a[2], b[i]));
            ASSERT_EQ(exact::plane_signs(a, b)[i], plane.side(b[i]));
        }
        touching += triangles_touch(a, b) ? 1 : 0;
        ASSERT_EQ(exact::triangles_touch(a, b), triangles_touch(a, b));
        ASSERT_EQ(exact::classify_contact(a, b), classify_contact(a, b));
        ASSERT_EQ(exact::contact_without_filter(a, b), classify_contact(a, b));
        ASSERT_EQ(exact::is_degenerate(a), is_degenerate(a));
        ASSERT_EQ(exact::is_within(b, a, 0.5), is_within_exactly(b, a, 0.5));
    }
    const std::size_t all = cases().size();
    EXPECT_GT(touching, all / 4);
    EXPECT_LT(touching, all * 3 / 4);
    EXPECT_GT(zeros, all / 20);
}

TEST(ExactEntryPoints, AnswerTheSameInEveryMode) {
    const std::vector<Case> all = cases();
    test::AnswerBytes expected;
    for (const Case& pair : all) add_answers(pair, expected);
    for (const test::FloatMode& mode : test::float_modes()) {
        test::AnswerBytes found;
        const std::uint64_t left = test::run_in(mode, [&] {
            for (const Case& pair : all) add_answers(pair, found);
        });
        EXPECT_TRUE(found == expected) << mode.name;
        EXPECT_EQ(left, test::control_bits(mode.control)) << mode.name;
    }
}

// By the header: one to three corners, in every build.
TEST(ExactEntryPointsDeathTest, AnotherNumberOfCornersStopsTheProgram) {
    const Corners t = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    const std::vector<Double3> points(5, {0, 0, 5});
    const auto ask = [&](std::size_t count) {
        return exact::is_within(std::span(points).first(count), t, 5);
    };
    for (const std::size_t count : {1U, 2U, 3U}) EXPECT_TRUE(ask(count)) << count;
    for (const std::size_t count : {0U, 4U, 5U}) {
        EXPECT_DEATH((void)ask(count), "has 1 to 3 corners") << count;
    }
}

}  // namespace
}  // namespace cdprep
