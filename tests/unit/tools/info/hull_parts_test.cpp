// SPDX-License-Identifier: MIT
// Convex parts in files: they hold the whole mesh, so that no touch is missed through them.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iostream>
#include <random>
#include <vector>

#include "cdprep/advanced/convex_distance.h"
#include "cdprep/advanced/find_falsehood.h"
#include "cdprep/format/find_damage.h"
#include "cdprep/hulls.h"
#include "cdprep/pairs.h"
#include "decompose/enclose/hull_sections.h"
#include "info/find_cover_falsehood.h"
#include "support/meshes.h"
#include "support/more_sections.h"
#include "support/open_tiny.h"
#include "support/random_pose.h"
#include "unit/tools/soup_of.h"

namespace cdprep::convex {
namespace {

using format::SectionId;
using test::as_section;

test::AlignedBytes baked(const test::TestMesh& mesh, const HullSections& hulls) {
    return test::with_sections(
        test::bake_tiny(mesh.positions, mesh.triangles, {.double_precision = true}),
        {as_section(SectionId::hulls, std::span(hulls.hulls)),
         as_section(SectionId::hull_blocks, std::span(hulls.blocks)),
         as_section(SectionId::hull_vertices, std::span(hulls.vertices)),
         as_section(SectionId::hull_facets, std::span(hulls.facets)),
         as_section(SectionId::hull_groups, std::span(hulls.groups)),
         as_section(SectionId::hull_neighbours, std::span(hulls.neighbours)),
         as_section(SectionId::hull_starts, std::span(hulls.starts))});
}

/// The whole's hull, and this many parts at most.
HullSections with_parts(const test::TestMesh& mesh, std::size_t parts, std::uint32_t vertices = 0) {
    const mesh::Mesh welded = test::mesh_of(mesh);
    HullSections sections = *make_hull_sections(welded, {}, vertices, serial_for);
    ApproximateOptions how;
    how.max_parts = parts;
    how.max_vertices = vertices;
    add_parts(sections, find_approximate_parts(welded, how).parts);
    return sections;
}

std::uint32_t part_count(const Model& model) {
    const auto first = find_hull(model, format::HullScope::part);
    return first ? static_cast<std::uint32_t>(model.hulls().hulls.size()) - *first : 0;
}

bool parts_meet(const Model& a, const Model& b, const Placement& placement) {
    const std::uint32_t first_a = *find_hull(a, format::HullScope::part);
    const std::uint32_t first_b = *find_hull(b, format::HullScope::part);
    for (std::uint32_t i = first_a; i < a.hulls().hulls.size(); ++i) {
        for (std::uint32_t k = first_b; k < b.hulls().hulls.size(); ++k) {
            if (convex_collide(convex_points(a, i), convex_points(b, k), placement)) return true;
        }
    }
    return false;
}

const test::TestMesh& ring() {
    static const test::TestMesh mesh = test::torus(1, 0.3, 32, 16);
    return mesh;
}

// By the builder's own figures, and by exact arithmetic on the file.
TEST(HullParts, AreSoundAndHoldEveryVertex) {
    for (const std::uint32_t vertices : {0U, 8U}) {
        const test::AlignedBytes file = baked(ring(), with_parts(ring(), 12, vertices));
        ASSERT_FALSE(format::find_damage(file.span()));
        const auto opened = test::open_tiny(test::AlignedBytes(file.span()));
        const Model& model = opened.model;
        EXPECT_FALSE(find_hull_falsehood(file.span(), model));
        EXPECT_FALSE(find_cover_falsehood(file.span(), model));
        EXPECT_GE(part_count(model), 4U);
        EXPECT_LE(part_count(model), 12U);
        EXPECT_EQ(find_hull(model, format::HullScope::part, 2), 3U);
        EXPECT_FALSE(find_hull(model, format::HullScope::part, 12));
        for (const format::Hull& hull : model.hulls().hulls) {
            EXPECT_TRUE(vertices == 0 || hull.point_count <= vertices);
            EXPECT_EQ((hull.flags & format::hull_exact) != 0,
                      vertices == 0 && hull.scope == format::HullScope::whole);
            EXPECT_EQ(hull.distance > 0, (hull.flags & format::hull_exact) == 0);
        }
    }
}

// Of sides that are no round numbers: cuts meet the diagonals in rounded places.
TEST(HullParts, OfOpenBoxesOfAnySidesCoverThem) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> side(0.2, 2);
    std::size_t several = 0;
    for (int i = 0; i < 12; ++i) {
        test::TestMesh box = test::unit_cube();
        box.triangles.resize(10);
        const double x = side(random), y = side(random), z = side(random);
        for (Double3& p : box.positions) p = {x * p.x, y * p.y, z * p.z};
        HullSections sections = *make_hull_sections(test::mesh_of(box), {}, 0, serial_for);
        ApproximateOptions how;
        how.max_error = 0.1;
        how.work = 20'000'000;
        const ApproximateParts found = find_approximate_parts(test::mesh_of(box), how);
        several += found.parts.size() > 1 ? 1 : 0;
        add_parts(sections, found.parts);
        const auto opened = test::open_tiny(baked(box, sections));
        EXPECT_FALSE(find_cover_falsehood(opened.bytes.span(), opened.model))
            << x << " " << y << " " << z;
    }
    EXPECT_GE(several, 8U);
}

// Every part of a ring holds a vertex that no other does: without it the check must tell.
TEST(HullParts, ThatLeaveAVertexOutAreFound) {
    HullSections sections = *make_hull_sections(test::mesh_of(ring()), {}, 0, serial_for);
    ApproximateOptions how;
    how.max_parts = 8;
    auto parts = find_approximate_parts(test::mesh_of(ring()), how).parts;
    parts.pop_back();
    add_parts(sections, parts);
    const test::AlignedBytes file = baked(ring(), sections);
    EXPECT_FALSE(format::find_damage(file.span()));
    const auto opened = test::open_tiny(test::AlignedBytes(file.span()));
    EXPECT_TRUE(find_hull_falsehood(file.span(), opened.model));
}

/// What a file says of a mesh with these boxes as its parts, turned by an angle.
struct Told {
    bool of_vertices;
    bool of_triangles;
};
using Box = std::array<Double3, 2>;
Told told_of(test::TestMesh mesh, const std::vector<Box>& boxes, double angle = 0) {
    const auto turn = [&](const Double3& p) -> Double3 {
        const double c = std::cos(angle), s = std::sin(angle);
        return {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
    };
    for (Double3& p : mesh.positions) p = turn(p);
    HullSections sections = *make_hull_sections(test::mesh_of(mesh), {}, 0, serial_for);
    std::vector<ApproximatePart> parts(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        std::vector<Double3> corners;
        for (unsigned k = 0; k < 8; ++k) {
            corners.push_back(
                turn({boxes[i][k & 1U].x, boxes[i][k >> 1U & 1U].y, boxes[i][k >> 2U].z}));
        }
        parts[i].hull = convex_hull(corners);
        parts[i].hull.numbers.clear();
    }
    add_parts(sections, parts);
    const auto opened = test::open_tiny(baked(mesh, sections));
    const auto file = opened.bytes.span();
    EXPECT_FALSE(format::find_damage(file));
    return {find_hull_falsehood(file, opened.model).has_value(),
            find_cover_falsehood(file, opened.model).has_value()};
}

/// From 0 to 4 along x, 1 wide and high.
test::TestMesh bar() {
    test::TestMesh mesh = test::unit_cube();
    for (Double3& p : mesh.positions) p.x *= 4;
    return mesh;
}

// Its corners are in the outer two of three parts. Their borders touch: all is covered, and
// not with the least crack between them, however the parts come one after the other.
TEST(HullParts, ThatLeaveThePartsOfATriangleBetweenThemOutAreFound) {
    const Box left = {{{0, 0, 0}, {1, 1, 1}}}, middle = {{{1, 0, 0}, {3, 1, 1}}},
              right = {{{3, 0, 0}, {4, 1, 1}}};
    for (const auto& boxes : {std::vector{left, middle, right}, std::vector{right, left, middle},
                              std::vector{middle, middle, right, left}}) {
        const Told told = told_of(bar(), boxes);
        EXPECT_FALSE(told.of_vertices);
        EXPECT_FALSE(told.of_triangles);
    }
    const Told without = told_of(bar(), {left, right});
    EXPECT_FALSE(without.of_vertices);
    EXPECT_TRUE(without.of_triangles);
    for (const Double3& low :
         {Double3{std::nextafter(1, 2), 0, 0}, Double3{1, 0x1p-60, 0}, Double3{1, 0, 0x1p-60}}) {
        const Told shrunk = told_of(bar(), {left, {{low, {3, 1, 1}}}, right});
        EXPECT_FALSE(shrunk.of_vertices);
        EXPECT_TRUE(shrunk.of_triangles);
    }
    const Told high = told_of(bar(), {left, {{{1, 0, 0}, {3, 1 - 0x1p-53, 1}}}, right});
    EXPECT_TRUE(high.of_triangles);
}

// Borders across the triangles that are no round numbers: overlapping by a little, or with a
// gap as small.
TEST(HullParts, ThatOverlapByLittleCoverTurnedOnesToo) {
    for (const double angle : {0.3, 0.8, 2.0}) {
        for (const double gap : {-1e-12, 1e-12}) {
            const Told told = told_of(bar(),
                                      {{{{-0.1, -0.1, -0.1}, {1.7 - gap, 1.1, 1.1}}},
                                       {{{1.7, -0.1, -0.1}, {3.1 - gap, 1.1, 1.1}}},
                                       {{{3.1, -0.1, -0.1}, {4.1, 1.1, 1.1}}}},
                                      angle);
            EXPECT_FALSE(told.of_vertices);
            EXPECT_EQ(told.of_triangles, gap > 0) << angle;
        }
    }
}

// A square sheet under two polygons that share a border, and with one of them narrower.
TEST(HullParts, OfASheetAreItsPolygons) {
    const test::TestMesh sheet = {{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}},
                                  {{{0, 1, 2}}, {{0, 2, 3}}}};
    const Box left = {{{0, 0, 0}, {1, 1, 0}}}, right = {{{1, 0, 0}, {2, 1, 0}}};
    EXPECT_FALSE(told_of(sheet, {left, right}).of_triangles);
    EXPECT_TRUE(told_of(sheet, {left, {{{std::nextafter(1, 2), 0, 0}, {2, 1, 0}}}}).of_triangles);
    EXPECT_TRUE(told_of(sheet, {left, {{{1, 0, 1}, {2, 1, 1}}}}).of_triangles);
}

// What the search finds is proved by other means: cuts along axes, along faces, and of sheets.
TEST(HullParts, ThatAreFoundCoverEveryTriangle) {
    test::TestMesh mesh = ring();
    for (const double angle : {0.0, 0.7}) {
        for (Double3& p : mesh.positions) {
            p = {std::cos(angle) * p.x - std::sin(angle) * p.y,
                 std::sin(angle) * p.x + std::cos(angle) * p.y, p.z + 0.1 * p.x};
        }
        for (const std::size_t parts : {3U, 16U}) {
            HullSections sections = with_parts(mesh, parts);
            const auto opened = test::open_tiny(baked(mesh, sections));
            EXPECT_FALSE(find_cover_falsehood(opened.bytes.span(), opened.model)) << parts;
        }
    }
}

// The oracle is the hierarchy of triangles, which is exact. A yes of the parts may be wrong:
// how often is printed.
TEST(HullPartsLaws, MissNoTouch) {
    const auto a = test::open_tiny(baked(ring(), with_parts(ring(), 16)));
    const test::TestMesh small = test::moved_by(test::torus(1, 0.4, 20, 10), 0.5, {0.1, 0.2, 0.3});
    const auto b = test::open_tiny(baked(small, with_parts(small, 8)));
    std::mt19937 random(11);
    int touching = 0, through_parts = 0;
    constexpr int kRounds = 2'000;
    Workspace workspace;
    for (int round = 0; round < kRounds; ++round) {
        const Placement placement = Placement::b_moves(test::random_pose(random, 1.3));
        const bool solids_touch =
            collide({a.model, b.model, placement, {.body = Body::solid}}, workspace).hit ==
            Answer::yes;
        const bool parts_touch = parts_meet(a.model, b.model, placement);
        EXPECT_TRUE(parts_touch || !solids_touch) << round;
        touching += solids_touch ? 1 : 0;
        through_parts += parts_touch ? 1 : 0;
    }
    std::cout << part_count(a.model) << " and " << part_count(b.model) << " parts: " << touching
              << " of " << kRounds << " poses touch, " << through_parts - touching
              << " more by parts\n";
    EXPECT_GT(touching, kRounds * 3 / 10);
    EXPECT_LT(touching, kRounds * 7 / 10);
}

}  // namespace
}  // namespace cdprep::convex
