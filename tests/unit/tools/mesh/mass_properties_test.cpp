// SPDX-License-Identifier: MIT
#include "mesh/mass_properties.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "cdprep/pose.h"
#include "unit/tools/soup_of.h"

namespace cdprep::convex {
namespace {

using format::Double3;
using format::MassProperties;

std::optional<MassProperties> properties_of(const test::TestMesh& mesh) {
    return find_mass_properties(test::mesh_of(mesh));
}

void expect_close(const MassProperties& found, const MassProperties& expected, double tolerance) {
    EXPECT_NEAR(found.volume, expected.volume, tolerance);
    EXPECT_NEAR(found.surface_area, expected.surface_area, tolerance);
    EXPECT_NEAR(found.centre.x, expected.centre.x, tolerance);
    EXPECT_NEAR(found.centre.y, expected.centre.y, tolerance);
    EXPECT_NEAR(found.centre.z, expected.centre.z, tolerance);
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_NEAR(found.inertia[i], expected.inertia[i], tolerance) << "inertia " << i;
    }
}

// Textbook: volume 1, area 6, inertia m (a^2 + b^2) / 12 = 1/6 about each axis.
TEST(MassProperties, AUnitCubeHasThoseOfTheTextbook) {
    const auto found = properties_of(test::unit_cube());
    ASSERT_TRUE(found);
    const double sixth = 1.0 / 6;
    expect_close(*found, {1, 6, {0.5, 0.5, 0.5}, {sixth, sixth, sixth, 0, 0, 0}}, 1e-15);
}

// A box of 2 x 3 x 4, mass 24: inertia m (b^2 + c^2) / 12 and so on.
TEST(MassProperties, ABoxHasThoseOfTheTextbook) {
    test::TestMesh box = test::unit_cube();
    for (Double3& p : box.positions) p = {2 * p.x + 7, 3 * p.y - 1, 4 * p.z};
    const auto found = properties_of(box);
    ASSERT_TRUE(found);
    expect_close(*found, {24, 52, {8, 0.5, 2}, {50, 40, 26, 0, 0, 0}}, 1e-12);
}

// The corner tetrahedron of the unit cube: integrals by hand. About the centre
// (1/4, 1/4, 1/4): xx = 1/80, xy = +1/480 with the sign of -integral(x y).
TEST(MassProperties, ACornerTetrahedronHasThoseOfTheIntegrals) {
    const test::TestMesh corner = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                   {{{0, 2, 1}}, {{0, 1, 3}}, {{0, 3, 2}}, {{1, 2, 3}}}};
    const auto found = properties_of(corner);
    ASSERT_TRUE(found);
    const double area = 1.5 + std::sqrt(3.0) / 2;
    expect_close(*found,
                 {1.0 / 6,
                  area,
                  {0.25, 0.25, 0.25},
                  {1.0 / 80, 1.0 / 80, 1.0 / 80, 1.0 / 480, 1.0 / 480, 1.0 / 480}},
                 1e-16);
}

// 81,920 triangles lie within 3e-5 of the sphere: 4/3 pi, 4 pi, 2/5 m r^2.
TEST(MassProperties, AFineSphereIsNearlyASphere) {
    const auto found = properties_of(test::icosphere(6));
    ASSERT_TRUE(found);
    const double volume = 4 * std::numbers::pi / 3;
    const double moment = 0.4 * volume;
    expect_close(
        *found, {volume, 4 * std::numbers::pi, {0, 0, 0}, {moment, moment, moment, 0, 0, 0}}, 3e-3);
    EXPECT_LT(found->volume, volume);  // the triangles lie inside
}

TEST(MassProperties, AnInvertedMeshHasNegativeVolumeAndTheSameCentre) {
    const auto found = properties_of(test::reversed(test::unit_cube()));
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->volume, -1, 1e-15);
    EXPECT_NEAR(found->centre.x, 0.5, 1e-15);
    EXPECT_NEAR(found->surface_area, 6, 1e-15);
}

TEST(MassProperties, AMeshThatEnclosesNothingHasNone) {
    const test::TestMesh sheet = test::grid_sheet(2, 2);
    EXPECT_FALSE(properties_of(test::joined(sheet, test::reversed(sheet))));
    EXPECT_FALSE(find_mass_properties({}));
}

TEST(MassProperties, ResultsBeyondTheRangeOfDoubleAreNone) {
    for (const int exponent : {-900, 900}) {
        EXPECT_FALSE(
            properties_of(test::moved_by(test::unit_cube(), std::ldexp(1.0, exponent), {0, 0, 0})))
            << exponent;
    }
}

