// SPDX-License-Identifier: MIT
#include "cdprep/contacts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "exact/vectors.h"
#include "support/brute_force.h"
#include "support/concave_solids.h"
#include "support/placements.h"
#include "support/random_pose.h"
#include "support/same_contacts.h"
#include "unit/tools/with_pieces.h"

namespace cdprep::test {
namespace {

std::vector<Contact> all_contacts(const Model& a, const Model& b, const Placement& placement,
                                  double tolerance, Manifold manifold = Manifold::four) {
    Workspace workspace;
    std::vector<Contact> found(
        contacts({a, b, placement}, workspace, {}, {.tolerance = tolerance}).found);
    EXPECT_EQ(contacts({a, b, placement}, workspace, found,
                       {.tolerance = tolerance, .manifold = manifold})
                  .count,
              found.size());
    return found;
}

std::vector<Contact> all_contacts(const OpenModel& a, const OpenModel& b,
                                  const Placement& placement, double tolerance) {
    return all_contacts(a.model, b.model, placement, tolerance);
}

void expect_near(const Double3& a, const Double3& b, double error = 1e-12) {
    EXPECT_NEAR(a.x, b.x, error);
    EXPECT_NEAR(a.y, b.y, error);
    EXPECT_NEAR(a.z, b.z, error);
}

/// A convex solid around a square base and an edge on top, along x: a roof.
TestMesh roof() {
    TestMesh mesh;
    mesh.positions = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, 0, 0}, {1, 0, 0}};
    mesh.triangles = {{{0, 2, 1}}, {{0, 3, 2}}, {{0, 1, 5}}, {{0, 5, 4}},
                      {{2, 3, 4}}, {{2, 4, 5}}, {{0, 4, 3}}, {{1, 2, 5}}};
    return mesh;
}

/// An L with arms 2 long, 1 wide and 1 high, whose notch is where x and y are above 1: cut so that
/// a seam between its pieces crosses its faces.
TestMesh l_with_a_seam() {
    return prism({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}},
                 {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}});
}

// By hand: one cube over the other by a gap, or into it: faces, and the corners of the square
// that they share.
TEST(Contacts, CubeOnCubeHasFourPoints) {
    const OpenModel cube = open_with_pieces(unit_cube());
    for (const double gap : {0.0625, 0.0, -0.125}) {
        SCOPED_TRACE(gap);
        const auto found = all_contacts(cube, cube, shifted({0.25, 0.5, 1 + gap}), 0.1);
        ASSERT_EQ(found.size(), 1U);
        const Contact& contact = found[0];
        EXPECT_EQ(contact.flags, gap > 0 ? 0U : +contact_overlap);
        EXPECT_LE(contact.lower, gap);
        EXPECT_GE(contact.upper, gap);
        EXPECT_NEAR(contact.lower, contact.upper, 1e-12);
        expect_near(contact.normal, {0, 0, 1});
        ASSERT_EQ(contact.point_count, 4U);
        double sum_x = 0, sum_y = 0;
        for (const ManifoldPoint& point : contact.points) {
            EXPECT_NEAR(point.distance, gap, 1e-12);
            EXPECT_NEAR(point.on_a.z, 1, 1e-12);
            EXPECT_NEAR(point.on_b.z, 1 + gap, 1e-12);
            EXPECT_TRUE(point.on_a.x == 0.25 || point.on_a.x == 1) << point.on_a.x;
            EXPECT_TRUE(point.on_a.y == 0.5 || point.on_a.y == 1) << point.on_a.y;
            sum_x += point.on_a.x;
            sum_y += point.on_a.y;
        }
        EXPECT_EQ(sum_x, 2.5);
        EXPECT_EQ(sum_y, 3);
    }
}

// By hand: all four corners of the square are equally deep, so the outline's first comes first;
// the diagonal's other end is farthest from it; then come those to the left and to the right.
TEST(Contacts, EqualCornersComeInTheOrderOfTheFace) {
    const OpenModel cube = open_with_pieces(unit_cube());
    const auto found = all_contacts(cube, cube, shifted({0, 0, 1}), 0.1);
    ASSERT_EQ(found.size(), 1U);
    ASSERT_EQ(found[0].point_count, 4U);
    const std::array<Double3, 4> corners = {{{0, 0, 1}, {1, 1, 1}, {0, 1, 1}, {1, 0, 1}}};
    for (std::size_t i = 0; i < 4; ++i) {
        SCOPED_TRACE(i);
        EXPECT_EQ(found[0].points[i].on_a, corners[i])
            << found[0].points[i].on_a.x << " " << found[0].points[i].on_a.y;
    }
}

// By hand, by symmetry: what holds for cubes of size 1 holds for those of any size.
TEST(Contacts, CubesOfAnySizeOverlapAlike) {
    for (const int exponent : {-990, -700, -530, -300, -266, -250, -241, -239, 0, 239, 253, 254,
                               255, 259, 332, 466, 515, 700, 990}) {
        SCOPED_TRACE(exponent);
        const double size = std::ldexp(1.0, exponent);
        const OpenModel cube = open_with_pieces(moved_by(unit_cube(), size, {0, 0, 0}));
        const auto found =
            all_contacts(cube, cube, shifted({0.5 * size, 0.25 * size, 0.875 * size}), 0);
        ASSERT_EQ(found.size(), 1U);
        EXPECT_EQ(found[0].flags, +contact_overlap);
        expect_near(found[0].normal, {0, 0, 1});
        EXPECT_LE(found[0].lower / size, -0.125);
        EXPECT_GE(found[0].upper / size, -0.125);
        EXPECT_NEAR(found[0].lower / size, -0.125, 1e-11);
        EXPECT_NEAR(found[0].upper / size, -0.125, 1e-11);
        ASSERT_EQ(found[0].point_count, 4U);
        for (const ManifoldPoint& point : found[0].points) {
            EXPECT_NEAR(point.distance / size, -0.125, 1e-11);
        }
    }
}

// By symmetry: the contact of two cubes in any pose, apart or not, scales with them.
TEST(Contacts, ScaleWithTheirCubes) {
    const OpenModel unit = open_with_pieces(unit_cube());
    for (const int exponent : {-990, -530, -500, -266, 259, 466, 515, 990}) {
        SCOPED_TRACE(exponent);
        const double size = std::ldexp(1.0, exponent);
        const OpenModel cube = open_with_pieces(moved_by(unit_cube(), size, {0, 0, 0}));
        std::mt19937 random(16);
        std::size_t seen = 0, overlapping = 0;
        for (int round = 0; round < 60; ++round) {
            SCOPED_TRACE(round);
            const Pose pose = random_pose(random, 1.25);
            const auto expected = all_contacts(unit, unit, Placement::b_moves(pose), 0.25);
            std::array<double, 12> rows{};
            std::copy_n(pose.rotation().begin(), 9, rows.begin());
            const Double3 way = size * pose.translation();
            rows[9] = way.x, rows[10] = way.y, rows[11] = way.z;
            const Pose scaled = Pose::from_rows(rows).value();
            const auto found = all_contacts(cube, cube, Placement::b_moves(scaled), 0.25 * size);
            ASSERT_EQ(found.size(), expected.size());
            for (std::size_t i = 0; i < found.size(); ++i) {
                EXPECT_EQ(found[i].flags, expected[i].flags);
                expect_near(found[i].normal, expected[i].normal, 1e-9);
                EXPECT_NEAR(found[i].lower / size, expected[i].lower, 1e-11);
                EXPECT_NEAR(found[i].upper / size, expected[i].upper, 1e-11);
                EXPECT_EQ(found[i].point_count, expected[i].point_count);
                overlapping += found[i].flags & contact_overlap;
                ++seen;
            }
        }
        EXPECT_GT(overlapping, seen / 5);
        EXPECT_LT(overlapping, seen * 4 / 5);
    }
}

