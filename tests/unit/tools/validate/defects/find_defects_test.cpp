// SPDX-License-Identifier: MIT
#include "validate/defects/find_defects.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <random>
#include <thread>

#include "mesh/weld.h"
#include "support/defect_zoo.h"
#include "unit/tools/soup_of.h"

namespace cdprep::mesh {
namespace {

using format::Verdict;

constexpr std::uint32_t kSolid = format::verdict_closed | format::verdict_two_manifold |
                                 format::verdict_oriented | format::verdict_orientable |
                                 format::verdict_balanced | format::verdict_crossings_examined;
constexpr std::uint32_t kAllPromises = format::promise_surface | format::promise_inside_exact |
                                       format::promise_simple_solid |
                                       format::promise_contained_pieces;

DefectReport report_of(const test::TestMesh& mesh, const DefectOptions& options = {}) {
    return find_defects(test::soup_of(mesh), options);
}

/// The finding of a rule, or an empty one.
Finding finding_of(const DefectReport& report, Rule rule) {
    for (const Finding& finding : report.findings) {
        if (finding.rule == rule) return finding;
    }
    return {rule, 0, {}};
}

using Numbers = std::vector<std::uint32_t>;

// By hand: the cube of edge 2.
TEST(FindDefects, SoundSolidHasNothingWrongAndKeepsAllPromises) {
    const DefectReport report = report_of(test::moved_by(test::unit_cube(), 2, {1, 1, 1}));
    EXPECT_TRUE(report.findings.empty());
    ASSERT_EQ(report.verdicts.size(), 2U);
    for (const Verdict& verdict : report.verdicts) {
        EXPECT_EQ(verdict.facts, kSolid);
        EXPECT_EQ(verdict.promises, kAllPromises);
        EXPECT_EQ(verdict.triangle_count, 12U);
        EXPECT_EQ(verdict.first_triangle, 0U);
        EXPECT_EQ(verdict.boundary_loops, 0U);
        EXPECT_EQ(verdict.euler, 2);
        EXPECT_EQ(verdict.genus, 0);
        EXPECT_EQ(verdict.area, 24);
        EXPECT_EQ(verdict.volume, 8);
        EXPECT_EQ(verdict.reserved, 0U);
    }
}

TEST(FindDefects, GenusCountsHandles) {
    const test::TestMesh ring = test::torus(2, 0.5, 16, 8);
    EXPECT_EQ(report_of(ring).verdicts[1].genus, 1);
    const test::TestMesh two = test::joined(ring, test::moved_by(ring, 1, {10, 0, 0}));
    const DefectReport report = report_of(test::joined(two, test::unit_cube()));
    EXPECT_EQ(report.verdicts.front().genus, 2);
    EXPECT_EQ(report.verdicts.front().euler, 2);  // 0 + 0 + 2
    EXPECT_EQ(report.verdicts[3].genus, 0);
    // Two balls have none, though 2 - their characteristic is negative.
    const test::TestMesh ball = test::icosphere(1);
    const DefectReport balls = report_of(test::joined(ball, test::moved_by(ball, 1, {9, 0, 0})));
    EXPECT_EQ(balls.verdicts.front().euler, 4);
    EXPECT_EQ(balls.verdicts.front().genus, 0);
}

// A book of so many pages that looking through them again at each would show: its two
// spine ends are ends of 2 boundary edges a page, and the whole boundary is one loop.
TEST(FindDefects, ManyBoundaryEdgesAtAVertexAreOneLoop) {
    constexpr std::uint32_t kPages = 100000;
    test::TestMesh book;
    book.positions = {{0, 0, 0}, {0, 0, 1}};
    for (std::uint32_t i = 0; i < kPages; ++i) {
        const double t = 6.283185307179586 * i / kPages;
        book.positions.push_back({std::cos(t), std::sin(t), 0.5});
        book.triangles.push_back({{0, 1, 2 + i}});
    }
    const DefectReport report = report_of(book, {.crossings = false});
    EXPECT_EQ(report.counts.boundary_edges, 2 * kPages);
    EXPECT_EQ(report.counts.boundary_loops, 1U);
    EXPECT_EQ(report.counts.non_manifold_edges, 1U);
    EXPECT_EQ(report.counts.t_junctions, 0U);
    const Finding loops = finding_of(report, Rule::boundary_loop);
    EXPECT_EQ(loops.places.at(0).vertices.front(), 1U);
}

TEST(FindDefects, OfNothingOnlyThatIsFound) {
    const DefectReport report = find_defects({});
    ASSERT_EQ(report.findings.size(), 1U);
    EXPECT_EQ(report.findings[0].rule, Rule::empty_mesh);
    ASSERT_EQ(report.verdicts.size(), 1U);
    EXPECT_EQ(report.verdicts.front().triangle_count, 0U);
    EXPECT_EQ(report.counts.components, 0U);
}

// A cube and, on it, a triangle without a place: only the triangle is reported, and all else
// is as without it. Its corners count as used.
TEST(FindDefects, TrianglesWithoutPlaceAreLeftOutOfAllElse) {
    test::TestMesh cube = test::unit_cube();
    const double infinity = std::numeric_limits<double>::infinity();
    cube.positions.push_back({infinity, -infinity, 3});
    cube.positions.push_back({5, 5, 5});
    cube.triangles.push_back({{0, 8, 1}});
    cube.triangles.push_back({{8, 9, 8}});
    cube.triangles.push_back({{0, 1, 10}});
    const DefectReport report = report_of(cube);
    EXPECT_EQ(report.findings.size(), 2U);
    EXPECT_EQ(report.counts.non_finite_vertices, 1U);
    EXPECT_EQ(report.counts.out_of_range_triangles, 1U);
    EXPECT_EQ(report.verdicts.front().promises, kAllPromises);
    EXPECT_EQ(report.verdicts.front().triangle_count, 12U);
    const Finding not_finite = finding_of(report, Rule::non_finite_coordinate);
    EXPECT_EQ(not_finite.places[0].vertices, Numbers{8});
    EXPECT_EQ(not_finite.places[0].position, (Double3{0, 0, 3}));
    const Finding out_of_range = finding_of(report, Rule::index_out_of_range);
    EXPECT_EQ(out_of_range.places[0].triangles, Numbers{14});
    EXPECT_EQ(out_of_range.places[0].measure, 10);
}

// Of nothing every sentence is true: none may be said, and the mesh is told of.
TEST(FindDefects, MeshesWithoutASoundTrianglePromiseNothingOfTheSolid) {
    const double infinity = std::numeric_limits<double>::infinity();
    const test::TestMesh nothing{{}, {}};
    const test::TestMesh points{{{0, 0, 0}, {1, 0, 0}}, {}};
    const test::TestMesh infinite{{{0, 0, 0}, {1, 0, 0}, {infinity, 0, 0}}, {{{0, 1, 2}}}};
    const test::TestMesh out_of_range{{{0, 0, 0}, {1, 0, 0}}, {{{0, 1, 2}}}};
    const test::TestMesh segments{{{0, 0, 0}, {1, 0, 0}}, {{{0, 1, 0}}, {{1, 1, 0}}}};
    for (const bool crossings : {true, false}) {
        for (const auto* mesh : {&nothing, &points, &infinite, &out_of_range, &segments}) {
            DefectOptions options;
            options.crossings = crossings;
            const DefectReport report = report_of(*mesh, options);
            const Finding finding = finding_of(report, Rule::empty_mesh);
            EXPECT_EQ(finding.count, 1U);
            ASSERT_EQ(finding.places.size(), 1U);
            EXPECT_TRUE(finding.places[0].triangles.empty());
            ASSERT_EQ(report.verdicts.size(), 1U);
            const Verdict& verdict = report.verdicts.front();
            EXPECT_EQ(verdict.facts, crossings ? format::verdict_crossings_examined : 0U);
            EXPECT_EQ(verdict.promises, format::promise_surface);
            EXPECT_EQ(verdict.genus, -1);
            EXPECT_EQ(verdict.euler, 0);
        }
    }
    test::TestMesh one = segments;
    one.positions.push_back({0, 1, 0});
    one.triangles.push_back({{0, 1, 2}});
    EXPECT_EQ(finding_of(report_of(one), Rule::empty_mesh).count, 0U);
}

// As an import leaves them: corners set to 0, all such triangles listed.
TEST(FindDefects, TrianglesOutOfRangeAreThoseOfTheList) {
    TriangleSoup soup = test::soup_of(test::unit_cube());
    constexpr std::uint32_t kBad = 1500;
    for (std::uint32_t i = 0; i < kBad; ++i) {
        const auto number = static_cast<std::uint32_t>(soup.triangles.size());
        soup.out_of_range.push_back({number, -1 - static_cast<std::int64_t>(i)});
        soup.triangles.push_back({{0, 0, 0}});
        // Between the last two is one that is as the file has it.
        if (i + 2 == kBad) soup.triangles.push_back({{0, 0, 0}});
    }
    soup.bad_number_count = kBad;
    DefectOptions options;
    options.max_places = kBad;
    const DefectReport report = find_defects(soup, options);
    EXPECT_EQ(report.counts.out_of_range_triangles, kBad);
    EXPECT_EQ(report.counts.degenerate_triangles, 1U);
    const Finding out_of_range = finding_of(report, Rule::index_out_of_range);
    ASSERT_EQ(out_of_range.places.size(), kBad);
    EXPECT_EQ(out_of_range.places[2].measure, -3);
    EXPECT_EQ(out_of_range.places.back().triangles, Numbers{12 + kBad});
    EXPECT_EQ(out_of_range.places.back().measure, -double{kBad});
    EXPECT_EQ(finding_of(report, Rule::repeated_corner).places[0].triangles,
              Numbers{12 + kBad - 1});
}

// Every triangle has corners of its own: places name those, not the joined ones.
TEST(FindDefects, PlacesOfEdgesNameTheCornersOfTheirTriangle) {
    test::TestMesh cube = test::unshared(test::unit_cube());
    cube.triangles.erase(cube.triangles.begin());
    const DefectReport report = report_of(cube);
    const Finding edges = finding_of(report, Rule::boundary_edge);
    ASSERT_EQ(edges.count, 3U);
    for (const Place& place : edges.places) {
        ASSERT_EQ(place.triangles.size(), 1U);
        ASSERT_EQ(place.vertices.size(), 2U);
        const auto& corners = cube.triangles[place.triangles[0]].vertex;
        for (const std::uint32_t vertex : place.vertices) {
            EXPECT_NE(std::find(corners.begin(), corners.end(), vertex), corners.end());
        }
        const Double3& a = cube.positions[place.vertices[0]];
        const Double3& b = cube.positions[place.vertices[1]];
        EXPECT_EQ(place.measure, std::hypot(a.x - b.x, a.y - b.y, a.z - b.z));
    }
    EXPECT_TRUE(
        std::is_sorted(edges.places.begin(), edges.places.end(),
                       [](const Place& a, const Place& b) { return a.triangles < b.triangles; }));
    // The corners of the triangle that is left out are used by others no more.
    EXPECT_EQ(report.counts.unreferenced_vertices, 3U);
    EXPECT_EQ(report.counts.duplicate_vertices, 28U);
}

// A sheet of 4 x 3 squares without its middle ones: two loops.
TEST(FindDefects, PlacesOfLoopsRunAlongThem) {
    const DefectReport report = report_of(test::grid_sheet(4, 3));
    const Finding loops = finding_of(report, Rule::boundary_loop);
    ASSERT_EQ(loops.count, 1U);
    const Place& rim = loops.places[0];
    EXPECT_EQ(rim.vertices.size(), 14U);  // 2 (4 + 3) edges
    EXPECT_EQ(rim.measure, 5);            // the diagonal of 4 by 3
    const test::TestMesh sheet = test::grid_sheet(4, 3);
    for (std::size_t i = 0; i < rim.vertices.size(); ++i) {
        const Double3& a = sheet.positions[rim.vertices[i]];
        const Double3& b = sheet.positions[rim.vertices[(i + 1) % rim.vertices.size()]];
        EXPECT_EQ(std::fabs(a.x - b.x) + std::fabs(a.y - b.y), 1) << "step " << i;
    }
    EXPECT_TRUE(std::is_sorted(rim.triangles.begin(), rim.triangles.end()));
}

TEST(FindDefects, LoopsThatShareAVertexAreOneAndAllTheirEdgesAreNamed) {
    // Two triangles that meet in a point.
    const DefectReport report = report_of(
        {{{0, 0, 0}, {1, 1, 0}, {1, -1, 0}, {-1, 1, 0}, {-1, -1, 0}}, {{{0, 2, 1}}, {{0, 3, 4}}}});
    const Finding loops = finding_of(report, Rule::boundary_loop);
    ASSERT_EQ(loops.count, 1U);
    EXPECT_EQ(loops.places[0].vertices.size(), 6U);
    EXPECT_EQ(loops.places[0].triangles, (Numbers{0, 1}));
    const Finding pinched = finding_of(report, Rule::non_manifold_vertex);
    EXPECT_EQ(pinched.places[0].measure, 2);
    EXPECT_EQ(pinched.places[0].triangles, (Numbers{0, 1}));
    EXPECT_EQ(pinched.places[0].vertices, Numbers{0});
}

// Each triangle twice, with both windings, at coordinates whose products round: the sum of
// doubles has a sign, the volume has none.
TEST(FindDefects, TwoSidedSheetsHaveNoVolumeAndAreNotInverted) {
    std::mt19937 random(20261121);
    std::uniform_real_distribution<double> coordinate(-1, 1);
    int signs = 0;
    for (int round = 0; round < 50; ++round) {
        test::TestMesh sheet = test::grid_sheet(5, 5);
        for (Double3& p : sheet.positions) {
            p = {100 + p.x + 0.1 * coordinate(random), p.y / 3, coordinate(random)};
        }
        double sum = 0;
        const test::TestMesh both = test::joined(sheet, test::reversed(sheet));
        for (const Triangle& t : both.triangles) {
            const Double3& a = both.positions[t.vertex[0]];
            const Double3& b = both.positions[t.vertex[1]];
            const Double3& c = both.positions[t.vertex[2]];
            sum += a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) +
                   a.z * (b.x * c.y - b.y * c.x);
        }
        signs += sum != 0 ? 1 : 0;
        const DefectReport report = report_of(both);
        EXPECT_EQ(report.counts.inverted_components, 0U);
        EXPECT_EQ(report.verdicts[1].volume, 0);
        EXPECT_EQ(report.counts.opposite_triangles, 50U);
        EXPECT_NE(report.verdicts[1].facts & format::verdict_balanced, 0U);
    }
    EXPECT_GT(signs, 10);  // or this would show nothing
}

// D04: a box 1 x 1 x g, far from the origin, g one ulp of its place.
TEST(FindDefects, ThinShellsKnowTheirInsideAndVolumeExactly) {
    const double place = 0x1p40;
    const double thickness = std::nextafter(place, 2 * place) - place;
    test::TestMesh box = test::unit_cube();
    for (Double3& p : box.positions) p.z = place + p.z * thickness;
    EXPECT_EQ(report_of(box).verdicts[1].volume, thickness);
    EXPECT_EQ(report_of(box).counts.inverted_components, 0U);
    const DefectReport turned = report_of(test::reversed(box));
    EXPECT_EQ(turned.counts.inverted_components, 1U);
    EXPECT_EQ(finding_of(turned, Rule::inverted_component).places[0].measure, -thickness);
}

// D06: the Klein bottle cannot be without crossings; only its edges are asked.
TEST(FindDefects, KleinBottleCannotBeOriented) {
    constexpr int kColumns = 7;
    const test::TestMesh bottle = test::klein_bottle(6, kColumns);
    const DefectReport report = report_of(bottle, {.crossings = false});
    EXPECT_EQ(report.counts.non_orientable_components, 1U);
    EXPECT_EQ(report.counts.inconsistent_edges, std::size_t{kColumns});
    const Verdict& verdict = report.verdicts[1];
    EXPECT_EQ(verdict.facts, format::verdict_closed | format::verdict_two_manifold);
    EXPECT_EQ(verdict.euler, 0);
    EXPECT_EQ(verdict.genus, -1);
    EXPECT_EQ(verdict.promises, format::promise_surface);
}

// D07: half a ball has one border, and its pieces cannot be contained.
TEST(FindDefects, HemisphereHasOneBorder) {
    const test::TestMesh ball = test::upper_half(test::icosphere(3));
    const DefectReport report = report_of(ball);
    EXPECT_EQ(report.counts.boundary_loops, 1U);
    EXPECT_EQ(report.verdicts[1].boundary_loops, 1U);
    EXPECT_EQ(report.verdicts[1].promises, format::promise_surface);
    EXPECT_EQ(report.verdicts[1].euler, 1);  // a disc
    EXPECT_EQ(report.verdicts[1].volume, 0);
}

// D08: all animals of the zoo in one.
TEST(FindDefects, DirtySoupHasEachDefectCountedExactly) {
    const std::vector<test::ZooAnimal> zoo = test::defect_zoo();
    test::ZooAnimal all = zoo.front();
    for (std::size_t i = 1; i < zoo.size(); ++i) all = test::side_by_side(all, zoo[i]);
    all.found[404] = all.components;
    const DefectReport report =
        report_of(all.mesh, {.weld_distance = test::kZooWidth, .seam_width = test::kZooWidth});
    ASSERT_EQ(report.findings.size(), all.found.size());
    for (const Finding& finding : report.findings) {
        EXPECT_EQ(finding.count, all.found[static_cast<int>(finding.rule)]) << id_of(finding.rule);
    }
}

// D11: ten thousand coplanar triangles have a rim and nothing else.
TEST(FindDefects, FlatSheetHasNothingButItsRim) {
    const DefectReport report = report_of(test::grid_sheet(100, 50));
    ASSERT_EQ(report.findings.size(), 2U);
    EXPECT_EQ(report.counts.boundary_edges, 300U);
    EXPECT_EQ(report.counts.boundary_loops, 1U);
}

TEST(FindDefects, ExtentBeyondFloatIsToldByVertexOrByAxis) {
    // Each coordinate is a float, the extent is not.
    const double large = 3.4e38;
    const test::TestMesh box = test::moved_by(test::unit_cube(), 2 * large, {-large, -large, 0});
    const Finding wide = finding_of(report_of(box), Rule::extent_beyond_float);
    EXPECT_EQ(wide.count, 2U + 4U);  // x and y; the four vertices above z = 2 large
    const test::TestMesh fits = test::moved_by(test::unit_cube(), large, {0, 0, 0});
    EXPECT_EQ(finding_of(report_of(fits), Rule::extent_beyond_float).count, 0U);
    // Beyond what can be baked, and still nothing else is wrong.
    const DefectReport huge = report_of(test::moved_by(test::unit_cube(), 0x1p1010, {0, 0, 0}));
    EXPECT_EQ(finding_of(huge, Rule::extent_beyond_float).count, 7U);
    EXPECT_EQ(huge.findings.size(), 1U);
}

// By hand: a bake keeps the segment, so its ends count as those of other triangles do.
TEST(FindDefects, ExtentBeyondFloatHoldsForTrianglesThatRepeatACorner) {
    const test::TestMesh far_away = {{{1e39, 0, 0}, {0, 1, 0}}, {{{0, 0, 1}}}};
    const Finding alone = finding_of(report_of(far_away), Rule::extent_beyond_float);
    ASSERT_EQ(alone.count, 1U);
    EXPECT_EQ(alone.places[0].vertices, Numbers{0});
    EXPECT_EQ(alone.places[0].measure, 1e39);
    // Each coordinate is a float, the length of the segment is not.
    const test::TestMesh wide = {{{3e38, 0, 0}, {-3e38, 0, 0}}, {{{0, 1, 1}}}};
    const Finding axis = finding_of(report_of(wide), Rule::extent_beyond_float);
    ASSERT_EQ(axis.count, 1U);
    EXPECT_EQ(axis.places[0].vertices, (Numbers{1, 0}));
    EXPECT_EQ(axis.places[0].measure, 6e38);
    // The vertex that a sound triangle uses too is told once, in the order of the file.
    const test::TestMesh both = {{{1e39, 0, 0}, {0, 2e39, 0}, {0, 0, 1}, {0, 0, 3e39}},
                                 {{{1, 0, 2}}, {{3, 3, 1}}}};
    const Finding shared = finding_of(report_of(both), Rule::extent_beyond_float);
    ASSERT_EQ(shared.count, 3U);
    EXPECT_EQ(shared.places[0].vertices, Numbers{0});
    EXPECT_EQ(shared.places[1].vertices, Numbers{1});
    EXPECT_EQ(shared.places[2].vertices, Numbers{3});
}

// Ratio and areas do not depend on the scale, nor on what their squares leave of double.
TEST(FindDefects, ShapesAreJudgedAtAnyScale) {
    test::TestMesh mesh;
    mesh.positions = {{0, 0, 0}, {8, 0, 0}, {4, 0x1p-40, 0}, {4, 4, 0}, {4, 0, 0}};
    mesh.triangles = {{{0, 1, 2}}, {{0, 1, 3}}, {{0, 1, 4}}};
    for (const int exponent : {0, -40, 40, -300, 300, -700, 700, -1000, 1015}) {
        const DefectReport report = report_of(
            test::moved_by(mesh, std::ldexp(1.0, exponent), {0, 0, 0}), {.crossings = false});
        EXPECT_EQ(report.counts.sliver_triangles, 1U) << exponent;
        EXPECT_EQ(report.counts.zero_area_triangles, 1U) << exponent;
        EXPECT_EQ(finding_of(report, Rule::zero_area).places[0].measure, std::ldexp(8.0, exponent));
        EXPECT_DOUBLE_EQ(finding_of(report, Rule::sliver).places[0].measure, 0x1p-44);
    }
}

// Its height is twice the ratio of its area to the square of its longest edge, which is 1.
TEST(FindDefects, ATriangleBelowTheSliverRatioIsASliver) {
    const auto slivers = [](double height) {
        return report_of({{{0, 0, 0}, {1, 0, 0}, {0.5, height, 0}}, {{{0, 1, 2}}}})
            .counts.sliver_triangles;
    };
    EXPECT_EQ(slivers(2e-10), 0U);
    EXPECT_EQ(slivers(std::nextafter(2e-10, 0)), 1U);
}

// By hand: twice the area is 2^-52, less than rounding of the products may hide.
TEST(FindDefects, TheThinnestTriangleHasAnArea) {
    const test::TestMesh thin = {{{0, 0, 0}, {1, 1, 0}, {1, 1 + 0x1p-52, 0}}, {{{0, 1, 2}}}};
    const DefectReport report = report_of(thin);
    EXPECT_EQ(report.counts.zero_area_triangles, 0U);
    EXPECT_EQ(report.counts.sliver_triangles, 1U);
    const test::TestMesh flat = {{{0, 0, 0}, {1, 1, 0}, {2, 2, 0}}, {{{0, 1, 2}}}};
    EXPECT_EQ(report_of(flat).counts.zero_area_triangles, 1U);
}

TEST(FindDefects, CavitiesKeepThePromiseThatNestedSolidsBreak) {
    const test::TestMesh outer = test::moved_by(test::unit_cube(), 8, {0, 0, 0});
    const test::TestMesh inner = test::moved_by(test::unit_cube(), 2, {3, 3, 3});
    const DefectReport cavity = report_of(test::joined(outer, test::reversed(inner)));
    EXPECT_EQ(cavity.counts.nested_components, 1U);
    EXPECT_EQ(cavity.counts.inverted_components, 1U);
    EXPECT_EQ(cavity.verdicts[0].promises, kAllPromises);
    EXPECT_EQ(cavity.verdicts[0].volume, 512 - 8);
    EXPECT_EQ(cavity.verdicts[2].promises, kAllPromises & ~format::promise_simple_solid);
    const DefectReport solid = report_of(test::joined(outer, inner));
    EXPECT_EQ(solid.counts.nested_components, 1U);
    EXPECT_EQ(solid.verdicts[0].promises, kAllPromises & ~format::promise_simple_solid);
    const Place place = finding_of(solid, Rule::nested_component).places[0];
    EXPECT_EQ(place.triangles, (Numbers{0, 12}));
    EXPECT_EQ(place.measure, 1);
    // Without a look at crossings nothing can be promised of the whole.
    const DefectReport quick = report_of(outer, {.crossings = false});
    EXPECT_EQ(quick.verdicts[0].promises, kAllPromises & ~format::promise_simple_solid);
}

// The inner one's lowest vertex lies on the outer one's face, the others within.
TEST(FindDefects, NestingIsDecidedByAVertexOffTheSurface) {
    const test::TestMesh outer = test::moved_by(test::unit_cube(), 8, {0, 0, 0});
    const test::TestMesh inner = {{{8, 3, 5}, {6, 2, 5}, {6, 4, 4}, {6, 3, 7}},
                                  {{{0, 2, 1}}, {{0, 3, 2}}, {{0, 1, 3}}, {{1, 2, 3}}}};
    const DefectReport within = report_of(test::joined(outer, inner));
    EXPECT_EQ(within.counts.nested_components, 1U);
    const test::TestMesh outside = test::moved_by(test::reversed(inner), -1, {16, 6, 10});
    const DefectReport beside = report_of(test::joined(outer, outside));
    EXPECT_EQ(beside.counts.touching_pairs, within.counts.touching_pairs);
    EXPECT_EQ(beside.counts.nested_components, 0U);
}

TEST(FindDefects, ComponentsInComponentsAreEachAPair) {
    test::TestMesh dolls = test::unit_cube();
    for (int size = 3; size <= 9; size += 2) {
        dolls = test::joined(
            dolls, test::moved_by(test::unit_cube(), size,
                                  {(1.0 - size) / 2, (1.0 - size) / 2, (1.0 - size) / 2}));
    }
    const DefectReport report = report_of(dolls);
    EXPECT_EQ(report.counts.components, 5U);
    EXPECT_EQ(report.counts.nested_components, 10U);  // 4 + 3 + 2 + 1
}

TEST(FindDefects, TrianglesThatRepeatACornerCountWithTheirComponent) {
    test::TestMesh mesh =
        test::joined(test::unit_cube(), test::moved_by(test::unit_cube(), 1, {5, 0, 0}));
    mesh.triangles.push_back({{9, 9, 10}});
    mesh.positions.push_back({50, 50, 50});
    mesh.triangles.push_back({{16, 16, 16}});
    // Nothing is connected by one.
    mesh.triangles.push_back({{0, 0, 9}});
    const DefectReport report = report_of(mesh);
    EXPECT_EQ(report.counts.components, 2U);
    EXPECT_EQ(report.counts.degenerate_triangles, 3U);
    EXPECT_EQ(report.verdicts[0].triangle_count, 27U);
    EXPECT_EQ(report.verdicts[1].triangle_count, 13U);
    EXPECT_EQ(report.verdicts[2].triangle_count, 13U);
    EXPECT_EQ(report.verdicts[2].first_triangle, 12U);
}

// A crack along one loop: a slit whose sides are 1/8 apart.
TEST(FindDefects, SlitsOfOneLoopAreSeams) {
    // Two strips joined at the left: the slit is y in [0, 1/8], x in [0, 8].
    test::TestMesh slit;
    slit.positions = {{-2, 0, 0},    {0, 0, 0},     {8, 0, 0}, {8, -4, 0}, {-2, -4, 0},
                      {0, 0.125, 0}, {8, 0.125, 0}, {8, 4, 0}, {-2, 4, 0}};
    slit.triangles = {{{0, 4, 1}}, {{1, 4, 3}}, {{1, 3, 2}}, {{0, 1, 5}},
                      {{0, 5, 8}}, {{5, 7, 8}}, {{5, 6, 7}}};
    const DefectReport report = report_of(slit, {.seam_width = 0.25});
    EXPECT_EQ(report.counts.boundary_loops, 1U);
    // The ends at x = 8; those at x = 0 are neighbours, 1/8 apart along the loop.
    const Finding seams = finding_of(report, Rule::near_seam);
    ASSERT_EQ(seams.count, 2U);
    EXPECT_EQ(seams.places[0].vertices[0], 2U);
    EXPECT_EQ(seams.places[0].measure, 0.125);
    EXPECT_EQ(seams.places[1].vertices[0], 6U);
    EXPECT_EQ(report_of(slit, {.seam_width = 0.1}).counts.near_seams, 0U);
    EXPECT_EQ(report_of(slit).counts.near_seams, 0U);
}

// Around a slit's closed end, ends at most four widths apart along the loop are neighbours: here
// the way is 2 + 1/8 + 2, of exact lengths. A width of 33/32 makes that the limit itself.
TEST(FindDefects, EndsFourWidthsApartAlongTheLoopAreNeighbours) {
    test::TestMesh slit;
    slit.positions = {{-2, 0, 0},    {0, 0, 0},     {2, 0, 0}, {2, -4, 0}, {-2, -4, 0},
                      {0, 0.125, 0}, {2, 0.125, 0}, {2, 4, 0}, {-2, 4, 0}};
    slit.triangles = {{{0, 4, 1}}, {{1, 4, 3}}, {{1, 3, 2}}, {{0, 1, 5}},
                      {{0, 5, 8}}, {{5, 7, 8}}, {{5, 6, 7}}};
    const double limit = 4.125 / 4;
    EXPECT_EQ(report_of(slit, {.seam_width = limit}).counts.near_seams, 0U);
    EXPECT_GT(report_of(slit, {.seam_width = std::nextafter(limit, 0)}).counts.near_seams, 0U);
}

TEST(FindDefects, NearVerticesAreThoseThatWeldingWouldJoin) {
    const test::TestMesh mesh = test::random_soup(5, 60, 0.5);
    const DefectReport report = report_of(mesh, {.weld_distance = 0.3, .crossings = false});
    const Finding near = finding_of(report, Rule::near_vertex);
    const Welded welded = weld(test::soup_of(mesh), {.distance = 0.3});
    EXPECT_EQ(near.count, welded.report.merged_vertices);
    EXPECT_GT(near.count, 180U * 3 / 10);
    EXPECT_LT(near.count, 180U * 7 / 10);
    for (const Place& place : near.places) {
        ASSERT_EQ(place.vertices.size(), 2U);
        EXPECT_LT(place.vertices[0], place.vertices[1]);
        EXPECT_GT(place.measure, 0);
    }
}

// By hand: an upright triangle through a flat one, along x = 1 from y = 0 to 2 or less.
TEST(FindDefects, PlacesOfMeetingsLieWhereTrianglesMeet) {
    const test::TestMesh flat = {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{{0, 1, 2}}}};
    const auto place_with = [&flat](const test::TestMesh& other, Rule rule) {
        const Finding finding = finding_of(report_of(test::joined(flat, other)), rule);
        EXPECT_EQ(finding.count, 1U);
        EXPECT_EQ(finding.places.at(0).triangles, (Numbers{0, 1}));
        return finding.places.at(0).position;
    };
    const test::TestMesh through = {{{1, 1, -1}, {1, 1, 1}, {1, 9, 0}}, {{{0, 1, 2}}}};
    EXPECT_EQ(place_with(through, Rule::crossing_triangles), (Double3{1, 2, 0}));
    const test::TestMesh on_it = {{{1, 1, 0}, {1, 1, 1}, {2, 1, 1}}, {{{0, 1, 2}}}};
    EXPECT_EQ(place_with(on_it, Rule::touching_triangles), (Double3{1, 1, 0}));
    const test::TestMesh within = {{{1, 1, 0}, {1.75, 1, 0}, {1, 1.75, 0}}, {{{0, 1, 2}}}};
    const Double3 middle = place_with(within, Rule::coplanar_overlap);
    EXPECT_DOUBLE_EQ(middle.x, 1.25);
    EXPECT_DOUBLE_EQ(middle.y, 1.25);
    EXPECT_EQ(middle.z, 0);
}

