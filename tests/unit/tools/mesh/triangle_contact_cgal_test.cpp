// SPDX-License-Identifier: MIT
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <random>

#include "support/hard_triangles.h"

#include "exact/triangle_contact.h"

namespace cdprep::test {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;

Kernel::Point_3 point(const Double3& p) {
    return {p.x, p.y, p.z};
}

/// CGAL takes triangles with area only.
bool cgal_says(const Corners& a, const Corners& b) {
    return CGAL::do_intersect(Kernel::Triangle_3(point(a[0]), point(a[1]), point(a[2])),
                              Kernel::Triangle_3(point(b[0]), point(b[1]), point(b[2])));
}

TEST(TriangleContactAgainstCgal, AgreesOnTheHardCases) {
    int compared = 0;
    for (const HardPair& pair : hard_triangles()) {
        if (is_degenerate(pair.a) || is_degenerate(pair.b)) continue;
        ++compared;
        for (std::size_t i = 0; i < kRelabellings; ++i) {
            const HardPair p = relabelled(pair, i);
            ASSERT_EQ(triangles_touch(p.a, p.b), cgal_says(p.a, p.b)) << p.id << ' ' << i;
        }
    }
    EXPECT_GT(compared, 50);
}

Corners random_triangle(std::mt19937& random, bool coarse) {
    std::uniform_int_distribution<int> grid(-2, 2);
    std::uniform_real_distribution<double> fine(-1, 1);
    Corners t;
    do {
        for (Double3& p : t) {
            const auto draw = [&] { return coarse ? 0.1 * grid(random) : fine(random); };
            p = {draw(), draw(), draw()};
        }
    } while (is_degenerate(t));
    return t;
}

TEST(TriangleContactAgainstCgal, AgreesOnRandomPairs) {
    constexpr std::uint32_t kSeed = 13;
    std::mt19937 random(kSeed);
    constexpr int kRounds = 40'000;
    int touching = 0;
    for (int round = 0; round < kRounds; ++round) {
        const Corners a = random_triangle(random, round % 2 == 0);
        Corners b = random_triangle(random, round % 2 == 0);
        if (round % 5 == 0) b[1] = a[2];
        if (is_degenerate(b)) continue;
        const bool truth = cgal_says(a, b);
        ASSERT_EQ(triangles_touch(a, b), truth) << "seed " << kSeed << ", round " << round;
        ASSERT_EQ(triangles_touch_by_segments(a, b), truth) << "seed " << kSeed << ' ' << round;
        touching += truth ? 1 : 0;
    }
    EXPECT_GT(touching, kRounds * 3 / 10);
    EXPECT_LT(touching, kRounds * 7 / 10);
}

}  // namespace
}  // namespace cdprep::test