// By hand: two faces nearly parallel, nearest where an edge of one crosses an edge of the other.
// The upper cube is turned by 0.02 about z, so that the edges cross at x = 0.5, and leans by 0.02
// and 1e-4, so that this is the lowest point. The faces still share nearly a unit square.
TEST(Contacts, FacesNearlyParallelHaveFourPointsWhereEdgesCross) {
    const OpenModel cube = open_with_pieces(unit_cube());
    constexpr double kGap = 1e-3, kTolerance = 0.05;
    const Pose turned = Pose::from_quaternion(1, 0.01, 5e-5, 0.01, {0, 0, 0}).value();
    const Double3 end = transform_point(turned, {0.5, 0, 0});
    const Pose pose =
        Pose::from_quaternion(1, 0.01, 5e-5, 0.01, Double3{0.5, 0, 1 + kGap} - end).value();
    const auto found = all_contacts(cube, cube, Placement::b_moves(pose), kTolerance);
    ASSERT_EQ(found.size(), 1U);
    const Contact& contact = found[0];
    EXPECT_EQ(contact.feature_a.kind, FeatureKind::edge);
    EXPECT_EQ(contact.feature_b.kind, FeatureKind::edge);
    EXPECT_LT(contact.normal.z, 1 - 1e-10);  // of neither face
    ASSERT_EQ(contact.point_count, 4U);
    EXPECT_NEAR(contact.points[0].distance, contact.upper, 1e-12);
    Double3 lower = contact.points[0].on_a, upper = lower;
    for (const ManifoldPoint& point : contact.points) {
        EXPECT_LE(point.distance, kTolerance);
        EXPECT_GE(point.distance, contact.lower - 1e-12);
        expect_near(point.on_b, point.on_a + point.distance * contact.normal);
        lower = {std::min(lower.x, point.on_a.x), std::min(lower.y, point.on_a.y), 0};
        upper = {std::max(upper.x, point.on_a.x), std::max(upper.y, point.on_a.y), 0};
    }
    EXPECT_GT(upper.x - lower.x, 0.9);
    EXPECT_GT(upper.y - lower.y, 0.9);
}

// The same cubes, deeper and deeper: no point claims more than the contact's proven bound.
TEST(Contacts, NoManifoldPointIsDeeperThanItsContact) {
    const OpenModel cube = open_with_pieces(unit_cube());
    const Pose turned = Pose::from_quaternion(1, 0.01, 5e-5, 0.01, {0, 0, 0}).value();
    const Double3 end = transform_point(turned, {0.5, 0, 0});
    std::size_t deep = 0;
    for (int step = 0; step <= 60; ++step) {
        const double x = 0.5 + 0.008 * step, z = 1 - 0.005 * step;
        const Pose pose =
            Pose::from_quaternion(1, 0.01, 5e-5, 0.01, Double3{x, 0, z} - end).value();
        for (const Contact& contact : all_contacts(cube, cube, Placement::b_moves(pose), 0.05)) {
            deep += contact.lower < 0 ? 1 : 0;
            for (std::uint32_t i = 0; i < contact.point_count; ++i) {
                EXPECT_GE(contact.points[i].distance, contact.lower - 1e-12) << step;
            }
        }
    }
    EXPECT_GT(deep, 50U);
}

TEST(Contacts, BeyondTheToleranceThereIsNone) {
    const OpenModel cube = open_with_pieces(unit_cube());
    EXPECT_EQ(all_contacts(cube, cube, shifted({0, 0, 1.25}), 0.25).size(), 1U);
    EXPECT_EQ(all_contacts(cube, cube, shifted({0, 0, 1.25}), std::nextafter(0.25, 0)).size(), 0U);
    EXPECT_EQ(all_contacts(cube, cube, shifted({0, 0, 1}), 0).size(), 1U);
    EXPECT_EQ(all_contacts(cube, cube, shifted({0, 0, 1}), -1).size(), 0U);
    EXPECT_EQ(all_contacts(cube, cube, shifted({0, 0, 1}), NAN).size(), 0U);
}

// By hand: ridges along x and along y, one over the other.
TEST(Contacts, EdgesThatCrossAnswerAsEdges) {
    const OpenModel roof_a = open_with_pieces(roof());
    const Pose turn = Pose::from_rows({0, 1, 0, 1, 0, 0, 0, 0, -1, 0.25, 0.5, 0.375}).value();
    const auto found = all_contacts(roof_a, roof_a, Placement::b_moves(turn), 0.5);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].feature_a.kind, FeatureKind::edge);
    EXPECT_EQ(found[0].feature_b.kind, FeatureKind::edge);
    expect_near(found[0].normal, {0, 0, 1});
    expect_near(found[0].point_a, {0.25, 0, 0});
    expect_near(found[0].point_b, {0.25, 0, 0.375});
    ASSERT_EQ(found[0].point_count, 1U);
    EXPECT_NEAR(found[0].points[0].distance, 0.375, 1e-15);
    const TestMesh mesh = roof();
    for (const ContactFeature& feature : {found[0].feature_a, found[0].feature_b}) {
        const auto& vertex = mesh.triangles[feature.triangle].vertex;
        const std::uint32_t from = vertex[feature.edge], to = vertex[(feature.edge + 1) % 3U];
        EXPECT_EQ(from + to, 9U) << "not the ridge";
        EXPECT_EQ(feature.vertex, from);
    }
}

// By hand: an octahedron's lowest corner over a cube's top.
TEST(Contacts, AVertexOverAFaceAnswersAsThat) {
    TestMesh eight = icosphere(0);
    eight.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    eight.triangles = {{{0, 2, 4}}, {{2, 1, 4}}, {{1, 3, 4}}, {{3, 0, 4}},
                       {{2, 0, 5}}, {{1, 2, 5}}, {{3, 1, 5}}, {{0, 3, 5}}};
    const OpenModel cube = open_with_pieces(unit_cube()), octahedron = open_with_pieces(eight);
    for (const double gap : {0.125, -0.0625}) {
        SCOPED_TRACE(gap);
        const auto found = all_contacts(cube, octahedron, shifted({0.5, 0.25, 2 + gap}), 0.25);
        ASSERT_EQ(found.size(), 1U);
        EXPECT_EQ(found[0].feature_a.kind, FeatureKind::face);
        EXPECT_EQ(found[0].feature_b.kind, FeatureKind::vertex);
        EXPECT_EQ(found[0].feature_b.vertex, 5U);
        const TestMesh mesh = unit_cube();
        for (const std::uint32_t v : mesh.triangles[found[0].feature_a.triangle].vertex) {
            EXPECT_EQ(mesh.positions[v].z, 1);
        }
        expect_near(found[0].normal, {0, 0, 1});
        EXPECT_NEAR(found[0].lower, gap, 1e-12);
        expect_near(found[0].point_b, {0.5, 0.25, 1 + gap});
        EXPECT_NEAR(found[0].points[0].distance, gap, 1e-12);
    }
}

