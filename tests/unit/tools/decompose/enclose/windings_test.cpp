// SPDX-License-Identifier: MIT
#include "decompose/enclose/windings.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/concave_solids.h"
#include "unit/tools/soup_of.h"

namespace cdprep::convex {
namespace {

using mesh::Double3;
using test::joined;
using test::moved_by;
using test::reversed;
using test::TestMesh;
using test::unit_cube;
using test::welded;

Windings windings_of(const TestMesh& mesh) {
    return find_windings(welded(mesh), serial_for);
}

/// A cube of side 9 with a cavity of side 5 around a cube of side 1.
TestMesh nested() {
    return joined(
        joined(moved_by(unit_cube(), 9, {}), reversed(moved_by(unit_cube(), 5, {2, 2, 2}))),
        moved_by(unit_cube(), 1, {4, 4, 4}));
}

// All by hand.
TEST(Windings, OfSolidsAreSimpleWhicheverWayTheyAreWound) {
    for (const TestMesh& solid : {unit_cube(), test::l_prism(), test::trefoil_tube(), nested(),
                                  joined(unit_cube(), moved_by(unit_cube(), 2, {5, 0, 0}))}) {
        EXPECT_EQ(windings_of(solid), Windings::simple);
        EXPECT_EQ(windings_of(reversed(solid)), Windings::simple);
    }
}

TEST(Windings, OfAComponentThatIsInsideOutAreOpposed) {
    const TestMesh apart = moved_by(unit_cube(), 1, {5, 0, 0});
    EXPECT_EQ(windings_of(joined(unit_cube(), reversed(apart))), Windings::opposed);
    EXPECT_EQ(windings_of(joined(reversed(unit_cube()), apart)), Windings::opposed);
    // Two cavities, one in the other.
    EXPECT_EQ(windings_of(joined(joined(moved_by(unit_cube(), 9, {}),
                                        reversed(moved_by(unit_cube(), 5, {2, 2, 2}))),
                                 reversed(moved_by(unit_cube(), 1, {4, 4, 4})))),
              Windings::opposed);
}

// Crossing, touching, one in the other, and with an edge of four triangles.
TEST(Windings, OfComponentsThatMeetOrOverlapAreUnknown) {
    for (const TestMesh& other :
         {moved_by(unit_cube(), 1, {0.5, 0.5, 0.5}), moved_by(unit_cube(), 1, {1, 0.25, 0.25}),
          moved_by(unit_cube(), 3, {-1, -1, -1}), moved_by(unit_cube(), 1, {1, 1, 0})}) {
        EXPECT_EQ(windings_of(joined(unit_cube(), other)), Windings::unknown);
    }
}

// Two cubes share a vertex: they are one component.
TEST(Windings, OfAPinchedSurfaceAreUnknown) {
    const TestMesh pinched =
        joined(moved_by(unit_cube(), 3, {}), moved_by(unit_cube(), 1, {3, 3, 3}));
    EXPECT_EQ(windings_of(pinched), Windings::unknown);
}

// Both sides of a sheet bound no volume, however they are rounded.
TEST(KnownVolume, IsThatOfASolidAndNotOfASheet) {
    EXPECT_TRUE(has_known_volume(welded(test::l_prism())));
    EXPECT_TRUE(has_known_volume(welded(moved_by(unit_cube(), 1, {1e4, 1e4, 1e4}))));
    EXPECT_TRUE(has_known_volume(welded(moved_by(unit_cube(), 0x1p-300, {}))));
    EXPECT_FALSE(has_known_volume({}));
    for (int i = 0; i < 20; ++i) {
        const TestMesh sheet = test::turned(test::grid_sheet(6, 6), 0.3 * i + 0.1);
        EXPECT_FALSE(has_known_volume(welded(joined(sheet, reversed(sheet))))) << i;
    }
}

// Thinner plates have less of their volume known: rounding is about 2^-53 of the cube of the size.
TEST(KnownVolume, EndsWherePlatesAreAsThinAsRounding) {
    const auto plate = [](double thickness) {
        TestMesh mesh = unit_cube();
        for (Double3& p : mesh.positions) p.z *= thickness;
        return welded(test::turned(mesh, 0.7));
    };
    EXPECT_TRUE(has_known_volume(plate(1e-9)));
    EXPECT_FALSE(has_known_volume(plate(1e-13)));
}

}  // namespace
}  // namespace cdprep::convex
