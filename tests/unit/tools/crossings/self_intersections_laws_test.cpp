// SPDX-License-Identifier: GPL-3.0-or-later
// Against CGAL: its self_intersections() where a mesh is one of its own, and its exact
// predicates on every pair where more than two triangles meet at an edge.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <set>

#include "crossings/self_intersections.h"
#include "mesh/weld.h"
#include "support/exact_contact.h"
#include "support/team.h"
#include "unit/tools/soup_of.h"

namespace cdprep::mesh {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;

using Pair = std::array<std::uint32_t, 2>;

Kernel::Point_3 point(const Double3& p) {
    return {p.x, p.y, p.z};
}

std::vector<Pair> pairs_of(const std::vector<TriangleMeeting>& meetings) {
    std::vector<Pair> pairs;
    for (const TriangleMeeting& meeting : meetings) pairs.push_back({meeting.a, meeting.b});
    return pairs;
}

bool repeats_a_corner(const Triangle& t) {
    const auto& v = t.vertex;
    return v[0] == v[1] || v[1] == v[2] || v[2] == v[0];
}

/// What CGAL finds, without what it says of triangles of zero area; nothing when the mesh
/// is none of its own.
std::optional<std::vector<Pair>> self_intersections_of(const Mesh& mesh) {
    SurfaceMesh surface;
    for (const Double3& p : mesh.positions) surface.add_vertex(point(p));
    std::vector<std::uint32_t> number;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto& v = mesh.triangles[i].vertex;
        if (repeats_a_corner(mesh.triangles[i])) continue;
        using Vertex = SurfaceMesh::Vertex_index;
        const auto face = surface.add_face(Vertex(v[0]), Vertex(v[1]), Vertex(v[2]));
        if (face == SurfaceMesh::null_face()) return std::nullopt;
        number.push_back(i);
    }
    std::vector<std::pair<SurfaceMesh::Face_index, SurfaceMesh::Face_index>> found;
    CGAL::Polygon_mesh_processing::self_intersections(surface, std::back_inserter(found));
    std::vector<Pair> pairs;
    for (const auto& [f, g] : found) {
        if (f != g)
            pairs.push_back({std::min(number[f], number[g]), std::max(number[f], number[g])});
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

/// How two triangles meet by CGAL's predicates: false, or more than what they share.
bool meet(const Mesh& mesh, const Triangle& a, const Triangle& b) {
    const auto at = [&](const Triangle& t, std::size_t i) {
        return point(mesh.positions[t.vertex[i % 3]]);
    };
    std::vector<std::array<std::size_t, 2>> shared;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            if (a.vertex[i] == b.vertex[j]) shared.push_back({i, j});
        }
    }
    const Kernel::Triangle_3 in_a(at(a, 0), at(a, 1), at(a, 2));
    const Kernel::Triangle_3 in_b(at(b, 0), at(b, 1), at(b, 2));
    switch (shared.size()) {
        case 0:
            return CGAL::do_intersect(in_a, in_b);
        case 1: {
            const auto [i, j] = shared[0];
            return CGAL::do_intersect(in_a, Kernel::Segment_3(at(b, j + 1), at(b, j + 2))) ||
                   CGAL::do_intersect(in_b, Kernel::Segment_3(at(a, i + 1), at(a, i + 2)));
        }
        case 2: {
            const auto p = at(a, shared[0][0]), q = at(a, shared[1][0]);
            const auto r = at(a, 3 - shared[0][0] - shared[1][0]);
            const auto s = at(b, 3 - shared[0][1] - shared[1][1]);
            return CGAL::coplanar(p, q, r, s) &&
                   CGAL::coplanar_orientation(p, q, r, s) == CGAL::POSITIVE;
        }
        default:
            return true;
    }
}

bool has_area(const Mesh& mesh, const Triangle& t) {
    const auto at = [&](std::size_t i) { return point(mesh.positions[t.vertex[i]]); };
    return !CGAL::collinear(at(0), at(1), at(2));
}

std::vector<Pair> pairs_by_brute_force(const Mesh& mesh, std::size_t& asked) {
    std::vector<Pair> pairs;
    for (std::uint32_t a = 0; a < mesh.triangles.size(); ++a) {
        if (!has_area(mesh, mesh.triangles[a])) continue;
        for (std::uint32_t b = a + 1; b < mesh.triangles.size(); ++b) {
            if (!has_area(mesh, mesh.triangles[b])) continue;
            ++asked;
            if (meet(mesh, mesh.triangles[a], mesh.triangles[b])) pairs.push_back({a, b});
        }
    }
    return pairs;
}

