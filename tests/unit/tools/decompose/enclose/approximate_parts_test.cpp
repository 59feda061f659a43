// SPDX-License-Identifier: MIT
#include "decompose/enclose/approximate_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "decompose/enclose/distance_field.h"
#include "mesh/weld.h"
#include "support/concave_solids.h"
#include "support/run_threads.h"
#include "unit/tools/hull_flaw.h"
#include "unit/tools/recorded_text.h"
#include "unit/tools/soup_of.h"

namespace cdprep::convex {
namespace {

using mesh::Mesh;
using test::mesh_of;

Mesh cube(const Double3& at, double side) {
    return mesh_of(test::moved_by(test::unit_cube(), side, at));
}

Mesh l_prism() {
    return mesh_of(test::l_prism());
}

Mesh turned(Mesh mesh, double angle) {
    mesh.positions = test::turned({std::move(mesh.positions), {}}, angle).positions;
    return mesh;
}

/// A block 4 x 2 x 1 with a slot of this width from above, 1.5 deep: a U.
Mesh slotted(double width) {
    const double a = 2 - width / 2;
    const double b = 2 + width / 2;
    return mesh_of(test::prism({{0, 0}, {4, 0}, {4, 2}, {b, 2}, {b, 0.5}, {a, 0.5}, {a, 2}, {0, 2}},
                               {{0, 5, 7}, {7, 5, 6}, {0, 4, 5}, {0, 1, 4}, {1, 2, 4}, {4, 2, 3}}));
}

void append(Mesh& mesh, const Mesh& more) {
    const auto n = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), more.positions.begin(), more.positions.end());
    for (const auto& t : more.triangles) {
        mesh.triangles.push_back({{t.vertex[0] + n, t.vertex[1] + n, t.vertex[2] + n}});
    }
}

bool is_held(const ApproximateParts& found, const Double3& p) {
    return std::any_of(found.parts.begin(), found.parts.end(), [&](const ApproximatePart& part) {
        return part.hull.dimension == 3 && test::holds(part.hull, p);
    });
}

ApproximateParts within(const Mesh& mesh, double error) {
    ApproximateOptions options;
    options.max_error = error;
    return find_approximate_parts(mesh, options);
}

// Its hull is itself: 8 corners, 12 facets, whatever the error.
TEST(ApproximateParts, OfACubeIsTheCubeExactly) {
    for (const double error : {0.0, 0.01, 10.0}) {
        const ApproximateParts found = within(cube({0.1, 0.2, 0.3}, 1), error);
        ASSERT_EQ(found.parts.size(), 1u);
        EXPECT_EQ(found.parts[0].hull.points.size(), 8u);
        EXPECT_EQ(found.outer_error, 0.0);
        EXPECT_EQ(found.proof.outside, 0u);
        EXPECT_TRUE(found.is_as_asked);
    }
}

// One hull bridges the corner, half a side away in the middle; 2 boxes do without an error,
// and the fewest of them, however they are asked for and turned.
TEST(ApproximateParts, OfAnLPrismAreTwoBoxesUnlessOneHullWillDo) {
    const ApproximateParts one = within(l_prism(), 0.6);
    EXPECT_EQ(one.parts.size(), 1u);
    EXPECT_GE(one.outer_error, 0.5 - 1e-9);
    EXPECT_LE(one.outer_error, 0.5 * 1.05);
    ApproximateOptions two_parts;
    two_parts.max_parts = 2;
    for (const double angle : {0.0, 0.4, 1.1}) {
        const Mesh mesh = turned(l_prism(), angle);
        for (const double error : {0.2, 0.01, 1e-6}) {
            const ApproximateParts two = within(mesh, error);
            EXPECT_EQ(two.parts.size(), 2u) << angle << " " << error;
            EXPECT_LE(two.outer_error, 1e-9);
            EXPECT_TRUE(two.is_as_asked);
        }
        const ApproximateParts two = find_approximate_parts(mesh, two_parts);
        ASSERT_EQ(two.parts.size(), 2u) << angle;
        EXPECT_LE(two.outer_error, 1e-9);
        EXPECT_EQ(two.proof.outside, 0u);
        for (const ApproximatePart& part : two.parts) {
            // Where the other box begins on turned edges, rounding may leave corners.
            EXPECT_LE(part.hull.points.size(), angle == 0 ? 8u : 12u);
        }
    }
}

