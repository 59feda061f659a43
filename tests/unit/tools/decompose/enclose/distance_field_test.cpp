// SPDX-License-Identifier: MIT
#include "decompose/enclose/distance_field.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "unit/tools/soup_of.h"

namespace cdprep::convex {
namespace {

/// A prism of height 1 over an L of two arms of length 2 and width 1. It begins at `first`.
test::TestMesh l_at(const Double3& first) {
    constexpr std::array<std::array<double, 2>, 6> kOutline = {
        {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}};
    test::TestMesh mesh;
    for (const double z : {0.0, 1.0}) {
        for (const auto& [u, v] : kOutline) {
            mesh.positions.push_back({first.x + u, first.y + v, first.z + z});
        }
    }
    mesh.triangles = {{{0, 2, 1}}, {{0, 3, 2}}, {{0, 5, 3}},  {{3, 5, 4}},
                      {{6, 7, 8}}, {{6, 8, 9}}, {{6, 9, 11}}, {{9, 10, 11}}};
    for (std::uint32_t i = 0; i < 6; ++i) {
        const std::uint32_t next = (i + 1) % 6;
        mesh.triangles.push_back({{i, next, next + 6}});
        mesh.triangles.push_back({{i, next + 6, i + 6}});
    }
    return mesh;
}

// By hand: the middle of the facet over the notch is 1/2 from both arms. At 1e15, doubles are 1/8
// apart, and samples would be 1/25 apart. Where only some axes are so far out, each middle of a
// side is new, but the side along those axes does not become shorter.
TEST(DistanceField, SamplesEndWhereDoublesAreCoarser) {
    for (unsigned far_axes = 0; far_axes < 8; ++far_axes) {
        const auto first = [&](unsigned axis) { return (far_axes >> axis & 1U) == 0 ? 0 : 1e15; };
        const test::TestMesh test_mesh = l_at({first(0), first(1), -first(2)});
        const mesh::Mesh mesh = test::mesh_of(test_mesh);
        const Solid solid(mesh, Reference::solid, serial_for);
        const DistanceField field(solid, 0.1, 1, serial_for);
        const ConvexHull hull = convex_hull(test_mesh.positions);
        for (const Detail detail : {Detail::coarse, Detail::fine}) {
            const Estimate estimate = field.estimate(hull, 0, detail);
            EXPECT_NEAR(estimate.distance, 0.5, 0.2) << far_axes;
        }
    }
}

}  // namespace
}  // namespace cdprep::convex
