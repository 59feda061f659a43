// SPDX-License-Identifier: MIT
#include "decompose/enclose/part_cover.h"

#include <gtest/gtest.h>

#include <array>

#include "unit/tools/soup_of.h"

namespace cdprep::convex {
namespace {

/// The box from `lower`, twice as long along one axis as along the others, or half of it.
test::TestMesh box(const Double3& lower, double Double3::*axis, double length) {
    test::TestMesh mesh = test::moved_by(test::unit_cube(), 1, lower);
    for (Double3& p : mesh.positions) p.*axis = lower.*axis + (p.*axis - lower.*axis) * length;
    return mesh;
}

CoverCell cell_of(const test::TestMesh& mesh) {
    CoverCell cell{{}, 0, mesh.positions};
    for (const Double3& p : mesh.positions) cell.box.add(p);
    return cell;
}

// By hand: the hull of both halves of a box is the box. They have a face in common and no more,
// and either may come first.
TEST(CoverWithParts, HalvesOfABoxAreOnePartInEitherOrder) {
    for (const auto axis : {&Double3::x, &Double3::y, &Double3::z}) {
        Double3 middle = {1, 2, 3};
        const test::TestMesh first = box(middle, axis, 1);
        const mesh::Mesh whole = test::mesh_of(box(middle, axis, 2));
        middle.*axis += 1;
        const test::TestMesh second = box(middle, axis, 1);
        const Solid solid(whole, Reference::solid, serial_for);
        const DistanceField field(solid, 0.125, 0.5, serial_for);
        for (const bool is_swapped : {false, true}) {
            std::array cells = {cell_of(first), cell_of(second)};
            if (is_swapped) std::swap(cells[0], cells[1]);
            const Cover cover = cover_with_parts(cells, field, {.error = 0.25});
            ASSERT_TRUE(cover.complete);
            EXPECT_EQ(cover.parts, (std::vector<std::vector<std::uint32_t>>{{0, 1}}));
        }
    }
}

// By hand: a gap between them, wider than the error allows for.
TEST(CoverWithParts, BoxesApartAreTwoParts) {
    const test::TestMesh first = box({0, 0, 0}, &Double3::x, 1);
    const test::TestMesh second = box({3, 0, 0}, &Double3::x, 1);
    const mesh::Mesh whole = test::mesh_of(test::joined(first, second));
    const Solid solid(whole, Reference::solid, serial_for);
    const DistanceField field(solid, 0.125, 0.5, serial_for);
    const std::array cells = {cell_of(first), cell_of(second)};
    const Cover cover = cover_with_parts(cells, field, {.error = 0.25});
    ASSERT_TRUE(cover.complete);
    EXPECT_EQ(cover.parts.size(), 2U);
}

}  // namespace
}  // namespace cdprep::convex