// Two bars that cross: no hull of an arm and a half lies in the solid, so 2 are the fewest.
TEST(ApproximateParts, OfACrossAreTwoBarsThatCross) {
    const Mesh cross = mesh_of(test::plus_prism());
    for (const double angle : {0.0, 0.7}) {
        const ApproximateParts found = within(turned(cross, angle), 0.01);
        EXPECT_EQ(found.parts.size(), 2u) << angle;
        EXPECT_LE(found.outer_error, 1e-9);
        EXPECT_EQ(found.proof.outside, 0u);
    }
}

// Points of the solid on a grid that hits its faces and edges lie in a hull, exactly: the
// cuts leave no cracks.
TEST(ApproximateParts, LeaveNoCracksInTheSolid) {
    int asked = 0;
    const ApproximateParts found = within(l_prism(), 0.2);
    for (int x = 0; x <= 16; ++x) {
        for (int y = 0; y <= 16; ++y) {
            for (int z = 0; z <= 8; ++z) {
                if (x > 8 && y > 8) continue;
                ++asked;
                EXPECT_TRUE(is_held(found, {x / 8.0, y / 8.0, z / 8.0})) << x << y << z;
            }
        }
    }
    EXPECT_EQ(asked, 9 * (17 * 17 - 8 * 8));
}

/// Whether no part holds a point that is farther from the solid than the error, of those in
/// the middle of a slot or hole, from one place to another.
void expect_open(const Mesh& mesh, double width, const Double3& from, const Double3& to) {
    for (const double share : {0.2, 0.45, 0.49}) {
        for (const double angle : {0.0, 0.6}) {
            const ApproximateParts found = within(turned(mesh, angle), share * width);
            EXPECT_TRUE(found.is_as_asked) << width << " " << share << " " << angle;
            EXPECT_LE(found.outer_error, share * width) << width << " " << angle;
            EXPECT_EQ(found.proof.outside, 0u);
            EXPECT_LE(found.parts.size(), 14u) << width << " " << share << " " << angle;
            Mesh line;
            for (int i = 0; i <= 16; ++i) {
                const double t = i / 16.0;
                line.positions.push_back({from.x + t * (to.x - from.x),
                                          from.y + t * (to.y - from.y),
                                          from.z + t * (to.z - from.z)});
            }
            for (const Double3& p : turned(line, angle).positions) {
                EXPECT_FALSE(is_held(found, p)) << width << " " << share << " " << angle;
            }
        }
    }
}

// The middle between the walls is half the slot's width from the solid.
TEST(ApproximateParts, KeepSlotsOpenThatAreWiderThanTwiceTheError) {
    for (const double width : {1.0, 0.5}) {
        expect_open(slotted(width), width, {2, 0.5 + width / 2, 0.5}, {2, 2, 0.5});
    }
    // And close them when the error allows one part.
    EXPECT_TRUE(is_held(within(slotted(1), 1.2), {2, 1.5, 0.5}));
}

/// A ring of `count` sides, one high: the inner faces this far from the axis.
Mesh ring(std::uint32_t count, double inner, double outer) {
    Mesh mesh;
    for (const double radius : {inner, outer}) {
        for (const double z : {0.0, 1.0}) {
            for (std::uint32_t i = 0; i < count; ++i) {
                const double t = 2 * std::numbers::pi * i / count;
                const double r = radius / std::cos(std::numbers::pi / count);
                mesh.positions.push_back({r * std::cos(t), r * std::sin(t), z});
            }
        }
    }
    const auto add_quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        mesh.triangles.push_back({{a, b, c}});
        mesh.triangles.push_back({{a, c, d}});
    };
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t k = (i + 1) % count;
        const std::uint32_t top = count, around = 2 * count;
        add_quad(k, i, i + top, k + top);
        add_quad(i + around, k + around, k + around + top, i + around + top);
        add_quad(i + top, i + around + top, k + around + top, k + top);
        add_quad(k, k + around, i + around, i);
    }
    return mesh;
}