// By hand: a cube in the notch of an L is near one arm on either side, and the virtual faces
// inside the L answer nothing.
TEST(Contacts, ACubeInANotchTouchesBothArms) {
    const OpenModel arms = open_with_pieces(l_with_a_seam()), cube = open_with_pieces(unit_cube());
    ASSERT_GT(arms.model.pieces().pieces.size(), 1U);
    const auto found = all_contacts(arms, cube, shifted({1.0625, 1.125, 0}), 0.25);
    bool has_x = false, has_y = false;
    for (const Contact& contact : found) {
        EXPECT_GT(contact.lower, 0.06);
        EXPECT_LE(contact.upper, 0.25);
        const bool is_x = std::fabs(contact.normal.x - 1) < 1e-12;
        const bool is_y = std::fabs(contact.normal.y - 1) < 1e-12;
        has_x = has_x || (is_x && std::fabs(contact.upper - 0.0625) < 1e-12);
        has_y = has_y || (is_y && std::fabs(contact.upper - 0.125) < 1e-12);
    }
    EXPECT_TRUE(has_x);
    EXPECT_TRUE(has_y);
}

// By hand: centres on a line through vertices that lie opposite each other. As deep as the
// radii say.
TEST(Contacts, SpheresAnswerAtTheirPoles) {
    const TestMesh mesh = icosphere(3);
    const OpenModel sphere = open_with_pieces(mesh);
    ASSERT_EQ(sphere.model.pieces().pieces.size(), 1U);
    const Double3 pole = mesh.positions[0];
    const double radius = std::sqrt(pole.x * pole.x + pole.y * pole.y + pole.z * pole.z);
    const double way = 2 + 0.125 / radius;
    const auto found =
        all_contacts(sphere, sphere, shifted({way * pole.x, way * pole.y, way * pole.z}), 0.25);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_NEAR(found[0].lower, 0.125, 1e-12);
    expect_near(found[0].normal, {pole.x / radius, pole.y / radius, pole.z / radius}, 1e-9);
    EXPECT_EQ(found[0].feature_a.kind, FeatureKind::vertex);
    EXPECT_EQ(found[0].feature_a.vertex, 0U);

    const auto deep =
        all_contacts(sphere, sphere, shifted({1.75 * pole.x, 1.75 * pole.y, 1.75 * pole.z}), 0);
    ASSERT_EQ(deep.size(), 1U);
    EXPECT_EQ(deep[0].flags & contact_overlap, +contact_overlap);
    EXPECT_LT(deep[0].upper, 0);
    EXPECT_NEAR(deep[0].lower, -0.25 * radius, 0.02 * radius);
}

// Surfaces far apart do not touch, whatever is inside what.
TEST(Contacts, NestedSurfacesDoNotTouch) {
    const OpenModel outer = open_with_pieces(moved_by(unit_cube(), 8, {-4, -4, -4}));
    const OpenModel inner = open_with_pieces(unit_cube());
    EXPECT_EQ(all_contacts(outer, inner, shifted({0, 0, 0}), 0.5).size(), 0U);
    EXPECT_EQ(all_contacts(inner, outer, shifted({0, 0, 0}), 0.5).size(), 0U);
}

// By hand: a sheet is met from either side.
TEST(Contacts, ASheetIsMetFromBothSides) {
    const OpenModel sheet = open_with_pieces(grid_sheet(4, 4)),
                    cube = open_with_pieces(unit_cube());
    const auto above = all_contacts(sheet, cube, shifted({1.25, 1.5, 0.0625}), 0.125);
    ASSERT_EQ(above.size(), 1U);
    expect_near(above[0].normal, {0, 0, 1});
    EXPECT_EQ(above[0].point_count, 4U);
    EXPECT_NEAR(above[0].upper, 0.0625, 1e-13);
    const auto below = all_contacts(sheet, cube, shifted({1.25, 1.5, -1.0625}), 0.125);
    ASSERT_EQ(below.size(), 1U);
    expect_near(below[0].normal, {0, 0, -1});
    EXPECT_EQ(below[0].point_count, 4U);
    EXPECT_NEAR(below[0].upper, 0.0625, 1e-13);
}

// A cube slides over a flat floor whose triangles are pieces by themselves: whatever triangle it
// is half over or beside, the floor pushes up and nothing else.
TEST(Contacts, AFlatFloorOnlyPushesUp) {
    const OpenModel floor = open_with_pieces(grid_sheet(6, 6), PiecesOf::triangles);
    const OpenModel cube = open_with_pieces(unit_cube());
    int corrected = 0, plain = 0;
    for (const double height : {0.03125, 0.0, -0.03125}) {
        for (int step = 0; step < 40; ++step) {
            const Double3 at = {1.5 + 0.0517 * step, 1.6 + 0.0311 * step, height};
            const auto found = all_contacts(floor, cube, shifted(at), 0.125);
            ASSERT_GT(found.size(), 1U);
            for (const Contact& contact : found) {
                expect_near(contact.normal, {0, 0, 1}, 1e-9);
                const bool is_corrected = (contact.flags & contact_internal_edge) != 0;
                ++(is_corrected ? corrected : plain);
                EXPECT_LE(contact.lower, contact.upper);
                if (height > 0) {
                    EXPECT_GE(contact.upper, height);
                }
                if ((contact.flags & contact_overlap) != 0) {
                    EXPECT_LE(contact.lower, height + 1e-12);
                }
            }
        }
    }
    EXPECT_GT(corrected, 100);
    EXPECT_GT(plain, 100);
}

// The same where the floor bends up: a reflex edge takes the normals of its faces.
TEST(Contacts, AValleyPushesAlongItsFaces) {
    TestMesh valley = grid_sheet(6, 6);
    for (Double3& p : valley.positions) p.z = 0.75 * std::fabs(p.x - 3);
    const OpenModel floor = open_with_pieces(valley, PiecesOf::triangles);
    const OpenModel cube = open_with_pieces(moved_by(unit_cube(), 0.5, {-0.25, -0.25, 0}));
    int seen = 0;
    for (int step = 0; step < 60; ++step) {
        const double x = 2.6 + 0.0137 * step;
        const double height = 0.75 * (std::fabs(x - 3) + 0.25) + 0.015 * (step % 7) - 0.05;
        const Double3 at = {x, 1.5 + 0.031 * step, height};
        for (const Contact& contact : all_contacts(floor, cube, shifted(at), 0.1)) {
            EXPECT_NEAR(contact.normal.z, 0.8, 1e-9);
            EXPECT_NEAR(std::fabs(contact.normal.x), 0.6, 1e-9);
            ++seen;
        }
    }
    EXPECT_GT(seen, 30);
}

// By hand: corners, edges and faces of two cubes that have one point, one segment or one square in
// common, and a step on either side of that.
TEST(Contacts, CubesThatTouchExactlyAreNeitherApartNorDeep) {
    const OpenModel cube = open_with_pieces(unit_cube());
    for (const Double3& way : {Double3{1, 1, 1}, Double3{1, 1, 0.25}, Double3{1, 0.5, 0.25},
                               Double3{-1, 1, -1}, Double3{-1, 0.75, 1}}) {
        for (const double step : {0.0, 0x1p-40, -0x1p-40}) {
            SCOPED_TRACE(std::to_string(way.x) + " " + std::to_string(way.y) + " " +
                         std::to_string(way.z) + ", " + std::to_string(step));
            const double scale = 1 + step;
            const Double3 at = {way.x * scale, way.y * scale, way.z * scale};
            const auto found = all_contacts(cube, cube, shifted(at), 0x1p-30);
            ASSERT_EQ(found.size(), 1U);
            const Contact& contact = found[0];
            EXPECT_EQ((contact.flags & contact_overlap) != 0, step <= 0);
            EXPECT_EQ(contact.flags & contact_internal_edge, 0U);
            EXPECT_LE(contact.lower, contact.upper);
            EXPECT_NEAR(contact.lower, 0, 2 * std::fabs(step) + 1e-15);
            EXPECT_NEAR(contact.upper, 0, 2 * std::fabs(step) + 1e-15);
            EXPECT_NEAR(std::hypot(contact.normal.x, contact.normal.y, contact.normal.z), 1, 1e-12);
            // Towards B, along axes in which the two only just meet.
            const std::array<std::pair<double, double>, 3> axes = {
                {{way.x, contact.normal.x}, {way.y, contact.normal.y}, {way.z, contact.normal.z}}};
            for (const auto& [shift, along] : axes) {
                if (std::fabs(shift) == 1) {
                    EXPECT_GE(shift * along, -1e-12);
                } else {
                    EXPECT_NEAR(along, 0, 1e-12);
                }
            }
            for (const Double3& p : {contact.point_a, contact.point_b}) {
                for (const double x : {p.x, p.y, p.z}) {
                    EXPECT_GE(x, -1e-11);
                    EXPECT_LE(x, 1 + 1e-11);
                }
            }
            EXPECT_GE(contact.point_count, 1U);
        }
    }
}