using Exact = test::ExactTriangle<std::int64_t>;

/// Corners on the integer grid.
Exact exact_of(const Mesh& mesh, const Triangle& t) {
    Exact corners;
    for (std::size_t i = 0; i < 3; ++i) {
        const Double3& p = mesh.positions[t.vertex[i]];
        corners[i] = {std::llround(p.x), std::llround(p.y), std::llround(p.z)};
    }
    return corners;
}

/// How far above the triangle's plane, times the length of its normal.
std::int64_t height(const Exact& t, const test::ExactPoint<std::int64_t>& p) {
    return test::dot(test::cross(test::minus(t[1], t[0]), test::minus(t[2], t[0])),
                     test::minus(p, t[0]));
}

/// Whether an edge of a meets b's plane in one point, within a and strictly within b: by
/// that point's place between the three edges.
bool an_edge_pierces(const Exact& a, const Exact& b) {
    for (std::size_t i = 0; i < 3; ++i) {
        const auto &p = a[i], &q = a[(i + 1) % 3];
        const std::int64_t above = height(b, p), below = -height(b, q);
        if ((above > 0) != (below > 0) || above == 0 || below == 0) continue;
        const auto normal = test::cross(test::minus(b[1], b[0]), test::minus(b[2], b[0]));
        bool inside = true;
        for (std::size_t k = 0; k < 3; ++k) {
            test::ExactPoint<std::int64_t> away{};  // from corner k, times above + below
            for (std::size_t axis = 0; axis < 3; ++axis) {
                away[axis] = (p[axis] - b[k][axis]) * below + (q[axis] - b[k][axis]) * above;
            }
            const auto side =
                test::dot(normal, test::cross(test::minus(b[(k + 1) % 3], b[k]), away));
            inside &= above > 0 ? side > 0 : side < 0;
        }
        if (inside) return true;
    }
    return false;
}

/// The kind of a meeting of triangles on the integer grid, from the definitions.
Meeting kind_by_definition(const Mesh& mesh, const Triangle& a, const Triangle& b) {
    const Exact in_a = exact_of(mesh, a), in_b = exact_of(mesh, b);
    const std::set<std::uint32_t> of_a(a.vertex.begin(), a.vertex.end());
    const auto shared = std::count_if(b.vertex.begin(), b.vertex.end(),
                                      [&](std::uint32_t v) { return of_a.count(v) != 0; });
    if (shared == 3) return Meeting::duplicate;
    const bool flat =
        std::all_of(in_b.begin(), in_b.end(), [&](const auto& p) { return height(in_a, p) == 0; });
    const TriangleContact contact = test::contact_by_definition(in_a, in_b);
    if (flat) {
        const bool area = contact == TriangleContact::coplanar_overlap;
        if (shared > 0) return area ? Meeting::fold : Meeting::edge_overlap;
        return area ? Meeting::coplanar_overlap : Meeting::flat_touching;
    }
    if (shared > 0) return Meeting::corner_crossing;
    if (contact != TriangleContact::cross) return Meeting::touching;
    return an_edge_pierces(in_a, in_b) || an_edge_pierces(in_b, in_a) ? Meeting::crossing
                                                                      : Meeting::edge_crossing;
}

/// A sheet of n x n squares of which some vertices are moved, on a grid where `coarse`.
test::TestMesh crumpled_sheet(std::uint32_t seed, int n, double by, bool coarse) {
    test::TestMesh sheet = test::grid_sheet(n, n);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> fine(-by, by);
    for (Double3& p : sheet.positions) {
        if (coarse && random() % 3 != 0) continue;
        const auto moved = [&](double x) {
            return coarse ? x + std::round(fine(random)) : x + fine(random);
        };
        p = {moved(p.x), moved(p.y), moved(p.z)};
    }
    return sheet;
}