// The axis is half the width from the faces.
TEST(ApproximateParts, KeepHolesOpenThatAreWiderThanTwiceTheError) {
    expect_open(ring(4, 0.2, 1.5), 0.4, {0, 0, 0}, {0, 0, 1});
    expect_open(ring(24, 0.5, 1.5), 1, {0, 0, 0}, {0, 0, 1});
}

// Side by side, their common hull would stick out by half the gap, which the error allows.
TEST(ApproximateParts, NeverMergeComponentsUnlessAsked) {
    Mesh two = cube({0, 0, 0}, 1);
    append(two, cube({1.1, 0, 0}, 1));
    ApproximateOptions options;
    options.max_parts = 1;
    const ApproximateParts apart = find_approximate_parts(two, options);
    EXPECT_EQ(apart.parts.size(), 2u);
    EXPECT_EQ(apart.outer_error, 0.0);
    EXPECT_FALSE(apart.is_as_asked);
    options.merge_components = true;
    const ApproximateParts merged = find_approximate_parts(two, options);
    EXPECT_EQ(merged.parts.size(), 1u);
    EXPECT_NEAR(merged.outer_error, 0.05, 0.003);
    EXPECT_TRUE(merged.is_as_asked);
}

// Two nodes share a face: one component of the welded mesh, and still apart.
TEST(ApproximateParts, NeverMergeNodesThatTouch) {
    Mesh two = cube({0, 0, 0}, 1);
    append(two, cube({1, 0, 0}, 1));
    mesh::TriangleSoup soup;
    soup.positions = two.positions;
    soup.triangles = two.triangles;
    two = mesh::weld(soup).mesh;
    ASSERT_EQ(two.positions.size(), 12u);
    std::vector<std::uint32_t> node_of(24, 0);
    std::fill(node_of.begin() + 12, node_of.end(), 1);
    ApproximateOptions options;
    options.max_error = 1;
    options.node_of = node_of;
    const ApproximateParts found = find_approximate_parts(two, options);
    ASSERT_EQ(found.parts.size(), 2u);
    EXPECT_EQ(found.parts[0].hull.points.size(), 8u);
    EXPECT_EQ(found.outer_error, 0.0);
    EXPECT_EQ(found.parts[0].node + found.parts[1].node, 1u);
}

TEST(ApproximateParts, OfANodeTaggedConvexAreItsHull) {
    const std::vector<std::uint32_t> node_of(20, 0);
    const std::vector<std::uint8_t> tagged = {1};
    ApproximateOptions options;
    options.max_error = 0.01;
    options.node_of = node_of;
    options.convex_node = tagged;
    const ApproximateParts found = find_approximate_parts(l_prism(), options);
    ASSERT_EQ(found.parts.size(), 1u);
    EXPECT_GE(found.outer_error, 0.5 - 1e-9);
    EXPECT_FALSE(found.is_as_asked);
}

// A cube with a cavity: one body. A hull that closes it off is far from the surface, inside.
TEST(ApproximateParts, KeepCavitiesOpen) {
    Mesh hollow = cube({0, 0, 0}, 3);
    Mesh cavity = cube({1, 1, 1}, 1);
    for (auto& t : cavity.triangles) std::swap(t.vertex[0], t.vertex[1]);
    append(hollow, cavity);
    ApproximateOptions options;
    options.max_parts = 1;
    EXPECT_NEAR(find_approximate_parts(hollow, options).outer_error, 0.5, 0.03);
    const ApproximateParts found = within(hollow, 0.3);
    EXPECT_GT(found.parts.size(), 3u);
    EXPECT_FALSE(is_held(found, {1.5, 1.5, 1.5}));
    EXPECT_TRUE(is_held(found, {0.5, 1.5, 1.5}));
}

