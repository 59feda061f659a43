// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>

#include "support/meshes.h"
#include "support/open_tiny.h"

namespace cdprep::test {

/// Returns one large triangle in the plane z = x. A distance from it, measured in double alone, has
/// an interval that is some 1e-12 wide.
[[nodiscard]] inline TestMesh slanted_plate() {
    return {{{0, 0, 0}, {1000, 0, 1000}, {0, 1000, 0}}, {{{0, 1, 2}}}};
}

/// Returns two groups of eight small triangles above slanted_plate(), parallel to it. The first
/// triangle of each group has the given height above it, and all others have the height 3. With
/// open_slanted(), a search for the nearest measures the first group first.
[[nodiscard]] inline TestMesh slanted_panes(double first, double second) {
    TestMesh mesh;
    const auto add = [&](double place, double along, double height) {
        const auto corner = static_cast<std::uint32_t>(mesh.positions.size());
        const double up = height * std::sqrt(0.5);
        const double x = along - up, z = along + up;
        for (const Double3& p :
             {Double3{x, place, z}, Double3{x, place + 1, z}, Double3{x + 1, place, z + 1}}) {
            mesh.positions.push_back(p);
        }
        mesh.triangles.push_back({{corner, corner + 1, corner + 2}});
    };
    for (int i = 0; i < 8; ++i) add(200, 200 + 2 * i, i == 0 ? first : 3);
    for (int i = 0; i < 8; ++i) add(300, 300 + 2 * i, i == 0 ? second : 3);
    return mesh;
}

/// Opens one of these with axis-aligned boxes, which are far from tight around slanted triangles.
[[nodiscard]] inline OpenModel open_slanted(const TestMesh& mesh) {
    return open_tiny(mesh, {.double_precision = true, .bounds = build::BvhBounds::aligned});
}

}  // namespace cdprep::test