// By hand: a pile of three boxes, each asked about the one below it and the one below that. They
// are pushed up by as much as they sink in, in four points, however they are turned.
TEST(Contacts, APileOfBoxesIsPushedUp) {
    const OpenModel box = open_with_pieces(moved_by(unit_cube(), 1, {-0.5, -0.5, 0}));
    for (const double sink : {0.0, 0.0078125, -0.0078125}) {
        for (int turn = 0; turn < 12; ++turn) {
            SCOPED_TRACE(turn);
            const auto pose = [&](int number) {
                const double angle = 0.13 * turn * number;
                return Pose::from_quaternion(std::cos(angle), 0, 0, std::sin(angle),
                                             {0.05 * number, -0.03 * turn, number * (1 - sink)})
                    .value();
            };
            for (int number = 0; number < 2; ++number) {
                const Placement next = Placement::world(pose(number), pose(number + 1));
                const auto found = all_contacts(box, box, next, 0.01);
                ASSERT_EQ(found.size(), 1U);
                expect_near(found[0].normal, {0, 0, 1}, 1e-9);
                EXPECT_EQ(found[0].flags & contact_internal_edge, 0U);
                EXPECT_NEAR(found[0].upper, -sink, 1e-12);
                EXPECT_EQ(found[0].point_count, 4U);
                for (const ManifoldPoint& point : found[0].points) {
                    EXPECT_NEAR(point.distance, -sink, 1e-12);
                }
            }
            EXPECT_EQ(all_contacts(box, box, Placement::world(pose(0), pose(2)), 0.01).size(), 0U);
        }
    }
}

// By hand: a box that stands on an edge or a corner, slid over a floor in small triangles and over
// one in pieces: its lowest part hits the middle, edges and corners of triangles alike.
TEST(Contacts, AFloorPushesATiltedBoxUp) {
    const OpenModel by_triangles = open_with_pieces(grid_sheet(6, 6), PiecesOf::triangles);
    const OpenModel by_surface = open_with_pieces(grid_sheet(6, 6));
    const TestMesh cube = unit_cube();
    const OpenModel box = open_with_pieces(moved_by(cube, 1, {-0.5, -0.5, -0.5}));
    const std::array<std::array<double, 4>, 3> tilts = {
        {{1, 0.3, 0, 0}, {1, 0.3, 0.4, 0.1}, {1, -0.2, 0.15, 0.5}}};
    std::size_t seen = 0, corrected = 0;
    for (const auto& [w, x, y, z] : tilts) {
        const Pose turn = Pose::from_quaternion(w, x, y, z, {}).value();
        double lowest = 0;
        for (const Double3& p : cube.positions) {
            lowest = std::min(lowest, transform_point(turn, {p.x - 0.5, p.y - 0.5, p.z - 0.5}).z);
        }
        for (const double height : {0.03125, 0.0, -0.03125}) {
            for (int step = 0; step < 24; ++step) {
                const Double3 at = {1.5 + 0.125 * step, 1.75 + 0.0625 * step, height - lowest};
                const Placement placement =
                    Placement::b_moves(Pose::from_quaternion(w, x, y, z, at).value());
                for (const OpenModel* floor : {&by_triangles, &by_surface}) {
                    SCOPED_TRACE(std::to_string(height) + ", step " + std::to_string(step));
                    const auto found = all_contacts(floor->model, box.model, placement, 0.0625);
                    ASSERT_GE(found.size(), 1U);
                    for (const Contact& contact : found) {
                        expect_near(contact.normal, {0, 0, 1}, 1e-9);
                        corrected += (contact.flags & contact_internal_edge) != 0 ? 1 : 0;
                        ++seen;
                    }
                }
            }
        }
    }
    EXPECT_GT(seen, 400U);
    EXPECT_GT(corrected, seen / 10);
    EXPECT_LT(corrected, seen * 9 / 10);
}

/// A ball of 1,280 triangles whose vertices are up to 4 % nearer to its middle, at random.
TestMesh rough_ball(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> share(0.96, 1);
    TestMesh ball = icosphere(3);
    for (Double3& p : ball.positions) {
        const double factor = share(random);
        p = {factor * p.x, factor * p.y, factor * p.z};
    }
    return ball;
}

// By construction: a rough ball that sinks into a box forty times its size is pushed up, by as much
// as each piece sank in, wherever the normals of its small faces point.
TEST(Contacts, ALargeBoxPushesARoughBallUp) {
    TestMesh wide = unit_cube();
    for (Double3& p : wide.positions) p = {40 * p.x - 20, 40 * p.y - 20, p.z - 1};
    const OpenModel box = open_with_pieces(wide);
    std::size_t seen = 0;
    for (unsigned seed = 1; seed <= 6; ++seed) {
        const TestMesh mesh = rough_ball(seed);
        const OpenModel ball = open_with_pieces(mesh);
        double lowest = 0;
        for (const Double3& p : mesh.positions) lowest = std::min(lowest, p.z);
        for (const double depth : {0.001, 0.01, 0.1}) {
            const Double3 at = {1.5 + seed, 0.75, -lowest - depth};
            for (const Contact& contact : all_contacts(box, ball, shifted(at), 0)) {
                SCOPED_TRACE(contact.piece_b);
                expect_near(contact.normal, {0, 0, 1}, 1e-9);
                EXPECT_GE(contact.lower, -depth * (1 + 1e-9));
                EXPECT_NEAR(contact.upper, contact.lower, 1e-12);
                EXPECT_EQ(contact.flags, +contact_overlap);
                ASSERT_GE(contact.point_count, 1U);
                EXPECT_NEAR(contact.points[0].distance, contact.lower, 1e-12);
                ++seen;
            }
        }
    }
    EXPECT_GT(seen, 100U);
}