/// Open, of one side, without volume.
Mesh moebius() {
    Mesh mesh;
    constexpr int kSteps = 48;
    for (int i = 0; i < kSteps; ++i) {
        const double t = 2 * std::numbers::pi * i / kSteps;
        for (const double s : {-0.4, 0.4}) {
            const double r = 1 + s * std::cos(t / 2);
            mesh.positions.push_back({r * std::cos(t), r * std::sin(t), s * std::sin(t / 2)});
        }
    }
    for (std::uint32_t i = 0; i < kSteps; ++i) {
        const std::uint32_t a = 2 * i, b = a + 1;
        const bool last = i + 1 == kSteps;
        const std::uint32_t c = last ? 1 : a + 2, d = last ? 0 : a + 3;
        mesh.triangles.push_back({{a, c, b}});
        mesh.triangles.push_back({{b, c, d}});
    }
    return mesh;
}

// Surfaces enclose nothing: their parts hold them, and stay near.
TEST(ApproximateParts, OfOpenSurfacesHoldThemAndStayNear) {
    const ApproximateParts band = within(moebius(), 0.1);
    EXPECT_GT(band.parts.size(), 3u);
    EXPECT_LT(band.parts.size(), 40u);
    EXPECT_LE(band.outer_error, 0.1);
    EXPECT_EQ(band.proof.outside, 0u);
    EXPECT_EQ(band.proof.triangles, 96u);
    EXPECT_GE(band.proof.fragments, 96u);
    Mesh sheet;
    sheet.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    sheet.triangles = {{{0, 1, 2}}, {{0, 2, 3}}, {{0, 2, 1}}, {{0, 3, 2}}};
    const ApproximateParts flat = within(sheet, 0.01);
    ASSERT_EQ(flat.parts.size(), 1u);
    EXPECT_EQ(flat.parts[0].hull.dimension, 2);
    EXPECT_LE(flat.outer_error, 1e-9);
}

TEST(ApproximateParts, OfNothingAreNone) {
    EXPECT_TRUE(within({}, 1).parts.empty());
}

// The largest of the limits of engines; errors are of the hulls that come out.
TEST(ApproximateParts, HaveNoMoreVerticesThanAllowedAndStillEnclose) {
    ApproximateOptions options;
    options.max_parts = 6;
    options.max_vertices = 8;
    const ApproximateParts found = find_approximate_parts(moebius(), options);
    EXPECT_LE(found.parts.size(), 6u);
    for (const ApproximatePart& part : found.parts) EXPECT_LE(part.hull.points.size(), 8u);
    EXPECT_EQ(found.proof.outside, 0u);
}

TEST(ApproximateParts, WithoutWorkAreLooserAndSaySo) {
    ApproximateOptions options;
    options.max_error = 0.1;
    options.work = 1000;
    const ApproximateParts found = find_approximate_parts(moebius(), options);
    EXPECT_TRUE(found.ran_out_of_work);
    EXPECT_FALSE(found.is_as_asked);
    EXPECT_GE(found.parts.size(), 1u);
    EXPECT_GT(found.outer_error, 0.1);
    EXPECT_EQ(found.proof.outside, 0u);
}

// Powers of two change no bit but those of exponents.
TEST(ApproximateParts, ScaleWithTheModel) {
    const test::TestMesh knot = test::trefoil_tube();
    for (const std::size_t parts : {3U, 6U, 12U}) {
        ApproximateOptions options;
        options.max_parts = parts;
        options.work = 30'000'000;
        const ApproximateParts plain = find_approximate_parts(mesh_of(knot), options);
        ASSERT_GT(plain.parts.size(), 1U);
        for (const double scale : {0x1p-9, 0x1p9}) {
            const ApproximateParts scaled =
                find_approximate_parts(mesh_of(test::moved_by(knot, scale, {})), options);
            ASSERT_EQ(scaled.parts.size(), plain.parts.size()) << parts << " " << scale;
            EXPECT_EQ(scaled.outer_error, scale * plain.outer_error);
            for (std::size_t i = 0; i < plain.parts.size(); ++i) {
                const auto& points = plain.parts[i].hull.points;
                ASSERT_EQ(scaled.parts[i].hull.points.size(), points.size());
                for (std::size_t k = 0; k < points.size(); ++k) {
                    const Double3 p = {scale * points[k].x, scale * points[k].y,
                                       scale * points[k].z};
                    EXPECT_EQ(scaled.parts[i].hull.points[k], p);
                }
            }
        }
    }
}

