// SPDX-License-Identifier: MIT
#include "cdprep/points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "support/exact_contact.h"
#include "support/exact_rational.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"

namespace cdprep::test {
namespace {

std::optional<RayHit> cast(const TestMesh& mesh, const Ray& ray, const RayOptions& options = {}) {
    const OpenModel model = open_tiny(mesh, {.double_precision = true});
    Workspace workspace;
    return cast_ray(model.model, ray, workspace, options);
}

// By hand: the bottom of the unit cube, one unit above the origin of the ray.
TEST(CastRay, MeasuresInLengthsOfTheDirection) {
    const auto hit = cast(unit_cube(), {{0.25, 0.5, -1}, {0, 0, 0.5}});
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->t, 2.0);
    EXPECT_EQ(hit->triangle, 0u);
    EXPECT_EQ(hit->point.z, 0.0);
    EXPECT_FALSE(cast(unit_cube(), {{0.25, 0.5, -1}, {0, 0, -1}}));
}

TEST(CastRay, LimitIsInclusive) {
    const Ray ray{{0.25, 0.5, -1}, {0, 0, 1}};
    EXPECT_TRUE(cast(unit_cube(), ray, {.max_t = 1.0}));
    EXPECT_FALSE(cast(unit_cube(), ray, {.max_t = std::nextafter(1.0, 0.0)}));
}

TEST(CastRay, EdgesAndCornersHitAndTheLowestTriangleAnswers) {
    const auto diagonal = cast(unit_cube(), {{0.5, 0.5, -1}, {0, 0, 1}});  // both bottom faces
    ASSERT_TRUE(diagonal);
    EXPECT_EQ(diagonal->triangle, 0u);
    EXPECT_TRUE(cast(unit_cube(), {{0, 0, -1}, {0, 0, 1}}));    // along an edge of the cube
    EXPECT_TRUE(cast(unit_cube(), {{-1, -1, -1}, {1, 1, 1}}));  // through a corner
    EXPECT_FALSE(cast(unit_cube(), {{-0x1p-50, 0, -1}, {0, 0, 1}}));
}

// By hand, in the plane of the triangle: enters at x = 0, starts inside, runs
// along an edge, passes by, points away.
TEST(CastRay, RaysInTheTrianglesPlaneHitWhereTheyEnter) {
    EXPECT_EQ(cast(right_triangle(), {{-1, 1, 0}, {1, 0, 0}})->t, 1.0);
    EXPECT_EQ(cast(right_triangle(), {{1, 1, 0}, {1, 0, 0}})->t, 0.0);
    EXPECT_EQ(cast(right_triangle(), {{-2, 0, 0}, {1, 0, 0}})->t, 2.0);
    EXPECT_EQ(cast(right_triangle(), {{-1, 5, 0}, {1, -1, 0}})->t, 1.0);
    EXPECT_FALSE(cast(right_triangle(), {{-1, 6, 0}, {1, -1, 0}}));
    EXPECT_FALSE(cast(right_triangle(), {{-1, 1, 0}, {-1, 0, 0}}));
    EXPECT_FALSE(cast(right_triangle(), {{5, 1, 0}, {1, 0, 0}}));
}

TEST(CastRay, TrianglesWithoutAreaAnswerAsSegments) {
    const TestMesh segment{{{1, 0, 0}, {1, 2, 0}, {1, 1, 0}}, {{{0, 1, 2}}}};
    EXPECT_EQ(cast(segment, {{0, 1.5, 0}, {1, 0, 0}})->t, 1.0);
    EXPECT_EQ(cast(segment, {{1, -1, 0}, {0, 1, 0}})->t, 1.0);
    EXPECT_FALSE(cast(segment, {{0, 1.5, 0x1p-60}, {1, 0, 0}}));
    EXPECT_FALSE(cast(segment, {{0, 2.5, 0}, {1, 0, 0}}));
}

TEST(CastRay, NothingIsHitInAnEmptyModel) {
    EXPECT_FALSE(cast({}, {{0, 0, 0}, {1, 0, 0}}));
    EXPECT_FALSE(cast(unit_cube(), {{0, 0, 0}, {0, 0, 0}}));
}

TEST(CastRay, ScaleDoesNotMatter) {
    for (const double scale : {0x1p-1000, 0x1p-100, 0x1p100, 0x1p900}) {
        const TestMesh cube = moved_by(unit_cube(), scale, {0, 0, 0});
        const auto hit = cast(cube, {{scale / 4, scale / 2, -scale}, {0, 0, scale}});
        ASSERT_TRUE(hit) << scale;
        EXPECT_EQ(hit->t, 1.0) << scale;
    }
}

/// Exact for small integers: where line and plane cross, as a fraction.
struct RayCrossing {
    long long numerator;
    long long denominator;  ///< > 0
};

using Integers = std::array<long long, 3>;

Integers minus(const Integers& a, const Integers& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Integers cross(const Integers& a, const Integers& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
long long dot(const Integers& a, const Integers& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Integers integers(const Double3& p) {
    return {static_cast<long long>(p.x), static_cast<long long>(p.y), static_cast<long long>(p.z)};
}

/// The textbook test in integers: plane, then three half-planes. Nothing when the
/// ray is parallel to the plane.
std::optional<RayCrossing> exact_crossing(const Ray& ray, const std::array<Double3, 3>& t) {
    const Integers o = integers(ray.origin), d = integers(ray.direction);
    const Integers a = integers(t[0]), b = integers(t[1]), c = integers(t[2]);
    const Integers n = cross(minus(b, a), minus(c, a));
    long long den = dot(n, d);
    long long num = dot(n, minus(a, o));
    if (den == 0) return std::nullopt;
    if (den < 0) {
        den = -den;
        num = -num;
    }
    if (num < 0) return std::nullopt;
    const Integers p = {o[0] * den + num * d[0], o[1] * den + num * d[1], o[2] * den + num * d[2]};
    const auto inside = [&](const Integers& u, const Integers& v) {
        const Integers at = {p[0] - u[0] * den, p[1] - u[1] * den, p[2] - u[2] * den};
        return dot(n, cross(minus(v, u), at)) >= 0;
    };
    if (!inside(a, b) || !inside(b, c) || !inside(c, a)) return std::nullopt;
    return RayCrossing{num, den};
}

bool is_parallel(const Ray& ray, const std::array<Double3, 3>& t) {
    const Integers a = integers(t[0]), b = integers(t[1]), c = integers(t[2]);
    return dot(cross(minus(b, a), minus(c, a)), integers(ray.direction)) == 0;
}

// The oracle: integers on a coarse grid, where rays meet edges and corners often.
// Triangles that are parallel to a ray are left to the tests by hand.
TEST(CastRayLaws, AgreesWithIntegersOnACoarseGrid) {
    std::mt19937 random(20261121);
    std::uniform_int_distribution<int> grid(-6, 6);
    int hits = 0, rays = 0;
    for (int round = 0; round < 60; ++round) {
        const TestMesh mesh = coarse_grid_soup(random(), 20, 4);
        const OpenModel model = open_tiny(mesh);
        Workspace workspace;
        for (int i = 0; i < 60; ++i) {
            const auto number = [&] { return static_cast<double>(grid(random)); };
            const double ox = number(), oy = number(), oz = number();
            const double dx = number(), dy = number(), dz = number();
            const Ray ray{{ox, oy, oz}, {dx, dy, dz}};
            if (dx == 0 && dy == 0 && dz == 0) continue;
            bool parallel = false;
            std::optional<RayCrossing> nearest;
            for (const Triangle& triangle : mesh.triangles) {
                const std::array<Double3, 3> t = {mesh.positions[triangle.vertex[0]],
                                                  mesh.positions[triangle.vertex[1]],
                                                  mesh.positions[triangle.vertex[2]]};
                parallel = parallel || is_parallel(ray, t);
                const auto crossing = exact_crossing(ray, t);
                if (crossing && (!nearest || crossing->numerator * nearest->denominator <
                                                 nearest->numerator * crossing->denominator)) {
                    nearest = crossing;
                }
            }
            if (parallel) continue;
            const auto hit = cast_ray(model.model, ray, workspace);
            ASSERT_EQ(hit.has_value(), nearest.has_value()) << "round " << round << ", ray " << i;
            ++rays;
            if (!hit) continue;
            ++hits;
            const double exact =
                static_cast<double>(nearest->numerator) / static_cast<double>(nearest->denominator);
            ASSERT_NEAR(hit->t, exact, 1e-14 * (1 + exact));
        }
    }
    EXPECT_GT(rays, 1000);
    EXPECT_GT(hits, rays * 2 / 10);
    EXPECT_LT(hits, rays * 8 / 10);
}

/// Triangles that the ray hits, lowest number first, in all forms alike.
std::vector<std::uint32_t> triangles_hit(const Model& model, const Ray& ray, Workspace& workspace) {
    std::vector<RayHit> hits(model.triangle_count());
    hits.resize(all_ray_hits(model, ray, workspace, hits));
    EXPECT_TRUE(std::is_sorted(hits.begin(), hits.end()));
    EXPECT_EQ(all_ray_hits(model, ray, workspace, {}), hits.size());
    EXPECT_EQ(ray_hits(model, ray, workspace), !hits.empty());
    const auto first = cast_ray(model, ray, workspace);
    EXPECT_EQ(first.has_value(), !hits.empty());
    if (first) {
        EXPECT_EQ(first->t, hits[0].t);
        EXPECT_EQ(first->triangle, hits[0].triangle);
        EXPECT_EQ(first->point, hits[0].point);
    }
    std::vector<RayHit> few(hits.size() / 2);
    EXPECT_EQ(all_ray_hits(model, ray, workspace, few), hits.size());
    for (std::size_t i = 0; i < few.size(); ++i) EXPECT_EQ(few[i].triangle, hits[i].triangle);
    std::vector<std::uint32_t> visited;
    const auto visit = [&](const RayHit& hit) {
        visited.push_back(hit.triangle);
        return true;
    };
    EXPECT_TRUE(visit_ray_hits(model, ray, workspace, visit));
    std::vector<std::uint32_t> triangles;
    for (const RayHit& hit : hits) triangles.push_back(hit.triangle);
    std::sort(triangles.begin(), triangles.end());
    std::sort(visited.begin(), visited.end());
    EXPECT_EQ(visited, triangles);
    return triangles;
}

Ray coarse_ray(std::mt19937& random, int reach) {
    std::uniform_int_distribution<int> grid(-reach, reach);
    const auto number = [&] { return static_cast<double>(grid(random)); };
    const double ox = number(), oy = number(), oz = number();
    const double dx = number(), dy = number(), dz = number();
    return {{ox, oy, oz}, {dx, dy, dz}};
}

// The oracle: every triangle in integers; parallel ones are left out on both sides.
TEST(CastRayLaws, AllHitsAreThoseOfIntegers) {
    std::mt19937 random(20261122);
    int hits = 0, tested = 0;
    for (int round = 0; round < 60; ++round) {
        const TestMesh mesh = coarse_grid_soup(random(), round % 2 == 0 ? 7 : 100, 4);
        const OpenModel model = open_tiny(mesh);
        Workspace workspace;
        for (int i = 0; i < 30; ++i) {
            const Ray ray = coarse_ray(random, 6);
            if (ray.direction == Double3{0, 0, 0}) continue;
            const auto found = triangles_hit(model.model, ray, workspace);
            for (std::uint32_t k = 0; k < mesh.triangles.size(); ++k) {
                const auto& vertex = mesh.triangles[k].vertex;
                const std::array<Double3, 3> t = {mesh.positions[vertex[0]],
                                                  mesh.positions[vertex[1]],
                                                  mesh.positions[vertex[2]]};
                if (is_parallel(ray, t)) continue;
                const bool truth = exact_crossing(ray, t).has_value();
                ASSERT_EQ(std::binary_search(found.begin(), found.end(), k), truth)
                    << "round " << round << ", ray " << i;
                hits += truth ? 1 : 0;
                ++tested;
            }
        }
    }
    EXPECT_GT(hits, tested / 50);
    EXPECT_LT(hits, tested / 2);
}

/// The textbook test in exact numbers, for triangles that are not parallel to the ray.
bool truly_hits(const Ray& ray, const std::array<Double3, 3>& corners) {
    const auto at = [](const Double3& p) { return ExactPoint<ExactNumber>{p.x, p.y, p.z}; };
    const auto o = at(ray.origin), d = at(ray.direction);
    const std::array<ExactPoint<ExactNumber>, 3> t = {
        minus(at(corners[0]), o), minus(at(corners[1]), o), minus(at(corners[2]), o)};
    const auto n = cross(minus(t[1], t[0]), minus(t[2], t[0]));
    const int along = dot(n, d).sign();
    if (along == 0 || dot(n, t[0]).sign() * along < 0) return false;
    for (std::size_t i = 0; i < 3; ++i) {
        if (dot(d, cross(t[i], t[(i + 1) % 3])).sign() * along < 0) return false;
    }
    return true;
}

// The oracle: exact numbers. Rays aimed at points of edges, from near and from far beyond
// the model's size: rounding alone decides on which side they pass.
TEST(CastRayLaws, RaysAtEdgesAgreeWithExactNumbers) {
    std::mt19937 random(20261124);
    std::uniform_real_distribution<double> part(0, 1);
    int hits = 0, tested = 0;
    for (int round = 0; round < 60; ++round) {
        const TestMesh mesh = random_soup(random(), 40, 0.5);
        const OpenModel model = open_tiny(mesh, {.double_precision = true});
        Workspace workspace;
        for (int i = 0; i < 20; ++i) {
            const std::size_t aimed = random() % mesh.triangles.size();
            const auto& v = mesh.triangles[aimed].vertex;
            const Double3 &a = mesh.positions[v[0]], &b = mesh.positions[v[1]];
            const double s = part(random);
            const Double3 o = fine_point(random, std::array<double, 4>{2, 1e3, 1e15, 1e300}[i % 4]);
            const Ray ray = {o,
                             {a.x + s * (b.x - a.x) - o.x, a.y + s * (b.y - a.y) - o.y,
                              a.z + s * (b.z - a.z) - o.z}};
            const auto found = triangles_hit(model.model, ray, workspace);
            for (std::uint32_t k = 0; k < mesh.triangles.size(); ++k) {
                const auto& vertex = mesh.triangles[k].vertex;
                const bool truth =
                    truly_hits(ray, {mesh.positions[vertex[0]], mesh.positions[vertex[1]],
                                     mesh.positions[vertex[2]]});
                ASSERT_EQ(std::binary_search(found.begin(), found.end(), k), truth)
                    << "seed 20261124, round " << round << ", ray " << i;
                hits += k == aimed && truth ? 1 : 0;
                tested += k == aimed ? 1 : 0;
            }
        }
    }
    EXPECT_GT(hits, tested * 3 / 10) << hits << " " << tested;
    EXPECT_LT(hits, tested * 7 / 10) << hits << " " << tested;
}

// By the definition of a line: a direction's length changes nothing, even where origin
// + direction is no double; and neither does where the model lies, nor its size.
TEST(CastRayLaws, TheDirectionCountsAsGiven) {
    std::mt19937 random(20261123);
    int hits = 0, rays = 0;
    for (int round = 0; round < 40; ++round) {
        const TestMesh mesh = coarse_grid_soup(random(), 60, 4);
        const double shift = 0x1p45;
        const TestMesh far = moved_by(mesh, 1, {shift, -shift, 3 * shift});
        const OpenModel model = open_tiny(mesh, {.double_precision = true});
        const OpenModel far_model = open_tiny(far, {.double_precision = true});
        Workspace workspace;
        for (int i = 0; i < 20; ++i) {
            const Ray ray = coarse_ray(random, 6);
            if (ray.direction == Double3{0, 0, 0}) continue;
            const auto truth = triangles_hit(model.model, ray, workspace);
            const Double3& o = ray.origin;
            const Double3& d = ray.direction;
            for (const double factor : {0x1p-600, 0x1p600, 847288609443.0, 0x1p-45}) {
                const Double3 longer = {factor * d.x, factor * d.y, factor * d.z};
                ASSERT_EQ(triangles_hit(model.model, {o, longer}, workspace), truth) << factor;
                const Double3 there = {o.x + shift, o.y - shift, o.z + 3 * shift};
                ASSERT_EQ(triangles_hit(far_model.model, {there, longer}, workspace), truth)
                    << factor;
            }
            hits += truth.empty() ? 0 : 1;
            ++rays;
        }
    }
    EXPECT_GT(hits, rays * 3 / 10);
    EXPECT_LT(hits, rays * 7 / 10) << hits << " " << rays;
}

// By hand: the direction's small component is lost beside the origin, and beside its
// own large one, but decides.
TEST(CastRay, NoBitOfTheDirectionIsLost) {
    const TestMesh wall{{{1, 0, -1}, {1, 4, 0}, {1, 0, 1}}, {{{0, 1, 2}}}};
    EXPECT_TRUE(cast(wall, {{0, 0, 0}, {1, 0x1p-1074, 0}}));
    EXPECT_FALSE(cast(wall, {{0, 0, 0}, {1, -0x1p-1074, 0}}));
    EXPECT_TRUE(cast(wall, {{0, 0, 0}, {0x1p1000, 0x1p-1074, 0}}));
    EXPECT_FALSE(cast(wall, {{0, 0, 0}, {0x1p1000, -0x1p-1074, 0}}));
    const TestMesh flat{{{1, 0, 0}, {1, 4, 0}, {2, 0, 0}}, {{{0, 1, 2}}}};  // in its plane
    EXPECT_TRUE(cast(flat, {{0, 0, 0}, {0x1p1000, 0x1p-1074, 0}}));
    EXPECT_FALSE(cast(flat, {{0, 0, 0}, {0x1p1000, -0x1p-1074, 0}}));
    EXPECT_FALSE(cast(flat, {{0, 0, 0}, {1, 0, 0x1p-1074}}));
}

// By hand: the cube from below, along the diagonal of bottom and top: four triangles at
// two places.
TEST(CastRay, AllHitsComeInOrder) {
    const OpenModel cube = open_tiny(unit_cube());
    Workspace workspace;
    const Ray up{{0.5, 0.5, -1}, {0, 0, 1}};
    std::array<RayHit, 8> hits{};
    ASSERT_EQ(all_ray_hits(cube.model, up, workspace, hits), 4u);
    EXPECT_EQ(hits[0].t, 1.0);
    EXPECT_EQ(hits[1].t, 1.0);
    EXPECT_LT(hits[0].triangle, hits[1].triangle);
    EXPECT_EQ(hits[2].t, 2.0);
    EXPECT_EQ(hits[3].t, 2.0);
    EXPECT_EQ(hits[3].point, (Double3{0.5, 0.5, 1}));
    EXPECT_EQ(all_ray_hits(cube.model, up, workspace, hits, {.max_t = 1}), 2u);
    EXPECT_TRUE(ray_hits(cube.model, up, workspace, {.max_t = 1}));
    EXPECT_FALSE(ray_hits(cube.model, up, workspace, {.max_t = 0.5}));
    EXPECT_FALSE(ray_hits(cube.model, up, workspace, {.max_t = -1}));
    EXPECT_FALSE(ray_hits(cube.model, up, workspace, {.max_t = std::nan("")}));
    int seen = 0;
    const auto visit = [&](const RayHit&) { return ++seen < 3; };
    EXPECT_FALSE(visit_ray_hits(cube.model, up, workspace, visit));
    EXPECT_EQ(seen, 3);
    const OpenModel empty = open_tiny(TestMesh{});
    EXPECT_FALSE(ray_hits(empty.model, up, workspace));
    EXPECT_EQ(all_ray_hits(empty.model, up, workspace, hits), 0u);
}

// A closed surface: by the definition of inside, every ray from within hits.
TEST(CastRayLaws, NoRayEscapesAClosedSurface) {
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    const TestMesh sphere = icosphere(3);
    const OpenModel model = open_tiny(sphere, {.double_precision = true});
    Workspace workspace;
    for (int i = 0; i < 2000; ++i) {
        const double x = normal(random), y = normal(random), z = normal(random);
        ASSERT_TRUE(cast_ray(model.model, {{0.1, 0.2, 0.3}, {x, y, z}}, workspace)) << i;
    }
    for (const Double3& vertex : sphere.positions) {  // through every vertex
        ASSERT_TRUE(cast_ray(model.model, {{0, 0, 0}, vertex}, workspace));
    }
}

// By hand: a ray from an edge in the plane of a face of a cube that is 2^999 wide begins on it, and
// one from 2^999 before it hits at 1. Areas of such lengths are beyond the largest double.
TEST(CastRay, InThePlaneOfAHugeFaceTIsFinite) {
    TestMesh cube = unit_cube();
    for (Double3& p : cube.positions) p = {p.x * 0x1p999, p.y * 0x1p999, p.z * 0x1p999};
    const OpenModel open = open_tiny(cube, {.double_precision = true});
    Workspace workspace;
    const auto on = cast_ray(open.model, {{0, 0, 1.6875}, {0, 3.375, 1.6875}}, workspace);
    ASSERT_TRUE(on);
    EXPECT_EQ(on->t, 0);
    const Double3 before = {0, -0x1p999, 0x1p998}, along_y = {0, 0x1p999, 0};
    const auto hit = cast_ray(open.model, {before, along_y}, workspace);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->t, 1);
    EXPECT_EQ(hit->point, (Double3{0, 0, 0x1p998}));
}

/// A triangle that nearly contains the ray, and a wall before it.
TestMesh ramp_behind_a_wall() {
    return {{{1.8, 0, 0.54000000000000004},
             {1.3, 0, 0.39000000000000001},
             {2.1000000000000001, 0.60000000000000009, 1.05},
             {0.6, -1, -1},
             {0.6, 1, -1},
             {0.6, 0, 2}},
            {{{0, 1, 2}}, {{3, 4, 5}}}};
}

// By exact numbers: t is 0.5 at the wall and 1.625 at the ramp, which the ray meets at an angle
// below a rounding.
TEST(CastRay, AGrazedTriangleIsHitAtItsPlace) {
    const OpenModel model = open_tiny(ramp_behind_a_wall(), {.double_precision = true});
    const Ray ray = {{0, 0, 0}, {1.2000000000000002, 0.30000000000000004, 0.57000000000000006}};
    Workspace workspace;
    const auto first = cast_ray(model.model, ray, workspace);
    ASSERT_TRUE(first);
    EXPECT_EQ(first->triangle, 1u);
    EXPECT_NEAR(first->t, 0.5, 1e-12);
    EXPECT_NEAR(first->point.x, 0.6, 1e-12);
    std::array<RayHit, 2> hits{};
    ASSERT_EQ(all_ray_hits(model.model, ray, workspace, hits), 2u);
    EXPECT_EQ(hits[0].triangle, 1u);
    EXPECT_NEAR(hits[1].t, 1.625, 1e-12);
    EXPECT_EQ(all_ray_hits(model.model, ray, workspace, {}, {.max_t = 1}), 1u);
}

// By exact numbers: t is 1.22738.
TEST(CastRay, TheLimitKeepsAGrazedTriangleWithinIt) {
    const TestMesh ramp{{{1.2000000000000002, -1, -0.33999999999999991},
                         {1.6000000000000001, 0.60000000000000009, 0.90000000000000002},
                         {2.6000000000000001, 0.20000000000000001, 0.92000000000000004}},
                        {{{0, 1, 2}}}};
    const OpenModel model = open_tiny(ramp, {.double_precision = true});
    const Ray ray = {{-0.60000000000000009, 0.30000000000000004, 0.029999999999999999},
                     {1.9000000000000001, -0.60000000000000009, 0.14999999999999999}};
    Workspace workspace;
    EXPECT_TRUE(ray_hits(model.model, ray, workspace, {.max_t = 2}));
    EXPECT_FALSE(ray_hits(model.model, ray, workspace, {.max_t = 1}));
    const auto hit = cast_ray(model.model, ray, workspace);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->t, 1.22738, 1e-5);
    EXPECT_NEAR(hit->point.x, 1.73202, 1e-5);
}

// By the order of hits: the first of all is the answer, and lies in the model, though rays run in
// the plane of all triangles, up to rounding.
TEST(CastRayLaws, TheFirstHitIsTheFirstOfAllInAPlaneToo) {
    std::mt19937 random(20261132);
    std::uniform_real_distribution<double> fine(-1, 1);
    int hits = 0, rays = 0;
    for (int round = 0; round < 60; ++round) {
        const double x = fine(random), y = fine(random), z = fine(random);
        const auto on_plane = [&](double at_x, double at_y) {
            return Double3{at_x, at_y, x * at_x + y * at_y + z};
        };
        TestMesh mesh;
        for (std::uint32_t i = 0; i < 120; ++i) {
            const double at_x = fine(random), at_y = fine(random);
            for (int k = 0; k < 3; ++k) {
                const double by_x = 0.2 * fine(random), by_y = 0.2 * fine(random);
                mesh.positions.push_back(on_plane(at_x + by_x, at_y + by_y));
            }
            mesh.triangles.push_back({{3 * i, 3 * i + 1, 3 * i + 2}});
        }
        const OpenModel model = open_tiny(mesh, {.double_precision = true});
        Workspace workspace;
        for (int i = 0; i < 30; ++i) {
            const double from_x = 3 * fine(random), from_y = 3 * fine(random);
            const double to_x = 0.5 * fine(random), to_y = 0.5 * fine(random);
            const Double3 o = on_plane(from_x, from_y), to = on_plane(to_x, to_y);
            const Ray ray{o, {to.x - o.x, to.y - o.y, to.z - o.z}};
            ++rays;
            hits += triangles_hit(model.model, ray, workspace).empty() ? 0 : 1;
            const auto first = cast_ray(model.model, ray, workspace);
            if (!first) continue;
            ASSERT_LT(std::fabs(first->point.x), 1.21) << "round " << round << ", ray " << i;
            ASSERT_LT(std::fabs(first->point.y), 1.21) << "round " << round << ", ray " << i;
        }
    }
    EXPECT_GT(hits, rays * 3 / 10);
}

// By hand: a triangle across the x axis. Origins so far away are beyond the range of its boxes'
// coordinates.
TEST(CastRay, RaysFromFarAwayMeetSmallModels) {
    for (const double size : {1.0, 0x1p-10, 0x1p-300, 0x1p-900}) {
        const TestMesh mesh{{{0, -size, -size}, {0, size, -size}, {0, 0, size}}, {{{0, 1, 2}}}};
        const OpenModel model = open_tiny(mesh, {.double_precision = true});
        Workspace workspace;
        for (const double far : {0x1p100, 0x1p900, 0x1p1000, 0x1p1014, 0x1p1020, 0x1p1023}) {
            for (const double side : {-1.0, 1.0}) {
                const Ray ray = {{side * far, 0, 0}, {-side, 0, 0}};
                EXPECT_TRUE(ray_hits(model.model, ray, workspace)) << size << " " << far;
                const auto hit = cast_ray(model.model, ray, workspace);
                ASSERT_TRUE(hit) << size << " " << far;
                EXPECT_EQ(hit->t, far);
                EXPECT_EQ(hit->point.x, 0);
                EXPECT_FALSE(ray_hits(model.model, {ray.origin, {side, 0, 0}}, workspace));
                EXPECT_FALSE(ray_hits(model.model, ray, workspace, {.max_t = far / 2}));
            }
        }
    }
}

}  // namespace
}  // namespace cdprep::test