// By testing the normals of all 1,280 faces: a ball leaves a box no farther than along any of them.
// The deepest of a rough ball's contacts with it is first in a list of one.
TEST(Contacts, ALargePieceLeavesAlongItsBestFace) {
    const TestMesh mesh = icosphere(3);
    const OpenModel ball = open_with_pieces(mesh);
    ASSERT_EQ(ball.model.pieces().pieces.size(), 1U);
    const OpenModel rough = open_with_pieces(rough_ball(7));
    std::mt19937 random(11);
    std::size_t seen = 0;
    for (int round = 0; round < 40; ++round) {
        SCOPED_TRACE(round);
        Pose pose = random_pose(random, 0);
        const Double3 way = transform_point(pose, {1.9, 0, 0});
        std::array<double, 12> rows{};
        std::copy_n(pose.rotation().begin(), 9, rows.begin());
        rows[9] = way.x, rows[10] = way.y, rows[11] = way.z;
        pose = Pose::from_rows(rows).value();
        const auto reach = [](const std::vector<Double3>& points, const Double3& n) {
            double most = -10;
            for (const Double3& p : points) most = std::max(most, cdprep::dot(p, n));
            return most;
        };
        std::vector<Double3> moved;
        for (const Double3& p : mesh.positions) moved.push_back(transform_point(pose, p));
        double least = 10;
        for (const Triangle& t : mesh.triangles) {
            const Double3 &p = mesh.positions[t.vertex[0]], &q = mesh.positions[t.vertex[1]],
                          &r = mesh.positions[t.vertex[2]];
            const Double3 n = cdprep::cross(q - p, r - p);
            const Double3 normal = (1 / std::sqrt(cdprep::dot(n, n))) * n;
            least = std::min(least, reach(mesh.positions, normal) + reach(moved, -normal));
        }
        for (const Contact& contact : all_contacts(ball, ball, Placement::b_moves(pose), 0)) {
            EXPECT_GE(contact.lower, -least * (1 + 1e-9));
            EXPECT_GE(contact.upper, contact.lower);
            ++seen;
        }

        const Pair pair = {ball.model, rough.model, Placement::b_moves(pose)};
        const auto all = all_contacts(ball, rough, pair.placement, 0.01);
        Workspace workspace;
        std::array<Contact, 1> first;
        const auto listed = contacts(pair, workspace, first, {.tolerance = 0.01, .most = 1});
        ASSERT_EQ(listed.found, all.size());
        double deepest = 1;
        for (const Contact& contact : all) deepest = std::min(deepest, contact.upper);
        if (!all.empty()) {
            EXPECT_EQ(first[0].upper, deepest);
        }
    }
    EXPECT_GT(seen, 30U);
}

// By hand: a prism of 100 sides lies on one of them, which is two triangles with four corners.
TEST(Contacts, ALargePieceHasWholeFaces) {
    constexpr std::uint32_t kSides = 100;
    std::vector<std::array<double, 2>> outline;
    std::vector<std::array<std::uint32_t, 3>> fan;
    const double turn = 2 * std::acos(-1.0) / kSides;
    for (std::uint32_t k = 0; k < kSides; ++k) {
        outline.push_back({std::cos(turn * k), std::sin(turn * k)});
        if (k > 1) fan.push_back({0, k - 1, k});
    }
    TestMesh wide = unit_cube();
    for (Double3& p : wide.positions) p = {40 * p.x - 20, 40 * p.y - 20, p.z - 1};
    const OpenModel box = open_with_pieces(wide);
    const OpenModel round = open_with_pieces(prism(outline, fan));
    ASSERT_EQ(round.model.pieces().pieces.size(), 1U);
    for (std::uint32_t k = 0; k < kSides; ++k) {
        SCOPED_TRACE(k);
        const double c = std::cos(turn * (k + 0.5)), s = std::sin(turn * (k + 0.5));
        const double height = std::cos(turn / 2) - 0.001;
        const Pose pose = Pose::from_rows({0, 0, -1, s, -c, 0, -c, -s, 0, 0, 0, height}).value();
        const auto found = all_contacts(box.model, round.model, Placement::b_moves(pose), 0);
        ASSERT_EQ(found.size(), 1U);
        expect_near(found[0].normal, {0, 0, 1}, 1e-9);
        ASSERT_EQ(found[0].point_count, 4U);
        for (const ManifoldPoint& point : found[0].points) {
            EXPECT_NEAR(point.distance, -0.001, 1e-12);
        }
    }
}

// By hand: two triangles above a box, bent along their common edge. Whatever edge the nearest
// corner leans over, the box is below.
TEST(Contacts, AGapHasANormalTowardsTheOtherSide) {
    TestMesh wide = unit_cube();
    for (Double3& p : wide.positions) p = {40 * p.x - 20, 40 * p.y - 20, p.z - 1};
    const OpenModel box = open_with_pieces(wide);
    TestMesh bent;
    bent.positions = {{0.21875, -1.765625, 0.0625},
                      {0.328125, -1.859375, 0.109375},
                      {0.203125, -1.859375, 0.140625},
                      {0.3125, -1.984375, 0.171875}};
    bent.triangles = {{{0, 1, 2}}, {{1, 3, 2}}};
    for (const PiecesOf pieces : {PiecesOf::surface, PiecesOf::triangles}) {
        const OpenModel above = open_with_pieces(bent, pieces);
        const auto found = all_contacts(box, above, shifted({0, 0, 0}), 0.121);
        EXPECT_GE(found.size(), 1U);
        for (const Contact& contact : found) {
            EXPECT_GT(contact.normal.z, 0);
            EXPECT_GT(contact.lower, 0);
        }
    }
}

// By hand: two triangles of one plane, each a piece, rise from a corner and an edge on a box. Their
// common edge continues the plane over the corner, but nothing there is below it.
TEST(Contacts, ACornerOfAPlaneIsPushedUp) {
    TestMesh wide = unit_cube();
    for (Double3& p : wide.positions) p = {40 * p.x - 20, 40 * p.y - 20, p.z - 1};
    const OpenModel box = open_with_pieces(wide);
    TestMesh leaning;
    leaning.positions = {
        {4.3125, -1.75, 0.0625}, {4.1875, -1.6875, 0}, {4.375, -1.625, 0}, {4.5, -1.6875, 0.0625}};
    leaning.triangles = {{{0, 1, 2}}, {{0, 2, 3}}};
    const OpenModel above = open_with_pieces(leaning, PiecesOf::triangles);
    for (const double height : {0.0, 0.004, -0.004}) {
        SCOPED_TRACE(height);
        const auto found = all_contacts(box, above, shifted({0, 0, height}), 0.0085);
        ASSERT_EQ(found.size(), 2U);
        for (const Contact& contact : found) {
            expect_near(contact.normal, {0, 0, 1}, 1e-9);
            EXPECT_NEAR(contact.lower, height, 1e-12);
            EXPECT_EQ(contact.flags & contact_internal_edge, 0U);
        }
    }
}

// By hand: cones of few and of many sides stand on their tips in a box, or just above it. They are
// convex, so each is one piece, and the tip is the nearest point.
TEST(Contacts, AConeOfAnySidesStandsOnItsTip) {
    const OpenModel box = open_with_pieces(moved_by(unit_cube(), 40, {-20, -20, -40}));
    for (const int sides : {8, 40, 63, 64, 65, 100}) {
        SCOPED_TRACE(sides);
        TestMesh mesh;
        mesh.positions = {{0, 0, 0}, {0, 0, 1}};
        for (int i = 0; i < sides; ++i) {
            const double angle = 2 * std::numbers::pi * i / sides;
            mesh.positions.push_back({std::cos(angle), std::sin(angle), 1});
        }
        for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(sides); ++i) {
            const std::uint32_t next = (i + 1) % static_cast<std::uint32_t>(sides);
            mesh.triangles.push_back({{0, 2 + next, 2 + i}});
            mesh.triangles.push_back({{1, 2 + i, 2 + next}});
        }
        const OpenModel cone = open_with_pieces(mesh);
        ASSERT_EQ(cone.model.pieces().pieces.size(), 1U);
        for (const double height : {-0.125, 0.0, 0.0625}) {
            const auto found = all_contacts(box, cone, shifted({1, 2, height}), 0.125);
            ASSERT_EQ(found.size(), 1U);
            expect_near(found[0].normal, {0, 0, 1}, 1e-9);
            EXPECT_NEAR(found[0].lower, height, 1e-12);
            EXPECT_EQ(found[0].feature_b.kind, FeatureKind::vertex);
            EXPECT_EQ(found[0].feature_b.vertex, 0U);
        }
    }
}

