// SPDX-License-Identifier: GPL-3.0-or-later
// Large stars: what the search leaves out, the exact decision denies.
#include "crossings/star_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

#include "crossings/self_intersections.h"
#include "crossings/triangle_meeting.h"

namespace cdprep::mesh {
namespace {

using Pair = std::array<std::uint32_t, 2>;

/// Triangles around vertex 0.
struct GrowingStar {
    Mesh mesh;

    std::uint32_t add_point(const Double3& p) {
        mesh.positions.push_back(p);
        return static_cast<std::uint32_t>(mesh.positions.size() - 1);
    }
    void add(std::uint32_t p, std::uint32_t q, std::mt19937& random) {
        std::array<std::uint32_t, 3> v = {0, p, q};
        std::shuffle(v.begin(), v.end(), random);
        mesh.triangles.push_back({v});
    }
};

/// What the exact decision says of two triangles of a star.
bool meet(const Mesh& mesh, std::uint32_t a, std::uint32_t b) {
    auto v = mesh.triangles[a].vertex, w = mesh.triangles[b].vertex;
    // Common corners first, in the same order.
    std::size_t shared = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto in_w = std::find(w.begin() + static_cast<std::ptrdiff_t>(shared), w.end(), v[i]);
        if (in_w == w.end()) continue;
        std::swap(w[shared], *in_w);
        std::swap(v[shared++], v[i]);
    }
    const auto& p = mesh.positions;
    const Corners in_a = {p[v[0]], p[v[1]], p[v[2]]}, in_b = {p[w[0]], p[w[1]], p[w[2]]};
    if (shared == 1) return meeting_at_corner(in_a, in_b).has_value();
    return shared == 3 || meeting_at_edge(in_a, in_b).has_value();
}

std::vector<std::uint32_t> all_of(const Mesh& mesh) {
    std::vector<std::uint32_t> all(mesh.triangles.size());
    std::iota(all.begin(), all.end(), 0U);
    return all;
}

/// Returns how many pairs meet, and in `visited` how many were visited.
std::size_t expect_none_left_out(const Mesh& mesh, std::size_t& visited) {
    std::set<Pair> pairs;
    const std::vector<std::uint32_t> all = all_of(mesh);
    StarPairs search(mesh, 0, all);
    while (search.advance([&](std::uint32_t a, std::uint32_t b) {
        EXPECT_LT(a, b);
        EXPECT_TRUE(pairs.insert({a, b}).second) << "twice";
    })) {
    }
    visited = pairs.size();
    std::set<Pair> truth;
    for (std::uint32_t a = 0; a < mesh.triangles.size(); ++a) {
        for (std::uint32_t b = a + 1; b < mesh.triangles.size(); ++b) {
            if (meet(mesh, a, b)) truth.insert({a, b});
        }
    }
    EXPECT_TRUE(std::includes(pairs.begin(), pairs.end(), truth.begin(), truth.end()));
    std::set<Pair> found;
    for (const TriangleMeeting& meeting : find_self_intersections(mesh)) {
        found.insert({meeting.a, meeting.b});
    }
    EXPECT_EQ(found, truth);
    return truth.size();
}

/// Spokes in all directions, some triangles narrow and some wide, near 0 or far from it.
TEST(StarPairs, OfRandomStarsNoneIsLeftOut) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> around(-1, 1);
    for (const double scale : {1.0, 0x1p-500, 0x1p1022}) {
        for (const double away : {0.0, 0.5}) {
            GrowingStar star;
            const auto point = [&](const Double3& p) {
                return star.add_point({scale * (p.x + away), scale * (p.y + away), scale * p.z});
            };
            point({0, 0, 0});
            for (int i = 0; i < 500; ++i) {
                const Double3 p = {around(random), around(random), around(random)};
                const double wide = i % 2 == 0 ? 1 : std::pow(10.0, 4 * around(random) - 4);
                const std::uint32_t first = point(p);
                star.add(first,
                         point({p.x + wide * around(random), p.y + wide * around(random),
                                p.z + wide * around(random)}),
                         random);
            }
            std::size_t visited = 0;
            EXPECT_GT(expect_none_left_out(star.mesh, visited), 300U) << scale;
            EXPECT_LT(visited, 500U * 499 / 2 * 7 / 10);
        }
    }
}