/// A mesh times a power of two.
Mesh scaled(Mesh mesh, int exponent) {
    for (Double3& p : mesh.positions) {
        p = {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent)};
    }
    return mesh;
}

Mesh open_box() {
    Mesh box = cube({0, 0, 0}, 1);
    box.triangles.resize(10);
    return box;
}

void expect_same(const ApproximateParts& found, const ApproximateParts& plain, int exponent) {
    ASSERT_EQ(found.parts.size(), plain.parts.size()) << exponent;
    EXPECT_EQ(found.outer_error, std::ldexp(plain.outer_error, exponent)) << exponent;
    EXPECT_EQ(found.outer_lower, std::ldexp(plain.outer_lower, exponent)) << exponent;
    EXPECT_EQ(found.is_as_asked, plain.is_as_asked) << exponent;
    for (std::size_t i = 0; i < plain.parts.size(); ++i) {
        const ConvexHull &hull = found.parts[i].hull, &expected = plain.parts[i].hull;
        Mesh points;
        points.positions = expected.points;
        EXPECT_EQ(hull.points, scaled(points, exponent).positions) << exponent;
        EXPECT_EQ(hull.facets, expected.facets) << exponent;
        EXPECT_EQ(found.parts[i].triangles, plain.parts[i].triangles) << exponent;
    }
}

// From far below the floats to the largest coordinate: the parts of size 1, times a power of two.
TEST(ApproximateParts, OfAnySizeAreThoseOfSizeOne) {
    ApproximateOptions by_parts;
    by_parts.max_parts = 2;
    ApproximateOptions to_surface = by_parts;
    to_surface.reference = Reference::surface;
    ApproximateOptions few_vertices = by_parts;
    few_vertices.max_vertices = 5;
    ApproximateOptions by_error;
    by_error.max_error = 0.3;
    for (const Mesh& mesh : {cube({0, 0, 0}, 1), open_box(), l_prism()}) {
        for (ApproximateOptions options : {by_parts, to_surface, few_vertices, by_error}) {
            options.work = 1'000'000;
            const ApproximateParts plain = find_approximate_parts(mesh, options);
            for (const int exponent : {-900, -700, -500, -70, 70, 500, 700, 990, 999}) {
                ApproximateOptions how = options;
                if (options.max_error) how.max_error = std::ldexp(*options.max_error, exponent);
                const ApproximateParts found = find_approximate_parts(scaled(mesh, exponent), how);
                expect_same(found, plain, exponent);
                EXPECT_EQ(found.work, plain.work);
            }
        }
    }
}

// A few units of the smallest double across. Corners move outwards to whole units, and the bounds
// with them.
TEST(ApproximateParts, OfSubnormalSizeHoldTheMeshWithinTheirBounds) {
    for (const int exponent : {-1074, -1073, -1070, -1050, -1022}) {
        for (const Mesh& mesh : {scaled(open_box(), exponent), scaled(l_prism(), exponent)}) {
            for (const std::uint32_t vertices : {0U, 4U}) {
                ApproximateOptions options;
                options.max_parts = 3;
                options.max_vertices = vertices;
                options.work = 1'000'000;
                const ApproximateParts found = find_approximate_parts(mesh, options);
                EXPECT_TRUE(found.is_as_asked);
                EXPECT_LE(found.outer_lower, found.outer_error);
                // Ten units more: that much is rounded to whole ones.
                EXPECT_LE(found.outer_error, std::ldexp(4.0, exponent) + 10 * 0x1p-1074);
                EXPECT_EQ(found.proof.outside, 0U);
                for (const Double3& p : mesh.positions) EXPECT_TRUE(is_held(found, p)) << exponent;
                for (const ApproximatePart& part : found.parts) {
                    EXPECT_TRUE(vertices == 0 || part.hull.points.size() <= vertices);
                }
            }
        }
    }
}