// By hand: a box slides over the top of an L and on along the outside of its arms, across the edges
// between pieces: each is flat, and every piece that is met from outside pushes along the common
// face. A wall that a corner of the box has come near to in the solid does not.
TEST(Contacts, TheSeamsOfASolidDoNotPushSideways) {
    const OpenModel arms = open_with_pieces(l_with_a_seam());
    ASSERT_GT(arms.model.pieces().pieces.size(), 1U);
    const OpenModel box = open_with_pieces(moved_by(unit_cube(), 0.5, {-0.25, -0.25, 0}));
    std::size_t seen = 0, across = 0, behind = 0;
    for (const double height : {0.03125, 0.0, -0.03125, -0.125}) {
        for (int step = 0; step < 30; ++step) {
            SCOPED_TRACE(std::to_string(height) + ", step " + std::to_string(step));
            const double along = 0.3 + 0.0443 * step;
            for (const double turn : {0.0, 0.2, 0.7}) {
                const Pose on_top = Pose::from_quaternion(std::cos(turn), 0, 0, std::sin(turn),
                                                          {along, 0.4 + 0.003 * step, 1 + height})
                                        .value();
                const auto found =
                    all_contacts(arms.model, box.model, Placement::b_moves(on_top), 0.0625);
                across += found.size() > 1 ? 1 : 0;
                for (const Contact& contact : found) {
                    if ((contact.flags & contact_from_behind) != 0) {
                        EXPECT_LT(height, 0);  // else nothing is in the solid
                        ++behind;
                        continue;
                    }
                    expect_near(contact.normal, {0, 0, 1}, 1e-9);
                    ++seen;
                }
            }
        }
    }
    EXPECT_GT(seen, 200U);
    EXPECT_GT(across, 50U);
    EXPECT_GT(behind, 0U);
    EXPECT_LT(behind, seen / 10);
}

/// A tetrahedron that stands on its tip at 0, 0, 0, behind the plane y = 0.
TestMesh on_its_tip() {
    TestMesh mesh;
    mesh.positions = {{0, 0, 0}, {-0.25, 0, 1}, {0.25, 0, 1}, {0, -0.5, 1}};
    mesh.triangles = {{{0, 1, 2}}, {{1, 3, 2}}, {{0, 3, 1}}, {{0, 2, 3}}};
    return mesh;
}

/// The pose that turns both models, and the same after a shift.
Placement turned_pair(const Pose& turn, const Double3& shift) {
    std::array<double, 12> rows{};
    std::copy_n(turn.rotation().begin(), 9, rows.begin());
    const Double3 at = transform_point(turn, shift);
    rows[9] = at.x, rows[10] = at.y, rows[11] = at.z;
    return Placement::world(turn, Pose::from_rows(rows).value());
}

// By hand: a box, and a corner, rest on one piece of a solid's top. The nearest point of the other
// piece is a vertex at the seam, straight across it. Nothing but the top pushes, however both are
// turned. A face of the second solid goes down from that vertex, but pushes the corner farther.
TEST(Contacts, ABodyAcrossASeamIsPushedByTheTop) {
    const OpenModel arms =
        open_with_pieces(prism({{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}},
                               {{1, 2, 3}, {1, 3, 4}, {0, 1, 4}, {0, 4, 5}, {0, 5, 6}}));
    const OpenModel stem =
        open_with_pieces(prism({{0, 0}, {3, 0}, {3, 1}, {2, 1}, {2, 2}, {1, 2}, {1, 1}, {0, 1}},
                               {{0, 1, 2}, {0, 2, 3}, {0, 3, 6}, {0, 6, 7}, {3, 4, 5}, {3, 5, 6}}));
    const OpenModel box = open_with_pieces(moved_by(unit_cube(), 0.5, {0, 0, 0}));
    const OpenModel tip = open_with_pieces(on_its_tip());
    struct Resting {
        const OpenModel& below;
        const OpenModel& above;
        Double3 at;
    };
    std::mt19937 random(17);
    std::size_t across = 0;
    for (const Resting& pair :
         {Resting{arms, box, {1.125, 0, 1}}, Resting{arms, box, {1.125, -0.5, 1}},
          Resting{stem, tip, {1, 0.875, 1}}}) {
        ASSERT_GT(pair.below.model.pieces().pieces.size(), 1U);
        for (int round = 0; round < 100; ++round) {
            SCOPED_TRACE(round);
            const Pose turn = round == 0 ? Pose() : random_pose(random, 0);
            const Double3 up = transform_point(turn, {0, 0, 1});
            for (const Contact& contact :
                 all_contacts(pair.below, pair.above, turned_pair(turn, pair.at), 0.2)) {
                EXPECT_NEAR(cdprep::dot(contact.normal, contact.normal), 1, 1e-12);
                // The other pair of pieces touches along z = 1, up to rounding.
                if (contact.lower < 0.1 || contact.feature_a.kind != FeatureKind::vertex) continue;
                expect_near(contact.normal, up, 1e-9);
                EXPECT_EQ(contact.flags, +contact_internal_edge);
                ++across;
            }
        }
    }
    EXPECT_GT(across, 100U);
}

// By hand: a box rests on a cube's top, apart from it by rounding or by a little. However both are
// turned, the top pushes it, with as many points as where they overlap as little.
TEST(Contacts, ABodyAtRestIsPushedByTheTop) {
    const OpenModel cube = open_with_pieces(unit_cube());
    const OpenModel box = open_with_pieces(moved_by(unit_cube(), 0.5, {0, 0, 0}));
    std::mt19937 random(24);
    std::uniform_real_distribution<double> place(0.0, 0.5);
    std::size_t apart = 0;
    for (int round = 0; round < 300; ++round) {
        SCOPED_TRACE(round);
        const Pose turn = random_pose(random, round % 2 == 0 ? 0 : 1);
        const Double3 up = transform_point(turn, {0, 0, 1}) - turn.translation();
        for (const double gap : {0.0, 1e-15, 1e-13, 1e-11, 1e-9}) {
            const double x = place(random), y = place(random);
            const auto found =
                all_contacts(cube.model, box.model, turned_pair(turn, {x, y, 1 + gap}), 0.01);
            ASSERT_EQ(found.size(), 1U);
            expect_near(found[0].normal, up, 1e-6);
            EXPECT_EQ(found[0].point_count, 4U);
            EXPECT_NEAR(found[0].upper, gap, 1e-14);
            apart += found[0].flags & contact_overlap ? 0 : 1;
        }
    }
    EXPECT_GT(apart, 1000U);
}

// By hand: a box slides from one arm over a seam onto the other piece. The plane of the seam holds
// an outer face as well, which the box is not near.
TEST(Contacts, AFaceBesideASeamDoesNotPushSideways) {
    const OpenModel arms =
        open_with_pieces(prism({{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}},
                               {{1, 2, 3}, {1, 3, 4}, {0, 1, 4}, {0, 4, 5}, {0, 5, 6}}));
    ASSERT_EQ(arms.model.pieces().pieces.size(), 2U);
    const OpenModel box = open_with_pieces(moved_by(unit_cube(), 0.5, {0, 0, 0}));
    std::mt19937 random(25);
    std::size_t both = 0;
    for (int round = 0; round < 100; ++round) {
        SCOPED_TRACE(round);
        const Pose turn = random_pose(random, 0);
        const Double3 up = transform_point(turn, {0, 0, 1});
        for (const double over : {-1e-13, 1e-13, 1e-9, 1e-6}) {
            for (const double sunk : {0.0, 1e-8, 1e-5}) {
                for (const double y : {0.25, -0.25}) {
                    const Placement placement = turned_pair(turn, {1 - over, y, 1 - sunk});
                    const auto found = all_contacts(arms, box, placement, 0.01);
                    both += found.size() == 2 ? 1 : 0;
                    for (const Contact& contact : found) {
                        if ((contact.flags & contact_from_behind) != 0) continue;
                        expect_near(contact.normal, up, 1e-6);
                    }
                }
            }
        }
    }
    EXPECT_GT(both, 1500U);
}

