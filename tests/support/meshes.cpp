// SPDX-License-Identifier: MIT
#include "support/meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <utility>

namespace cdprep::test {
namespace {

std::uint32_t add_vertex(TestMesh& mesh, const Double3& p) {
    mesh.positions.push_back(p);
    return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

void add_triangle(TestMesh& mesh, const Double3& a, const Double3& b, const Double3& c) {
    const std::uint32_t first = add_vertex(mesh, a);
    add_vertex(mesh, b);
    add_vertex(mesh, c);
    mesh.triangles.push_back({{first, first + 1, first + 2}});
}

Double3 on_sphere(const Double3& p) {
    const double length = std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
    return {p.x / length, p.y / length, p.z / length};
}

TestMesh icosahedron() {
    const double g = std::numbers::phi;
    TestMesh mesh;
    mesh.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                      {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    for (Double3& p : mesh.positions) p = on_sphere(p);
    mesh.triangles = {{{0, 11, 5}}, {{0, 5, 1}},  {{0, 1, 7}},   {{0, 7, 10}}, {{0, 10, 11}},
                      {{1, 5, 9}},  {{5, 11, 4}}, {{11, 10, 2}}, {{10, 7, 6}}, {{7, 1, 8}},
                      {{3, 9, 4}},  {{3, 4, 2}},  {{3, 2, 6}},   {{3, 6, 8}},  {{3, 8, 9}},
                      {{4, 9, 5}},  {{2, 4, 11}}, {{6, 2, 10}},  {{8, 6, 7}},  {{9, 8, 1}}};
    return mesh;
}

TestMesh split_in_four(const TestMesh& coarse) {
    TestMesh fine;
    fine.positions = coarse.positions;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto [at, is_new] = middles.try_emplace(std::minmax(a, b), 0U);
        if (is_new) {
            const Double3& p = coarse.positions[a];
            const Double3& q = coarse.positions[b];
            at->second = add_vertex(fine, on_sphere({p.x + q.x, p.y + q.y, p.z + q.z}));
        }
        return at->second;
    };
    for (const Triangle& t : coarse.triangles) {
        const auto [a, b, c] = t.vertex;
        const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        for (const Triangle& part : {Triangle{{a, ab, ca}}, Triangle{{ab, b, bc}},
                                     Triangle{{ca, bc, c}}, Triangle{{ab, bc, ca}}}) {
            fine.triangles.push_back(part);
        }
    }
    return fine;
}

}  // namespace

TestMesh unit_cube() {
    TestMesh mesh;
    for (int i = 0; i < 8; ++i) {
        add_vertex(mesh, {static_cast<double>(i & 1), static_cast<double>(i >> 1 & 1),
                          static_cast<double>(i >> 2)});
    }
    mesh.triangles = {{{0, 2, 3}}, {{0, 3, 1}}, {{4, 5, 7}}, {{4, 7, 6}}, {{0, 1, 5}}, {{0, 5, 4}},
                      {{2, 6, 7}}, {{2, 7, 3}}, {{0, 4, 6}}, {{0, 6, 2}}, {{1, 3, 7}}, {{1, 7, 5}}};
    return mesh;
}

TestMesh right_triangle() {
    return {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{{0, 1, 2}}}};
}

TestMesh grid_sheet(int n, int m) {
    TestMesh mesh;
    for (int x = 0; x <= n; ++x) {
        for (int y = 0; y <= m; ++y) {
            add_vertex(mesh, {static_cast<double>(x), static_cast<double>(y), 0});
        }
    }
    const auto at = [m](int x, int y) { return static_cast<std::uint32_t>(x * (m + 1) + y); };
    for (int x = 0; x < n; ++x) {
        for (int y = 0; y < m; ++y) {
            mesh.triangles.push_back({{at(x, y), at(x + 1, y), at(x + 1, y + 1)}});
            mesh.triangles.push_back({{at(x, y), at(x + 1, y + 1), at(x, y + 1)}});
        }
    }
    return mesh;
}

TestMesh icosphere(int level) {
    TestMesh mesh = icosahedron();
    for (int i = 0; i < level; ++i) mesh = split_in_four(mesh);
    return mesh;
}

TestMesh torus(double big, double small, int n, int m) {
    TestMesh mesh;
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < m; ++j) {
            const double u = 2 * std::numbers::pi * i / n;
            const double v = 2 * std::numbers::pi * j / m;
            const double r = big + small * std::cos(v);
            add_vertex(mesh, {r * std::cos(u), r * std::sin(u), small * std::sin(v)});
        }
    }
    const auto at = [n, m](int i, int j) { return static_cast<std::uint32_t>(i % n * m + j % m); };
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < m; ++j) {
            mesh.triangles.push_back({{at(i, j), at(i + 1, j), at(i + 1, j + 1)}});
            mesh.triangles.push_back({{at(i, j), at(i + 1, j + 1), at(i, j + 1)}});
        }
    }
    return mesh;
}

TestMesh random_soup(std::uint32_t seed, int count, double size) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> anywhere(-1, 1);
    TestMesh mesh;
    for (int i = 0; i < count; ++i) {
        const Double3 p{anywhere(random), anywhere(random), anywhere(random)};
        const auto near = [&] {
            return Double3{p.x + size * anywhere(random), p.y + size * anywhere(random),
                           p.z + size * anywhere(random)};
        };
        const Double3 q = near();
        add_triangle(mesh, p, q, near());
    }
    return in_floats(std::move(mesh));
}