// A unit of 2^1000 apart, the parts of either body are larger by what the small one loses.
TEST(ApproximateParts, OfVeryDifferentSizesHoldBoth) {
    Mesh mesh = scaled(l_prism(), 999);
    append(mesh, scaled(turned(l_prism(), 0.4), -300));
    ApproximateOptions options;
    options.max_parts = 4;
    options.work = 1'000'000;
    const ApproximateParts found = find_approximate_parts(mesh, options);
    EXPECT_LE(found.parts.size(), 4U);
    EXPECT_LE(found.outer_error, 0x1p970);
    for (const Double3& p : mesh.positions) EXPECT_TRUE(is_held(found, p));
}

// Its only coordinate of usual size is the same everywhere. A point has no size at all.
TEST(ApproximateParts, OfATinySheetFarFromTheOriginEnd) {
    Mesh sheet;
    for (const double y : {0.0, 4e-323}) {
        for (const double z : {0.0, 4e-323}) sheet.positions.push_back({1, y, z});
    }
    sheet.triangles = {{{0, 1, 3}}, {{0, 1, 2}}};
    Mesh point;
    point.positions = {{1, 2, 3}};
    point.triangles = {{{0, 0, 0}}};
    for (const Mesh& mesh : {sheet, point}) {
        for (const double error : {0.0, 1e-320, 1.0}) {
            ApproximateOptions options;
            options.max_error = error;
            options.work = 1'000'000;
            const ApproximateParts found = find_approximate_parts(mesh, options);
            EXPECT_LE(found.outer_error, 1e-322) << error;
            EXPECT_LE(found.outer_lower, found.outer_error) << error;
        }
    }
}

// However small the error: fields of distances, cells and searches are bounded by the work
// too, of which the tasks handed out are a measure. A field for this error alone is ten
// thousand.
TEST(ApproximateParts, TakeNoMoreThanTheWorkAllowedForAnyError) {
    for (const double error : {1e-9, 1e-4, 1e-2}) {
        std::size_t tasks = 0;
        const auto run = [&](std::size_t count, Task task) {
            tasks += count;
            for (std::size_t i = 0; i < count; ++i) task(i);
        };
        ApproximateOptions options;
        options.max_error = error;
        options.work = 1'000;
        options.parallel_for = run;
        // A strip that no few planes cut exactly.
        const ApproximateParts found = find_approximate_parts(moebius(), options);
        EXPECT_LT(tasks, 10'000u);
        EXPECT_TRUE(found.ran_out_of_work);
        EXPECT_FALSE(found.is_as_asked);
        EXPECT_EQ(found.proof.outside, 0u);
        EXPECT_LE(found.outer_lower, found.outer_error);
    }
}

/// Triangles that cross each other all over a unit cube, connected at corners that they share.
Mesh thicket(std::uint32_t triangles) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> at(0, 1);
    Mesh mesh;
    const std::uint32_t vertices = 8 + triangles / 4;
    for (std::uint32_t i = 0; i < vertices; ++i) {
        mesh.positions.push_back({at(random), at(random), at(random)});
    }
    std::uniform_int_distribution<std::uint32_t> any(0, vertices - 1);
    while (mesh.triangles.size() < triangles) {
        const std::uint32_t a = any(random), b = any(random), c = any(random);
        if (a != b && b != c && c != a) mesh.triangles.push_back({{a, b, c}});
    }
    return mesh;
}