/// Unconnected triangles with corners on the unit sphere: large ones, so that many meet.
test::TestMesh triangles_in_a_ball(std::uint32_t seed, std::uint32_t count) {
    test::TestMesh mesh;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> around(-1, 1);
    for (std::uint32_t i = 0; i < 3 * count; ++i) {
        Double3 p{around(random), around(random), around(random)};
        const double length = std::hypot(p.x, p.y, p.z);
        mesh.positions.push_back({p.x / length, p.y / length, p.z / length});
        if (i % 3 == 2) mesh.triangles.push_back({{i - 2, i - 1, i}});
    }
    return mesh;
}

constexpr std::uint32_t kSeed = 20261121;

// Few corners and many triangles: every kind of sharing, and duplicates.
TEST(SelfIntersectionsAgainstCgal, CoarseSoupsHaveTheSamePairsOfTheDefinedKinds) {
    std::size_t asked = 0, met = 0;
    std::set<Meeting> kinds;
    for (std::uint32_t seed = kSeed; seed < kSeed + 60; ++seed) {
        const int grid = 1 + static_cast<int>(seed % 3);
        const Mesh mesh = test::welded(test::coarse_grid_soup(seed, 40, grid));
        const auto found = find_self_intersections(mesh);
        ASSERT_EQ(pairs_of(found), pairs_by_brute_force(mesh, asked)) << "seed " << seed;
        met += found.size();
        for (const TriangleMeeting& meeting : found) {
            kinds.insert(meeting.meeting);
            ASSERT_EQ(meeting.meeting, kind_by_definition(mesh, mesh.triangles[meeting.a],
                                                          mesh.triangles[meeting.b]));
        }
    }
    EXPECT_EQ(kinds.size(), 9u) << "of each kind one";
    EXPECT_GT(met, asked * 3 / 10);
    EXPECT_LT(met, asked * 7 / 10);
}

TEST(SelfIntersectionsAgainstCgal, FineSoupsHaveTheSamePairs) {
    std::size_t asked = 0, met = 0;
    for (std::uint32_t seed = kSeed; seed < kSeed + 20; ++seed) {
        const Mesh mesh = test::welded(triangles_in_a_ball(seed, 60));
        const auto found = find_self_intersections(mesh);
        ASSERT_EQ(pairs_of(found), pairs_by_brute_force(mesh, asked)) << "seed " << seed;
        met += found.size();
    }
    EXPECT_GT(met, asked * 3 / 10);
    EXPECT_LT(met, asked * 7 / 10);
}

/// Compares with CGAL's own function, which the mesh must suit. Returns the share of
/// triangles that are in a pair.
double expect_as_cgal(const Mesh& mesh) {
    const auto truth = self_intersections_of(mesh);
    EXPECT_TRUE(truth.has_value());
    if (!truth) return 0;
    const auto found = pairs_of(find_self_intersections(mesh));
    EXPECT_EQ(found, *truth);
    std::set<std::uint32_t> involved;
    for (const Pair& pair : found) involved.insert(pair.begin(), pair.end());
    return static_cast<double>(involved.size()) / static_cast<double>(mesh.triangles.size());
}

TEST(SelfIntersectionsAgainstCgal, CrumpledSheetsHaveTheSamePairs) {
    double sum = 0;
    int rounds = 0;
    for (std::uint32_t seed = kSeed; seed < kSeed + 10; ++seed) {
        for (const double by : {0.7, 0.9, 1.2}) {
            SCOPED_TRACE(testing::Message() << "seed " << seed << ", by " << by);
            sum += expect_as_cgal(test::welded(crumpled_sheet(seed, 20, by, false)));
            ++rounds;
        }
    }
    EXPECT_GT(sum, rounds * 0.3);
    EXPECT_LT(sum, rounds * 0.7);
}

// On a grid vertices meet by chance, and more than two triangles at an edge.
TEST(SelfIntersectionsAgainstCgal, CoarseSheetsHaveTheSamePairs) {
    std::size_t asked = 0, met = 0;
    for (std::uint32_t seed = kSeed; seed < kSeed + 10; ++seed) {
        const Mesh mesh = test::welded(crumpled_sheet(seed, 12, 1.5, true));
        const auto found = find_self_intersections(mesh);
        ASSERT_EQ(pairs_of(found), pairs_by_brute_force(mesh, asked)) << "seed " << seed;
        met += found.size();
    }
    EXPECT_GT(met, 500u);
    EXPECT_GT(asked, 2 * met);
}