// Volume, area and inertia about the centre do not know where the mesh is.
TEST(MassPropertiesLaws, MovingTheMeshMovesOnlyTheCentre) {
    const test::TestMesh torus = test::torus(2, 0.5, 24, 12);
    const auto home = properties_of(torus);
    const auto away = properties_of(test::moved_by(torus, 1, {1000, -300, 50}));
    ASSERT_TRUE(home && away);
    MassProperties expected = *home;
    expected.centre = {home->centre.x + 1000, home->centre.y - 300, home->centre.z + 50};
    expect_close(*away, expected, 1e-9);
}

// A power of two scales without rounding: length^3, length^2, length, length^5.
TEST(MassPropertiesLaws, ScalingByAPowerOfTwoScalesEachByItsPower) {
    const test::TestMesh torus = test::torus(2, 0.5, 24, 12);
    const auto home = properties_of(torus);
    const auto large = properties_of(test::moved_by(torus, 8, {0, 0, 0}));
    ASSERT_TRUE(home && large);
    EXPECT_EQ(large->volume, home->volume * 512);
    EXPECT_EQ(large->surface_area, home->surface_area * 64);
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_EQ(large->inertia[i], home->inertia[i] * 32768) << i;
    }
    EXPECT_GT(home->inertia[0], 0);
}

/// Inertia of the points of a box that are inside the tetrahedron, by drawing.
TEST(MassPropertiesLaws, ARandomTetrahedronAgreesWithDrawnPoints) {
    constexpr std::uint32_t kSeed = 20261121;
    std::mt19937 random(kSeed);
    std::uniform_real_distribution<double> coordinate(-1, 1);
    std::exponential_distribution<double> share;
    test::TestMesh mesh;
    for (int i = 0; i < 4; ++i) {
        mesh.positions.push_back({coordinate(random), coordinate(random), coordinate(random)});
    }
    mesh.triangles = {{{0, 2, 1}}, {{0, 1, 3}}, {{0, 3, 2}}, {{1, 2, 3}}};
    const auto found = properties_of(mesh);
    ASSERT_TRUE(found);
    constexpr int kPoints = 400'000;
    double xx = 0, xy = 0, sum_x = 0;
    for (int i = 0; i < kPoints; ++i) {
        std::array<double, 4> weight{share(random), share(random), share(random), share(random)};
        const double total = weight[0] + weight[1] + weight[2] + weight[3];
        Double3 p{0, 0, 0};
        for (std::size_t k = 0; k < 4; ++k) {
            p.x += weight[k] / total * mesh.positions[k].x;
            p.y += weight[k] / total * mesh.positions[k].y;
            p.z += weight[k] / total * mesh.positions[k].z;
        }
        const double x = p.x - found->centre.x, y = p.y - found->centre.y,
                     z = p.z - found->centre.z;
        sum_x += x;
        xx += y * y + z * z;
        xy -= x * y;
    }
    EXPECT_NEAR(sum_x / kPoints, 0, 2e-3) << "seed " << kSeed;
    EXPECT_NEAR(xx / kPoints, found->inertia[0] / found->volume, 2e-3) << "seed " << kSeed;
    EXPECT_NEAR(xy / kPoints, found->inertia[3] / found->volume, 2e-3) << "seed " << kSeed;
}

// Moments m about axes r, as columns: the tensor is the sum of m r r^T.
TEST(PrincipalInertia, IsTheTensor) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> entry(-1, 1);
    for (int round = 0; round < 1000; ++round) {
        const double scale = std::ldexp(1.0, static_cast<int>(random() % 200) - 100);
        std::array<double, 6> inertia;
        for (double& x : inertia) x = scale * entry(random);
        if (round % 4 == 0) inertia[3] = inertia[4] = inertia[5] = 0;
        if (round % 8 == 0) inertia[1] = inertia[0];
        const auto [m, q] = principal_inertia(inertia);
        EXPECT_LE(m[0], m[1]);
        EXPECT_LE(m[1], m[2]);
        EXPECT_NEAR(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], 1, 1e-15);
        const Pose turn = Pose::from_quaternion(q[3], q[0], q[1], q[2], {}).value();
        const auto& r = turn.rotation();
        const auto tensor = [&](std::size_t i, std::size_t j) {
            double sum = 0;
            for (std::size_t k = 0; k < 3; ++k) sum += r[3 * i + k] * m[k] * r[3 * j + k];
            return sum;
        };
        const std::array<double, 6> found = {tensor(0, 0), tensor(1, 1), tensor(2, 2),
                                             tensor(0, 1), tensor(1, 2), tensor(2, 0)};
        for (std::size_t i = 0; i < 6; ++i) {
            EXPECT_NEAR(found[i], inertia[i], 1e-14 * scale) << "entry " << i;
        }
    }
}

// A body without extent has no moments, and its axes are those of the model.
TEST(PrincipalInertia, OfAPointIsNone) {
    const auto [moments, axes] = principal_inertia({});
    EXPECT_EQ(moments, (std::array<double, 3>{}));
    EXPECT_EQ(axes, (std::array<double, 4>{0, 0, 0, 1}));
}

}  // namespace
}  // namespace cdprep::convex
