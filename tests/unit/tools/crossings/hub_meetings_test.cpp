// SPDX-License-Identifier: MIT
// Vertices with more than 512 triangles, against the exact decision on every pair.
#include "crossings/hub_meetings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <utility>

#include "crossings/triangle_meeting.h"
#include "support/large_stars.h"
#include "unit/tools/soup_of.h"

namespace cdprep::mesh {
namespace {

using Pair = std::array<std::uint32_t, 2>;

constexpr std::uint32_t kMany = 700;  ///< triangles around a vertex
constexpr std::uint32_t kHubSeed = 20261122;

bool share_a_vertex(const Mesh& mesh, std::uint32_t a, std::uint32_t b) {
    const auto& v = mesh.triangles[a].vertex;
    const auto& w = mesh.triangles[b].vertex;
    return std::any_of(v.begin(), v.end(), [&w](std::uint32_t vertex) {
        return std::find(w.begin(), w.end(), vertex) != w.end();
    });
}

bool has_area(const Mesh& mesh, std::uint32_t triangle) {
    return !exact::is_degenerate(corners_of(mesh, triangle));
}

/// The pairs without a common vertex, one by one.
std::set<Pair> pairs_apart(const Mesh& mesh) {
    std::set<Pair> pairs;
    const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
    for (std::uint32_t a = 0; a < count; ++a) {
        if (!has_area(mesh, a)) continue;
        for (std::uint32_t b = a + 1; b < count; ++b) {
            if (!has_area(mesh, b) || share_a_vertex(mesh, a, b)) continue;
            if (meeting_apart(corners_of(mesh, a), corners_of(mesh, b))) pairs.insert({a, b});
        }
    }
    return pairs;
}

/// Returns how many pairs meet of which one triangle is at a hub.
std::size_t expect_all_apart(const test::TestMesh& test_mesh) {
    const Mesh mesh = test::mesh_of(test_mesh);
    const Hubs hubs(mesh, VertexStars(mesh, {}));
    EXPECT_FALSE(hubs.empty());
    std::set<Pair> found;
    std::size_t at_hubs = 0;
    for (const TriangleMeeting& meeting : find_self_intersections(mesh)) {
        if (share_a_vertex(mesh, meeting.a, meeting.b)) continue;
        EXPECT_TRUE(found.insert({meeting.a, meeting.b}).second) << "twice";
        at_hubs += hubs.has(meeting.a) || hubs.has(meeting.b) ? 1 : 0;
    }
    EXPECT_EQ(found, pairs_apart(mesh));
    return at_hubs;
}

TEST(HubMeetings, OfConesThroughEachOtherNoneIsLeftOut) {
    for (const double height : {1.0, 0.01}) {
        for (const double angle : {0.0, 0.3, 1.1}) {
            const test::TestMesh cones =
                test::joined(test::turned(test::double_cone(kMany, height), angle),
                             test::moved_by(test::turned(test::double_cone(kMany, 0.5), 2 * angle),
                                            0.7, {0.6, 0.25, 0.125}));
            EXPECT_GT(expect_all_apart(cones), 100U) << height << ' ' << angle;
            EXPECT_GT(expect_all_apart(test::moved_by(cones, 1, {1e6, -1e6, 1e5})), 100U);
        }
    }
}

TEST(HubMeetings, OfAStarAndASoupNoneIsLeftOut) {
    const test::TestMesh mesh =
        test::joined(test::random_star(kHubSeed, kMany), test::random_soup(kHubSeed, 300, 0.3));
    for (const double scale : {1.0, 0x1p-500, 0x1p500, 0x1p1000}) {
        EXPECT_GT(expect_all_apart(test::moved_by(mesh, scale, {0, 0, 0})), 3000U) << scale;
    }
}

// On a grid much lies in one plane or in line with the hub, or touches it.
TEST(HubMeetings, OfStarsOnAGridNoneIsLeftOut) {
    std::mt19937 random(kHubSeed);
    const auto number = [&random](std::uint32_t below) {
        return static_cast<std::uint32_t>(random() % below);
    };
    for (const int grid : {2, 3, 5}) {
        test::TestMesh mesh;
        for (int x = -grid; x <= grid; ++x) {
            for (int y = -grid; y <= grid; ++y) {
                for (int z = -1; z <= 1; ++z) {
                    mesh.positions.push_back({double(x), double(y), double(z)});
                }
            }
        }
        const auto points = static_cast<std::uint32_t>(mesh.positions.size());
        // Two hubs, with triangles at both, and triangles at none.
        for (std::uint32_t i = 0; i < 3 * kMany; ++i) {
            const std::uint32_t a = i < 2 * kMany ? i % 2 : number(points);
            const std::uint32_t b = i % 9 == 0 ? (a + 1) % points : number(points);
            const std::uint32_t c = number(points);
            if (a != b && b != c && c != a) mesh.triangles.push_back({{a, b, c}});
        }
        // The hubs are the middle and its neighbour, which other triangles pass through.
        std::swap(mesh.positions[0], mesh.positions[points / 2]);
        std::swap(mesh.positions[1], mesh.positions[points / 2 + 3]);
        EXPECT_GT(expect_all_apart(mesh), 10000U) << grid;
    }
}

// A book of triangles at one edge: both ends are hubs.
TEST(HubMeetings, OfABookAndASoupNoneIsLeftOut) {
    test::TestMesh book;
    book.positions = {{0, 0, -1}, {0, 0, 1}};
    for (std::uint32_t i = 0; i < kMany; ++i) {
        const double angle = 6.283185307179586 * i / kMany;
        book.positions.push_back({std::cos(angle), std::sin(angle), 0.5});
        book.triangles.push_back({{0, 1, i + 2}});
    }
    EXPECT_GT(expect_all_apart(test::joined(book, test::random_soup(kHubSeed, 300, 0.3))), 1000U);
}

/// Counted, so that no machine is too slow: 64 steps a triangle are some 2 us.
TEST(HubMeetings, OfADoubleConeTheStepsAreLinear) {
    for (const std::uint32_t count : {1000U, 10000U, 100000U}) {
        for (const double height : {1.0, 0.001}) {
            const Mesh mesh = test::mesh_of(test::turned(test::double_cone(count, height), 0.7));
            SearchOptions options;
            options.limits.steps = 64 * mesh.triangles.size();
            std::size_t found = 0;
            EXPECT_TRUE(search_self_intersections(
                mesh, options,
                [&](std::span<const TriangleMeeting> some) { found += some.size(); }))
                << count << ' ' << height;
            EXPECT_EQ(found, 0U);
        }
    }
}

/// Two caps and a wall, as a cylinder has them, in no special direction.
TEST(HubMeetings, OfACylinderTheStepsAreLinear) {
    constexpr std::uint32_t kCount = 20000;
    test::TestMesh mesh = test::double_cone(kCount, 0);
    mesh.positions[1].z = 1;
    for (std::uint32_t i = 0; i < kCount; ++i) {
        const Double3 p = mesh.positions[2 + i];
        mesh.positions.push_back({p.x, p.y, 1});
    }
    for (std::uint32_t i = 0; i < kCount; ++i) {
        const std::uint32_t a = 2 + i, b = 2 + (i + 1) % kCount;
        mesh.triangles[2 * i + 1] = {{1, b + kCount, a + kCount}};
        mesh.triangles.push_back({{a, a + kCount, b}});
        mesh.triangles.push_back({{b, a + kCount, b + kCount}});
    }
    for (const double angle : {0.0, 0.7}) {
        const Mesh turned = test::mesh_of(test::turned(mesh, angle));
        SearchOptions options;
        options.limits.steps = 64 * turned.triangles.size();
        EXPECT_TRUE(search_self_intersections(turned, options, [](auto) {})) << angle;
    }
}

}  // namespace
}  // namespace cdprep::mesh