// Each question about a point takes looks at hundreds of triangles then. What is looked at is
// paid for: a field for the same work has that many fewer nodes.
TEST(ApproximateParts, OfAThicketPayForEveryLook) {
    constexpr std::size_t kNodes = 40'000;
    const auto spacing = [](const Mesh& mesh, std::size_t& measured) {
        const Solid solid(mesh, Reference::solid, serial_for);
        const DistanceField field(solid, 0.01, 0.02, serial_for, kNodes);
        measured = field.measured();
        return field.spacing();
    };
    std::size_t few = 0, many = 0;
    const double fine = spacing(thicket(8), few);
    const double coarse = spacing(thicket(4'000), many);
    EXPECT_GT(coarse, 1.4 * fine);  // nodes to the third power
    EXPECT_LE(few, kNodes);
    EXPECT_LE(many, 2 * kNodes);
    EXPECT_GT(many, kNodes / 4);
}

// A small error of a thicket would take cells, fields and hulls without end.
TEST(ApproximateParts, OfAThicketEndWithLooserOnesAndSaySo) {
    ApproximateOptions options;
    options.max_error = 1e-4;
    options.work = 20'000'000;
    const ApproximateParts found = find_approximate_parts(thicket(2'000), options);
    EXPECT_TRUE(found.ran_out_of_work);
    EXPECT_FALSE(found.is_as_asked);
    EXPECT_EQ(found.proof.outside, 0u);
    EXPECT_LE(found.work, 4 * options.work);
}

/// Coordinates of few bits: no C library rounds a sine otherwise.
Mesh rounded(Mesh mesh) {
    for (Double3& p : mesh.positions) {
        p = {std::round(p.x * 0x1p20) / 0x1p20, std::round(p.y * 0x1p20) / 0x1p20,
             std::round(p.z * 0x1p20) / 0x1p20};
    }
    return mesh;
}

// That they enclose, and how closely, is asked above: this tells how well the search chooses,
// and how much it looks at.
TEST(ApproximateParts, AreAsRecorded) {
    Mesh two = turned(slotted(0.5), 0.3);
    append(two, turned(cube({4.2, 0.1, 0}, 1), 0.3));
    std::vector<ApproximateOptions> asked(6);
    asked[0].max_parts = 5;
    asked[1].max_error = 0.07;
    asked[2].max_error = 0.02;
    asked[2].max_vertices = 9;
    asked[3].max_parts = 3;
    asked[3].reference = Reference::surface;
    asked[4].max_error = 0.1;
    asked[4].merge_components = true;
    asked[5].max_parts = 8;
    asked[5].max_vertices = 12;
    std::string text;
    for (const Mesh& mesh : {rounded(moebius()), rounded(two), rounded(turned(l_prism(), 0.4)),
                             rounded(ring(9, 0.5, 1.5)), thicket(40)}) {
        for (ApproximateOptions& options : asked) {
            options.work = 3'000'000;
            const ApproximateParts found = find_approximate_parts(mesh, options);
            text += std::to_string(found.parts.size()) + " parts, " +
                    std::to_string(found.outer_lower) + " to " + std::to_string(found.outer_error) +
                    ", " + std::to_string(found.work) + " looked at, " +
                    std::to_string(found.proof.fragments) + " fragments, " +
                    std::to_string(found.proof.tests) + " tests:";
            for (const ApproximatePart& part : found.parts) {
                text += " " + std::to_string(part.hull.points.size()) + "/" +
                        std::to_string(part.triangles.size());
            }
            text += "\n";
        }
    }
    EXPECT_EQ(test::hash_of_text(text), 0x2cc64983a09c05af) << text;
}

TEST(ApproximateParts, AreTheSameForAnyThreads) {
    const auto with_threads = [](std::size_t threads) {
        // Taken in turns, each thread from its own end.
        auto run = [threads](std::size_t count, Task task) {
            test::run_threads(threads, [&](std::size_t thread) {
                for (std::size_t i = thread; i < count; i += threads) task(count - 1 - i);
            });
        };
        ApproximateOptions options;
        options.max_parts = 9;
        options.parallel_for = run;
        return find_approximate_parts(moebius(), options);
    };
    const ApproximateParts alone = with_threads(1);
    for (const std::size_t threads : {2u, 5u, 8u}) {
        const ApproximateParts found = with_threads(threads);
        ASSERT_EQ(found.parts.size(), alone.parts.size());
        EXPECT_EQ(found.outer_error, alone.outer_error);
        for (std::size_t i = 0; i < found.parts.size(); ++i) {
            EXPECT_EQ(found.parts[i].hull.points, alone.parts[i].hull.points);
            EXPECT_EQ(found.parts[i].hull.facets, alone.parts[i].hull.facets);
            EXPECT_EQ(found.parts[i].triangles, alone.parts[i].triangles);
        }
    }
}

}  // namespace
}  // namespace cdprep::convex
