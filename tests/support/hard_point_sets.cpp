// SPDX-License-Identifier: MIT
#include "support/hard_point_sets.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "support/meshes.h"

namespace cdprep::test {
namespace {

using Points = std::vector<Double3>;
using Cases = std::vector<HardPointSet>;

Points cube_corners(double size) {
    Points corners = unit_cube().positions;
    for (Double3& p : corners) p = {p.x * size, p.y * size, p.z * size};
    return corners;
}

void add_low_dimensions(Cases& all) {
    all.push_back({"C01 equal points", {{1, 0.0, 2}, {1, -0.0, 2}, {1, 0.0, 2}}, 0, 1, 0});
    all.push_back({"C01 collinear points",
                   {{1, 2, 3}, {3, 6, 9}, {-2, -4, -6}, {0, 0, 0}, {3, 6, 9}},
                   1,
                   2,
                   0});
    Points square;
    for (int i = 0; i < 9; ++i) square.push_back({double(i % 3), 7, double(i / 3)});
    all.push_back({"C01 coplanar points", square, 2, 4, 2});
    const double next = std::nextafter(1.0, 2.0);
    all.push_back(
        {"C01 collinear but for a bit", {{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {1, 1, next}}, 2, 3, 2});
    all.push_back({"C01 coplanar but for a bit",
                   {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}, {0.5, 0.5, next}},
                   3,
                   5,
                   5});
}

}  // namespace

Points lattice(int n) {
    Points points;
    for (int i = 0; i < n * n * n; ++i) {
        points.push_back({double(i % n), double(i / n % n), double(i / (n * n))});
    }
    return points;
}

Points crowded_faces(int count) {
    std::mt19937 random(3);
    std::uniform_int_distribution<int> inside(0, 1 << 20);
    Points points = cube_corners(1 << 20);
    for (int i = 0; i < count; ++i) {
        std::array<double, 3> p = {double(inside(random)), double(inside(random)),
                                   double(inside(random))};
        p[static_cast<std::size_t>(i % 3)] = i % 2 == 0 ? 0 : 1 << 20;
        if (i % 7 == 0) p[static_cast<std::size_t>((i + 1) % 3)] = 0;
        points.push_back({p[0], p[1], p[2]});
    }
    return shuffled(points, 4);
}

Points moment_curve(int count) {
    Points points;
    for (int t = 1; t <= count; ++t) {
        const double x = t;
        points.push_back({x, x * x, x * x * x});
    }
    return points;
}

// Gale: neighbours with the first or with the last point are the facets of a cyclic polytope;
// seen from later points, earlier ones turn counter-clockwise.
std::vector<std::array<std::uint32_t, 3>> cyclic_facets(std::uint32_t count) {
    std::vector<std::array<std::uint32_t, 3>> facets;
    for (std::uint32_t i = 1; i + 1 < count; ++i) facets.push_back({0, i + 1, i});
    for (std::uint32_t i = 0; i + 2 < count; ++i) facets.push_back({i, i + 1, count - 1});
    std::sort(facets.begin(), facets.end());
    return facets;
}

Points cube_with_bumps(double bump) {
    Points points = cube_corners(1);
    for (int axis = 0; axis < 6; ++axis) {
        std::array<double, 3> p = {0.5, 0.5, 0.5};
        p[static_cast<std::size_t>(axis % 3)] = axis < 3 ? 1 + bump : -bump;
        points.push_back({p[0], p[1], p[2]});
    }
    return points;
}

Points noisy_plane(int count, double height) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> flat(-1, 1);
    std::uniform_int_distribution<int> noise(-1, 1);
    Points points;
    for (int i = 0; i < count; ++i) {
        const int step = noise(random);
        const double x = flat(random), y = flat(random);
        points.push_back({x, y, step == 0 ? height : std::nextafter(height, step * 1e308)});
    }
    return points;
}

Points mixed_points(std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> fine(-1, 1);
    std::uniform_int_distribution<int> grid(-2, 2);
    Points points;
    for (int i = 0; i < 60; ++i) {
        if (seed % 2 == 0) {
            points.push_back({fine(random), fine(random), fine(random)});
        } else {
            points.push_back({double(grid(random)), double(grid(random)), double(grid(random))});
        }
    }
    return points;
}

Points points_in_a_ball(std::size_t count) {
    std::mt19937 random(9);
    std::uniform_real_distribution<double> inside(-1, 1);
    Points points;
    while (points.size() < count) {
        const Double3 p = {inside(random), inside(random), inside(random)};
        if (p.x * p.x + p.y * p.y + p.z * p.z <= 1) points.push_back(p);
    }
    return points;
}

Points shuffled(Points points, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::shuffle(points.begin(), points.end(), random);
    return points;
}

Cases hard_point_sets(bool full) {
    Cases all;
    add_low_dimensions(all);
    all.push_back({"C02 a lattice", lattice(full ? 100 : 12), 3, 8, 6});
    all.push_back({"C03 crowded faces", crowded_faces(full ? 100'000 : 1'000), 3, 8, 6});
    Points sphere = shuffled(lattice_sphere(full ? 1155 : 45), 1);
    if (full) sphere.resize(10'000);
    const std::size_t extreme = sphere.size();
    all.push_back({"C04 co-spherical points", std::move(sphere), 3, extreme});
    Points symmetric = lattice_sphere(15);
    const std::size_t corners = symmetric.size();
    all.push_back({"C04 with coplanar faces", std::move(symmetric), 3, corners});
    for (const int count : {5, 100, full ? 1 << 16 : 1 << 8}) {
        const auto n = static_cast<std::size_t>(count);
        all.push_back(
            {"C05 moment curve of " + std::to_string(count), moment_curve(count), 3, n, 2 * n - 4});
    }
    for (const double bump : {0x1p-52, 0x1p-20, 0.0, -0x1p-52, 0.25}) {
        all.push_back({"C06 bumps of " + std::to_string(bump), cube_with_bumps(bump), 3,
                       bump > 0 ? 14U : 8U, bump > 0 ? 24U : 6U});
    }
    for (const double height : {1.0, 0.0, 1e300}) {
        all.push_back({"C07 a noisy plane", noisy_plane(full ? 10'000 : 200, height)});
    }
    for (std::uint32_t seed = 0; seed < (full ? 60U : 8U); ++seed) {
        all.push_back({"C08 mixed points, seed " + std::to_string(seed), mixed_points(seed)});
    }
    all.push_back({"C09 a ball", points_in_a_ball(full ? 1'000'000 : 4'000)});
    return all;
}

}  // namespace cdprep::test