/// Where a body that comes down along a way begins to touch another: the last height at which it
/// does not, and the first at which it does.
struct Landing {
    double above;
    double below;
};

/// Returns nothing if they do not meet between the heights -8 and 8.
template <class Touches>
std::optional<Landing> find_landing(Touches&& touches) {
    double below = 8;
    while (below > -8 && !touches(below)) below -= 0.0625;
    if (below <= -8) return std::nullopt;
    Landing landing = {below + 0.0625, below};
    for (;;) {
        const double middle = 0.5 * (landing.above + landing.below);
        if (middle == landing.above || middle == landing.below) return landing;
        (touches(middle) ? landing.below : landing.above) = middle;
    }
}

/// A plate with so many sides that not every way out of it is tried.
TestMesh round_plate() {
    constexpr std::uint32_t kSides = 24;
    std::vector<std::array<double, 2>> outline;
    std::vector<std::array<std::uint32_t, 3>> cut;
    for (std::uint32_t i = 0; i < kSides; ++i) {
        const double angle = 2 * std::numbers::pi * i / kSides;
        outline.push_back({std::cos(angle), std::sin(angle)});
        if (i > 1) cut.push_back({0, i - 1, i});
    }
    return prism(outline, cut);
}

/// A plate of three points whose edges are divided by vertices that lie on them up to rounding.
TestMesh pointed_plate() {
    std::vector<std::array<double, 2>> corner, outline;
    for (std::uint32_t i = 0; i < 6; ++i) {
        const double angle = 0.1 + std::numbers::pi * i / 3, reach = i % 2 == 0 ? 2 : 0.8;
        corner.push_back({reach * std::cos(angle), reach * std::sin(angle)});
    }
    const auto rounded = [](double x) { return std::round(1e9 * x) / 1e9; };
    for (std::uint32_t i = 0; i < 6; ++i) {
        const auto &p = corner[i], &q = corner[(i + 1) % 6];
        outline.push_back({rounded(p[0]), rounded(p[1])});
        outline.push_back({rounded((p[0] + q[0]) / 2), rounded((p[1] + q[1]) / 2)});
    }
    return prism(outline, {{11, 0, 1},
                           {11, 1, 10},
                           {10, 1, 2},
                           {3, 4, 5},
                           {3, 5, 2},
                           {2, 5, 6},
                           {7, 8, 9},
                           {7, 9, 6},
                           {6, 9, 10},
                           {2, 6, 10}});
}

// By definition: bodies that come to touch do so by their rounding, and are pushed back the way
// they came or to a side. Edges of their hulls are divided in the mesh, or end at a seam.
TEST(Contacts, BodiesThatBeginToTouchAreNotDeep) {
    const OpenModel arms =
        open_with_pieces(prism({{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}},
                               {{1, 2, 3}, {1, 3, 4}, {0, 1, 4}, {0, 4, 5}, {0, 5, 6}}));
    const OpenModel plate =
        open_with_pieces(prism({{0, 0}, {0.5, 0}, {1, 0}, {1, 1}, {0.5, 1}, {0, 1}},
                               {{0, 1, 5}, {1, 4, 5}, {1, 2, 4}, {2, 3, 4}}));
    const OpenModel tip = open_with_pieces(on_its_tip());
    const OpenModel disc = open_with_pieces(round_plate());
    const OpenModel star = open_with_pieces(pointed_plate());
    const std::array<const OpenModel*, 5> models = {&arms, &plate, &tip, &disc, &star};
    const Double3 way = {0.1, 0.2, 1};
    Workspace workspace;
    std::mt19937 random(26);
    std::size_t apart = 0, overlapping = 0;
    for (int round = 0; round < 1200; ++round) {
        SCOPED_TRACE(round);
        const OpenModel &a = *models[random() % 5], &b = *models[random() % 5];
        const Pose below = random_pose(random, 1), above = random_pose(random, 1);
        const auto at = [&](double height) {
            std::array<double, 12> rows{};
            std::copy_n(above.rotation().begin(), 9, rows.begin());
            const Double3 place = above.translation() + height * way;
            rows[9] = place.x, rows[10] = place.y, rows[11] = place.z;
            return Placement::world(below, Pose::from_rows(rows).value());
        };
        const auto landing = find_landing([&](double height) {
            return collide({a.model, b.model, at(height)}, workspace).hit == Answer::yes;
        });
        if (!landing) continue;
        for (const double height : {landing->above, landing->below}) {
            for (const Contact& contact : all_contacts(a, b, at(height), 1e-9)) {
                if ((contact.flags & contact_from_behind) != 0) continue;
                EXPECT_GE(cdprep::dot(contact.normal, way), -1e-7);
                EXPECT_GE(contact.lower, -1e-9);
                overlapping += contact.flags & contact_overlap ? 1 : 0;
                apart += contact.flags & contact_overlap ? 0 : 1;
            }
        }
    }
    EXPECT_GT(apart, 500U);
    EXPECT_GT(overlapping, 500U);
}

/// A sheet over [0, 1] x [0, 1] that is bent everywhere.
TestMesh bumpy_sheet() {
    TestMesh mesh = grid_sheet(6, 6);
    for (Double3& p : mesh.positions) {
        p = {p.x / 6, p.y / 6, 0.3 * std::sin(1.3 * p.x + 0.7 * p.y)};
    }
    return mesh;
}

// By hand: the distance of pieces that do not overlap is positive, so no point of them is negative,
// though some are in a solid or inside a hull.
TEST(Contacts, NoManifoldPointIsNegativeWithoutAnOverlap) {
    const OpenModel sheet = open_with_pieces(bumpy_sheet());
    const OpenModel arms = open_with_pieces(l_with_a_seam());
    std::mt19937 random(18);
    std::size_t apart = 0, behind = 0, points = 0;
    for (int round = 0; round < 100; ++round) {
        SCOPED_TRACE(round);
        const Placement placement = Placement::b_moves(random_pose(random, 1));
        for (const Contact& contact : all_contacts(sheet, arms, placement, 0.3)) {
            if ((contact.flags & contact_overlap) != 0) continue;
            ASSERT_GE(contact.point_count, 1U);
            for (std::uint32_t i = 0; i < contact.point_count; ++i) {
                EXPECT_GE(contact.points[i].distance, -1e-9);
            }
            points += contact.point_count;
            behind += (contact.flags & contact_from_behind) != 0 ? 1 : 0;
            ++apart;
        }
    }
    EXPECT_GT(apart, 500U);
    EXPECT_GT(behind, 50U);
    EXPECT_GT(points, apart);
}

