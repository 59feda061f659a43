// SPDX-License-Identifier: GPL-3.0-or-later
#include "query/inaccessible/radial_cover.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "support/meshes.h"

namespace cdprep::mesh {
namespace {

using test::TestMesh;

constexpr Double3 kOrigin = {0, 0, 0};

std::vector<std::uint32_t> all_of(const TestMesh& mesh) {
    std::vector<std::uint32_t> numbers(mesh.triangles.size());
    std::iota(numbers.begin(), numbers.end(), 0U);
    return numbers;
}

std::vector<std::uint32_t> hidden_in(const TestMesh& mesh, const Double3& centre = kOrigin) {
    const RadialCover cover(centre, mesh.positions, mesh.triangles);
    std::vector<std::uint32_t> hidden;
    for (const std::uint32_t t : all_of(mesh)) {
        if (cover.is_hidden(t, all_of(mesh))) hidden.push_back(t);
    }
    return hidden;
}

std::vector<std::uint32_t> range(std::uint32_t first, std::uint32_t last) {
    std::vector<std::uint32_t> numbers(last - first);
    std::iota(numbers.begin(), numbers.end(), first);
    return numbers;
}

TEST(RadialCover, ConvexSurfaceHidesNothing) {
    EXPECT_TRUE(hidden_in(test::icosphere(2)).empty());
}

TEST(RadialCover, OuterShellHidesTheInner) {
    const TestMesh outer = test::icosphere(2);
    const TestMesh both = test::joined(outer, test::moved_by(test::icosphere(2), 0.5, kOrigin));
    const auto count = static_cast<std::uint32_t>(outer.triangles.size());
    EXPECT_EQ(hidden_in(both), range(count, 2 * count));
    // Seen from a centre elsewhere, whose cones cut across the triangles.
    const TestMesh inner = test::moved_by(test::icosphere(1), 0.25, {0.1, 0.2, -0.1});
    EXPECT_EQ(hidden_in(test::joined(outer, inner), {0.1, 0.15, -0.05}),
              range(count, count + static_cast<std::uint32_t>(inner.triangles.size())));
}

// The inner triangle fills the window exactly: shared edges leave no slit.
TEST(RadialCover, WindowBaresWhatItShows) {
    TestMesh outer = test::icosphere(1);
    const TestMesh inner = test::moved_by(outer, 0.5, kOrigin);
    constexpr std::uint32_t kWindow = 17;
    outer.triangles.erase(outer.triangles.begin() + kWindow);
    const auto first = static_cast<std::uint32_t>(outer.triangles.size());
    std::vector<std::uint32_t> expected =
        range(first, first + static_cast<std::uint32_t>(inner.triangles.size()));
    expected.erase(expected.begin() + kWindow);
    EXPECT_EQ(hidden_in(test::joined(outer, inner)), expected);
}

TEST(RadialCover, ScaleChangesNothing) {
    for (const int exponent : {-900, 900}) {
        const double scale = std::ldexp(1.0, exponent);
        const TestMesh outer = test::moved_by(test::icosphere(0), scale, kOrigin);
        const TestMesh inner = test::moved_by(test::icosphere(0), scale / 2, kOrigin);
        EXPECT_EQ(hidden_in(test::joined(outer, inner)), range(20, 40)) << exponent;
    }
}

TEST(RadialCover, EdgeOnTrianglesNeitherHideNorAreHidden) {
    TestMesh mesh = test::joined(test::icosphere(1), test::fan(5));
    const RadialCover cover(kOrigin, mesh.positions, mesh.triangles);
    const std::vector<std::uint32_t> all = all_of(mesh);
    for (std::uint32_t t = 80; t < 85; ++t) {
        EXPECT_TRUE(cover.is_edge_on(t));
        EXPECT_FALSE(cover.is_hidden(t, all));
    }
    EXPECT_TRUE(hidden_in(mesh).empty());
}

TEST(RadialCover, OwnPlaneDoesNotHide) {
    EXPECT_TRUE(hidden_in(test::moved_by(test::copies_of_one_triangle(3), 1, {0, 0, 1})).empty());
}

// --- Against all cells of the arrangement of all planes, in whole numbers ---------

__extension__ typedef __int128 Int128;  // NOLINT(modernize-use-using)
using Whole = std::array<Int128, 3>;

Whole cross(const Whole& a, const Whole& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Int128 dot(const Whole& a, const Whole& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Whole sum(const Whole& a, const Whole& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

/// Three corners, turned outwards; the inward normals of the cone; the supporting plane.
struct WholeTriangle {
    std::array<Whole, 3> side;
    Whole normal;
    Int128 height;
};

WholeTriangle whole(const TestMesh& mesh, std::uint32_t t) {
    std::array<Whole, 3> p;
    for (std::size_t i = 0; i < 3; ++i) {
        const Double3& q = mesh.positions[mesh.triangles[t].vertex[i]];
        p[i] = {static_cast<Int128>(q.x), static_cast<Int128>(q.y), static_cast<Int128>(q.z)};
    }
    if (dot(cross(p[0], p[1]), p[2]) < 0) std::swap(p[1], p[2]);
    const std::array<Whole, 3> side = {cross(p[0], p[1]), cross(p[1], p[2]), cross(p[2], p[0])};
    return {side, sum(sum(side[0], side[1]), side[2]), dot(side[0], p[2])};
}

Whole beyond(const WholeTriangle& s, const WholeTriangle& t) {
    Whole normal;
    for (std::size_t i = 0; i < 3; ++i) {
        normal[i] = s.height * t.normal[i] - t.height * s.normal[i];
    }
    return normal;
}

bool is_inside(const std::vector<Whole>& sides, const Whole& direction) {
    return std::all_of(sides.begin(), sides.end(),
                       [&](const Whole& n) { return dot(n, direction) > 0; });
}

/// A cell is a convex cone with three corners at least, each where two planes meet, and
/// the sum of three lies inside it: so every cell has a direction among all sums.
bool is_hidden_by_cells(const TestMesh& mesh, std::uint32_t t) {
    const WholeTriangle own = whole(mesh, t);
    if (own.height == 0) return false;
    std::vector<std::vector<Whole>> hiders;
    std::vector<Whole> planes(own.side.begin(), own.side.end());
    for (std::uint32_t s = 0; s < mesh.triangles.size(); ++s) {
        const WholeTriangle other = whole(mesh, s);
        if (s == t || other.height == 0) continue;
        hiders.push_back({other.side[0], other.side[1], other.side[2], beyond(other, own)});
        planes.insert(planes.end(), hiders.back().begin(), hiders.back().end());
    }
    std::vector<Whole> corners;
    for (std::size_t i = 0; i < planes.size(); ++i) {
        for (std::size_t j = 0; j < planes.size(); ++j) {
            const Whole ray = cross(planes[i], planes[j]);
            const bool inside = std::all_of(own.side.begin(), own.side.end(),
                                            [&](const Whole& n) { return dot(n, ray) >= 0; });
            if (inside && ray != Whole{}) corners.push_back(ray);
        }
    }
    const auto is_bare = [&](const Whole& direction) {
        return is_inside({own.side.begin(), own.side.end()}, direction) &&
               std::none_of(hiders.begin(), hiders.end(), [&](const std::vector<Whole>& sides) {
                   return is_inside(sides, direction);
               });
    };
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    for (std::size_t i = 0; i < corners.size(); ++i) {
        for (std::size_t j = i + 1; j < corners.size(); ++j) {
            for (std::size_t k = j + 1; k < corners.size(); ++k) {
                // A sum on a border of some plane is inside no cell; then every closed
                // neighbour is tested by a sum of its own.
                const Whole direction = sum(sum(corners[i], corners[j]), corners[k]);
                const bool on_border = std::any_of(
                    planes.begin(), planes.end(),
                    [&](const Whole& n) { return n != Whole{} && dot(n, direction) == 0; });
                if (!on_border && is_bare(direction)) return false;
            }
        }
    }
    return true;
}

/// A triangle about the diagonal with corners near the axes, or a small one below.
void add_corners(TestMesh& mesh, std::mt19937& random, std::array<int, 2> reach,
                 std::array<int, 2> aside) {
    std::uniform_int_distribution<int> along(reach[0], reach[1]);
    std::uniform_int_distribution<int> off(aside[0], aside[1]);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int axis = 0; axis < 3; ++axis) {
        std::array<double, 3> p = {double(off(random)), double(off(random)), double(off(random))};
        p[static_cast<std::size_t>(axis)] = along(random);
        mesh.positions.push_back({p[0], p[1], p[2]});
    }
    mesh.triangles.push_back({{first, first + 1, first + 2}});
}

TEST(RadialCover, EqualsAllCellsOfTheArrangement) {
    std::mt19937 random(7);
    int hidden = 0;
    int asked = 0;
    for (int round = 0; round < 150; ++round) {
        TestMesh mesh;
        add_corners(mesh, random, {6, 12}, {0, 2});
        add_corners(mesh, random, {6, 12}, {0, 2});
        add_corners(mesh, random, {3, 4}, {1, 2});
        const RadialCover cover(kOrigin, mesh.positions, mesh.triangles);
        for (const std::uint32_t t : all_of(mesh)) {
            const bool expected = is_hidden_by_cells(mesh, t);
            ASSERT_EQ(cover.is_hidden(t, all_of(mesh)), expected) << round << ' ' << t;
            ++asked;
            hidden += expected ? 1 : 0;
        }
    }
    EXPECT_GT(hidden, asked / 10);
    EXPECT_LT(hidden, asked / 2);
}

// Each octant of the outer octahedron is split about a point of its own, so that borders
// cross those of the inner one: many fragments, all covered, or all but one.
TEST(RadialCover, CoverOfManyFragmentsIsComplete) {
    std::mt19937 random(11);
    std::uniform_int_distribution<int> weight(1, 9);
    TestMesh mesh;
    mesh.positions = {{16, 0, 0}, {0, 16, 0}, {0, 0, 16}};
    std::vector<Triangle> tiles = {{{0, 1, 2}}};
    for (int split = 0; split < 20; ++split) {
        const std::size_t at = random() % tiles.size();
        const auto v = tiles[at].vertex;
        std::array<double, 3> w = {double(weight(random)), double(weight(random)),
                                   double(weight(random))};
        Double3 p{};
        for (std::size_t i = 0; i < 3; ++i) {
            const Double3& q = mesh.positions[v[i]];
            p = {p.x + w[i] * q.x, p.y + w[i] * q.y, p.z + w[i] * q.z};
        }
        const auto made = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.push_back(p);
        tiles[at] = {{v[0], v[1], made}};
        tiles.push_back({{v[1], v[2], made}});
        tiles.push_back({{v[2], v[0], made}});
    }
    mesh.triangles = tiles;
    const TestMesh inner = {{{7, 1, 1}, {1, 7, 1}, {1, 1, 7}}, {{{0, 1, 2}}}};
    const TestMesh all = test::joined(mesh, inner);
    const auto last = static_cast<std::uint32_t>(all.triangles.size() - 1);
    const RadialCover cover({0, 0, 0}, all.positions, all.triangles);
    EXPECT_TRUE(cover.is_hidden(last, all_of(all)));
    int bare = 0;
    for (std::uint32_t missing = 0; missing < last; ++missing) {
        std::vector<std::uint32_t> others = all_of(all);
        others.erase(others.begin() + missing);
        if (!cover.is_hidden(last, others)) ++bare;
    }
    EXPECT_GT(bare, 5);
}

}  // namespace
}  // namespace cdprep::mesh