// Directions of a coarse grid: many triangles share spokes, lie in one plane, or are copies.
TEST(StarPairs, OfStarsOnAGridNoneIsLeftOut) {
    std::mt19937 random(8);
    for (const int grid : {1, 2, 3}) {
        GrowingStar star;
        star.add_point({0, 0, 0});
        std::vector<std::uint32_t> spokes;
        for (int x = -grid; x <= grid; ++x) {
            for (int y = -grid; y <= grid; ++y) {
                for (int z = -grid; z <= grid; ++z) {
                    if (x == 0 && y == 0 && z == 0) continue;
                    spokes.push_back(star.add_point({x / 4.0, y / 4.0, z / 4.0}));
                }
            }
        }
        while (star.mesh.triangles.size() < 600) {
            const std::uint32_t p = spokes[random() % spokes.size()];
            const std::uint32_t q = spokes[random() % spokes.size()];
            const Double3 &a = star.mesh.positions[p], &b = star.mesh.positions[q];
            const bool flat =
                a.x * b.y == a.y * b.x && a.y * b.z == a.z * b.y && a.z * b.x == a.x * b.z;
            if (!flat) star.add(p, q, random);
        }
        std::size_t visited = 0;
        EXPECT_GT(expect_none_left_out(star.mesh, visited), 1000U) << grid;
    }
}

/// Pages of three books with a common end, some of them at one angle.
TEST(StarPairs, OfBooksThoseAtOneAngleAreLeft) {
    std::mt19937 random(9);
    constexpr std::uint32_t kPages = 300;
    for (const std::uint32_t angles : {7U, 100U, 1000000U}) {
        GrowingStar star;
        star.add_point({0, 0, 0});
        for (const Double3& end : {Double3{0, 0, 1}, Double3{1, 0, 0}, Double3{-1, 0, 0}}) {
            const std::uint32_t spine = star.add_point(end);
            for (std::uint32_t i = 0; i < kPages; ++i) {
                const double t = 6.283185307179586 * (random() % angles) / angles;
                const double far = 1 + static_cast<double>(i) / kPages;
                const double a = far * std::cos(t), b = far * std::sin(t);
                star.add(spine,
                         star.add_point(end.x == 0 ? Double3{a, b, 0.5} : Double3{end.x / 2, a, b}),
                         random);
            }
        }
        std::size_t visited = 0;
        const std::size_t met = expect_none_left_out(star.mesh, visited);
        EXPECT_GT(met, 5000U);
        EXPECT_LT(visited, 3 * kPages * (3 * kPages - 1) / 2 * 9 / 10);
    }
}

/// What would take minutes pair by pair.
TEST(StarPairs, OfManyTrianglesFewAreVisited) {
    std::mt19937 random(10);
    constexpr std::uint32_t kSteps = 20000;
    GrowingStar stair, book;
    stair.add_point({0, 0, 0});
    book.add_point({0, 0, 0});
    const std::uint32_t spine = book.add_point({0, 0, 1});
    const auto step = [](std::uint32_t i) {
        return Double3{std::cos(0.25 * i), std::sin(0.25 * i), 2.0 * i / kSteps - 1};
    };
    for (std::uint32_t i = 0; i < kSteps; ++i) {
        const std::uint32_t first = stair.add_point(step(i));
        stair.add(first, stair.add_point(step(i + 1)), random);
        const double t = 6.283185307179586 * i / kSteps;
        book.add(spine, book.add_point({std::cos(t), std::sin(t), 0.5}), random);
    }
    for (const GrowingStar* star : {&stair, &book}) {
        std::uint64_t visited = 0;
        StarPairs search(star->mesh, 0, all_of(star->mesh));
        while (search.advance([&](std::uint32_t, std::uint32_t) { ++visited; })) {
        }
        EXPECT_LT(visited, std::uint64_t{kSteps} * kSteps / 50);
    }
}

}  // namespace
}  // namespace cdprep::mesh