// By hand: a fin stands through a square of two triangles, one of which it touches. Whichever comes
// first, and even if the work ends there, the pieces overlap.
TEST(Contacts, PiecesOverlapThoughTheWorkEndsBeforeTheirTrianglesTouch) {
    TestMesh fin;
    fin.positions = {{0.25, 0.75, -0.1}, {0.25, 0.75, 0.3}, {0.5, 0.5, 0.3}};
    fin.triangles = {{{0, 1, 2}}};
    const OpenModel upright = open_with_pieces(fin);
    for (const bool is_first : {false, true}) {
        TestMesh square;
        square.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
        square.triangles = {{{0, 1, 2}}, {{0, 2, 3}}};
        if (is_first) std::swap(square.triangles[0], square.triangles[1]);
        const OpenModel plate = open_with_pieces(square);
        const Pair pair = {plate.model, upright.model, shifted({0, 0, 0})};
        Workspace workspace;
        std::array<Contact, 2> all, some;
        ASSERT_EQ(contacts(pair, workspace, all, {.tolerance = 0.2}).count, 1U);
        EXPECT_EQ(all[0].flags & contact_overlap, +contact_overlap);
        EXPECT_NEAR(all[0].lower, -0.1, 1e-12);
        const auto verdict = contacts(pair, workspace, some, {.tolerance = 0.2, .work = 2});
        ASSERT_EQ(verdict.count, 1U);
        EXPECT_FALSE(verdict.searched);
        expect_same(all[0], some[0]);
    }
}

// A law: a list with a limit spreads over a surface of any size alike.
TEST(Contacts, AreSpreadOverSheetsOfAnySize) {
    TestMesh bumpy = grid_sheet(10, 10);
    for (Double3& p : bumpy.positions) {
        p = {p.x / 16, p.y / 16, std::sin(0.8 * p.x + 0.4 * p.y)};
    }
    std::vector<std::uint64_t> expected;
    for (const int exponent : {300, -540, 520, 990}) {  // too large or small for ways by faces
        SCOPED_TRACE(exponent);
        const double size = std::ldexp(1.0, exponent);
        const OpenModel sheet = open_with_pieces(moved_by(bumpy, size, {0, 0, 0}));
        const Pair pair = {sheet.model, sheet.model, shifted({size / 128, size / 64, size / 16})};
        Workspace workspace;
        std::array<Contact, 12> found;
        const auto verdict =
            contacts(pair, workspace, found, {.tolerance = size / 8, .most = found.size()});
        ASSERT_EQ(verdict.count, found.size());
        EXPECT_GT(verdict.found, 4 * found.size());
        std::vector<std::uint64_t> ids;
        for (const Contact& contact : found) ids.push_back(contact.id);
        if (expected.empty()) expected = ids;
        EXPECT_EQ(ids, expected);
    }
}

// A law: a limit of work leaves out contacts, but changes none.
TEST(Contacts, AContactWithinALimitOfWorkIsThatWithoutOne) {
    const OpenModel sheet = open_with_pieces(bumpy_sheet());
    const OpenModel flat = open_with_pieces(moved_by(grid_sheet(4, 4), 0.25, {0, 0, 0}));
    const OpenModel arms = open_with_pieces(l_with_a_seam());
    const std::array<std::array<const OpenModel*, 2>, 3> models = {
        {{&sheet, &flat}, {&flat, &flat}, {&arms, &arms}}};
    Workspace workspace;
    std::mt19937 random(19);
    std::size_t cut = 0, overlapping = 0;
    for (int round = 0; round < 1500; ++round) {
        SCOPED_TRACE(round);
        const OpenModel &a = *models[round % 3][0], &b = *models[round % 3][1];
        const Pair pair = {a.model, b.model, Placement::b_moves(random_pose(random, 0.5))};
        const auto all = all_contacts(a, b, pair.placement, 0.2);
        std::vector<Contact> some(all.size());
        const std::uint64_t work = 1 + random() % (round % 3 == 2 ? 60 : 100);
        for (const std::uint32_t most : {0U, 8U}) {
            const auto verdict = contacts(
                pair, workspace, some,
                {.tolerance = 0.2, .manifold = Manifold::four, .most = most, .work = work});
            for (std::size_t i = 0; i < verdict.count; ++i) {
                const auto same = std::ranges::find(all, some[i].id, &Contact::id);
                ASSERT_NE(same, all.end());
                expect_same(*same, some[i]);
                if (verdict.searched) continue;
                overlapping += some[i].flags & contact_overlap;
                ++cut;
            }
        }
    }
    EXPECT_GT(overlapping, cut / 5);
    EXPECT_LT(overlapping, cut * 4 / 5);
    EXPECT_GT(cut, 50U);
}

// Beyond what one walk keeps there is another: every pair once, in order.
TEST(Contacts, ManyPairsComeOnceAndInOrder) {
    const OpenModel a = open_with_pieces(grid_sheet(7, 7), PiecesOf::triangles);
    const OpenModel b = open_with_pieces(grid_sheet(5, 9), PiecesOf::triangles);
    const std::size_t expected = a.model.pieces().pieces.size() * b.model.pieces().pieces.size();
    ASSERT_GT(expected, 8000U);
    Workspace workspace;
    std::vector<Contact> found(expected + 1);
    ASSERT_EQ(
        contacts({a.model, b.model, shifted({0, 0, 1})}, workspace, found, {.tolerance = 20}).count,
        expected);
    for (std::size_t i = 0; i < expected; ++i) {
        ASSERT_EQ(found[i].piece_a, i / b.model.pieces().pieces.size());
        ASSERT_EQ(found[i].piece_b, i % b.model.pieces().pieces.size());
    }
    std::vector<Contact> few(3);
    const ContactsVerdict verdict =
        contacts({a.model, b.model, shifted({0, 0, 1})}, workspace, few, {.tolerance = 20});
    EXPECT_EQ(verdict.found, expected);
    EXPECT_EQ(verdict.count, 3U);
    EXPECT_FALSE(verdict.complete);
    EXPECT_EQ(few[2].piece_b, 2U);
    std::size_t visited = 0;
    const auto visit = [&](const Contact& contact) {
        EXPECT_EQ(contact.piece_b, visited);
        return ++visited < 5;
    };
    EXPECT_FALSE(visit_contacts({a.model, b.model, shifted({0, 0, 1})}, workspace, visit,
                                {.tolerance = 20}));
    EXPECT_EQ(visited, 5U);
}

// By the table of needs: a model without pieces does not serve Ask::contacts.
TEST(ContactsDeathTest, StopWhereAModelWasNotBakedForThem) {
    const OpenModel bare = open_tiny(unit_cube()), cube = open_with_pieces(unit_cube());
    EXPECT_TRUE(cube.model.serves(Ask::contacts));
    EXPECT_DEATH((void)all_contacts(bare, cube, shifted({0, 0, 1}), 0.5), "contacts needs");
    EXPECT_DEATH((void)all_contacts(cube, bare, shifted({0, 0, 1}), 0.5), "contacts needs");
}

// Triangles without area are the segment or point that they are, unless they are skipped.
TEST(Contacts, DegenerateTrianglesAnswerAsWhatTheyAre) {
    TestMesh segment;
    segment.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    segment.triangles = {{{0, 1, 2}}};
    TestMesh point;
    point.positions = {{0, 0, 0}};
    point.triangles = {{{0, 0, 0}}};
    const OpenModel cube = open_with_pieces(unit_cube());
    for (const TestMesh& mesh : {segment, point}) {
        const OpenModel thin = open_with_pieces(mesh);
        const auto found = all_contacts(cube, thin, shifted({0.25, 0.25, 1.25}), 0.5);
        ASSERT_EQ(found.size(), 1U);
        EXPECT_NEAR(found[0].lower, 0.25, 1e-15);
        expect_near(found[0].normal, {0, 0, 1});
        const auto inside = all_contacts(cube, thin, shifted({0.5, 0.5, 1}), 0);
        ASSERT_EQ(inside.size(), 1U);
        EXPECT_EQ(inside[0].upper, 0);
    }
}

}  // namespace
}  // namespace cdprep::test