// A hundred thousand in a row along the rays that nesting casts, each in its own box.
TEST(FindDefects, ComponentsInARowAreNotAskedOfEachOther) {
    test::TestMesh row;
    constexpr std::uint32_t kCount = 100'000;
    for (std::uint32_t i = 0; i < kCount; ++i) {
        const double x = 2.0 * i;
        row.positions.insert(row.positions.end(), {{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0}, {x, 0, 1}});
        for (const Triangle& t :
             {Triangle{{0, 2, 1}}, Triangle{{0, 1, 3}}, Triangle{{0, 3, 2}}, Triangle{{1, 2, 3}}}) {
            row.triangles.push_back(
                {{4 * i + t.vertex[0], 4 * i + t.vertex[1], 4 * i + t.vertex[2]}});
        }
    }
    const DefectReport report = report_of(row, {.crossings = false});
    EXPECT_EQ(report.counts.components, kCount);
    EXPECT_EQ(report.findings.size(), 1U);
}

// ------------------------------------------------------------ threads, and a million places

void expect_same(const DefectReport& a, const DefectReport& b) {
    ASSERT_EQ(a.findings.size(), b.findings.size());
    for (std::size_t i = 0; i < a.findings.size(); ++i) {
        EXPECT_EQ(a.findings[i].rule, b.findings[i].rule);
        EXPECT_EQ(a.findings[i].count, b.findings[i].count);
        ASSERT_EQ(a.findings[i].places.size(), b.findings[i].places.size());
        for (std::size_t k = 0; k < a.findings[i].places.size(); ++k) {
            const Place& p = a.findings[i].places[k];
            const Place& q = b.findings[i].places[k];
            EXPECT_EQ(p.triangles, q.triangles);
            EXPECT_EQ(p.vertices, q.vertices);
            EXPECT_EQ(p.position, q.position);
            EXPECT_EQ(p.measure, q.measure);
        }
    }
    EXPECT_EQ(std::memcmp(&a.counts, &b.counts, sizeof a.counts), 0);
    ASSERT_EQ(a.verdicts.size(), b.verdicts.size());
    EXPECT_EQ(
        std::memcmp(a.verdicts.data(), b.verdicts.data(), a.verdicts.size() * sizeof(Verdict)), 0);
}

