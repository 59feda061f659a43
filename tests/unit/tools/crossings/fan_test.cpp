// SPDX-License-Identifier: GPL-3.0-or-later
#include "crossings/fan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "crossings/triangle_meeting.h"

namespace cdprep::mesh {
namespace {

constexpr double kTurn = 6.283185307179586;

/// Triangles around vertex 0 from spoke to spoke, in a mixed order.
struct Star {
    Mesh mesh;
    std::vector<std::uint32_t> triangles;
};

Star star_of(std::vector<Double3> spokes, bool closed, std::mt19937& random) {
    Star star;
    star.mesh.positions = {{0.5, -0.25, 3}};
    for (const Double3& p : spokes) {
        const Double3& at = star.mesh.positions[0];
        star.mesh.positions.push_back({at.x + p.x, at.y + p.y, at.z + p.z});
    }
    const auto count = static_cast<std::uint32_t>(spokes.size());
    for (std::uint32_t i = 0; i + (closed ? 0 : 1) < count; ++i) {
        std::array<std::uint32_t, 3> v = {0, 1 + i, 1 + (i + 1) % count};
        std::rotate(v.begin(), v.begin() + random() % 3, v.end());
        star.mesh.triangles.push_back({v});
    }
    std::shuffle(star.mesh.triangles.begin(), star.mesh.triangles.end(), random);
    star.triangles.resize(star.mesh.triangles.size());
    std::iota(star.triangles.begin(), star.triangles.end(), 0U);
    return star;
}

Corners corners_from(const Mesh& mesh, const Triangle& t, std::uint32_t vertex) {
    const auto corner = std::find(t.vertex.begin(), t.vertex.end(), vertex) - t.vertex.begin();
    const auto at = [&](std::ptrdiff_t i) {
        return mesh.positions[t.vertex[static_cast<std::size_t>((corner + i) % 3)]];
    };
    return {at(0), at(1), at(2)};
}

/// Whether any two triangles have more in common than they share.
bool any_meet(const Star& star) {
    for (const Triangle& a : star.mesh.triangles) {
        for (const Triangle& b : star.mesh.triangles) {
            if (&a >= &b) continue;
            std::vector<std::uint32_t> shared;
            for (const std::uint32_t v : a.vertex) {
                if (std::count(b.vertex.begin(), b.vertex.end(), v) != 0) shared.push_back(v);
            }
            if (shared.size() == 3) return true;
            if (shared.size() == 1) {
                if (meeting_at_corner(corners_from(star.mesh, a, 0), corners_from(star.mesh, b, 0)))
                    return true;
                continue;
            }
            const auto edge_first = [&](const Triangle& t) {
                const auto third =
                    std::find_if(t.vertex.begin(), t.vertex.end(),
                                 [&](std::uint32_t v) { return v != shared[0] && v != shared[1]; });
                return Corners{star.mesh.positions[shared[0]], star.mesh.positions[shared[1]],
                               star.mesh.positions[*third]};
            };
            if (meeting_at_edge(edge_first(a), edge_first(b))) return true;
        }
    }
    return false;
}

struct Tally {
    int asked = 0, meet = 0, side_by_side = 0;
};

/// The law: what lies side by side does not meet.
void ask(Fan& fan, const Star& star, Tally& tally) {
    const bool meet = any_meet(star);
    const bool side_by_side = fan.lies_side_by_side(star.mesh, 0, star.triangles);
    ASSERT_FALSE(meet && side_by_side);
    ++tally.asked;
    tally.meet += meet ? 1 : 0;
    tally.side_by_side += side_by_side ? 1 : 0;
}

// Most spokes in the order of their angles, over less than a turn, one, or more.
TEST(Fan, WhatLiesSideBySideDoesNotMeet) {
    std::mt19937 random(20261121);
    std::uniform_real_distribution<double> fine(0, 1);
    Fan fan;
    Tally tally;
    for (int round = 0; round < 6000; ++round) {
        const auto count = 3 + random() % (round % 10 == 0 ? 20 : 7);
        const bool closed = random() % 2 == 0;
        const auto turns =
            closed ? static_cast<double>(1 + random() % 2) : 0.3 + 1.2 * fine(random);
        std::vector<double> angles(count);
        for (double& angle : angles) angle = kTurn * turns * fine(random);
        std::sort(angles.begin(), angles.end());
        if (round % 3 == 0) std::shuffle(angles.begin(), angles.end(), random);
        const double steep = round % 4 == 0 ? 3.0 : 0.3;
        std::vector<Double3> spokes;
        for (const double angle : angles) {
            const double length = 0.2 + fine(random);
            spokes.push_back(
                {length * std::cos(angle), length * std::sin(angle), steep * (fine(random) - 0.5)});
        }
        ask(fan, star_of(spokes, closed, random), tally);
    }
    EXPECT_GT(tally.meet, tally.asked * 3 / 10);
    EXPECT_LT(tally.meet, tally.asked * 7 / 10);
    EXPECT_GT(tally.side_by_side, tally.asked * 2 / 10);
}

// On a grid rays coincide, sectors are straight or folded, and all lies in a few planes.
TEST(Fan, WhatLiesSideBySideOnAGridDoesNotMeet) {
    std::mt19937 random(7);
    Fan fan;
    Tally tally;
    for (int round = 0; round < 20'000; ++round) {
        std::vector<Double3> spokes;
        const auto draw = [&] { return static_cast<double>(random() % 3) - 1; };
        const auto count = 3 + random() % 4;
        while (spokes.size() < count) {
            const Double3 p{draw(), draw(), round % 2 == 0 ? 0 : draw()};
            if (std::find(spokes.begin(), spokes.end(), p) == spokes.end() && p != Double3{0, 0, 0})
                spokes.push_back(p);
        }
        const Star star = star_of(spokes, random() % 2 == 0, random);
        const auto has_area = [&](const Triangle& t) {
            return !exact::is_degenerate(corners_from(star.mesh, t, 0));
        };
        if (!std::all_of(star.mesh.triangles.begin(), star.mesh.triangles.end(), has_area))
            continue;
        ask(fan, star, tally);
    }
    EXPECT_GT(tally.meet, tally.asked * 3 / 10);
    EXPECT_LT(tally.meet, tally.asked * 7 / 10);
    EXPECT_GT(tally.side_by_side, tally.asked / 10);
}

}  // namespace
}  // namespace cdprep::mesh
