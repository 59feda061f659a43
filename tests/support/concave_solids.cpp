// SPDX-License-Identifier: MIT
#include "support/concave_solids.h"

#include <cmath>
#include <map>

namespace cdprep::test {
namespace {

/// A body of revolution about z: rings of `count` corners, closed by fans to two points.
TestMesh turned(const std::vector<std::array<double, 2>>& radius_and_height, int count) {
    TestMesh mesh;
    const auto n = static_cast<std::uint32_t>(count);
    const auto rings = static_cast<std::uint32_t>(radius_and_height.size());
    for (const auto& [radius, height] : radius_and_height) {
        for (int i = 0; i < count; ++i) {
            const double angle = 2 * std::acos(-1.0) * i / count;
            mesh.positions.push_back({radius * std::cos(angle), radius * std::sin(angle), height});
        }
    }
    mesh.positions.push_back({0, 0, radius_and_height.front()[1]});
    mesh.positions.push_back({0, 0, radius_and_height.back()[1]});
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t j = (i + 1) % n;
        for (std::uint32_t k = 0; k + 1 < rings; ++k) {
            const std::uint32_t a = k * n, b = a + n;
            mesh.triangles.push_back({{a + i, a + j, b + j}});
            mesh.triangles.push_back({{a + i, b + j, b + i}});
        }
        mesh.triangles.push_back({{rings * n, j, i}});
        mesh.triangles.push_back({{rings * n + 1, (rings - 1) * n + i, (rings - 1) * n + j}});
    }
    return mesh;
}

/// A square tube along a curve: `at` gives the middle of each ring and its two axes.
template <class At>
TestMesh tube(int rings, bool is_closed, At at) {
    TestMesh mesh;
    for (int i = 0; i < rings; ++i) {
        for (const Double3& corner : at(i)) mesh.positions.push_back(corner);
    }
    const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        mesh.triangles.push_back({{a, b, c}});
        mesh.triangles.push_back({{a, c, d}});
    };
    const auto count = static_cast<std::uint32_t>(rings);
    for (std::uint32_t i = 0; i + (is_closed ? 0 : 1) < count; ++i) {
        const std::uint32_t a = 4 * i, b = 4 * ((i + 1) % count);
        for (std::uint32_t k = 0; k < 4; ++k) {
            const std::uint32_t l = (k + 1) % 4;
            quad(a + k, a + l, b + l, b + k);
        }
    }
    if (!is_closed) {
        quad(3, 2, 1, 0);
        const std::uint32_t z = 4 * (count - 1);
        quad(z, z + 1, z + 2, z + 3);
    }
    return mesh;
}

/// A ring of four points around `middle`, spanned by two directions.
std::array<Double3, 4> ring_of(const Double3& middle, const Double3& u, const Double3& w) {
    const auto corner = [&](double s, double t) {
        return Double3{middle.x + s * u.x + t * w.x, middle.y + s * u.y + t * w.y,
                       middle.z + s * u.z + t * w.z};
    };
    return {corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)};
}

}  // namespace

TestMesh prism(const std::vector<std::array<double, 2>>& outline,
               const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    TestMesh mesh;
    const auto count = static_cast<std::uint32_t>(outline.size());
    for (const double z : {0.0, 1.0}) {
        for (const auto& p : outline) mesh.positions.push_back({p[0], p[1], z});
    }
    for (const auto& t : triangles) {
        mesh.triangles.push_back({{t[2], t[1], t[0]}});
        mesh.triangles.push_back({{count + t[0], count + t[1], count + t[2]}});
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t j = (i + 1) % count;
        mesh.triangles.push_back({{i, j, count + j}});
        mesh.triangles.push_back({{i, count + j, count + i}});
    }
    return mesh;
}

TestMesh l_prism() {
    return prism({{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}},
                 {{{0, 1, 2}, {0, 2, 3}, {0, 3, 5}, {3, 4, 5}}});
}

TestMesh u_prism() {
    return prism({{{0, 0}, {3, 0}, {3, 2}, {2, 2}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}},
                 {{{0, 1, 4}, {0, 4, 5}, {1, 2, 3}, {1, 3, 4}, {0, 5, 6}, {0, 6, 7}}});
}

TestMesh plus_prism() {
    return prism({{{1, 0},
                   {2, 0},
                   {2, 1},
                   {3, 1},
                   {3, 2},
                   {2, 2},
                   {2, 3},
                   {1, 3},
                   {1, 2},
                   {0, 2},
                   {0, 1},
                   {1, 1}}},
                 {{{0, 1, 2},
                   {0, 2, 11},
                   {2, 3, 4},
                   {2, 4, 5},
                   {5, 6, 7},
                   {5, 7, 8},
                   {8, 9, 10},
                   {8, 10, 11},
                   {2, 5, 8},
                   {2, 8, 11}}});
}

TestMesh spiral_stair() {
    constexpr int kRings = 60;
    return tube(kRings, false, [](int i) {
        const double angle = 0.3 * i, c = std::cos(angle), s = std::sin(angle);
        return ring_of({3 * c, 3 * s, 0.15 * i}, {0.8 * c, 0.8 * s, 0}, {0, 0, 0.25});
    });
}

TestMesh trefoil_tube() {
    constexpr int kRings = 96;
    return tube(kRings, true, [](int i) {
        const double t = 2 * std::acos(-1.0) * i / kRings;
        const Double3 middle = {std::sin(t) + 2 * std::sin(2 * t),
                                std::cos(t) - 2 * std::cos(2 * t), -std::sin(3 * t)};
        // Across the curve, and outwards enough not to be along it.
        const Double3 along = {std::cos(t) + 4 * std::cos(2 * t),
                               -std::sin(t) + 4 * std::sin(2 * t), -3 * std::cos(3 * t)};
        const double flat = std::hypot(along.x, along.y);
        const Double3 u = {0.2 * along.y / flat, -0.2 * along.x / flat, 0};
        const double length = std::hypot(flat, along.z);
        const Double3 w = {-0.2 * along.x * along.z / (flat * length),
                           -0.2 * along.y * along.z / (flat * length), 0.2 * flat / length};
        return ring_of(middle, w, u);
    });
}

TestMesh star() {
    return turned({{{0.3, 0}, {1, 0.5}, {0.3, 1}, {1.1, 1.5}, {0.3, 2}}}, 9);
}

TestMesh box_with_a_fine_side(int n, int m) {
    const TestMesh sheet = grid_sheet(n, m);
    const auto below = static_cast<std::uint32_t>(sheet.positions.size());
    TestMesh box = joined(sheet, reversed(moved_by(sheet, 1, {0, 0, -1})));
    std::map<std::array<std::uint32_t, 2>, int> edges;
    for (const Triangle& t : sheet.triangles) {
        for (std::size_t i = 0; i < 3; ++i) ++edges[{t.vertex[i], t.vertex[(i + 1) % 3]}];
    }
    for (const auto& [edge, count] : edges) {
        const auto [a, b] = edge;
        if (edges.contains({b, a})) continue;
        box.triangles.push_back({{b, a, a + below}});
        box.triangles.push_back({{b, a + below, b + below}});
    }
    return box;
}

}  // namespace cdprep::test