TEST(FindDefects, SaysTheSameOnAnyThreadsInAnyOrder) {
    test::TestMesh mesh = test::joined(test::coarse_grid_soup(7, 400, 6), test::icosphere(3));
    mesh = test::joined(mesh, test::moved_by(test::icosphere(3), 1, {0.5, 0, 0}));
    const DefectReport alone = report_of(mesh);
    EXPECT_GT(alone.findings.size(), 8U);
    for (std::size_t threads = 1; threads <= 8; ++threads) {
        const auto run = [threads](std::size_t count,
                                   const std::function<void(std::size_t)>& body) {
            std::vector<std::size_t> order(count);
            std::iota(order.begin(), order.end(), std::size_t{0});
            std::shuffle(order.begin(), order.end(),
                         std::mt19937(static_cast<std::uint32_t>(threads)));
            std::vector<std::jthread> team;
            for (std::size_t t = 0; t < threads; ++t) {
                team.emplace_back([&, t] {
                    for (std::size_t i = t; i < count; i += threads) body(order[i]);
                });
            }
        };
        expect_same(report_of(mesh, {.parallel_for = run}), alone);
    }
}

// 400,000 triangles apart: 1.2 million boundary edges, 400,000 loops and components.
TEST(FindDefects, KeepsFewPlacesOfAMillionAndCountsThemAll) {
    constexpr std::uint32_t kCount = 400'000;
    test::TestMesh mesh;
    for (std::uint32_t i = 0; i < kCount; ++i) {
        const double x = 4.0 * (i % 1000), y = 4.0 * (i / 1000);
        mesh.positions.insert(mesh.positions.end(), {{x, y, 0}, {x + 1, y, 0}, {x, y + 1, 1}});
        mesh.triangles.push_back({{3 * i, 3 * i + 1, 3 * i + 2}});
    }
    const DefectReport report = report_of(mesh, {.max_places = 10});
    EXPECT_EQ(report.counts.boundary_edges, 3U * kCount);
    EXPECT_EQ(report.counts.boundary_loops, kCount);
    EXPECT_EQ(report.counts.components, kCount);
    std::uint64_t found = 0;
    for (const Finding& finding : report.findings) {
        found += finding.count;
        EXPECT_EQ(finding.places.size(), 10U);
        EXPECT_EQ(finding.places.capacity() < 100, true);
    }
    EXPECT_EQ(found, 5U * kCount);
    // Triangle 3's first edge is the tenth of the edges.
    EXPECT_EQ(finding_of(report, Rule::boundary_edge).places[9].triangles, Numbers{3});
}

// One place may not grow with the mesh either.
TEST(FindDefects, CutsThePlaceOfALongLoop) {
    const DefectReport report = report_of(test::grid_sheet(2000, 1));
    const Finding loops = finding_of(report, Rule::boundary_loop);
    EXPECT_EQ(report.counts.boundary_edges, 4002U);
    EXPECT_EQ(loops.places[0].vertices.size(), 1000U);
    EXPECT_LE(loops.places[0].triangles.size(), 1000U);
}

}  // namespace
}  // namespace cdprep::mesh
