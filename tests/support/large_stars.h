// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "support/meshes.h"

namespace cdprep::test {

/// Returns a closed surface of an upward and a downward cone. Their common rim is about the z axis
/// and has radius 1. The tips at z = height and z = -height have `count` triangles each.
inline TestMesh double_cone(std::uint32_t count, double height) {
    TestMesh mesh;
    mesh.positions = {{0, 0, height}, {0, 0, -height}};
    for (std::uint32_t i = 0; i < count; ++i) {
        const double angle = 6.283185307179586 * i / count;
        mesh.positions.push_back({std::cos(angle), std::sin(angle), 0});
        const std::uint32_t a = 2 + i, b = 2 + (i + 1) % count;
        mesh.triangles.push_back({{0, a, b}});
        mesh.triangles.push_back({{1, b, a}});
    }
    return mesh;
}

/// Returns `count` triangles with a corner at the origin. The other corners are anywhere in
/// [-1, 1]^3.
inline TestMesh random_star(std::uint32_t seed, std::uint32_t count) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> around(-1, 1);
    TestMesh mesh;
    mesh.positions = {{0, 0, 0}};
    for (std::uint32_t i = 0; i < count; ++i) {
        for (int corner = 0; corner < 2; ++corner) {
            mesh.positions.push_back({around(random), around(random), around(random)});
        }
        mesh.triangles.push_back({{0, 2 * i + 1, 2 * i + 2}});
    }
    return mesh;
}

/// Returns `count` triangles without shared corners in the square [-1, 1]^2 of the plane z = 0.
/// Most of them are large, and most pairs overlap.
inline TestMesh coplanar_soup(std::uint32_t seed, std::uint32_t count) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> around(-1, 1);
    TestMesh mesh;
    for (std::uint32_t i = 0; i < 3 * count; ++i) {
        mesh.positions.push_back({around(random), around(random), 0});
        if (i % 3 == 2) mesh.triangles.push_back({{i - 2, i - 1, i}});
    }
    return in_floats(mesh);
}

}  // namespace cdprep::test