TestMesh coarse_grid_soup(std::uint32_t seed, int count, int grid) {
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> step(-grid, grid);
    const auto point = [&] {
        const int x = step(random), y = step(random), z = step(random);
        return Double3{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
    };
    TestMesh mesh;
    for (int i = 0; i < count; ++i) {
        const Double3 a = point(), b = point(), c = point();
        add_triangle(mesh, a, b, c);
    }
    return mesh;
}

TestMesh fan(int count) {
    TestMesh mesh;
    add_vertex(mesh, {0, 0, 0});
    for (int i = 0; i < count; ++i) {
        const double angle = 2 * std::numbers::pi * i / count;
        add_vertex(mesh, {std::cos(angle), std::sin(angle), 0});
    }
    for (int i = 0; i < count; ++i) {
        mesh.triangles.push_back({{0, static_cast<std::uint32_t>(i + 1),
                                   static_cast<std::uint32_t>((i + 1) % count + 1)}});
    }
    return mesh;
}

TestMesh copies_of_one_triangle(int count) {
    TestMesh mesh;
    for (int i = 0; i < count; ++i) add_triangle(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    return mesh;
}

TestMesh geometric_progression(int count) {
    TestMesh mesh;
    for (int i = 0; i < count; ++i) {
        const double x = std::ldexp(1.0, -i);
        add_triangle(mesh, {x, 0, 0}, {x, x / 4, 0}, {x, 0, x / 4});
    }
    return mesh;
}

TestMesh klein_bottle(int rows, int columns) {
    TestMesh bottle;
    for (int r = 0; r < rows; ++r) {
        const double u = 2 * std::numbers::pi * r / rows;
        for (int c = 0; c < columns; ++c) {
            // A figure of eight that turns by half a turn on its way around.
            const double v = 2 * std::numbers::pi * c / columns;
            const double x = std::sin(v), y = std::sin(2 * v);
            const double reach = 2 + std::cos(u / 2) * x - std::sin(u / 2) * y;
            bottle.positions.push_back({reach * std::cos(u), reach * std::sin(u),
                                        std::sin(u / 2) * x + std::cos(u / 2) * y});
        }
    }
    const auto at = [&](int r, int c) {
        // Past the last row the columns run backwards.
        const int column = r == rows ? (2 * columns - c) % columns : c % columns;
        return static_cast<std::uint32_t>(r % rows * columns + column);
    };
    for (int r = 0; r < rows; ++r) {
        for (int c = 0; c < columns; ++c) {
            bottle.triangles.push_back({{at(r, c), at(r, c + 1), at(r + 1, c)}});
            bottle.triangles.push_back({{at(r + 1, c), at(r, c + 1), at(r + 1, c + 1)}});
        }
    }
    return bottle;
}

TestMesh upper_half(TestMesh mesh) {
    std::erase_if(mesh.triangles, [&](const Triangle& t) {
        return std::any_of(t.vertex.begin(), t.vertex.end(),
                           [&](std::uint32_t v) { return mesh.positions[v].z < 0; });
    });
    return mesh;
}

TestMesh three_sheets() {
    TestMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0},  {1, 1, 0},
                      {0, 0, 1}, {1, 0, 1}, {0, -1, 0}, {1, -1, 0}};
    mesh.triangles = {{{0, 1, 3}}, {{0, 3, 2}}, {{0, 1, 5}}, {{0, 5, 4}}, {{1, 0, 6}}, {{1, 6, 7}}};
    return mesh;
}

std::vector<Double3> lattice_sphere(int radius) {
    std::vector<Double3> points;
    for (int x = -radius; x <= radius; ++x) {
        for (int y = -radius; y <= radius; ++y) {
            const int rest = radius * radius - x * x - y * y;
            if (rest < 0) continue;
            const int z = static_cast<int>(std::lround(std::sqrt(rest)));
            if (z * z != rest) continue;
            points.push_back({double(x), double(y), double(z)});
            if (z > 0) points.push_back({double(x), double(y), double(-z)});
        }
    }
    return points;
}

TestMesh joined(const TestMesh& first, const TestMesh& second) {
    TestMesh mesh = first;
    const auto offset = static_cast<std::uint32_t>(first.positions.size());
    mesh.positions.insert(mesh.positions.end(), second.positions.begin(), second.positions.end());
    for (const Triangle& t : second.triangles) {
        mesh.triangles.push_back(
            {{t.vertex[0] + offset, t.vertex[1] + offset, t.vertex[2] + offset}});
    }
    return mesh;
}

TestMesh moved_by(TestMesh mesh, double scale, const Double3& shift) {
    for (Double3& p : mesh.positions) {
        p = {scale * p.x + shift.x, scale * p.y + shift.y, scale * p.z + shift.z};
    }
    return mesh;
}

TestMesh turned(TestMesh mesh, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    for (Double3& p : mesh.positions) {
        p = {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
        p = {p.x, c * p.y - s * p.z, s * p.y + c * p.z};
    }
    return mesh;
}

TestMesh with_shared_vertices(TestMesh mesh) {
    std::map<std::array<double, 3>, std::uint32_t> first;
    for (Triangle& triangle : mesh.triangles) {
        for (std::uint32_t& vertex : triangle.vertex) {
            const Double3& p = mesh.positions[vertex];
            vertex = first.emplace(std::array{p.x, p.y, p.z}, vertex).first->second;
        }
    }
    return mesh;
}

TestMesh reversed(TestMesh mesh) {
    for (Triangle& t : mesh.triangles) std::swap(t.vertex[1], t.vertex[2]);
    return mesh;
}

TestMesh in_floats(TestMesh mesh) {
    for (Double3& p : mesh.positions) {
        p = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
    }
    return mesh;
}

}  // namespace cdprep::test