TEST(SelfIntersectionsAgainstCgal, BodiesThroughEachOtherHaveTheSamePairs) {
    const test::TestMesh ball = test::icosphere(3);
    const test::TestMesh ring = test::torus(1, 0.25, 40, 20);
    EXPECT_GT(expect_as_cgal(test::welded(test::joined(ball, ring))), 0.03);
    EXPECT_GT(expect_as_cgal(test::welded(test::joined(
                  test::unit_cube(), test::moved_by(test::unit_cube(), 1, {0.5, 0, 0})))),
              0.5);
}

// The answer is one of signs: powers of two change none, and far away the same numbers hold.
TEST(SelfIntersections, ScaleAndPlaceChangeNothing) {
    for (std::uint32_t seed = kSeed; seed < kSeed + 6; ++seed) {
        for (const test::TestMesh& mesh :
             {test::coarse_grid_soup(seed, 200, 6), crumpled_sheet(seed, 12, 1.5, true)}) {
            const auto found = find_self_intersections(test::welded(mesh));
            EXPECT_FALSE(found.empty());
            for (const double scale :
                 {0x1p-40, 0x1p40, 0x1p-300, 0x1p300, 0x1p-900, 0x1p900, 0x1p1019}) {
                EXPECT_EQ(
                    find_self_intersections(test::welded(test::moved_by(mesh, scale, {0, 0, 0}))),
                    found)
                    << scale;
            }
            for (const double away : {0x1p10, 0x1p30, 0x1p48}) {
                EXPECT_EQ(find_self_intersections(
                              test::welded(test::moved_by(mesh, 1, {away, -away, away}))),
                          found)
                    << away;
            }
        }
    }
}

TEST(SelfIntersections, FarFromTheOriginTheyAreCgals) {
    for (const double away : {1e3, 1e7, 1e12}) {
        const test::TestMesh sheet = crumpled_sheet(kSeed, 20, 0.9, false);
        const Mesh mesh = test::welded(test::moved_by(sheet, 1, {away, away / 3, -away}));
        EXPECT_GT(expect_as_cgal(mesh), 0.1);
    }
}

TEST(SelfIntersections, AnyNumberOfThreadsGivesTheSame) {
    const Mesh mesh = test::welded(crumpled_sheet(kSeed, 150, 0.6, false));
    const auto found = find_self_intersections(mesh);
    EXPECT_GT(found.size(), 1000u);
    EXPECT_TRUE(std::is_sorted(found.begin(), found.end(), [](const auto& x, const auto& y) {
        return std::array{x.a, x.b} < std::array{y.a, y.b};
    }));
    for (unsigned threads = 1; threads <= 8; ++threads) {
        const test::Team team(threads);
        EXPECT_EQ(find_self_intersections(mesh, team), found) << threads;
    }
}

// A triangle more, that shares nothing, changes no answer about the others, and the order
// of triangles changes the numbers alone.
TEST(SelfIntersections, TheOrderOfTrianglesChangesNumbersAlone) {
    std::mt19937 random(kSeed);
    for (std::uint32_t seed = kSeed; seed < kSeed + 10; ++seed) {
        const Mesh mesh = test::welded(test::coarse_grid_soup(seed, 60, 3));
        Mesh mixed = mesh;
        std::vector<std::uint32_t> number(mesh.triangles.size());
        for (std::uint32_t i = 0; i < number.size(); ++i) number[i] = i;
        std::shuffle(number.begin(), number.end(), random);
        for (std::uint32_t i = 0; i < number.size(); ++i) {
            auto& v = mixed.triangles[i].vertex = mesh.triangles[number[i]].vertex;
            std::rotate(v.begin(), v.begin() + random() % 3, v.end());
            if (random() % 2 == 0) std::swap(v[0], v[1]);
        }
        auto found = find_self_intersections(mixed);
        for (TriangleMeeting& m : found) {
            const auto [a, b] = std::minmax({number[m.a], number[m.b]});
            m = {a, b, m.meeting};
        }
        std::sort(found.begin(), found.end(), [](const auto& x, const auto& y) {
            return std::array{x.a, x.b} < std::array{y.a, y.b};
        });
        EXPECT_EQ(found, find_self_intersections(mesh)) << seed;
    }
}

}  // namespace
}  // namespace cdprep::mesh
